// SPDX-License-Identifier: BSD-3-Clause
// Static cases of shells that tests of both tiers run (A09).
#pragma once

#include <cstdio>
#include <numbers>

#include "shell_case.hpp"

namespace tenon::testing {

inline constexpr double pi = std::numbers::pi;

inline MechanicsOptions statics(double tolerance) {
  MechanicsOptions options;
  options.loads.relaxation.emplace().tolerance = tolerance;
  options.viscosity = {0, 0};
  return options;
}

inline void report(const char* what, double value, double reference, std::int64_t steps) {
  std::printf("A09 %-28s %13.6g, reference %13.6g, ratio %.4f, %lld steps\n", what, value, reference, value / reference,
              static_cast<long long>(steps));
}

inline double twisted_beam(double t, double load, int direction) {
  const auto surface = [](double r, double s) {
    const double a = 0.5 * pi * s, y = 1.1 * (r - 0.5);
    return Vec3{12 * s, y * std::cos(a), y * std::sin(a)};
  };
  MechanicsOptions options = statics(t > 0.1 ? 1e-4 : 1e-5);
  options.motions = {hold("s0", "xyzrxryrz")};
  Vec3 force{};
  force[static_cast<std::size_t>(direction)] = load;
  options.loads.nodal_forces = {force_on("middle", force)};
  const auto body =
      shell_body(shared_mesh(shell_grid({2, 12}, surface)), elastic_material(29e6, 0.22, 1), section(t), options);
  const std::int64_t steps = relax(*body);
  const double u = displacement_of(*body, "middle")[static_cast<std::size_t>(direction)];
  const double reference =
      t > 0.1 ? (direction == 2 ? 5.42453e-3 : 1.753248e-3) : (direction == 2 ? 5.256e-3 : 1.294e-3);
  report(direction == 2 ? "twisted beam, Z" : "twisted beam, Y", u, reference, steps);
  return u / reference;
}

inline double pinched_cylinder(int n) {
  const auto surface = [](double r, double s) {
    return Vec3{300 * std::sin(0.5 * pi * s), 300 * r, 300 * std::cos(0.5 * pi * s)};
  };
  MechanicsOptions options = statics(1e-4);
  options.motions = {hold("r1", "xz"), hold("r0", "yrxrz"), hold("s0", "xryrz"), hold("s1", "zrxry")};
  options.loads.nodal_forces = {force_on("r0s0", {0, 0, -0.25})};
  const auto body =
      shell_body(shared_mesh(shell_grid({n, n}, surface)), elastic_material(3e6, 0.3, 1), section(3), options);
  const std::int64_t steps = relax(*body);
  const double w = -displacement_of(*body, "r0s0")[2];
  report("pinched cylinder", w, 1.82488e-5, steps);
  return w / 1.82488e-5;
}

}  // namespace tenon::testing
