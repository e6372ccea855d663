// SPDX-License-Identifier: BSD-3-Clause
// Temperatures of particles: heat that flows between them, that comes from plastic work, and from outside.
#pragma once

#include <string>
#include <vector>

#include "components/sph/formulation.hpp"
#include "components/sph/pair_hits.hpp"
#include "components/sph/particle_data.hpp"
#include "components/sph/particle_decomposition.hpp"
#include "components/sph/sph_options.hpp"

namespace tenon {

/// Conduction by pairs [Bro85, CM99]:
///   m_i c_i dT_i/dt = sum_j V_i V_j 4 k_i k_j/(k_i + k_j) (T_i - T_j) (1/r dW/dr) / lambda_ij
/// between all particles that are near each other now, so that what one loses the other gains; free surfaces are
/// adiabatic. lambda_ij is the mean of lambda_i = -1/d sum_j V_j r dW/dr, one for a continuum: without it the error of
/// a lattice would not fall with its spacing. T(n+1) = T(n) + dt T'(n).
class ParticleHeat {
 public:
  /// Throws Error(usage) where conduction is asked for and a material cannot conduct.
  ParticleHeat(const std::string& component, const SphOptions& options, ParticleData& particles,
               ParticleDecomposition& decomposition);

  /// Local. Of owned particles, at the start of a run.
  void start(double time);
  void start(double time, std::size_t i);
  /// Local. The same of a particle that comes in during the run; what it holds counts as received.
  void wake(double time, std::size_t i) { start(time, i), received_[i] = heat_[i]; }
  /// Local. To the temperatures of the end of the step, by the rates of its start and the heat that came since.
  void advance(double time, double dt);
  /// Local. Heat that goes into an owned particle, J: of plastic work; or from elsewhere.
  void add_plastic(std::size_t i, double heat);
  void add_received(std::size_t i, double heat);
  /// Local. A temperature from elsewhere, K; what it takes counts as received.
  void set(std::size_t i, double temperature);
  /// Collective. Rates at the present places and densities.
  void compute();

  /// Local. Of owned particles, s.
  Formulation::Limit stable_step() const;
  bool conducts() const { return options_.heat_conduction; }
  bool has_capacity(std::size_t i) const { return capacity_[static_cast<std::size_t>(particles_.body[i])] > 0; }
  Column& temperature() { return temperature_; }
  void energies(std::vector<EnergyTerm>& terms) const;

 private:
  template <typename K, int d>
  void scales();
  template <typename K, int d>
  void sum();
  double capacity(std::size_t i) const {
    return particles_.mass[i] * capacity_[static_cast<std::size_t>(particles_.body[i])];
  }

  const SphOptions& options_;
  ParticleData& particles_;
  ParticleDecomposition& decomposition_;
  Column &temperature_, &conductivity_, &scale_, &flow_, &heat_, &made_, &received_;
  std::vector<double> capacity_, reference_;  // of bodies: J/(kg K), K
  PairHits hits_;
};

}  // namespace tenon
