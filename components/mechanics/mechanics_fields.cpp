// SPDX-License-Identifier: BSD-3-Clause
// Fields that mechanics shows, gives and takes, and the extrema for the history.
#include <algorithm>
#include <cmath>
#include <limits>

#include "components/mechanics/hex8_volume.hpp"
#include "components/mechanics/mechanics.hpp"

namespace tenon {

namespace {

double von_mises_stress(Hex8Block& block, LocalIndex e) {
  const double mean = (block.stress(e, 0) + block.stress(e, 1) + block.stress(e, 2)) / 3;
  const double x = block.stress(e, 0) - mean, y = block.stress(e, 1) - mean, z = block.stress(e, 2) - mean;
  const double xy = block.stress(e, 3), yz = block.stress(e, 4), zx = block.stress(e, 5);
  return std::sqrt(1.5 * (x * x + y * y + z * z + 2 * (xy * xy + yz * yz + zx * zx)));
}

FieldDescription node_vector(std::string name, std::string unit) {
  return {std::move(name), Location::node, FieldKind::point_value, 3, std::move(unit)};
}

}  // namespace

template <typename Value>
ExportPort Mechanics::element_port(std::string field, int components, std::string unit, Value value) {
  return {{std::move(field), Location::element, FieldKind::point_value, components, std::move(unit)},
          [this, components, value](std::span<double> out) {
            auto to = out.begin();
            for (std::size_t b = 0; b < blocks_.size(); ++b)
              for (LocalIndex e = 0; e < blocks_[b]->size(); ++e)
                for (int c = 0; c < components; ++c) *to++ = value(b, e, c);
          }};
}

std::vector<ExportPort> Mechanics::exports() {
  std::vector<ExportPort> ports;
  ports.push_back({node_vector("displacement", "m"), [this](std::span<double> out) {
                     for (std::size_t n = 0; n < nodes_.size(); ++n)
                       for (std::size_t c = 0; c < 3; ++c)
                         out[3 * n + c] = nodes_.position()[n][c] - mesh_->coordinates[n][c];
                   }});
  ports.push_back({node_vector("velocity", "m/s"), [this](std::span<double> out) {
                     for (std::size_t n = 0; n < nodes_.size(); ++n)
                       for (std::size_t c = 0; c < 3; ++c) out[3 * n + c] = nodes_.velocity()[n][c];
                   }});
  ports.push_back(
      element_port("stress", 6, "Pa", [this](std::size_t b, LocalIndex e, int c) { return blocks_[b]->stress(e, c); }));
  ports.push_back(element_port("von_mises", 1, "Pa",
                               [this](std::size_t b, LocalIndex e, int) { return von_mises_stress(*blocks_[b], e); }));
  ports.push_back(element_port("pressure", 1, "Pa", [this](std::size_t b, LocalIndex e, int) {
    return -(blocks_[b]->stress(e, 0) + blocks_[b]->stress(e, 1) + blocks_[b]->stress(e, 2)) / 3;
  }));
  ports.push_back(element_port("eqps", 1, "1", [this](std::size_t b, LocalIndex e, int) {
    return blocks_[b]->plastic() ? blocks_[b]->history(e, 0) : 0.0;
  }));
  ports.push_back(element_port("density", 1, "kg/m^3", [this](std::size_t b, LocalIndex e, int) {
    return value_of(blocks_[b]->mass, e) / hex8_volume(mesh_->blocks[b].nodes(e), nodes_.position());
  }));
  ports.push_back(element_port("temperature", 1, "K", [this](std::size_t b, LocalIndex e, int) {
    return value_of(blocks_[b]->temperature, e);
  }));
  if (options_.heat == HeatMode::exported)
    ports.push_back({{"plastic_heat", Location::element, FieldKind::total, 1, "J"},
                     [this](std::span<double> out) { give_heat(out); }});
  return ports;
}

std::vector<ImportPort> Mechanics::imports() {
  return {{{"temperature", Location::element, FieldKind::point_value, 1, "K"},
           [this](std::span<const double> values) { take_temperature(values); }}};
}

// What comes before the first step is the temperature at which the body is free of stress, unless the user gave one.
void Mechanics::take_temperature(std::span<const double> values) {
  auto from = values.begin();
  for (const auto& block : blocks_) {
    for (LocalIndex e = 0; e < block->size(); ++e) value_of(block->temperature, e) = *from++;
    block->fill_padding();
    if (!started_ && !options_.initial_temperature) block->temperature_used = block->temperature;
  }
}

double Mechanics::heat(std::size_t block, LocalIndex element) const {
  const std::optional<ThermalProperties>& thermal = blocks_[block]->material().thermal;
  return thermal ? thermal->taylor_quinney * value_of(blocks_[block]->plastic_work, element) : 0.0;
}

void Mechanics::give_heat(std::span<double> values) {
  auto to = values.begin();
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    for (LocalIndex e = 0; e < blocks_[b]->size(); ++e) {
      const double now = heat(b, e);
      *to++ = now - value_of(heat_given_[b], e);
      value_of(heat_given_[b], e) = now;
    }
}

std::vector<HistoryValue> Mechanics::history_values() {
  using Reduce = HistoryValue::Reduce;
  constexpr double none = -std::numeric_limits<double>::infinity();
  double eqps = none, von_mises = none, temperature = none, moved = none;
  bool plastic = false;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    Hex8Block& block = *blocks_[b];
    plastic = plastic || block.plastic();
    for (LocalIndex e = 0; e < block.size(); ++e) {
      if (block.plastic()) eqps = std::max(eqps, block.history(e, 0));
      von_mises = std::max(von_mises, von_mises_stress(block, e));
      temperature = std::max(temperature, value_of(block.temperature, e));
    }
  }
  for (const LocalIndex n : mesh_->owned_nodes) {
    const auto i = static_cast<std::size_t>(n);
    moved = std::max(moved, norm(nodes_.position()[i] - mesh_->coordinates[i]));
  }
  std::vector<HistoryValue> values;
  if (plastic) values.push_back({"max_eqps", Reduce::max, eqps});
  values.push_back({"max_von_mises", Reduce::max, von_mises});
  values.push_back({"max_temperature", Reduce::max, temperature});
  values.push_back({"max_displacement", Reduce::max, moved});
  return values;
}

std::vector<SkipCount> Mechanics::skips() const {
  std::vector<SkipCount> skipped;
  if (mesh_->comm.size() == 1) skipped.push_back({"exchange of ghost velocities (one rank)", steps_});
  if (!conditions_.has_motions() && !conditions_.has_walls())
    skipped.push_back({"prescribed motions and walls (none)", steps_});
  return skipped;
}

}  // namespace tenon
