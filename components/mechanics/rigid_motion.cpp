// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/rigid_motion.hpp"

#include <cmath>

#include "components/mechanics/nodal_damping.hpp"
#include "framework/base/error.hpp"

namespace tenon {

Quaternion product(const Quaternion& a, const Quaternion& b) {
  return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3], a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
          a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1], a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

Quaternion rotation_by(const Vec3& r) {
  const double angle = norm(r), half = 0.5 * angle;
  // sin(angle/2)/angle without loss for small angles.
  const double s = angle > 1e-4 ? std::sin(half) / angle : 0.5 - angle * angle / 48;
  return {std::cos(half), s * r[0], s * r[1], s * r[2]};
}

Vec3 rotate(const Quaternion& q, const Vec3& x) {
  const Vec3 v{q[1], q[2], q[3]}, t = 2.0 * cross(v, x);
  return x + q[0] * t + cross(v, t);
}

Vec3 rotate_back(const Quaternion& q, const Vec3& x) {
  return rotate({q[0], -q[1], -q[2], -q[3]}, x);
}

SymmetricTensor<double> inverted(const SymmetricTensor<double>& s, const std::string& label) {
  const SymmetricTensor<double> a{s.yy * s.zz - s.yz * s.yz, s.xx * s.zz - s.zx * s.zx, s.xx * s.yy - s.xy * s.xy,
                                  s.zx * s.yz - s.xy * s.zz, s.xy * s.zx - s.xx * s.yz, s.xy * s.yz - s.yy * s.zx};
  const double determinant = s.xx * a.xx + s.xy * a.xy + s.zx * a.zx, scale = trace(s);
  if (!(determinant > 1e-12 * scale * scale * scale))
    throw Error(ExitCode::usage, label +
                                     ": has no moment of inertia about some axis; expected a body with extent in at "
                                     "least two directions");
  const double d = 1 / determinant;
  return {d * a.xx, d * a.yy, d * a.zz, d * a.xy, d * a.yz, d * a.zx};
}

Vec3 angular_velocity(const RigidInertia& body, const RigidState& state) {
  return rotate(state.orientation, times(body.inverse, rotate_back(state.orientation, state.momentum)));
}

Vec3 angular_momentum(const RigidInertia& body, const RigidState& state, const Vec3& velocity) {
  return rotate(state.orientation, times(body.inertia, rotate_back(state.orientation, velocity)));
}

double kinetic_energy(const RigidInertia& body, const RigidState& state) {
  return 0.5 * (body.mass * dot(state.velocity, state.velocity) + dot(angular_velocity(body, state), state.momentum));
}

// In the body: P1 - P0 = dt' (P0 + P1)/2 x w with w = J^-1 (P0 + P1)/2, that is P1 = P0 turned about w by -|w| dt.
void spin_freely(const RigidInertia& body, RigidState& state, double dt) {
  const Vec3 start = rotate_back(state.orientation, state.momentum);
  Vec3 velocity = times(body.inverse, start);
  constexpr int most = 100;
  double change = 0;
  for (int i = 0; i < most; ++i) {
    const Vec3 end = rotate_back(rotation_by(dt * velocity), start);
    const Vec3 next = times(body.inverse, 0.5 * (start + end));
    const double now = norm(next - velocity);
    velocity = next;
    // The iteration contracts by about |w| dt: it ends when round-off is all that is left.
    if (now <= 1e-16 * norm(next) || (i > 3 && now >= change)) break;
    change = now;
  }
  Quaternion q = product(state.orientation, rotation_by(dt * velocity));
  const double size = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (double& c : q) c /= size;
  state.orientation = q;
}

}  // namespace tenon
