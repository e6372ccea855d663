// SPDX-License-Identifier: BSD-3-Clause
// What a transfer refuses: pairings that make no sense, options out of range, points too far away.
#include <fmt/core.h>

#include <algorithm>
#include <limits>

#include "transfer/grid_transfer_impl.hpp"

namespace tenon::transfer {

[[noreturn]] void refuse(const std::string& name, const std::string& why) {
  throw Error(ExitCode::usage, fmt::format("transfer '{}': {}", name, why));
}

namespace {

bool surfaces_only(const Mesh& mesh) {
  return std::all_of(mesh.blocks.begin(), mesh.blocks.end(),
                     [](const ElementBlock& block) { return topology(block.kind).dimension == 2; });
}

}  // namespace

/// The method that the kind of the field asks for. Depends on arguments that are the same on every rank.
Method choose_method(const FieldDescription& field, const Grid& source, const TransferOptions& options,
                     const std::string& name) {
  if (field.kind == FieldKind::flux)
    refuse(name,
           fmt::format("'{}' is a flux; fluxes belong to surfaces, which cannot be transferred: give a total or a "
                       "density",
                       field.name));
  const bool interpolated = field.kind == FieldKind::point_value;
  Method method = options.method;
  if (method == Method::automatic) {
    method = interpolated ? Method::interpolate : Method::conserve;
    if (interpolated && !source.mesh)
      method = Method::moving_least_squares;
    else if (interpolated && surfaces_only(*source.mesh))
      method = Method::nearest_projection;
  }
  const bool by_values = method == Method::interpolate || method == Method::nearest_projection ||
                         method == Method::moving_least_squares || method == Method::project;
  if (by_values && field.kind == FieldKind::total)
    refuse(name, fmt::format("'{}' is a total, an amount per node or element, and cannot be interpolated; use method "
                             "conserve or automatic",
                             field.name));
  if (method == Method::conserve && interpolated)
    refuse(name,
           fmt::format("'{}' is a point value and has no amount to conserve; use method interpolate or automatic, "
                       "or transfer the amount itself (say, energy instead of temperature)",
                       field.name));
  const bool in_elements = method == Method::interpolate || method == Method::nearest_projection;
  if (!source.blocks.empty() && !in_elements)
    refuse(name, "blocks can be chosen for the methods interpolate and nearest_projection only");
  if (!source.sides.empty() && method != Method::nearest_projection)
    refuse(name, fmt::format("side set '{}' can be chosen for method nearest_projection only", source.sides));
  if (method == Method::nearest_projection &&
      (options.outside == OutsidePolicy::value || options.outside == OutsidePolicy::extrapolate))
    refuse(name,
           "method nearest_projection gives every point the value of its foot: its outside policy is nearest or "
           "error");
  if (method == Method::conserve && options.outside == OutsidePolicy::value)
    refuse(name, fmt::format("outside policy 'value' would lose the amounts of '{}' outside the target; use nearest, "
                             "extrapolate or error",
                             field.name));
  return method;
}

void check_options(const TransferOptions& options, const std::string& name) {
  if (!(options.tolerance >= 0 && options.tolerance < 0.1))
    refuse(name,
           fmt::format("tolerance {} is not a fraction of an element's size between 0 and 0.1", options.tolerance));
  if (options.neighbours < 4 || options.neighbours > 64)
    refuse(name, fmt::format("neighbours {} is not between 4 and 64", options.neighbours));
  if (!(options.greatest_distance >= 0))
    refuse(name, fmt::format("greatest distance {} m is negative", options.greatest_distance));
}

void refuse_misses(const Misses& misses, const TransferOptions& options, const std::string& name) {
  const bool too_far = options.outside != OutsidePolicy::value && misses.greatest_distance > options.greatest_distance;
  const bool refused = options.outside == OutsidePolicy::error && misses.outside > 0;
  if (!refused && !too_far) return;
  const Vec3& x = misses.farthest;
  throw Error(
      ExitCode::geometry,
      fmt::format("transfer '{}': {} of {} points lie outside the mesh; the farthest is at ({:.6g}, {:.6g}, {:.6g}), "
                  "{:.6g} m away ({}); check the placement of the meshes, or choose another outside policy{}",
                  name, misses.outside, misses.targets, x[0], x[1], x[2], misses.greatest_distance,
                  too_far ? fmt::format("at most {:.6g} m allowed", options.greatest_distance)
                          : std::string("policy error allows none"),
                  too_far ? " or greatest distance" : ""));
}

Misses MissCounter::total(const Communicator& comm, GlobalId skipped) const {
  Misses misses;
  misses.targets = comm.sum(targets_);
  misses.skipped = skipped;
  misses.outside = comm.sum(outside_);
  const double greatest = comm.max(distance_);
  if (!(greatest > 0)) return misses;
  misses.greatest_distance = greatest;
  const bool candidate = distance_ == greatest;
  const GlobalId first = comm.min(candidate ? id_ : std::numeric_limits<GlobalId>::max());
  const double nowhere = -std::numeric_limits<double>::infinity();
  misses.farthest = candidate && id_ == first ? point_ : Vec3{nowhere, nowhere, nowhere};
  comm.max(std::span<double>(misses.farthest));
  return misses;
}

}  // namespace tenon::transfer
