// SPDX-License-Identifier: BSD-3-Clause
// Fields that mechanics shows, gives and takes, and the extrema for the history.
#include <algorithm>
#include <cmath>
#include <limits>

#include "components/mechanics/mechanics.hpp"

namespace tenon {

namespace {

double von_mises_stress(const ElementGroup& block, LocalIndex e) {
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
            groups_.in_mesh_order([&](const ElementGroup& group, LocalIndex e) {
              for (int c = 0; c < components; ++c) *to++ = value(group, e, c);
            });
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
  using Group = ElementGroup;
  ports.push_back(element_port("stress", 6, "Pa",
                               [](const Group& g, LocalIndex e, int component) { return g.stress(e, component); }));
  ports.push_back(
      element_port("von_mises", 1, "Pa", [](const Group& g, LocalIndex e, int) { return von_mises_stress(g, e); }));
  ports.push_back(element_port("pressure", 1, "Pa", [](const Group& g, LocalIndex e, int) {
    return -(g.stress(e, 0) + g.stress(e, 1) + g.stress(e, 2)) / 3;
  }));
  ports.push_back(element_port(
      "eqps", 1, "1", [](const Group& g, LocalIndex e, int) { return g.model().plastic() ? g.history(e, 0) : 0.0; }));
  if (nodes_.has_rotations()) {
    ports.push_back(element_port("stress_top", 6, "Pa", [](const Group& g, LocalIndex e, int component) {
      return g.face_stress(e, component, true);
    }));
    ports.push_back(element_port("stress_bottom", 6, "Pa", [](const Group& g, LocalIndex e, int component) {
      return g.face_stress(e, component, false);
    }));
    ports.push_back(
        element_port("thickness", 1, "m", [](const Group& g, LocalIndex e, int) { return g.thickness(e); }));
  }
  ports.push_back(element_port("density", 1, "kg/m^3", [this](const Group& g, LocalIndex e, int) {
    return value_of(g.mass, e) / g.volume(e, nodes_.position());
  }));
  ports.push_back(element_port("temperature", 1, "K",
                               [](const Group& g, LocalIndex e, int) { return value_of(g.temperature, e); }));
  if (std::ranges::any_of(groups_, [](const auto& group) { return group->model().damage() >= 0; })) {
    ports.push_back(element_port("damage", 1, "1", [](const Group& g, LocalIndex e, int) {
      return g.model().damage() >= 0 ? g.history(e, g.model().damage()) : 0.0;
    }));
  }
  if (loose_) {
    ports.push_back(element_port("element_status", 1, "1",
                                 [](const Group& g, LocalIndex e, int) { return g.alive(e) ? 1.0 : 0.0; }));
  }
  if (options_.heat == HeatMode::exported)
    ports.push_back({{"plastic_heat", Location::element, FieldKind::total, 1, "J"},
                     [this](std::span<double> out) { give_heat(out); }});
  if (contact_ && contact_->fields()) add_contact_ports(ports);
  return ports;
}

// Contact fills owned nodes; ghosts are refreshed when a field is read.
void Mechanics::add_contact_ports(std::vector<ExportPort>& ports) {
  ContactFields& fields = *contact_->fields();
  const auto vector = [&](std::string field, std::string unit, std::vector<Vec3>& values) {
    ports.push_back({node_vector(std::move(field), std::move(unit)), [this, &values](std::span<double> out) {
                       for (std::size_t n = 0; n < values.size(); ++n) std::ranges::copy(values[n], &out[3 * n]);
                       mesh_->node_halo.forward<double>(out, out, 3);
                     }});
  };
  const auto scalar = [&](std::string field, FieldKind kind, std::string unit, std::vector<double>& values) {
    ports.push_back(
        {{std::move(field), Location::node, kind, 1, std::move(unit)}, [this, &values, kind](std::span<double> out) {
           std::ranges::copy(values, out.begin());
           mesh_->node_halo.forward<double>(out, out);
           if (kind == FieldKind::total) std::ranges::fill(values, 0.0);
         }});
  };
  vector("contact_force", "N", fields.force);
  vector("contact_slip", "m", fields.slip);
  scalar("gap", FieldKind::point_value, "m", fields.gap);
  scalar("contact_status", FieldKind::point_value, "1", fields.status);
  scalar("contact_pressure", FieldKind::point_value, "Pa", fields.pressure);
  scalar("friction_heat", FieldKind::total, "J", fields.friction_heat);
}

std::vector<ImportPort> Mechanics::imports() {
  return {{{"temperature", Location::element, FieldKind::point_value, 1, "K"},
           [this](std::span<const double> values) { take_temperature(values); }}};
}

// What comes before the first step is the temperature at which the body is free of stress, unless the user gave one.
void Mechanics::take_temperature(std::span<const double> values) {
  auto from = values.begin();
  groups_.in_mesh_order([&](ElementGroup& group, LocalIndex e) { value_of(group.temperature, e) = *from++; });
  for (const auto& group : groups_) {
    group->fill_padding();
    if (!started_ && !options_.initial_temperature) group->temperature_used = group->temperature;
  }
}

double Mechanics::heat(const ElementGroup& group, LocalIndex element) {
  const std::optional<ThermalProperties>& thermal = group.material().thermal;
  return thermal ? thermal->taylor_quinney * value_of(group.plastic_work, element) : 0.0;
}

void Mechanics::give_heat(std::span<double> values) {
  auto to = values.begin();
  groups_.in_mesh_order([&](ElementGroup& group, LocalIndex e) {
    const double now = heat(group, e);
    *to++ = now - value_of(group.heat_given, e);
    value_of(group.heat_given, e) = now;
  });
}

std::vector<HistoryValue> Mechanics::history_values() {
  using Reduce = HistoryValue::Reduce;
  constexpr double none = -std::numeric_limits<double>::infinity();
  double eqps = none, von_mises = none, temperature = none, moved = none;
  bool plastic = false;
  double dead = 0;
  bool can_fail = false;
  for (const auto& group : groups_) {
    plastic = plastic || group->model().plastic(), can_fail = can_fail || group->can_die;
    for (LocalIndex e = 0; e < group->size(); ++e) {
      if (group->model().plastic()) eqps = std::max(eqps, group->history(e, 0));
      von_mises = std::max(von_mises, von_mises_stress(*group, e));
      temperature = std::max(temperature, value_of(group->temperature, e));
      const bool mine = group->elements().owners[static_cast<std::size_t>(e)] == mesh_->comm.rank();
      if (mine && !group->alive(e)) dead += 1;
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
  if (options_.loads.mass_scaling) values.push_back({"added_mass", Reduce::max, added_mass_.added});
  if (relaxation_) values.push_back({"relaxation_residual", Reduce::max, relaxation_->residual()});
  if (can_fail) values.push_back({"failed_elements", Reduce::sum, dead});
  if (loose_ && options_.erosion.loose_nodes == ErosionOptions::LooseNodes::remove) {
    values.push_back({"removed_mass", Reduce::max, removed_[0]});
    for (std::size_t c = 0; c < 3; ++c)
      values.push_back({std::string("removed_momentum_") + "xyz"[c], Reduce::max, removed_[1 + c]});
  }
  return values;
}

std::vector<SkipCount> Mechanics::skips() const {
  std::vector<SkipCount> skipped;
  if (mesh_->comm.size() == 1) skipped.push_back({"exchange of ghost velocities (one rank)", steps_});
  if (!conditions_.has_motions() && !conditions_.has_walls())
    skipped.push_back({"prescribed motions and walls (none)", steps_});
  if (loads_->empty()) skipped.push_back({"loads (none)", steps_});
  if (subcycling_) skipped.push_back({"element updates (subcycling)", work_spared_});
  return skipped;
}

}  // namespace tenon
