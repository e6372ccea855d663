// SPDX-License-Identifier: BSD-3-Clause
// Danilovskaya's problem (case F06): the surface of a half-space at rest becomes hot at once; conduction with its own
// step sends temperatures to explicit mechanics. Uncoupled: strain rates make no heat.
#include <cstdio>

#include "components/thermal/thermal.hpp"
#include "constraints_case.hpp"
#include "framework/simulation/simulation.hpp"
#include "transfer/field_link.hpp"

namespace tenon::testing {
namespace {

constexpr int elements = 400;
constexpr double youngs_modulus = 210e9, nu = 0.3, density = 7850, specific_heat = 460, conductivity = 2.167e8,
                 expansion = 12e-6, step = 10, start_temperature = 300, depth = 8;  // units of kappa / c

struct Scales {
  double c = std::sqrt(youngs_modulus * (1 - nu) / ((1 + nu) * (1 - 2 * nu)) / density);
  double kappa = conductivity / (density * specific_heat);
  double length = kappa / c, time = kappa / (c * c);
  double stress = youngs_modulus * expansion / (1 - 2 * nu) * step;
};

class HalfSpace {
 public:
  HalfSpace() : log_(false), simulation_(communicator(), log_, 0.0, 3 * scale.time) {
    const double h = depth * scale.length / elements;
    const auto mesh = shared_mesh(on_root(box({0, 0, 0}, {depth * scale.length, h, h}, {elements, 1, 1})));
    ThermalOptions heat;
    heat.blocks = {{"box", density, specific_heat, conductivity, start_temperature}};
    heat.stepper = ThermalStepper::tr_bdf2;
    heat.control.tolerance = 1e-3;
    heat.control.maximum = 0.0025 * scale.time;  // a fraction of the mechanical step: no lag
    heat.prescribed = {{"x_min", TimeFunction::constant(start_temperature + step)}};
    Component& source = simulation_.add(std::make_unique<Thermal>("conduction", mesh, heat));
    MaterialDescription steel = elastic_material(youngs_modulus, nu, density);
    steel.elastic->expansion = expansion;
    steel.thermal = ThermalProperties{conductivity, specific_heat, start_temperature, 0.9};
    MechanicsOptions o;
    o.initial_temperature = start_temperature;
    o.motions = {symmetry("y_min", {0, 1, 0}), symmetry("y_max", {0, 1, 0}), symmetry("z_min", {0, 0, 1}),
                 symmetry("z_max", {0, 0, 1})};
    auto solid = body(mesh, steel, o);
    solid_ = solid.get();
    Component& target = simulation_.add(std::move(solid));
    transfer::FieldLinkOptions link;
    link.source_field = link.target_field = "temperature";
    simulation_.add(std::make_unique<transfer::FieldLink>("temperature", source, target, link));
    simulation_.initialize();
  }
  Simulation& simulation() { return simulation_; }
  /// Of mechanics, which may stand behind the simulation's clock.
  double tau() const { return solid_->time() / scale.time; }
  /// sigma / (beta T0) at a depth xi, linear between the centres of elements.
  double stress(double xi) {
    const std::vector<double> s = field(*solid_, "stress");
    const double at = xi / depth * elements - 0.5;
    const auto e = static_cast<std::size_t>(at);
    const double w = at - double(e);
    return ((1 - w) * s[6 * e] + w * s[6 * e + 6]) / scale.stress;
  }

  const Scales scale;

 private:
  Log log_;
  Simulation simulation_;
  Mechanics* solid_ = nullptr;
};

TEST(Danilovskaya, StressesAndFront) {
  HalfSpace half_space;
  Simulation& simulation = half_space.simulation();
  // xi, tau, sigma / (beta T0)
  const double points[][3] = {{1, 0.5, -0.405224}, {1, 2, 0.056876}, {2, 3, 0.058325}};
  double before[3] = {}, value[3], lowest = 0, front = 0, tau_before = 0, stress_before = 0;
  bool seen[3] = {};
  while (!simulation.done()) {
    simulation.step();
    const double tau = half_space.tau(), s1 = half_space.stress(1);
    if (tau == tau_before) continue;
    for (int i = 0; i < 3; ++i) {
      const double now = half_space.stress(points[i][0]);
      if (!seen[i] && tau >= points[i][1] * (1 - 1e-12)) {
        const double w = (points[i][1] - tau_before) / (tau - tau_before);
        value[i] = (1 - w) * before[i] + w * now, seen[i] = true;
      }
      before[i] = now;
    }
    lowest = std::min(lowest, s1);
    // The jump of +1 from -0.8844 to 0.1144 is half-way at -0.385.
    if (front == 0 && tau > 0.8 && s1 > -0.385 && stress_before <= -0.385)
      front = tau_before + (tau - tau_before) * (-0.385 - stress_before) / (s1 - stress_before);
    tau_before = tau, stress_before = s1;
  }
  for (int i = 0; i < 3; ++i) {
    std::printf("F06 sigma*(%g, %g) = %.6f, exact %.6f (%.2f %%)\n", points[i][0], points[i][1], value[i], points[i][2],
                100 * (value[i] / points[i][2] - 1));
    EXPECT_NEAR(value[i], points[i][2], 0.02 * std::abs(points[i][2]));
  }
  std::printf("F06 front at xi = 1: tau %.4f, lowest %.4f, %lld steps\n", front, lowest,
              static_cast<long long>(simulation.steps()));
  EXPECT_NEAR(front, 1, 0.01);
  EXPECT_LT(simulation.ledger().take().error, 1e-11);
}

}  // namespace
}  // namespace tenon::testing
