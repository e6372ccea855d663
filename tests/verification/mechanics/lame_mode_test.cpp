// SPDX-License-Identifier: BSD-3-Clause
// The Lame mode of a free cube (case A04): three-dimensional, without boundary conditions, for any Poisson
// ratio.
#include <numbers>

#include "mechanics_case.hpp"

namespace tenon::testing {
namespace {

constexpr double pi = std::numbers::pi, edge = 0.1;
const double omega = std::sqrt(2.0) * pi / edge * std::sqrt(steel().elastic->shear_modulus() / steel().density);

Vec3 shape(const Vec3& x) {
  return {std::cos(pi * x[0] / edge) * std::sin(pi * x[1] / edge),
          -std::sin(pi * x[0] / edge) * std::cos(pi * x[1] / edge), 0};
}

/// Relative error of the frequency, from the zeros of the mode's amplitude over four periods.
double frequency_error(int n, double distortion) {
  BoxShape box;
  box.high = {edge, edge, edge};
  box.elements = {n, n, n};
  box.distortion = distortion;
  MechanicsOptions options;
  options.viscosity = {0, 0};
  options.hourglass.coefficient = 0.01;
  options.initial_velocity_function = [](const Vec3& x) { return 0.01 * shape(x); };
  const auto m = body(shared_mesh(on_root(box)), steel(), options);
  m->initialize();
  double before = 0, last_zero = 0, first_zero = 0;
  int zeros = 0;
  while (m->time() < 4.1 * 2 * pi / omega) {
    const double dt = m->time_step();
    m->advance(dt);
    const std::vector<double> v = field(*m, "velocity");
    double amplitude = 0;
    for (std::size_t i = 0; i < m->mesh().coordinates.size(); ++i) {
      const Vec3 s = shape(m->mesh().coordinates[i]);
      amplitude += m->nodal_mass()[i] * (v[3 * i] * s[0] + v[3 * i + 1] * s[1]);
    }
    if (before * amplitude < 0) {
      const double zero = m->time() - dt * amplitude / (amplitude - before);
      if (zeros++ == 0) first_zero = zero;
      last_zero = zero;
    }
    before = amplitude;
  }
  return pi * (zeros - 1) / (last_zero - first_zero) / omega - 1;
}

TEST(LameMode, FrequencyConvergesAsOnePointElementsDo) {
  const double e8 = frequency_error(8, 0), e16 = frequency_error(16, 0);
  EXPECT_NEAR(e8, -2.55e-2, 0.5 * 2.55e-2);
  EXPECT_NEAR(e16, -6.4e-3, 0.5 * 6.4e-3);
  EXPECT_NEAR(std::log2(e8 / e16), 2, 0.3);
}

TEST(LameMode, DistortedElementsKeepTheOrder) {
  const double e8 = frequency_error(8, 0.15);
  EXPECT_NEAR(e8, -2.55e-2, 0.5 * 2.55e-2);
}

}  // namespace
}  // namespace tenon::testing
