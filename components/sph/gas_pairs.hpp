// SPDX-License-Identifier: BSD-3-Clause
// Sums over the pairs of a compressible gas.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "components/sph/pair_hits.hpp"
#include "components/sph/particle_data.hpp"
#include "components/sph/sph_options.hpp"
#include "framework/search/neighbour_lists.hpp"

namespace tenon {

/// What the forces of a pair have to know of its other particle: one cache line.
struct GasRecord {
  double density;   ///< kg/m^3
  double sound;     ///< m/s
  double push;      ///< p/(Omega rho^2)
  double pressure;  ///< Pa
  double energy;    ///< J/kg
  double limiter;   ///< of the artificial viscosity, 0 to 1
  double unused[2];

  static constexpr std::size_t size = 8;
};

/// The pairs within the support at x(n), found once in a step: of each owned particle whole packs, which end with the
/// particle itself.
struct GasPairs {
  std::vector<std::size_t> begin;  ///< of each owned particle, and the end
  std::vector<std::size_t> count;  ///< of each owned particle, without what fills the pack
  std::vector<LocalIndex> other;
  std::vector<double> work;  ///< energy that particle i gains per (v_i - v_j) . (x_i - x_j), kg/(m^2 s)/kg

  std::int64_t memory() const {
    return static_cast<std::int64_t>((begin.capacity() + count.capacity() + work.capacity()) * sizeof(double) +
                                     other.capacity() * sizeof(LocalIndex));
  }
};

/// Records of all particles, ghosts too, one after the other.
struct GasRecords {
  std::vector<double> places;  ///< x, y, z, h
  std::vector<double> motion;  ///< v(n), mass
  std::vector<double> states;  ///< GasRecord
  std::vector<double> means;   ///< mean of the velocities before and after the kick, and a zero
};

/// What the first pass finds at an owned particle.
struct GasDensity {
  double density;           ///< sum of m W, kg/m^3
  double stretch;           ///< Omega = 1 + h/(d rho) drho/dh
  double divergence, curl;  ///< of the velocity, by gradients exact for linear fields, 1/s; if asked for
};

/// What the second one finds there.
struct GasForce {
  Vec3 acceleration;  ///< m/s^2
  double conduction;  ///< artificial, W/kg
  double growth;      ///< of the density, over the density, 1/s
  double signal;      ///< greatest signal speed of its pairs, m/s
};

/// What the passes work on.
struct GasPass {
  const SphOptions& options;
  const ParticleData& particles;
  const NeighbourLists& lists;
  const GasRecords& records;
  GasPairs& pairs;
  PairHits& hits;
};

/// First, of places and motion: fills `pairs` but for the work.
void find_gas_densities(const GasPass& pass, std::span<GasDensity> found);
/// Second, of states as well: fills the work. `stretch` has the Omega of owned particles.
void find_gas_forces(const GasPass& pass, const Column& stretch, std::span<GasForce> found);
/// After the kick, of places and means: rates of energy without conduction, W/kg.
void find_gas_work(const GasPass& pass, Column& rate);

}  // namespace tenon
