// SPDX-License-Identifier: BSD-3-Clause
// Planes, spheres and cylinders that bodies touch: where they are, and what a node does to them in a step.
#pragma once

#include <optional>

#include "components/contact/contact_options.hpp"
#include "framework/simulation/contact_party.hpp"

namespace tenon::contact {

/// How a node and a rigid surface stand to each other in a step; as Touch of faces.
struct RigidTouch {
  Vec3 normal;  ///< unit, from the surface to the node
  double gap;   ///< m, at the start for this normal, less the radius of the node
  double end_gap;
};

/// A rigid surface in motion; the same on every rank.
class MovingSurface {
 public:
  explicit MovingSurface(const RigidSurface& options) : options_(options), velocity_(options.velocity) {}

  const RigidSurface& options() const { return options_; }
  bool is_free() const { return options_.mass.has_value(); }
  /// Sets the place at a time, before the first step.
  void start(double time);
  /// The velocity of the step from `time` to `time + dt`, m/s; of a free one that without contact.
  Vec3 velocity(double time, double dt) const;
  const Vec3& shift() const { return shift_; }
  /// Ends a step: the velocity that it had, by which it moves.
  void move(const Vec3& velocity, double time, double dt);
  double kinetic_energy() const;
  void restore(const Vec3& shift, const Vec3& velocity) { shift_ = shift, velocity_ = velocity; }
  const Vec3& free_velocity() const { return velocity_; }

  /// Distance of a point from the surface at present, m; negative behind it.
  double distance(const Vec3& x) const;
  /// False if the node is farther than `margin` at the end of the step and did not cross. Relative motion is straight.
  bool touch(const Vec3& x0, const Vec3& x1, const Vec3& velocity, double dt, double radius, double margin,
             RigidTouch& touch) const;

 private:
  Vec3 told(double time) const;
  Vec3 across(const Vec3& x) const;

  RigidSurface options_;
  Vec3 shift_{}, velocity_{};  // from the place in the options, m; of a free one, m/s
};

}  // namespace tenon::contact
