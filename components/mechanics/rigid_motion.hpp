// SPDX-License-Identifier: BSD-3-Clause
// Equations of motion of one rigid body, without nodes and ranks.
#pragma once

#include <array>
#include <string>

#include "components/mechanics/small_tensor.hpp"
#include "framework/base/types.hpp"

namespace tenon {

/// Unit quaternion w + x i + y j + z k.
using Quaternion = std::array<double, 4>;
Quaternion product(const Quaternion& a, const Quaternion& b);
/// Rotation about the vector r by its length, rad.
Quaternion rotation_by(const Vec3& r);
Vec3 rotate(const Quaternion& q, const Vec3& x);
Vec3 rotate_back(const Quaternion& q, const Vec3& x);

/// Mass properties about the pivot, in the undeformed position.
struct RigidInertia {
  double mass = 0;                    ///< kg
  SymmetricTensor<double> inertia{};  ///< kg m^2
  SymmetricTensor<double> inverse{};
};
/// Throws Error(usage) naming `label` unless the tensor is positive definite.
SymmetricTensor<double> inverted(const SymmetricTensor<double>& s, const std::string& label);

/// Place, orientation, velocity and angular momentum about the pivot, which is the centre of mass or a fixed point.
/// Velocities are those of the half step before.
struct RigidState {
  Vec3 pivot{};                        ///< m
  Vec3 velocity{};                     ///< of the pivot, m/s
  Quaternion orientation{1, 0, 0, 0};  ///< from the undeformed position
  Vec3 momentum{};                     ///< angular, about the pivot, in space: kg m^2/s
  double angle = 0;                    ///< turned about the axis of a hinge or of a prescribed rotation, rad
};

/// Angular velocity in space, rad/s.
Vec3 angular_velocity(const RigidInertia& body, const RigidState& state);
/// Angular momentum of that angular velocity.
Vec3 angular_momentum(const RigidInertia& body, const RigidState& state, const Vec3& velocity);
/// J: half of M V.V + w.L.
double kinetic_energy(const RigidInertia& body, const RigidState& state);

/// Turns a body that is free of moments over dt: the implicit midpoint rule for Euler's equations [AKW93], which keeps
/// the energy and, with the rotation that belongs to it, the angular momentum in space to round-off, whatever the step.
/// The rule's step is stretched to (2/w) tan(w dt/2), so that a spin about a principal axis is exact. Second order.
/// Valid for |w| dt < 1.
void spin_freely(const RigidInertia& body, RigidState& state, double dt);
/// Greatest |w| dt that `spin_freely` should be asked for.
inline constexpr double greatest_turn = 0.5;

}  // namespace tenon
