// SPDX-License-Identifier: BSD-3-Clause
// What makes a fluid, a gas or a solid of particles: forces from places, velocities and state.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "components/sph/particle_data.hpp"
#include "components/sph/particle_decomposition.hpp"
#include "components/sph/sph_options.hpp"
#include "framework/simulation/component.hpp"

namespace tenon {

class ParticleHeat;

/// What a formulation works on.
struct SphContext {
  const Communicator& comm;
  const std::string& name;  ///< of the component, for messages
  const SphOptions& options;
  ParticleData& particles;
  ParticleDecomposition& decomposition;
  ParticleHeat* heat = nullptr;  ///< temperatures; of solids always
};

/// A force per mass whose work has a row in the ledger: the work that it does at the kicks is taken from that row.
struct ForcePart {
  std::string row;             ///< "internal_energy", "viscosity_energy"
  const Column* acceleration;  ///< at owned particles, m/s^2
  Column* energy;              ///< kept; grows by -m a . (v- + v+)/2 kick, J. Null: another column holds it already
};

/// A field to be shown or given away, of owned particles.
struct ParticleField {
  FieldDescription field;
  std::function<void(std::size_t particle, double* value)> read;
};

/// One way to make forces. A step from t(n) to t(n+1), each part on all particles before the next:
///   kick      v(n+1/2) = v(n-1/2) + kick a(n), by the component; contact may change v(n+1/2)
///   settle    at x(n), with both velocities: what the kick did to energies
///   drift     x(n+1) = x(n) + dt v(n+1/2), by the component; lists are renewed if need be
///   compute   densities, stresses and a(n+1) at x(n+1)
/// Sums over neighbours in the order of the lists only, and of pairs within the support only: then bits depend neither
/// on ranks nor on skins.
class Formulation {
 public:
  virtual ~Formulation() = default;

  /// Local. The state of the start, at owned particles that have a place, a mass, a body and a smoothing length:
  /// densities and what else it keeps. Masses may change. Not after a restart.
  virtual void start() = 0;
  /// Local. As `start`, for one particle that comes in during the run, with `heat` (J) that was in it; all columns that
  /// it has not are zero. Returns how much of the heat its own rows of the ledger hold from now on.
  virtual double wake(std::size_t /*particle*/, double /*heat*/) { return 0; }
  /// Collective. Accelerations of owned particles at the present places; refreshes what it reads of ghosts. `dt` (s) is
  /// the length of the step that led here, 0 at the start; `kick` of the next kick is not known yet.
  virtual void compute(double time, double dt) = 0;
  /// Collective, between kick and drift.
  virtual void settle(double /*kick*/) {}
  /// Velocity that carries particles, if not their own: of owned ones, m/s (XSPH, transport velocity). Null: none.
  virtual const Column* transport() const { return nullptr; }

  /// Local, from what a checkpoint keeps. Greatest stable step of owned particles, s, already times the CFL number, and
  /// which particle asks for it.
  struct Limit {
    double dt;
    std::size_t particle;
  };
  virtual Limit stable_step() const = 0;

  virtual std::vector<ForcePart> forces() = 0;
  virtual std::vector<ParticleField> fields() = 0;
  /// Local. Rows beyond those of the forces.
  virtual void energies(std::vector<EnergyTerm>&) {}
  virtual std::vector<HistoryValue> history_values() { return {}; }
  virtual void save(CheckpointWriter&) {}
  virtual void load(const CheckpointReader&) {}
  virtual std::int64_t memory() const { return 0; }
};

std::unique_ptr<Formulation> make_fluid(const SphContext& context);
std::unique_ptr<Formulation> make_gas(const SphContext& context);
std::unique_ptr<Formulation> make_solid(const SphContext& context);
std::unique_ptr<Formulation> make_total_lagrangian(const SphContext& context);

}  // namespace tenon
