// SPDX-License-Identifier: BSD-3-Clause
// Whether mechanics and conduction in one simulation, without a coupling, cost the sum of the two alone.
//   sum_of_parts [turns = 41]
// Three simulations stand side by side and take turns: ten steps of mechanics, the one step of conduction that goes
// with them, both in one. The ratio of processor times is taken turn by turn, so that a machine that changes its speed
// from one second to the next does not matter. On one rank; CSV, and the quartiles
// of the ratio at the end.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>

#include "components/mechanics/mechanics.hpp"
#include "components/thermal/thermal.hpp"
#include "framework/mesh/generators.hpp"
#include "framework/simulation/simulation.hpp"

namespace {

using namespace tenon;

constexpr double mechanics_step = 0.2e-6;
constexpr int steps_a_turn = 10;
/// A little more than the steps of mechanics, so that rounding does not add one.
constexpr double conduction_step = (steps_a_turn + 1e-6) * mechanics_step;

std::shared_ptr<const Mesh> box(int n, bool tetrahedra) {
  BoxShape shape;
  shape.elements = {n, n, n};
  shape.tetrahedra = tetrahedra;
  return distribute(Communicator::world(), generate(shape), {});
}

/// 46,656 hexahedra, J2.
std::unique_ptr<Component> mechanics() {
  MaterialDescription steel;
  steel.name = "steel";
  steel.density = 7850;
  steel.elastic = Elasticity{210e9, 0.3, 0};
  steel.plasticity = LinearHardeningParameters{400e6, 1e9};
  MechanicsOptions options;
  options.blocks = {{"box", steel, {}, {}}};
  options.time_step.fixed = mechanics_step;
  InitialVelocity stretch;
  stretch.gradient = {-2000, 300, 0, 0, 500, 0, 0, 0, 700};
  options.initial_velocities = {stretch};
  return std::make_unique<Mechanics>("mechanics", box(36, false), options);
}

/// 998,250 tetrahedra, far from steady.
std::unique_ptr<Component> conduction() {
  ThermalOptions options;
  options.blocks = {{"box", 7850, 500, 40, 293.15}};
  options.stepper = ThermalStepper::crank_nicolson;
  options.fixed_step = conduction_step;
  options.initial_function = [](const Vec3& x) { return 300 + 100 * x[0] * x[1] + 50 * x[2] * x[2]; };
  return std::make_unique<Thermal>("conduction", box(55, true), options);
}

std::unique_ptr<Simulation> simulation(Log& log, bool with_mechanics, bool with_conduction) {
  auto made = std::make_unique<Simulation>(Communicator::world(), log, 0.0, 1.0);
  if (with_mechanics) made->add(mechanics());
  if (with_conduction) made->add(conduction());
  made->initialize();
  return made;
}

double seconds_of(Simulation& simulation, int steps) {
  const std::clock_t start = std::clock();
  for (int i = 0; i < steps; ++i) simulation.step();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

void run(int turns) {
  Log log(false);
  const auto solid = simulation(log, true, false), heat = simulation(log, false, true),
             both = simulation(log, true, true);
  const std::array<std::pair<Simulation*, int>, 3> parts{
      {{solid.get(), steps_a_turn}, {heat.get(), 1}, {both.get(), steps_a_turn}}};
  for (const auto& [part, steps] : parts) seconds_of(*part, 2 * steps);
  std::vector<double> ratios;
  std::array<double, 3> least{HUGE_VAL, HUGE_VAL, HUGE_VAL};
  fmt::print("mechanics s,conduction s,both s,ratio\n");
  for (int turn = 0; turn < turns; ++turn) {
    std::array<double, 3> cost{};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t k = (i + static_cast<std::size_t>(turn)) % 3;
      cost[k] = seconds_of(*parts[k].first, parts[k].second);
      least[k] = std::min(least[k], cost[k]);
    }
    ratios.push_back(cost[2] / (cost[0] + cost[1]));
    fmt::print("{:.4f},{:.4f},{:.4f},{:.4f}\n", cost[0], cost[1], cost[2], ratios.back());
  }
  std::ranges::sort(ratios);
  const auto part = [&](std::size_t q) { return ratios[q * (ratios.size() - 1) / 4]; };
  fmt::print("both over the sum: median {:.4f}, quartiles {:.4f} and {:.4f}\n", part(2), part(1), part(3));
  fmt::print("of the least times: {:.4f}\n", least[2] / (least[0] + least[1]));
}

}  // namespace

int main(int argc, char** argv) {
  MpiEnvironment environment(argc, argv);
  if (Communicator::world().size() > 1) {
    fmt::print(stderr, "sum_of_parts runs on one rank\n");
    return 2;
  }
  run(argc > 1 ? std::atoi(argv[1]) : 41);
  return 0;
}
