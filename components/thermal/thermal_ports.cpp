// SPDX-License-Identifier: BSD-3-Clause
// What the component shows, takes, books and saves.
#include <algorithm>
#include <cstring>

#include "components/thermal/thermal.hpp"

namespace tenon {

std::vector<ExportPort> Thermal::exports() {
  return {{{"temperature", Location::node, FieldKind::point_value, 1, "K"},
           [this](std::span<double> out) { std::ranges::copy(temperature(), out.begin()); }},
          {{"heat_flux", Location::element, FieldKind::flux, 3, "W/m^2"},
           [this](std::span<double> out) { read_heat_flux(out); }}};
}

std::vector<ImportPort> Thermal::imports() {
  std::string hurry;
  if (chooses_step() && !options_.control.maximum)
    hurry = "the stepper tr_bdf2 of '" + name() +
            "' chooses its step from the heat that comes, so it must see it at once: give it time_step.maximum or "
            "time_step.fixed";
  std::vector<ImportPort> ports{{{"displacement", Location::node, FieldKind::point_value, 3, "m"},
                                 [this](std::span<const double> values) { receive_displacement(values); }},
                                {{"heat", Location::node, FieldKind::total, 1, "J"},
                                 [this](std::span<const double> values) { receive_heat(values); },
                                 hurry}};
  if (contact_ && contact_->needs_pressure())
    ports.push_back({{"contact_pressure", Location::node, FieldKind::point_value, 1, "Pa"},
                     [this](std::span<const double> values) { receive_pressure(values); }});
  return ports;
}

// -k grad T at the centre of each element.
void Thermal::read_heat_flux(std::span<double> out) const {
  std::array<Vec3, max_linear_nodes> corners;
  std::array<double, max_linear_nodes> values{};
  std::size_t place = 0;
  for (std::size_t b = 0; b < mesh_->blocks.size(); ++b) {
    const ElementBlock& block = mesh_->blocks[b];
    const thermal::ElementTable& table = matrix_.table(b);
    const thermal::Conductivity& conductivity = matrix_.conductivity(b);
    for (LocalIndex e = 0; e < block.size(); ++e) {
      const auto nodes = block.nodes(e);
      for (std::size_t a = 0; a < nodes.size(); ++a) {
        corners[a] = coordinates_[static_cast<std::size_t>(nodes[a])];
        values[a] = temperature_[static_cast<std::size_t>(nodes[a])];
      }
      const Vec3 gradient = thermal::centre_gradient(table, std::span(corners).first(nodes.size()),
                                                     std::span(values).first(nodes.size()));
      double mean = 0;
      for (std::size_t a = 0; a < nodes.size(); ++a) mean += values[a];
      const Vec3 uphill = conductivity.times(gradient, mean / static_cast<double>(nodes.size()));
      for (std::size_t c = 0; c < 3; ++c) out[place++] = -uphill[c];
    }
  }
}

void Thermal::receive_heat(std::span<const double> values) {
  for (std::size_t k = 0; k < waiting_heat_.size(); ++k) {
    const double heat = values[static_cast<std::size_t>(mesh_->owned_nodes[k])];
    waiting_heat_[k] += heat;
    supplied_[transferred][k] += heat;
  }
}

// Ghost nodes are refreshed from their owners when the geometry is, so only owned ones count here.
void Thermal::receive_displacement(std::span<const double> values) {
  displaced_ = true;
  for (const LocalIndex n : mesh_->owned_nodes) {
    double* mine = displacement_.data() + 3 * static_cast<std::size_t>(n);
    const double* theirs = values.data() + 3 * static_cast<std::size_t>(n);
    if (std::memcmp(mine, theirs, 3 * sizeof(double)) == 0) continue;
    std::copy_n(theirs, 3, mine);
    moved_here_ = true;
  }
}

void Thermal::energies(std::vector<EnergyTerm>& terms) {
  EnergyTerm& stored = terms.emplace_back(EnergyTerm{"thermal_energy", EnergyTerm::Role::stored, {}});
  for (std::size_t k = 0; k < rise_.size(); ++k) {
    if (content_.is_linear())
      stored.local.add_product(capacity_[k], rise_[k]);
    else
      stored.local.add(node_energy(k));
    stored.local.add(waiting_heat_[k]);
  }
  constexpr std::array<const char*, supplies> rows{"transferred_heat", "flux_heat",       "convection_heat",
                                                   "source_heat",      "prescribed_heat", "radiation_heat",
                                                   "steady_heat"};
  for (std::size_t kind = 0; kind < supplies; ++kind) {
    if (kind != transferred && !booked_[kind]) continue;
    terms.emplace_back(EnergyTerm{rows[kind], EnergyTerm::Role::supplied, {}}).local.add(supplied_[kind]);
  }
  if (contact_) terms.emplace_back(EnergyTerm{"contact_heat", EnergyTerm::Role::memo, {}}).local.add(passed_);
}

std::vector<HistoryValue> Thermal::history_values() {
  HistoryValue greatest{"max_temperature", HistoryValue::Reduce::max, -std::numeric_limits<double>::infinity()};
  HistoryValue least{"min_temperature", HistoryValue::Reduce::min, std::numeric_limits<double>::infinity()};
  for (const LocalIndex n : mesh_->owned_nodes) {
    const double t = temperature_[static_cast<std::size_t>(n)];
    greatest.local = std::max(greatest.local, t);
    least.local = std::min(least.local, t);
  }
  return {greatest, least};
}

std::vector<SkipCount> Thermal::skips() const {
  return {{"conductivity kept (no displacement)", skipped_assemblies_}};
}

std::vector<std::pair<std::string, std::vector<double>*>> Thermal::owned_state() {
  constexpr std::array<const char*, supplies> names{"transferred", "flux",      "convection", "source",
                                                    "prescribed",  "radiation", "steady"};
  std::vector<std::pair<std::string, std::vector<double>*>> state{
      {"initial_temperature", &initial_}, {"temperature_rise", &rise_}, {"waiting_heat", &waiting_heat_}};
  if (contact_) state.emplace_back("contact_heat", &passed_);
  for (std::size_t kind = 0; kind < supplies; ++kind)
    if (kind == transferred || booked_[kind])
      state.emplace_back(std::string("supplied_") + names[kind], &supplied_[kind]);
  return state;
}

void Thermal::save(CheckpointWriter& file) {
  std::vector<GlobalId> ids;
  std::vector<double> increment, displacement;
  for (const LocalIndex owned : mesh_->owned_nodes) {
    const auto n = static_cast<std::size_t>(owned);
    ids.push_back(mesh_->node_ids[n]);
    increment.push_back(increment_[n]);
    for (std::size_t c = 0; c < 3; ++c) displacement.push_back(displacement_[3 * n + c]);
  }
  const GlobalOrder order(mesh_->comm, ids, mesh_->global_nodes);
  if (contact_ && contact_->needs_pressure()) {
    std::vector<double> pressure;
    for (const LocalIndex n : mesh_->owned_nodes) pressure.push_back(pressure_[static_cast<std::size_t>(n)]);
    file.array(name() + ".contact_pressure", order, pressure, 1);
    file.integer(name() + ".contact_pressure_known", pressed_ ? 1 : 0);
  }
  for (const auto& [field, values] : owned_state()) file.array(name() + "." + field, order, *values, 1);
  file.array(name() + ".displacement", order, displacement, 3);
  file.array(name() + ".last_increment", order, increment, 1);
  file.scalar(name() + ".last_dt", last_dt_);
  file.scalar(name() + ".next_step", next_step_);
  file.integer(name() + ".multigrid", multigrid_chosen_ ? 1 : 0);
  file.scalar(name() + ".multigrid_factor", multigrid_factor_);
  // A displacement that has come but is not yet assembled changes the matrix, as it will in a run that goes on.
  file.integer(name() + ".multigrid_stale", mesh_->comm.any(multigrid_stale_ || moved_here_) ? 1 : 0);
}

void Thermal::load(const CheckpointReader& file) {
  std::vector<GlobalId> ids;
  for (const LocalIndex n : mesh_->owned_nodes) ids.push_back(mesh_->node_ids[static_cast<std::size_t>(n)]);
  const GlobalOrder owned(mesh_->comm, ids, mesh_->global_nodes);
  // A scene that restarts with other loads or another stepper books what it has not met before from zero on.
  for (const auto& [field, values] : owned_state())
    if ((!field.starts_with("supplied_") && field != "contact_heat") || file.has(name() + "." + field))
      file.array(name() + "." + field, owned, *values, 1);
  const GlobalOrder all(mesh_->comm, mesh_->node_ids, mesh_->global_nodes);
  file.array(name() + ".displacement", all, displacement_, 3);
  file.array(name() + ".last_increment", all, increment_, 1);
  if (contact_ && contact_->needs_pressure() && file.has(name() + ".contact_pressure")) {
    file.array(name() + ".contact_pressure", all, pressure_, 1);
    pressed_ = file.integer(name() + ".contact_pressure_known") != 0;
  }
  last_dt_ = file.scalar(name() + ".last_dt");
  next_step_ = file.scalar(name() + ".next_step");
  multigrid_chosen_ =
      options_.preconditioner != ThermalPreconditioner::jacobi && file.integer(name() + ".multigrid") != 0;
  multigrid_factor_ = file.scalar(name() + ".multigrid_factor");
  loaded_stale_ = file.integer(name() + ".multigrid_stale") != 0;
  loaded_ = true;
}

std::int64_t Thermal::memory() const {
  std::size_t values = displacement_.size() + temperature_.size() + increment_.size() + 3 * coordinates_.size();
  for (const std::vector<double>* v : {&initial_, &rise_, &capacity_, &volume_, &film_, &waiting_heat_, &right_side_,
                                       &residual_, &diagonal_, &inverse_diagonal_})
    values += v->size();
  for (const std::vector<double>& v : supplied_) values += v.size();
  values += passed_.size() + pending_passed_.size();
  for (const std::vector<double>& v : pending_) values += v.size();
  for (const std::vector<double>* v :
       {&rate_, &first_rate_, &mid_rate_, &target_, &start_rise_, &start_energy_, &given_, &received_})
    values += v->size();
  return static_cast<std::int64_t>(values * sizeof(double)) + matrix_.memory() + solver_.memory() + content_.memory() +
         (multigrid_ ? multigrid_->memory() : 0) + (contact_ ? contact_->memory() : 0);
}

}  // namespace tenon
