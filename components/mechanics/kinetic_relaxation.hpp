// SPDX-License-Identifier: BSD-3-Clause
// Dynamic relaxation by kinetic damping: the way to a static state.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "components/mechanics/loads.hpp"

namespace tenon {

/// [Cun76], [Bar99]: the body vibrates freely until its kinetic energy has passed a peak, where it is nearest to
/// equilibrium; nodes go back along their paths to the peak, by the parabola through the last three energies, and start
/// again at rest. Without any parameter, and no element sees a damping force.
///
/// Converged when |m a| <= tolerance |external forces and reactions| (Euclidean norms over all nodes) and the kinetic
/// energy is at most tolerance^2 of the work done on the elements. Sums are exact: any number of ranks takes the same
/// decisions.
class KineticRelaxation {
 public:
  KineticRelaxation(const RelaxationOptions& options, const Mesh& mesh);

  /// Local. Before a kick. True if the body starts again from rest, with a kick over half a step.
  bool begin(NodalState& nodes);
  /// Collective. Once velocities are final, `kick` seconds after those before: looks at energy and residual, and turns
  /// back if the peak is past. `previous_dt` (s) led to the present positions, `dt` follows.
  void watch(NodalState& nodes, const Loads& loads, double kick, double previous_dt, double dt, double time);

  bool converged() const { return converged_; }
  double residual() const { return residual_; }  ///< of the last step, relative
  std::int64_t steps() const { return steps_; }
  std::int64_t peaks() const { return peaks_; }
  /// "converged after ..." or "not converged ...".
  std::string report() const;

  /// J taken from each node, kinetic.
  std::vector<double>& taken() { return taken_; }
  /// What a restart needs besides: energies of the last two half steps, J; flags and counts.
  struct State {
    double energy, energy_before;
    std::int64_t turning, steps, peaks;
  };
  State state() const { return {energy_, energy_before_, turning_ ? 1 : 0, steps_, peaks_}; }
  void restore(const State& state);

 private:
  void turn_back(NodalState& nodes, double factor);

  RelaxationOptions options_;
  const Mesh& mesh_;
  std::vector<Vec3> before_, spin_before_;
  std::vector<double> taken_;
  double energy_ = 0, energy_before_ = 0, residual_ = 1;
  bool turning_ = false, converged_ = false;
  std::int64_t steps_ = 0, peaks_ = 0;
};

}  // namespace tenon
