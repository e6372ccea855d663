// SPDX-License-Identifier: BSD-3-Clause
// L2 (Galerkin) projection of a field onto another mesh.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "transfer/rows.hpp"

namespace tenon::transfer {

struct ProjectionOptions {
  /// Keeps every value between the least and the greatest of the source values around it.
  bool bounded = false;
  /// Makes the target's integral that of the whole source, by spreading what is missing. Without it, integrals agree
  /// only where the meshes cover each other, and only as far as the quadrature goes; linear fields are then exact also
  /// where one mesh has less than the other.
  bool keep_integral = true;
  /// Quadrature points along an edge of a target element.
  double points_per_edge = 2.5;
};

/// What an application did, the same on every rank; the worst of all components.
struct ProjectionOutcome {
  double spread = 0;         ///< integral that was spread to make up for the rest, over the integral of |f|
  std::int64_t clipped = 0;  ///< values that were brought back within their bounds by more than 1e-6 of the greatest
  double unplaced = 0;       ///< integral that no value had room for within its bounds, over the integral of |f|
};

/// The function u of the target mesh that is nearest to the source's f in the mean square, for point values and
/// densities; totals have to be divided by volumes first. Linear fields are exact, smooth ones of second order in the
/// mean square with errors near the least possible.
///
/// The right-hand side of M u = (N, f) needs quadrature, on the points of the source, and a quadrature that ignores
/// where the target's shape functions have kinks is wrong by a percent however fine the meshes. Hence by deferred
/// correction from the interpolated u_I = P f: M d = sum_q w_q N_i (f - u_I)(x_q), u = u_I + d. As f - u_I is of second
/// order, so is the error of the quadrature; for exact quadrature u is the projection. Midpoints of sub-cells serve,
/// not Gauss points: these integrate the square of a function with kinks now too high, now too low, so that some modes
/// grow in hundreds of transfers to and fro; midpoints take the square of what is linear in a cell too low [Jensen],
/// and all modes decay.
///
/// The integral of the whole source (by its own quadrature) is kept to round-off: the rest, as small as the error, is
/// spread in proportion to |u| (or to the room within the bounds). On elements, u is the mean over each.
/// Bitwise the same on any ranks.
class Projection {
 public:
  /// Collective. Builds the map. The meshes must outlive it. `sought` receives the target's nodes and where the source
  /// holds them. Throws as interpolation_map does, and Error(usage) for a target of second order.
  Projection(const Side& source, const Side& target, const PlaceRules& rules, const ProjectionOptions& options,
             const std::string& name, Sought& sought);
  Projection(Projection&&) noexcept;
  Projection& operator=(Projection&&) noexcept;
  ~Projection();

  /// Collective. `source`: all local items x components; `target` the same, every one set (ghosts included). No
  /// allocation after the first call with that many components.
  void apply(std::span<const double> source, std::span<double> target, int components) const;

  /// Of the last application.
  const ProjectionOutcome& outcome() const;
  /// Quadrature points of the source over all ranks, and how many of them lie outside of the target.
  GlobalId points() const;
  GlobalId points_outside() const;
  /// Local: bytes.
  std::int64_t memory() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tenon::transfer
