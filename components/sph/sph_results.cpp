// SPDX-License-Identifier: BSD-3-Clause
// What particles show: fields at their nodes, rows of the ledger, columns of the history, skips.
#include <algorithm>
#include <cmath>
#include <limits>

#include "components/sph/sph.hpp"

namespace tenon {

namespace {

FieldDescription at_nodes(std::string name, int components, std::string unit) {
  return {std::move(name), Location::node, FieldKind::point_value, components, std::move(unit)};
}

}  // namespace

std::span<const Vec3> Sph::current_coordinates() const {
  if (shown_steps_ == steps_ && !shown_places_.empty()) return shown_places_;
  if (waits_.empty())
    shown_places_.resize(static_cast<std::size_t>(mesh_->nodes()));
  else
    shown_places_ = mesh_->coordinates;
  shown_steps_ = steps_;
  home_->to_nodes(decomposition_->version(), std::span(particles_.position.values).first(3 * particles_.owned()),
                  {shown_places_.data()->data(), 3 * shown_places_.size()}, 3);
  return shown_places_;
}

std::vector<ExportPort> Sph::exports() {
  std::vector<ExportPort> ports;
  const auto column = [&](FieldDescription field, const Column& values) {
    ports.push_back({std::move(field), [this, &values](std::span<double> out) {
                       const auto components = static_cast<std::size_t>(values.components);
                       show_nothing_of_waiting(out, values.components);
                       home_->to_nodes(decomposition_->version(),
                                       std::span(values.values).first(components * particles_.owned()), out,
                                       values.components);
                     }});
  };
  ports.push_back({at_nodes("displacement", 3, "m"), [this](std::span<double> out) {
                     const std::span<const Vec3> x = current_coordinates();
                     for (std::size_t n = 0; n < x.size(); ++n)
                       for (std::size_t c = 0; c < 3; ++c) out[3 * n + c] = x[n][c] - mesh_->coordinates[n][c];
                   }});
  column(at_nodes("velocity", 3, "m/s"), particles_.velocity);
  column(at_nodes("density", 1, "kg/m^3"), particles_.density);
  column(at_nodes("smoothing_length", 1, "m"), particles_.length);
  column(at_nodes("particle_mass", 1, "kg"), particles_.mass);
  if (!waits_.empty())
    ports.push_back({at_nodes("active", 1, "1"), [this](std::span<double> out) {
                       for (std::size_t n = 0; n < out.size(); ++n) out[n] = waits_[n] != 0 ? 0 : 1;
                     }});
  for (const ParticleField& field : formulation_->fields())
    ports.push_back({field.field, [this, field](std::span<double> out) {
                       const auto components = static_cast<std::size_t>(field.field.components);
                       std::vector<double> values(components * particles_.owned());
                       for (std::size_t i = 0; i < particles_.owned(); ++i) field.read(i, &values[components * i]);
                       show_nothing_of_waiting(out, field.field.components);
                       home_->to_nodes(decomposition_->version(), values, out, field.field.components);
                     }});
  if (heat_) column(at_nodes("temperature", 1, "K"), heat_->temperature());
  if (contact_ && contact_->fields()) {
    ContactFields& fields = *contact_->fields();
    const auto vector = [&](std::string name, std::string unit, std::vector<Vec3>& values) {
      ports.push_back({at_nodes(std::move(name), 3, std::move(unit)), [&values](std::span<double> out) {
                         for (std::size_t n = 0; n < values.size(); ++n) std::ranges::copy(values[n], &out[3 * n]);
                       }});
    };
    const auto scalar = [&](std::string name, std::string unit, std::vector<double>& values) {
      ports.push_back({at_nodes(std::move(name), 1, std::move(unit)),
                       [&values](std::span<double> out) { std::ranges::copy(values, out.begin()); }});
    };
    vector("contact_force", "N", fields.force);
    vector("contact_slip", "m", fields.slip);
    scalar("gap", "m", fields.gap);
    scalar("contact_status", "1", fields.status);
    scalar("contact_pressure", "Pa", fields.pressure);
    ports.push_back({{"friction_heat", Location::node, FieldKind::total, 1, "J"}, [&fields](std::span<double> out) {
                       std::ranges::copy(fields.friction_heat, out.begin());
                       std::ranges::fill(fields.friction_heat, 0.0);
                     }});
  }
  return ports;
}

// A temperature that comes replaces what was there, and the heat that it takes is counted; heat is added.
std::vector<ImportPort> Sph::imports() {
  if (!heat_) return {};
  const auto each = [this](std::span<const double> nodes, auto&& take) {
    std::vector<double> values(particles_.owned());
    home_->to_particles(decomposition_->version(), nodes, values, 1);
    for (std::size_t i = 0; i < values.size(); ++i) take(i, values[i]);
  };
  return {{at_nodes("temperature", 1, "K"),
           [this, each](std::span<const double> nodes) {
             each(nodes, [&](std::size_t i, double value) { heat_->set(i, value); });
           }},
          {{"heat", Location::node, FieldKind::total, 1, "J"}, [this, each](std::span<const double> nodes) {
             each(nodes, [&](std::size_t i, double value) { heat_->add_received(i, value); });
           }}};
}

void Sph::energies(std::vector<EnergyTerm>& terms) {
  using Role = EnergyTerm::Role;
  const std::size_t owned = particles_.owned();
  EnergyTerm& kinetic = terms.emplace_back(EnergyTerm{"kinetic_energy", Role::stored, {}});
  for (std::size_t i = 0; i < owned; ++i) {
    if (has_walls_ && is_wall(i)) continue;
    const Vec3 v = particles_.velocity.vec(i);
    kinetic.local.add(0.5 * particles_.mass[i] * dot(v, v));
  }
  const auto row = [&](const std::string& name, Role role, const Column& values) {
    EnergyTerm& term = terms.emplace_back(EnergyTerm{name, role, {}});
    term.local.add(std::span(values.values).first(owned));
  };
  for (const ForcePart& force : forces_)
    if (force.energy) row(force.row, Role::stored, *force.energy);
  formulation_->energies(terms);
  if (heat_) heat_->energies(terms);
  if (has_gravity_) row("gravity_work", Role::supplied, *gravity_work_);
  if (has_walls_) row("boundary_work", Role::supplied, *boundary_work_);
  if (inflow_energy_) row("inflow_energy", Role::supplied, *inflow_energy_);
  if (debris_heat_) {
    row("debris_energy", Role::stored, *debris_heat_);
    row("taken_from_elements", Role::supplied, *debris_work_);
  }
  if (contact_) terms.push_back({"contact_work", Role::supplied, contact_->contact_work()});
}

std::vector<HistoryValue> Sph::history_values() {
  std::vector<HistoryValue> values = formulation_->history_values();
  double fastest = 0;
  for (std::size_t i = 0; i < particles_.owned(); ++i) fastest = std::max(fastest, norm(particles_.velocity.vec(i)));
  values.push_back({"greatest_speed", HistoryValue::Reduce::max, fastest});
  // Exact, so collective here; the same on every rank then.
  std::array<ExactSum, 7> sums;
  for (std::size_t i = 0; i < particles_.owned(); ++i) {
    if (has_walls_ && is_wall(i)) continue;
    const double m = particles_.mass[i];
    sums[0].add(m);
    for (std::size_t c = 0; c < 3; ++c)
      sums[1 + c].add(m * particles_.position[3 * i + c]), sums[4 + c].add(m * particles_.velocity[3 * i + c]);
  }
  std::array<double, 7> totals{};
  mesh_->comm.sum(sums, totals);
  values.push_back({"mass", HistoryValue::Reduce::max, totals[0]});
  for (std::size_t c = 0; c < static_cast<std::size_t>(options_.dimension); ++c) {
    const std::string axis(1, "xyz"[c]);
    values.push_back({"centre_" + axis, HistoryValue::Reduce::max, totals[0] > 0 ? totals[1 + c] / totals[0] : 0});
    values.push_back({"momentum_" + axis, HistoryValue::Reduce::max, totals[4 + c]});
  }
  return values;
}

std::vector<SkipCount> Sph::skips() const {
  std::vector<SkipCount> skips;
  if (!options_.always_search)
    skips.push_back({"neighbour lists kept, as the skin was not used up", steps_ - renewals_});
  if (mesh_->comm.size() > 1)
    skips.push_back(
        {"parts of particles kept, as a new balance would not have paid",
         std::max<std::int64_t>(decomposition_->counts().renewals - decomposition_->counts().rebalances, 0)});
  return skips;
}

std::int64_t Sph::memory() const {
  return decomposition_->memory() + formulation_->memory() + (contact_ ? contact_->memory() : 0) +
         static_cast<std::int64_t>(shown_places_.capacity() * sizeof(Vec3));
}

}  // namespace tenon
