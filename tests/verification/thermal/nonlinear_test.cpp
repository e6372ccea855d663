// SPDX-License-Identifier: BSD-3-Clause
// Coefficients that depend on the temperature: Kirchhoff's transform, Neumann's solution of Stefan's problem, radiation
// (NAFEMS T2, case D05), orthotropic conduction.
#include <gtest/gtest.h>

#include <numbers>

#include "thermal_case.hpp"

namespace tenon::testing {
namespace {

constexpr double pi = std::numbers::pi;

/// k = 1 + b T between 0 and 1: T = (sqrt(1 + (2 b + b^2) x) - 1) / b.
double kirchhoff_error(int n) {
  const double b = 4;
  ThermalOptions options;
  options.blocks = {material(1, 1)};
  options.blocks[0].conductivity_over_temperature = TemperatureTable({{0.0, 1.0}, {1.0, 1.0 + b}});
  options.stepper = ThermalStepper::steady;
  options.prescribed = {{"x_min", TimeFunction::constant(0)}, {"x_max", TimeFunction::constant(1)}};
  Thermal thermal("heat", distributed(bar(1, n)), options);
  thermal.initialize();
  thermal.advance(1);
  EXPECT_LT(balance(thermal).error(), 1e-12);
  double error = 0;
  for (std::size_t i = 0; i < thermal.temperature().size(); ++i) {
    const double x = thermal.mesh().coordinates[i][0], exact = (std::sqrt(1 + (2 * b + b * b) * x) - 1) / b;
    error = std::max(error, std::abs(thermal.temperature()[i] - exact));
  }
  return thermal.mesh().comm.max(error);
}

// At the mean of its ends an element conducts as k integrated over them, so that the nodes of a bar are exact.
TEST(Conductivity, OverTemperatureAgreesWithKirchhoffsTransform) {
  EXPECT_LT(kirchhoff_error(8), 1e-7);
  EXPECT_LT(kirchhoff_error(32), 1e-7);
}

/// u = integral of k dT obeys a linear equation where rho c grows with k: T at 0.3 s of a bar heated at both ends.
TEST(Conductivity, TransientWithHeatCapacityThatGrowsAlikeIsThatOfTheTransform) {
  const double b = 2;
  ThermalOptions warm, linear;
  warm.blocks = {material(1, 1)};
  warm.blocks[0].conductivity_over_temperature = TemperatureTable({{0.0, 1.0}, {1.0, 1.0 + b}});
  warm.blocks[0].specific_heat_over_temperature = TemperatureTable({{0.0, 1.0}, {1.0, 1.0 + b}});
  warm.stepper = ThermalStepper::tr_bdf2;
  warm.fixed_step = 0.01;
  warm.nonlinear_tolerance = 1e-10;
  warm.prescribed = {{"x_max", TimeFunction::constant(1)}};
  linear = warm;
  linear.blocks = {material(1, 1)};
  linear.prescribed = {{"x_max", TimeFunction::constant(1 + b / 2)}};
  const auto mesh = distributed(bar(1, 20));
  Thermal hot("heat", mesh, warm), u("heat", mesh, linear);
  hot.initialize(), u.initialize();
  run_until(hot, 0.3), run_until(u, 0.3);
  for (std::size_t i = 0; i < hot.temperature().size(); ++i) {
    const double t = hot.temperature()[i];
    EXPECT_NEAR(t + 0.5 * b * t * t, u.temperature()[i], 1e-7) << i;
  }
  EXPECT_LT(balance(hot).error(), 1e-12);
}

/// Neumann's one-phase solution [CJ59, 11.2]: lambda exp(lambda^2) erf(lambda) = Ste / sqrt(pi).
double neumann_lambda(double stefan) {
  double low = 0, high = 3;
  for (int i = 0; i < 100; ++i) {
    const double mid = 0.5 * (low + high);
    (mid * std::exp(mid * mid) * std::erf(mid) * std::sqrt(pi) < stefan ? low : high) = mid;
  }
  return low;
}

/// Relative error of the front at t = 0.1 s of a body at the melting point, one face of which is kept 1 K warmer.
double front_error(int n) {
  const double latent = 2, lambda = neumann_lambda(1 / latent), end = 0.1, interval = 0.01;
  ThermalOptions options;
  options.blocks = {{"box", 1, 1, 1, 100}};
  options.blocks[0].latent_heat = latent;
  options.blocks[0].solidus = 100;
  options.blocks[0].liquidus = 100 + interval;
  options.stepper = ThermalStepper::backward_euler;
  options.fixed_step = end / (4 * n);
  options.prescribed = {{"x_min", TimeFunction::constant(101)}};
  Thermal thermal("heat", distributed(bar(1, n)), options);
  thermal.initialize();
  run_until(thermal, end);
  EXPECT_LT(balance(thermal).error(), 1e-12);
  // The front by the enthalpy stored: latent x + the sensible heat of the exact profile.
  // Per area; the node that is held counts from its prescribed temperature on, so that its own share comes on top.
  const double stored = energy(thermal, "thermal_energy") * n * n + (latent + 1) * 0.5 / n;
  const double x = 2 * lambda * std::sqrt(end);
  double sensible = 0;
  const int points = 2000;
  for (int i = 0; i < points; ++i) {
    const double s = x * (i + 0.5) / points;
    sensible += x / points * (1 - std::erf(s / (2 * std::sqrt(end))) / std::erf(lambda));
  }
  EXPECT_NEAR(stored, latent * x + sensible, 0.005 * stored);
  // ... and by where the temperature passes the liquidus.
  double front = 0;
  for (int i = 0; i < n; ++i) {
    const double a = temperature_at(thermal, {double(i) / n, 0, 0}), b = temperature_at(thermal, {(i + 1.0) / n, 0, 0});
    const double melting = 100 + interval / 2;
    if (a >= melting && b < melting) front = (i + (a - melting) / (a - b)) / n;
  }
  return std::abs(front - x) / x;
}

TEST(ChangeOfPhase, FrontMovesAsInNeumannsSolution) {
  EXPECT_LT(front_error(50), 0.04);
  EXPECT_LT(front_error(200), 0.012);
}

TEST(ChangeOfPhase, MeltsAndFreezesWithTheSameHeat) {
  ThermalOptions options;
  options.blocks = {{"box", 1000, 500, 20, 300}};
  options.blocks[0].latent_heat = 2e5;
  options.blocks[0].solidus = 350, options.blocks[0].liquidus = 351;
  options.stepper = ThermalStepper::tr_bdf2;
  options.control = {1.0, {}, 20.0};
  options.fluxes = {{"x_max", TimeFunction::table({{0, 1e5}, {3600, 1e5}, {3600.001, -1e5}, {1e9, -1e5}})}};
  Thermal thermal("heat", distributed(bar(0.2, 8)), options);
  thermal.initialize();
  run_until(thermal, 3600);
  EXPECT_GT(temperature_at(thermal, {0.2, 0, 0}), 351);
  run_until(thermal, 7200);
  EXPECT_LT(balance(thermal).error(), 1e-11);
  // All the heat has gone again; the bar is level on the whole.
  EXPECT_LT(std::abs(energy(thermal, "thermal_energy")), 1e-3 * 1e5 * 0.025 * 0.025 * 3600);
}

// Case D05 [NAF90, test T2]: k dT/dx at the end that radiates is emissivity sigma (T^4 - 300^4).
TEST(NafemsT2, RadiatingBar) {
  for (const bool tetrahedra : {false, true}) {
    BoxShape shape = bar(0.1, 10);
    shape.tetrahedra = tetrahedra;
    ThermalOptions options;
    options.blocks = {{"box", 7850, 460, 55.6, 1000}};
    options.stepper = ThermalStepper::steady;
    options.prescribed = {{"x_min", TimeFunction::constant(1000)}};
    options.radiation = {{"x_max", 0.98, TimeFunction::constant(300)}};
    Thermal thermal("heat", distributed(shape), options);
    thermal.initialize();
    thermal.advance(1);
    EXPECT_NEAR(temperature_at(thermal, {0.1, 0, 0}), 927.0040, 1e-3);
    EXPECT_LT(balance(thermal).error(), 1e-12);
    EXPECT_NEAR(energy(thermal, "radiation_heat"), -energy(thermal, "prescribed_heat"),
                1e-7 * energy(thermal, "prescribed_heat"));
  }
}

// rho c dT/dt = - 2 emissivity sigma T^4 / thickness of a plate too thin for gradients: T = (T0^-3 + 3 a t)^(-1/3).
TEST(Radiation, CoolsAThinPlate) {
  BoxShape shape;
  shape.high = {0.001, 0.01, 0.01};
  ThermalOptions options;
  options.blocks = {{"box", 8000, 500, 400, 1000}};
  options.stepper = ThermalStepper::tr_bdf2;
  options.control.tolerance = 1e-3;
  for (const char* side : {"x_min", "x_max"}) options.radiation.push_back({side, 0.5, TimeFunction::constant(0)});
  Thermal thermal("heat", distributed(shape), options);
  thermal.initialize();
  run_until(thermal, 200);
  const double a = 2 * 0.5 * 5.670374419e-8 / (8000 * 500 * 0.001);
  EXPECT_NEAR(temperature_at(thermal, {0, 0, 0}), std::pow(1e-9 + 3 * a * 200, -1.0 / 3), 0.05);
  EXPECT_LT(balance(thermal).error(), 1e-12);
}

std::array<Vec3, 3> turned_tensor() {  // 10, 3 and 1 W/(m K) along axes turned by 30 degrees about z
  const double c = std::sqrt(0.75), s = 0.5;
  const Vec3 a{c, s, 0}, b{-s, c, 0}, d{0, 0, 1};
  std::array<Vec3, 3> k{};
  for (std::size_t i = 0; i < 3; ++i) k[i] = 10 * a[i] * a + 3 * b[i] * b + 1 * d[i] * d;
  return k;
}

TEST(Orthotropic, LinearFieldIsExactAndFlowsAskew) {
  const Vec3 g{3, -2, 5};
  ThermalOptions options;
  options.blocks = {material(1, 1)};
  options.blocks[0].conductivity_tensor = turned_tensor();
  options.initial = {{"", "", 7, g}};
  Thermal thermal("heat", distributed(cube(4, true, 0.2)), options);
  thermal.initialize();
  std::vector<double> flux(3 * static_cast<std::size_t>(thermal.mesh().elements()));
  thermal.exports()[1].read(flux);
  for (std::size_t i = 0; i < flux.size(); ++i) EXPECT_NEAR(flux[i], -dot(turned_tensor()[i % 3], g), 1e-9);
  thermal.advance(thermal.time_step());
  for (const LocalIndex n : thermal.mesh().owned_nodes) {
    const Vec3& x = thermal.mesh().coordinates[static_cast<std::size_t>(n)];
    const bool inside = std::ranges::all_of(x, [](double v) { return v > 0 && v < 1; });
    const double expected = 7 + dot(g, x), found = thermal.temperature()[static_cast<std::size_t>(n)];
    EXPECT_NEAR(found, inside ? expected : found, 1e-11);
  }
}

/// Manufactured solution T = e^-t sin x sin 2y sin 3z, whose mixed derivatives meet the mixed conductivities.
double orthotropic_error(int n, bool tetrahedra) {
  constexpr double end = 0.1;
  const std::array<Vec3, 3> k = turned_tensor();
  const auto exact = [](const Vec3& x, double t) {
    return std::exp(-t) * std::sin(x[0]) * std::sin(2 * x[1]) * std::sin(3 * x[2]);
  };
  BoxShape shape = cube(n, tetrahedra, 0.15);
  shape.high = {pi, pi / 2, pi / 3};
  ThermalOptions options;
  options.blocks = {material(1, 1)};
  options.blocks[0].conductivity_tensor = k;
  options.stepper = ThermalStepper::tr_bdf2;
  options.fixed_step = end / n;
  options.initial_function = [exact](const Vec3& x) { return exact(x, 0); };
  options.source_function = [exact, k](const Vec3& x, double t) {
    const double mixed = 2 * k[0][1] * 2 * std::cos(x[0]) * std::cos(2 * x[1]) * std::sin(3 * x[2]);
    return (k[0][0] + 4 * k[1][1] + 9 * k[2][2] - 1) * exact(x, t) - std::exp(-t) * mixed;
  };
  for (const char* set : {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"})
    options.prescribed.push_back({set, TimeFunction::constant(0)});
  Thermal thermal("heat", distributed(shape), options);
  thermal.initialize();
  run_until(thermal, end);
  ExactSum error, size;
  for (const LocalIndex i : thermal.mesh().owned_nodes) {
    const auto node = static_cast<std::size_t>(i);
    const double t = exact(thermal.mesh().coordinates[node], end), d = thermal.temperature()[node] - t;
    error.add(d * d), size.add(t * t);
  }
  return std::sqrt(thermal.mesh().comm.sum(error) / thermal.mesh().comm.sum(size));
}

TEST(Orthotropic, ManufacturedSolutionAlongTurnedAxesIsOfSecondOrder) {
  for (const bool tetrahedra : {false, true}) {
    const double coarse = orthotropic_error(8, tetrahedra), fine = orthotropic_error(16, tetrahedra);
    EXPECT_LT(fine, 0.04) << tetrahedra;
    EXPECT_GT(std::log2(coarse / fine), 1.7) << tetrahedra << ": " << coarse << " " << fine;
  }
}

}  // namespace
}  // namespace tenon::testing
