// SPDX-License-Identifier: BSD-3-Clause
#include "components/contact/rigid_surface.hpp"

#include <cmath>

namespace tenon::contact {

Vec3 MovingSurface::told(double time) const {
  Vec3 u;
  for (std::size_t c = 0; c < 3; ++c) u[c] = options_.displacement[c](time);
  return u;
}

void MovingSurface::start(double time) {
  shift_ = is_free() ? Vec3{} : told(time);
}

Vec3 MovingSurface::velocity(double time, double dt) const {
  return is_free() ? velocity_ : (1 / dt) * (told(time + dt) - shift_);
}

void MovingSurface::move(const Vec3& velocity, double time, double dt) {
  velocity_ = velocity;
  shift_ = is_free() ? shift_ + dt * velocity : told(time + dt);
}

double MovingSurface::kinetic_energy() const {
  return is_free() ? 0.5 * *options_.mass * dot(velocity_, velocity_) : 0.0;
}

/// From the centre or the axis to a place that is given from the point of the options.
Vec3 MovingSurface::across(const Vec3& x) const {
  const Vec3& axis = options_.direction;
  return options_.shape == RigidSurface::Shape::cylinder ? x - dot(x, axis) * axis : x;
}

double MovingSurface::distance(const Vec3& x) const {
  const Vec3 from = x - (options_.point + shift_);
  if (options_.shape == RigidSurface::Shape::plane) return dot(from, options_.direction);
  const double r = norm(across(from));
  return options_.hollow ? options_.radius - r : r - options_.radius;
}

bool MovingSurface::touch(const Vec3& x0, const Vec3& x1, const Vec3& velocity, double dt, double radius, double margin,
                          RigidTouch& touch) const {
  const Vec3 start = x0 - (options_.point + shift_), end = x1 - (options_.point + shift_) - dt * velocity;
  if (options_.shape == RigidSurface::Shape::plane) {
    touch.normal = options_.direction;
    touch.gap = dot(start, touch.normal) - radius, touch.end_gap = dot(end, touch.normal) - radius;
    return touch.end_gap <= margin;
  }
  const Vec3 a = across(start), b = across(end), way = b - a;
  const double reach = options_.radius + (options_.hollow ? -radius : radius);
  Vec3 foot = b;
  if (!options_.hollow && norm(a) > reach) {  // where it enters first: |a + t way| = reach
    const double aa = dot(way, way), half = dot(a, way), c = dot(a, a) - reach * reach;
    const double root = half * half - aa * c;
    if (aa > 0 && half < 0 && root > 0 && -half - std::sqrt(root) < aa)
      foot = a + ((-half - std::sqrt(root)) / aa) * way;
  }
  const double length = norm(foot);
  if (!(length > 0)) return false;
  touch.normal = (options_.hollow ? -1 / length : 1 / length) * foot;
  const double offset = options_.hollow ? -reach : reach;
  touch.gap = dot(touch.normal, a) - offset, touch.end_gap = dot(touch.normal, b) - offset;
  return touch.end_gap <= margin;
}

}  // namespace tenon::contact
