// SPDX-License-Identifier: BSD-3-Clause
// The free rigid body against conservation laws and closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "components/mechanics/nodal_damping.hpp"
#include "components/mechanics/rigid_motion.hpp"
#include "framework/base/error.hpp"

namespace tenon {
namespace {

/// A brick, principal moments 1 : 2 : 2.5, whose principal axes are turned in the reference position.
RigidInertia brick() {
  RigidInertia body;
  body.mass = 3;
  const Quaternion q = rotation_by({0.3, -0.7, 0.4});
  const double moments[] = {1, 2, 2.5};
  for (std::size_t i = 0; i < 3; ++i) {
    Vec3 axis{};
    axis[i] = 1;
    body.inertia = body.inertia + transverse_isotropic(moments[i], 0, rotate(q, axis));
  }
  body.inverse = inverted(body.inertia, "brick");
  return body;
}

Vec3 principal(int i) {
  Vec3 axis{};
  axis[static_cast<std::size_t>(i)] = 1;
  return rotate(rotation_by({0.3, -0.7, 0.4}), axis);
}

TEST(RigidMotion, InverseOfTheInertia) {
  const RigidInertia body = brick();
  const Vec3 x{0.2, -1, 3};
  EXPECT_NEAR(norm(times(body.inverse, times(body.inertia, x)) - x), 0, 1e-14);
  EXPECT_THROW(inverted({1, 1, 0, 0, 0, 0}, "rod"), Error);
}

TEST(RigidMotion, SpinAboutAPrincipalAxisIsExact) {
  const RigidInertia body = brick();
  for (int i = 0; i < 3; ++i) {
    RigidState state;
    const Vec3 w = 7.0 * principal(i);
    state.momentum = angular_momentum(body, state, w);
    const int steps = 100;
    const double dt = 2 * std::numbers::pi / 7 / steps;
    for (int s = 0; s < steps; ++s) spin_freely(body, state, dt);  // once round
    const Vec3 x{1, 2, 3};
    EXPECT_NEAR(norm(rotate(state.orientation, x) - x), 0, 1e-12);
  }
}

TEST(RigidMotion, ATumblingBodyKeepsEnergyAndMomentum) {
  const RigidInertia body = brick();
  RigidState state;
  state.momentum = angular_momentum(body, state, 5.0 * principal(1) + 0.01 * principal(0));  // unstable axis: it flips
  const double energy = kinetic_energy(body, state);
  const Vec3 momentum = state.momentum;
  double least = 1;
  for (int s = 0; s < 20000; ++s) {
    spin_freely(body, state, 2e-3);
    const Vec3 w = angular_velocity(body, state);
    least = std::min(least, dot(w, momentum) / (norm(w) * norm(momentum)));
    ASSERT_NEAR(kinetic_energy(body, state), energy, 1e-12 * energy) << s;
  }
  EXPECT_LT(least, 0.99);  // it did tumble
  EXPECT_EQ(norm(state.momentum - momentum), 0);
}

TEST(RigidMotion, TumblingConvergesWithSecondOrder) {
  const RigidInertia body = brick();
  const auto end = [&](int steps) {
    RigidState state;
    state.momentum = angular_momentum(body, state, {3, -2, 1});
    for (int s = 0; s < steps; ++s) spin_freely(body, state, 1.0 / steps);
    return rotate(state.orientation, {1, 1, 1});
  };
  const Vec3 exact = end(20000);
  const double coarse = norm(end(50) - exact), fine = norm(end(100) - exact);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.05);
}

TEST(RigidMotion, ASymmetricTopPrecessesAsEulerSays) {
  RigidInertia body;
  body.mass = 1;
  body.inertia = {2, 2, 3, 0, 0, 0};
  body.inverse = inverted(body.inertia, "top");
  RigidState state;
  state.momentum = angular_momentum(body, state, {0.5, 0, 4});
  const Vec3 along = (1 / norm(state.momentum)) * state.momentum;
  // The axis of the body turns about L at |L|/I1.
  const double rate = norm(state.momentum) / 2, t = 2;
  const int steps = 4000;
  for (int s = 0; s < steps; ++s) spin_freely(body, state, t / steps);
  const Vec3 axis = rotate(state.orientation, {0, 0, 1});
  const Vec3 expected = rotate(rotation_by(rate * t * along), {0, 0, 1});
  EXPECT_NEAR(norm(axis - expected), 0, 1e-6);
}

}  // namespace
}  // namespace tenon
