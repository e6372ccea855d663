// SPDX-License-Identifier: BSD-3-Clause
#include "components/sph/particle_pressure.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "components/materials/batch.hpp"
#include "framework/base/error.hpp"

namespace tenon {

void require_equations_of_state(const std::string& component, const SphOptions& options) {
  for (const SphBody& body : options.bodies)
    if (!body.material.equation_of_state)
      throw Error(ExitCode::usage,
                  fmt::format("{}: the material '{}' of '{}' has no equation_of_state, from which its pressure would "
                              "follow; give it one",
                              component, body.material.name, body.name));
}

void require_stiffness(const std::string& component, const SphOptions& options) {
  for (const SphBody& body : options.bodies)
    if (!(body.material.equation_of_state->bulk_modulus() > 0))
      throw Error(ExitCode::usage,
                  fmt::format("{}: the equation of state of the material '{}' of '{}' has no stiffness without energy, "
                              "of which `formulation: fluid` keeps no account; say `formulation: gas`",
                              component, body.material.name, body.name));
}

double undeformed_sound(const SphBody& body) {
  return std::sqrt(body.material.equation_of_state->bulk_modulus() / body.material.density);
}

// Newton steps, one where the law is linear. Away from zero first, where an ideal gas has no slope.
double energy_of(double pressure, double density, const SphBody& body) {
  const EquationOfState& state = *body.material.equation_of_state;
  LaneValues volume, energy;
  for (std::size_t l = 0; l < lanes; ++l)
    volume[l] = body.material.density / density, energy[l] = std::max(state.initial_energy(), 1e-300);
  for (int newton = 0; newton < 50; ++newton) {
    PressureLaw law;
    state.evaluate(volume, energy, law);
    if (!(law.B[0] > 0)) return state.initial_energy() / body.material.density;
    const double next = (pressure - law.A[0]) / law.B[0];
    const bool there = std::abs(next - energy[0]) <= 1e-14 * std::abs(next);
    for (double& e : energy) e = next;
    if (there) break;
  }
  return energy[0] / body.material.density;
}

// Eight particles at a time, whatever bodies they belong to: once for each of these.
void find_pressures(const SphOptions& options, const ParticleData& particles, const Column* energy, Column& pressure,
                    Column& sound) {
  const std::size_t owned = particles.owned();
  for (std::size_t first = 0; first < owned; first += lanes) {
    const std::size_t count = std::min<std::size_t>(lanes, owned - first);
    std::array<bool, lanes> done{};
    for (std::size_t at = 0; at < count; ++at) {
      if (done[at]) continue;
      const std::int32_t body = particles.body[first + at];
      const MaterialDescription& material = options.bodies[static_cast<std::size_t>(body)].material;
      const EquationOfState& state = *material.equation_of_state;
      LaneValues volume, energies;
      for (std::size_t l = 0; l < lanes; ++l) {
        const std::size_t i = first + std::min(l, count - 1);
        volume[l] = material.density / particles.density[i];
        energies[l] = energy ? material.density * (*energy)[i] : state.initial_energy();
      }
      PressureLaw law;
      state.evaluate(volume, energies, law);
      for (std::size_t l = at; l < count; ++l) {
        const std::size_t i = first + l;
        if (particles.body[i] != body) continue;
        done[l] = true;
        const double e = energies[l];
        const double p = std::max(law.A[l] + law.B[l] * e, state.least_pressure), rho = particles.density[i];
        const double over_density = (law.dA_dmu[l] + law.dB_dmu[l] * e) / material.density;
        const double over_energy = energy ? law.B[l] * material.density : 0;
        pressure[i] = p;
        sound[i] = std::sqrt(std::max(over_density + p / (rho * rho) * over_energy, 0.0));
      }
    }
  }
}

}  // namespace tenon
