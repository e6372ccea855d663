// SPDX-License-Identifier: BSD-3-Clause
// Case D06: contact conductance between two bars, steady and in time, with meshes that match and that do not.
#include <gtest/gtest.h>

#include <functional>

#include "thermal_contact_case.hpp"

namespace tenon::testing {
namespace {

constexpr double section = 0.02 * 0.02;  // m^2

/// Bars of 0.1 m at 100 and 0 degrees.
ThermalOptions steady_bars(double conductance, double k1 = 50, double k2 = 20) {
  ThermalOptions options = two_bars(ThermalStepper::steady, k1, k2);
  options.prescribed = {{"a_x_min", TimeFunction::constant(100)}, {"b_x_max", TimeFunction::constant(0)}};
  options.contacts = {contact_of_ends(conductance)};
  return options;
}

double flux_between(double conductance, double k1 = 50, double k2 = 20) {
  return 100 / (0.1 / k1 + 1 / conductance + 0.1 / k2);
}

class ContactMeshes : public ::testing::TestWithParam<std::pair<int, int>> {};

TEST_P(ContactMeshes, SteadyFluxAndTemperatures) {
  const auto [across_a, across_b] = GetParam();
  Thermal thermal("heat", distributed_pair(bar_between(0, 0.1, 8, across_a), bar_between(0.1, 0.2, 8, across_b)),
                  steady_bars(1000));
  thermal.initialize();
  thermal.advance(1);
  const bool match = across_a == across_b;
  const double tolerance = match ? 1e-9 : 5e-3;
  EXPECT_NEAR(thermal.contact_power(0) / section, 12500, 12500 * tolerance);
  for (const auto& [set, exact] : {std::pair{"a_x_max", 75.0}, {"b_x_min", 62.5}}) {
    const auto [low, high] = range_on(thermal, set);
    std::printf("%d | %d elements across, %s: %.10f to %.10f, flux %.8f W/m^2, %d iterations\n", across_a, across_b,
                set, low, high, thermal.contact_power(0) / section, thermal.last_solve().iterations);
    EXPECT_NEAR(low, exact, match ? 1e-8 : 0.05);
    EXPECT_NEAR(high, exact, match ? 1e-8 : 0.05);
  }
  EXPECT_LT(balance(thermal).error(), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(D06, ContactMeshes,
                         ::testing::Values(std::pair{1, 1}, std::pair{3, 3}, std::pair{2, 4}, std::pair{4, 3},
                                           std::pair{5, 2}, std::pair{3, 7}));

TEST(Contact, NothingPassesWithoutConductance) {
  ThermalOptions options = two_bars(ThermalStepper::backward_euler, 50, 20);
  options.fixed_step = 100;
  options.initial = {{"a_box", "", 100, {}}, {"b_box", "", 0, {}}};
  options.contacts = {contact_of_ends(0)};
  Thermal thermal("heat", distributed_pair(bar_between(0, 0.1, 4, 2), bar_between(0.1, 0.2, 4, 3)), options);
  thermal.initialize();
  for (int step = 0; step < 5; ++step) thermal.advance(100);
  EXPECT_EQ(range_on(thermal, "a_skin"), (std::pair{100.0, 100.0}));
  EXPECT_EQ(range_on(thermal, "b_skin"), (std::pair{0.0, 0.0}));
}

TEST(Contact, PerfectContactIsOneBar) {
  for (const double h : {1e5, 1e7, 1e9})
    for (const auto& [across_a, across_b] : {std::pair{2, 2}, {2, 3}, {4, 3}}) {
      Thermal thermal("heat", distributed_pair(bar_between(0, 0.1, 8, across_a), bar_between(0.1, 0.2, 8, across_b)),
                      steady_bars(h, 50, 50));
      thermal.initialize();
      thermal.advance(1);
      std::printf("h %g, %d | %d: flux %.6f (exact %.6f), %d iterations, multigrid %d\n", h, across_a, across_b,
                  thermal.contact_power(0) / section, flux_between(h, 50, 50), thermal.last_solve().iterations,
                  static_cast<int>(thermal.uses_multigrid()));
      EXPECT_NEAR(thermal.contact_power(0) / section, flux_between(h, 50, 50), across_a == across_b ? 0.01 : 25);
      EXPECT_NEAR(range_on(thermal, "a_x_max").first, range_on(thermal, "b_x_min").first, 0.6);
    }
}

// The closed forms of what passes, seen through whole solutions.
TEST(Contact, DependsOnGapAndPressure) {
  struct Case {
    double gap;       // m, between the bars
    double pressure;  // Pa; < 0: nobody says
    double expected;  // W/(m^2 K)
    std::function<void(ThermalContact&)> change;
  };
  const auto gas = [](ThermalContact& c) { c.gap_conductivity = 0.03, c.least_gap = 2e-6, c.greatest_gap = 5e-4; };
  const auto power_law = [](ThermalContact& c) { c.reference_pressure = 2e6; };
  const auto table = [](ThermalContact& c) { c.over_pressure = TimeFunction::table({{0, 100}, {1e6, 900}}); };
  const auto exact_touch = [](ThermalContact& c) { c.touching_gap = 1e-6; };
  const Case cases[] = {
      {0, -1, 1000, [](ThermalContact&) {}},
      {1e-4, -1, 1000, [](ThermalContact&) {}},  // within a tenth of a side of 6.7 mm
      {1e-4, -1, 0, exact_touch},
      {2e-3, -1, 0, [](ThermalContact&) {}},
      {0, -1, 1000 + 0.03 / 2e-6, gas},
      {1e-4, -1, 0.03 / 1e-4, [&](ThermalContact& c) { gas(c), exact_touch(c); }},
      {4.9e-4, -1, 0.03 / 4.9e-4, [&](ThermalContact& c) { gas(c), exact_touch(c); }},
      {5.1e-4, -1, 0, [&](ThermalContact& c) { gas(c), exact_touch(c); }},
      {0, -1, 1000, power_law},
      {0, 2e6, 1000, power_law},
      {0, 1e6, 1000 * std::pow(0.5, 0.95), power_law},
      {0, 0, 0, power_law},
      {0, -1, 100, table},
      {0, 5e5, 500, table},
      {0, 9e6, 900, table},
  };
  for (const Case& c : cases) {
    ThermalOptions options = steady_bars(1000);
    c.change(options.contacts[0]);
    Thermal thermal("heat", distributed_pair(bar_between(0, 0.1, 4, 3), bar_between(0.1 + c.gap, 0.2 + c.gap, 4, 4)),
                    options);
    thermal.initialize();
    if (c.pressure >= 0)
      import_port(thermal, "contact_pressure")
          .write(std::vector<double>(static_cast<std::size_t>(thermal.mesh().nodes()), c.pressure));
    thermal.advance(1);
    const double exact = c.expected > 0 ? flux_between(c.expected) : 0;
    EXPECT_NEAR(thermal.contact_power(0) / section, exact, 5e-3 * exact) << c.gap << " m, " << c.pressure << " Pa";
  }
}

// Body b moves away and comes back.
TEST(Contact, FollowsTheMotion) {
  Thermal thermal("heat", distributed_pair(bar_between(0, 0.1, 4, 3), bar_between(0.1, 0.2, 4, 4)), steady_bars(1000));
  thermal.initialize();
  for (const double distance : {0.0, 5e-3, 5e-3, 0.0}) {
    std::vector<double> u(3 * static_cast<std::size_t>(thermal.mesh().nodes()), 0.0);
    const ElementBlock& moving = *thermal.mesh().find_block("b_box");
    for (LocalIndex e = 0; e < moving.size(); ++e)
      for (const LocalIndex n : moving.nodes(e)) u[3 * static_cast<std::size_t>(n)] = distance;
    import_port(thermal, "displacement").write(u);
    thermal.advance(1);
    const double exact = distance == 0 ? 12500 : 0;
    EXPECT_NEAR(thermal.contact_power(0) / section, exact, 5e-3 * exact);
  }
}

TEST(Contact, ConductanceOverTime) {
  ThermalOptions options = steady_bars(0);
  options.contacts[0].conductance = TimeFunction::table({{0, 500}, {10, 1500}});
  Thermal thermal("heat", distributed_pair(bar_between(0, 0.1, 4, 3), bar_between(0.1, 0.2, 4, 3)), options);
  thermal.initialize();
  for (const double middle : {1.0, 3.0, 5.0}) {  // of a step of 2 s, at which the conductance counts
    thermal.advance(2);
    EXPECT_NEAR(thermal.contact_power(0) / section, flux_between(500 + 100 * middle), 1e-6) << middle;
  }
}

/// Temperatures of two bars of 0.1 m, insulated but for their contact, in `cells` finite volumes each, by
/// Crank-Nicolson in `steps` steps after a few of backward Euler: at the far ends and on both sides of the contact.
std::array<double, 4> fine_bars(double end, double h, int cells, int steps) {
  const auto n = static_cast<std::size_t>(2 * cells);
  const double dx = 0.1 / cells, k[2] = {50, 20}, c[2] = {4e6, 2e6};
  std::vector<double> t(n, 0.0), link(n, 0.0), lower(n), diagonal(n), right(n);
  for (std::size_t i = 0; i < n / 2; ++i) t[i] = 100;
  for (std::size_t i = 0; i + 1 < n; ++i) link[i] = k[i < n / 2 ? 0 : 1] / dx;
  const double across = 1 / (0.5 * dx / k[0] + 1 / h + 0.5 * dx / k[1]);
  link[n / 2 - 1] = across;
  const double dt = end / steps;
  const auto flux = [&](std::size_t i) { return i + 1 < n ? link[i] * (t[i] - t[i + 1]) : 0.0; };
  const auto step = [&](double theta, double length) {
    for (std::size_t i = 0; i < n; ++i) {
      const double capacity = c[i < n / 2 ? 0 : 1] * dx / length, left = i > 0 ? link[i - 1] : 0, mine = link[i];
      right[i] = (i > 0 ? flux(i - 1) : 0) - flux(i);
      diagonal[i] = capacity + theta * (left + (i + 1 < n ? mine : 0));
      lower[i] = -theta * left;
    }
    for (std::size_t i = 1; i < n; ++i) {  // the matrix is symmetric
      const double factor = lower[i] / diagonal[i - 1];
      diagonal[i] -= factor * lower[i];
      right[i] -= factor * right[i - 1];
    }
    for (std::size_t i = n; i-- > 0;) {
      if (i + 1 < n) right[i] -= lower[i + 1] * right[i + 1];
      right[i] /= diagonal[i];
    }
    for (std::size_t i = 0; i < n; ++i) t[i] += right[i];
  };
  for (int i = 0; i < 4; ++i) step(1, dt / 4);
  for (int i = 1; i < steps; ++i) step(0.5, dt);
  const double q = across * (t[n / 2 - 1] - t[n / 2]);
  return {t[0], t[n / 2 - 1] - 0.5 * dx * q / k[0], t[n / 2] + 0.5 * dx * q / k[1], t[n - 1]};
}

/// What the bodies have lost together, as a share of the heat that the first one had; nothing came or went outside.
double lost_heat(Thermal& thermal) {
  constexpr double heat = 100 * 4e6 * 0.1 * section;  // J
  return std::abs(balance(thermal).stored) / heat;
}

/// Of a bar of 0.1 m of hexahedra of one size, above 0 degrees, J.
double heat_of(const Thermal& thermal, const std::string& block) {
  const double per_volume = block == "a_box" ? 4e6 : 2e6;  // J/(m^3 K)
  ExactSum sum;
  const ElementBlock& b = *thermal.mesh().find_block(block);
  for (const LocalIndex e : owned_elements(b, communicator().rank()))
    for (const LocalIndex n : b.nodes(e)) sum.add(thermal.temperature()[static_cast<std::size_t>(n)]);
  return per_volume * 0.1 * section * communicator().sum(sum) / (8 * static_cast<double>(b.global_count));
}

/// Greatest error at the four places.
double transient_error(ThermalStepper stepper, int along, double dt, int across_b) {
  constexpr double end = 400, h = 1000;
  static const std::array<double, 4> exact = fine_bars(end, h, 1000, 4000);
  ThermalOptions options = two_bars(stepper, 50, 20);
  if (dt > 0) options.fixed_step = dt;
  options.initial = {{"a_box", "", 100, {}}, {"b_box", "", 0, {}}};
  options.contacts = {contact_of_ends(h)};
  Thermal thermal("heat", distributed_pair(bar_between(0, 0.1, along, 2), bar_between(0.1, 0.2, along, across_b)),
                  options);
  thermal.initialize();
  run_until(thermal, end);
  EXPECT_LT(lost_heat(thermal), 1e-12);
  // What has passed is what the second body has.
  EXPECT_NEAR(energy(thermal, "contact_heat"), heat_of(thermal, "b_box"), 1e-9 * heat_of(thermal, "b_box"));
  double error = 0;
  const char* sets[] = {"a_x_min", "a_x_max", "b_x_min", "b_x_max"};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto [low, high] = range_on(thermal, sets[i]);
    error = std::max({error, std::abs(low - exact[i]), std::abs(high - exact[i])});
  }
  return error;
}

TEST(Contact, TransientConvergesInSecondOrder) {
  for (const ThermalStepper stepper : {ThermalStepper::crank_nicolson, ThermalStepper::tr_bdf2})
    for (const int across_b : {2, 1}) {
      const double coarse = transient_error(stepper, 8, 10, across_b), fine = transient_error(stepper, 16, 5, across_b);
      const double order = std::log2(coarse / fine);
      std::printf("stepper %d, %d across: errors %.5f, %.5f K, order %.3f\n", static_cast<int>(stepper), across_b,
                  coarse, fine, order);
      EXPECT_NEAR(order, 2, 0.2);
      EXPECT_LT(fine, 0.1);
    }
}

// Heat that arises between two bodies is split as their effusivities sqrt(k rho c), however it is handed to their
// surfaces: the contact does it.
TEST(Contact, HeatOfTheInterfaceIsSplitByEffusivity) {
  for (const double share : {0.0, 0.5, 1.0}) {
    ThermalOptions options = two_bars(ThermalStepper::tr_bdf2, 50, 20);
    options.fixed_step = 0.5;
    options.contacts = {contact_of_ends(1e7)};
    options.fluxes = {{"a_x_max", TimeFunction::constant(share * 1e5)},
                      {"b_x_min", TimeFunction::constant((1 - share) * 1e5)}};
    BoxShape a = bar_between(0, 0.1, 32, 2), b = bar_between(0.1, 0.2, 32, 3);
    Thermal thermal("heat", distributed_pair(a, b), options);
    thermal.initialize();
    run_until(thermal, 20);  // the far ends feel nothing yet
    const double first = std::sqrt(50 * 4e6), second = std::sqrt(20 * 2e6);
    const double all = 1e5 * section * 20;
    EXPECT_NEAR(heat_of(thermal, "a_box"), all * first / (first + second), 0.005 * all) << share;
    EXPECT_NEAR(heat_of(thermal, "b_box"), all * second / (first + second), 0.005 * all) << share;
  }
}

TEST(Contact, ExplicitStepKnowsOfTheContact) {
  EXPECT_LT(transient_error(ThermalStepper::explicit_euler, 16, 0, 3), 0.2);
  ThermalOptions options = two_bars(ThermalStepper::explicit_euler, 50, 20);
  options.initial = {{"a_box", "", 100, {}}, {"b_box", "", 0, {}}};
  options.contacts = {contact_of_ends(1e6)};  // a hundred times more than the elements conduct
  Thermal thermal("heat", distributed_pair(bar_between(0, 0.1, 16, 2), bar_between(0.1, 0.2, 16, 3)), options);
  thermal.initialize();
  // Two halves of elements of 6.25 mm that exchange heat: rate h (1 / c1 + 1 / c2).
  const double rate = 1e6 * (1 / (4e6 * 3.125e-3) + 1 / (2e6 * 3.125e-3)), limit = thermal.stable_limit();
  std::printf("explicit limit %.6g s, of the contact alone %.6g s\n", limit, 2 / rate);
  EXPECT_LT(limit, 2 / rate);
  EXPECT_GT(limit, 0.5 * 2 / rate);
  for (int step = 0; step < 200; ++step) thermal.advance(limit);
  for (const double t : thermal.temperature()) EXPECT_TRUE(t >= -1 && t <= 101) << t;
  EXPECT_LT(lost_heat(thermal), 1e-12);
}

}  // namespace
}  // namespace tenon::testing
