// SPDX-License-Identifier: BSD-3-Clause
#include "components/sph/particle_heat.hpp"

#include <algorithm>
#include <limits>

#include "components/sph/kernel_choice.hpp"

namespace tenon {

namespace {
constexpr double room_temperature = 293.15;  // K, of what says nothing of temperatures
}

ParticleHeat::ParticleHeat(const std::string& component, const SphOptions& options, ParticleData& particles,
                           ParticleDecomposition& decomposition)
    : options_(options),
      particles_(particles),
      decomposition_(decomposition),
      temperature_(particles.add("temperature", ColumnKind::scalar, 1, true)),
      conductivity_(particles.add("conductivity", ColumnKind::scalar, 1, true)),
      scale_(particles.add("conduction_scale", ColumnKind::scalar, 1, false)),
      flow_(particles.add("heat_flow", ColumnKind::scalar, 1, true)),
      heat_(particles.add("heat", ColumnKind::scalar, 1, true)),
      made_(particles.add("heat_generated", ColumnKind::scalar, 1, true)),
      received_(particles.add("heat_received", ColumnKind::scalar, 1, true)) {
  for (const SphBody& body : options.bodies) {
    const auto& thermal = body.material.thermal;
    capacity_.push_back(thermal ? thermal->specific_heat : 0);
    reference_.push_back(thermal ? thermal->reference_temperature : room_temperature);
    if (!options.heat_conduction) continue;
    const auto refuse = [&](const std::string& why) {
      throw Error(ExitCode::usage, component + ": heat_conduction: the material '" + body.material.name + "' of '" +
                                       body.name + "' " + why);
    };
    if (!thermal || !(thermal->specific_heat > 0) || !(thermal->conductivity >= 0))
      refuse("has no thermal properties; give it a 'thermal' block with conductivity and specific_heat");
    if (thermal->conductivity_tensor || thermal->specific_heat_over_temperature || thermal->latent_heat > 0)
      refuse(
          "conducts by directions, or has a heat capacity that varies, which particles cannot follow; give one "
          "conductivity (a number or over temperature) and one specific_heat");
  }
}

void ParticleHeat::start(double time) {
  for (std::size_t i = 0; i < particles_.owned(); ++i) start(time, i);
}

void ParticleHeat::start(double time, std::size_t i) {
  const auto b = static_cast<std::size_t>(particles_.body[i]);
  const SphBody& body = options_.bodies[b];
  temperature_[i] =
      body.initial_temperature ? (*body.initial_temperature)(time, particles_.position.vec(i)) : reference_[b];
  if (body.held_temperature) temperature_[i] = (*body.held_temperature)(time);
  heat_[i] = capacity(i) * (temperature_[i] - reference_[b]);
}

// Energies are counted by what flowed, temperatures follow from it.
void ParticleHeat::advance(double time, double dt) {
  for (std::size_t i = 0; i < particles_.owned(); ++i) {
    if (!has_capacity(i)) continue;
    const double now = heat_[i] + dt * flow_[i];
    const auto& held = options_.bodies[static_cast<std::size_t>(particles_.body[i])].held_temperature;
    if (held) {
      const double wanted = (*held)(time + dt), needed = capacity(i) * (wanted - temperature_[i]);
      received_[i] += needed - dt * flow_[i];
      heat_[i] += needed, temperature_[i] = wanted;
      continue;
    }
    temperature_[i] += (now - heat_[i]) / capacity(i);
    heat_[i] = now;
  }
}

void ParticleHeat::add_plastic(std::size_t i, double heat) {
  if (!has_capacity(i) || heat == 0) return;
  heat_[i] += heat, made_[i] += heat;
  temperature_[i] += heat / capacity(i);
}

void ParticleHeat::add_received(std::size_t i, double heat) {
  if (!has_capacity(i) || heat == 0) return;
  heat_[i] += heat, received_[i] += heat;
  temperature_[i] += heat / capacity(i);
}

void ParticleHeat::set(std::size_t i, double temperature) {
  const double heat = capacity(i) * (temperature - temperature_[i]);
  heat_[i] += heat, received_[i] += heat;
  temperature_[i] = temperature;
}

void ParticleHeat::compute() {
  if (!conducts()) return;
  for (std::size_t i = 0; i < particles_.owned(); ++i) {
    const ThermalProperties& thermal = *options_.bodies[static_cast<std::size_t>(particles_.body[i])].material.thermal;
    conductivity_[i] = thermal.conductivity_over_temperature ? (*thermal.conductivity_over_temperature)(temperature_[i])
                                                             : thermal.conductivity;
  }
  const std::array<Column*, 2> places{&particles_.position, &particles_.density};
  decomposition_.refresh(places);
  with_kernel(options_.kernel, options_.dimension, [&]<typename K, int d>() { scales<K, d>(); });
  const std::array<Column*, 3> columns{&temperature_, &conductivity_, &scale_};
  decomposition_.refresh(columns);
  with_kernel(options_.kernel, options_.dimension, [&]<typename K, int d>() { sum<K, d>(); });
}

namespace {

template <typename K, int d>
WidePack slope_of(const PairHits& hits, std::size_t n) {
  const WidePack h = load_wide(&hits.h[n]), q = square_root(load_wide(&hits.squared[n])) / h;
  WidePack scale = load_wide(&hits.inside[n]) * (K::sigma(d) / (h * h));
  for (int c = 0; c < d; ++c) scale = scale / h;
  return scale * K::template slope<d>(q);
}

constexpr double least_scale = 0.3;  // of what has few neighbours, or none

}  // namespace

template <typename K, int d>
void ParticleHeat::scales() {
  for (std::size_t i = 0; i < particles_.owned(); ++i) {
    hits_.find(i, decomposition_.lists().of(i), particles_.position.data(), particles_.length.data(), K::support);
    WidePack sum{};
    for (std::size_t n = 0; n < hits_.padded(); n += wide_pack_width) {
      WidePack V;
      for (int l = 0; l < wide_pack_width; ++l) {
        const auto j = static_cast<std::size_t>(hits_.j[n + static_cast<std::size_t>(l)]);
        V[l] = particles_.mass[j] / particles_.density[j];
      }
      sum -= V * load_wide(&hits_.squared[n]) * slope_of<K, d>(hits_, n);
    }
    scale_[i] = std::max(sum_of(sum) / d, least_scale);
  }
}

template <typename K, int d>
void ParticleHeat::sum() {
  for (std::size_t i = 0; i < particles_.owned(); ++i) {
    hits_.find(i, decomposition_.lists().of(i), particles_.position.data(), particles_.length.data(), K::support);
    const double T = temperature_[i], k_i = conductivity_[i], volume = particles_.mass[i] / particles_.density[i];
    WidePack flow{};
    for (std::size_t n = 0; n < hits_.padded(); n += wide_pack_width) {
      WidePack V, T_j, k_j, scale;
      for (int l = 0; l < wide_pack_width; ++l) {
        const auto j = static_cast<std::size_t>(hits_.j[n + static_cast<std::size_t>(l)]);
        V[l] = particles_.mass[j] / particles_.density[j], T_j[l] = temperature_[j], k_j[l] = conductivity_[j];
        scale[l] = scale_[j];
      }
      const WidePack mean = 8.0 * (k_i * k_j) / ((k_i + k_j + 1e-300) * (scale_[i] + scale));
      flow += (volume * V) * mean * (T - T_j) * slope_of<K, d>(hits_, n);
    }
    flow_[i] = sum_of(flow);
  }
}

// Forward Euler: the highest rate of a lattice is near 4 d k/(rho c spacing^2), and h is above the spacing.
Formulation::Limit ParticleHeat::stable_step() const {
  Formulation::Limit limit{std::numeric_limits<double>::infinity(), 0};
  if (!conducts()) return limit;
  for (std::size_t i = 0; i < particles_.owned(); ++i) {
    const double spacing = particles_.length[i] / options_.smoothing;
    const double diffusivity = conductivity_[i] * particles_.mass[i] / (particles_.density[i] * capacity(i));
    const double dt = 0.25 * spacing * spacing / (options_.dimension * diffusivity + 1e-300);
    if (dt < limit.dt) limit = {dt, i};
  }
  return limit;
}

void ParticleHeat::energies(std::vector<EnergyTerm>& terms) const {
  using Role = EnergyTerm::Role;
  const auto row = [&](const char* name, Role role, const Column& values) {
    EnergyTerm& term = terms.emplace_back(EnergyTerm{name, role, {}});
    term.local.add(std::span(values.values).first(particles_.owned()));
  };
  if (!conducts()) {
    row("heat_generated", Role::memo, made_);
    return;
  }
  row("thermal_energy", Role::stored, heat_);
  row("heat_generated", Role::supplied, made_);
  row("heat_received", Role::supplied, received_);
}

}  // namespace tenon
