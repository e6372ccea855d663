// SPDX-License-Identifier: BSD-3-Clause
// First bending frequency of a cantilever of hexahedra (case A05): one-point elements with viscous hourglass control
// bend by their layers alone; the others have the bending of each element.
#include <cstdio>
#include <numbers>

#include "constraints_case.hpp"

namespace tenon::testing {
namespace {

using Form = HourglassOptions::Form;
using Formulation = MechanicsOptions::Formulation;

constexpr double timoshenko = 82.904;  // Hz; a clamped end adds about 0.5 % to it

/// First mode of a clamped Euler-Bernoulli beam of length 1, with 1 at the tip.
double first_mode(double x) {
  const double k = 1.87510406871, s = (std::cosh(k) + std::cos(k)) / (std::sinh(k) + std::sin(k));
  const auto shape = [&](double y) {
    return std::cosh(k * y) - std::cos(k * y) - s * (std::sinh(k * y) - std::sin(k * y));
  };
  return shape(x) / shape(1);
}

/// Frequency from the zeros of the tip's deflection over one and a half periods; layers of elements over the height of
/// 0.1 m.
double frequency(int layers, Form form, Formulation formulation = Formulation::automatic) {
  MechanicsOptions o;
  o.viscosity = {0, 0};
  o.hourglass.form = form;
  o.motions = {motion(PrescribedMotion::Kind::fixed, {"x_min"})};
  o.initial_velocity_function = [](const Vec3& x) { return Vec3{0, 0, 0.1 * first_mode(x[0])}; };
  auto mesh = shared_mesh(on_root(box({0, 0, 0}, {1, 0.05, 0.1}, {80, 1, layers})));
  for (const ElementBlock& block : mesh->blocks) o.blocks.push_back({block.name, steel(), formulation, {}});
  Mechanics beam("beam", mesh, o);
  beam.initialize();
  Ledger ledger(beam);
  const auto tip = static_cast<std::size_t>(mesh->find_node_set("x_max")->nodes.front());
  std::vector<double> zeros;
  double before = 0, time_before = 0;
  while (zeros.size() < 3 && beam.time() < 4 / timoshenko) {
    beam.advance(beam.time_step());
    const double now = beam.current_coordinates()[tip][2] - mesh->coordinates[tip][2];
    if (before * now < 0) zeros.push_back(time_before + (beam.time() - time_before) * before / (before - now));
    before = now, time_before = beam.time();
  }
  EXPECT_EQ(zeros.size(), 3u);
  EXPECT_LT(ledger.error(), 1e-12);
  return 1 / (zeros.back() - zeros.front());
}

TEST(Cantilever, OnePointElementsBendByTheirLayers) {
  double f[3];
  for (int i = 0, layers = 2; i < 3; ++i, layers *= 2) {
    f[i] = frequency(layers, Form::viscous);
    const double expected = timoshenko * std::sqrt(1 - 1.0 / (layers * layers));
    std::printf("A05 viscous, %d layers: %.3f Hz, a priori %.3f\n", layers, f[i], expected);
    EXPECT_NEAR(f[i], expected, 0.01 * expected) << layers;
  }
  EXPECT_NEAR(std::log2((f[1] - f[0]) / (f[2] - f[1])), 2, 0.15);
}

/// The hourglass modes carry the bending within the element: two layers are enough.
TEST(Cantilever, PhysicalHourglassStiffnessBendsWithinTheElement) {
  double f[3];
  for (int i = 0, layers = 2; i < 3; ++i, layers *= 2) {
    f[i] = frequency(layers, Form::physical);
    std::printf("A05 physical, %d layers: %.3f Hz\n", layers, f[i]);
    EXPECT_NEAR(f[i], 1.0025 * timoshenko, 0.005 * timoshenko) << layers;
  }
  EXPECT_GT(std::log2((f[1] - f[0]) / (f[2] - f[1])), 1.9);
}

}  // namespace
}  // namespace tenon::testing
