// SPDX-License-Identifier: BSD-3-Clause
// How wrong transferred values may be, from gradients recovered at the source [ZZ87].
#pragma once

#include <memory>
#include <span>
#include <string>

#include "transfer/rows.hpp"

namespace tenon::transfer {

/// Of a quadratic f with gradients g_a at the nodes x_a, sum N_a (f_a + g_a . (x - x_a) / 2) is exact, since
/// f_a + g_a . d / 2 = f(x) - g(x) . d / 2 with d = x - x_a and sum N_a d = 0. So that is a better value than sum N_a
/// f_a (by h^2 f'' / 8), and its difference from a transferred value, whatever the method, estimates the error of that.
/// Outside, g . (distance to the nearest point) is added. Of values on elements, f_e + g . (x - centre) is the better.
///
/// Gradients are recovered where they are needed only, so that an estimate from a thousand targets costs next to
/// nothing.
class ErrorEstimate {
 public:
  /// Collective. For about `samples` targets over all ranks, chosen by their global ids; 0: all. `places` (m) of the
  /// owned ones. The source must outlive it. `interpolation`: at all local targets.
  ErrorEstimate(const Side& source, const Items& targets, std::span<const Vec3> places, const RowMap& interpolation,
                GlobalId samples, const std::string& name);
  /// Collective. The same with no interpolation at hand: finds the targets that it chooses in the source by itself.
  ErrorEstimate(const Side& source, const Items& targets, std::span<const Vec3> places, const PlaceRules& rules,
                GlobalId samples, const std::string& name);
  ErrorEstimate(ErrorEstimate&&) noexcept;
  ErrorEstimate& operator=(ErrorEstimate&&) noexcept;
  ~ErrorEstimate();

  struct Result {
    double greatest = 0;     ///< error of any component, unit of the field
    double mean_square = 0;  ///< root of the mean square, of the worst component
  };
  /// Collective. Values of all local items x components.
  Result operator()(std::span<const double> source, std::span<const double> target, int components) const;
  /// Targets over all ranks.
  GlobalId samples() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tenon::transfer
