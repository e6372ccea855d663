// SPDX-License-Identifier: BSD-3-Clause
// All loads of a body, their share in the kick and in the energy ledger.
#pragma once

#include "components/mechanics/connectors.hpp"
#include "components/mechanics/load.hpp"
#include "components/mechanics/load_options.hpp"
#include "components/mechanics/nodal_damping.hpp"
#include "framework/simulation/component.hpp"

namespace tenon {

/// External forces enter the kick as negative resistance: f - F takes the place of f, so that prescribed motions, walls
/// and the work they book see the total force. The work that is then booked on the nodes is that against f - F; adding
/// back the work of F, dt F . (v- + v+)/2 with the final velocities, gives the internal one to the last bit.
///   apply     before the kick: forces at the present positions and time, then damping, which sees all others
///   remember  the velocities before the kick
///   book      once the velocities of the next half step are final
/// Each row of the ledger has its own forces and work. On a node whose motion is prescribed, damping takes the velocity
/// that it would have without: what this changes is the reaction.
class Loads {
 public:
  /// Collective. Body forces count the masses that the groups have now. Throws Error(usage) where options and mesh do
  /// not fit.
  Loads(const Mesh& mesh, const LoadOptions& options, const ElementGroups& groups);
  /// Collective. Once masses are final: dampers and the bounds of springs. `inverse_mass` (1/kg) bounds what a force
  /// on a node accelerates: 1/m, more where a rigid body turns.
  void finish(const Mesh& mesh, const NodalState& nodes, const ElementGroups& groups,
              std::span<const double> inverse_mass);

  bool empty() const { return rows_.empty(); }
  /// Collective.
  void apply(NodalState& nodes, const ElementGroups& groups, double time, double kick);
  /// Local. Velocities before the kick, as the work counts them.
  void remember(const NodalState& nodes);
  /// Local.
  void book(const NodalState& nodes, double kick);

  /// C of all that resists the velocity of a node implicitly, kg/s; nothing if nothing does.
  std::optional<SymmetricTensor<double>> damping(LocalIndex node, const NodalState& nodes) const;
  /// Local, between the halves of a step: something else changes the velocity of an owned node by dv (m/s), which
  /// dampers resist by C dv/2. Their rows and the force of the state follow; returns that change of the resisting
  /// force, N.
  Vec3 resist(LocalIndex node, const Vec3& dv, NodalState& nodes);

  /// The stable step where the elements alone allow `step`. With omega = 2/step and, of springs and explicit dampers,
  /// omega_s and c: dt^2/4 (omega^2 + omega_s^2) + dt/2 (c + beta omega^2) <= 1.
  double stable_step(double step) const;

  /// One row of the ledger: what its loads did on each local node, J.
  struct Row {
    std::string name;
    EnergyTerm::Role role;
    double sign;  ///< of the work in the row: +1 supplied, -1 stored or dissipated
    std::vector<std::unique_ptr<Load>> loads;
    std::vector<LocalIndex> nodes;  ///< that are touched, ascending
    std::vector<ForceRow> force;    ///< N
    std::vector<double> work;       ///< by the forces on the nodes since the start
  };
  std::vector<Row>& rows() { return rows_; }
  const std::vector<Row>& rows() const { return rows_; }
  /// Work and force of all rows on a node: J, N.
  double work(std::size_t node) const;
  Vec3 force(std::size_t node) const;
  std::int64_t memory() const;

 private:
  std::size_t row(const std::string& name);
  void add(const std::string& name, std::unique_ptr<Load> load);
  void find_nodes(std::size_t size);
  void find_bounds(const Mesh& mesh, std::span<const double> inverse_mass);
  void apply_damping(NodalState& nodes, double kick);

  LoadOptions options_;
  std::vector<Row> rows_;
  std::vector<const ConnectorForce*> springs_, dashpots_;
  NodalDamping damping_;
  std::optional<std::size_t> damping_row_, absorbed_row_;
  std::vector<ForceRow> damping_moment_;                        // N m; empty unless nodes turn and are damped
  std::vector<Vec3> before_, spin_before_;                      // velocities before the kick
  double spring_frequency_squared_ = 0, explicit_damping_ = 0;  // 1/s^2, 1/s
};

}  // namespace tenon
