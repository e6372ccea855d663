// SPDX-License-Identifier: BSD-3-Clause
// The books of failing elements (case A13): the energy that leaves with them, the wave that they release, and the mass
// and momentum of what remains.
#include <cstdio>

#include "constraints_case.hpp"

namespace tenon::testing {
namespace {

using Kind = PrescribedMotion::Kind;

// (a) A cube of 1 mm, perfectly plastic, is pulled to its plastic strain at failure of 0.2.
TEST(Erosion, EnergyOfACubeThatFails) {
  MaterialDescription metal = elastic_material(200e9, 0.3, 7850);
  metal.plasticity = LinearHardeningParameters{400e6, 0};
  metal.failure.emplace().plastic_strain = 0.2;
  MechanicsOptions o;
  PrescribedMotion pull = motion(Kind::velocity, {"x_max"});
  pull.components = {true, false, false};
  pull.value[0] = TimeFunction::constant(1);
  o.motions = {symmetry("x_min", {1, 0, 0}), symmetry("y_min", {0, 1, 0}), symmetry("z_min", {0, 0, 1}), pull};
  const auto b = body(shared_mesh(on_root(box({0, 0, 0}, {1e-3, 1e-3, 1e-3}, {1, 1, 1}))), metal, o);
  b->initialize();
  Ledger ledger(*b);
  const auto total = [&] {
    const auto r = energy_rows(*b);
    return r.at("kinetic_energy") + r.at("internal_energy") + r.at("eroded_energy") + r.at("hourglass_energy") +
           r.at("viscosity_energy") - r.at("boundary_work");
  };
  const double start = total();
  double worst = 0;
  while (b->time() < 0.3e-3) {
    b->advance(std::min(b->time_step(), 1e-6));
    worst = std::max(worst, std::abs(total() - start));
  }
  const auto rows = energy_rows(*b);
  std::printf("A13a eroded %.5f J, energy kept to %.2g J\n", rows.at("eroded_energy"), worst);
  EXPECT_NEAR(rows.at("eroded_energy"), 0.0804, 0.005 * 0.0804);
  EXPECT_LE(worst, 1e-3 * 0.0804);
  EXPECT_LE(std::abs(rows.at("internal_energy")), 1e-3 * 0.0804);  // the force of the half step in which it dies
  EXPECT_EQ(field(*b, "element_status")[0], 0);
  for (const ForceRow& f : b->internal_force())
    for (int c = 0; c < 3; ++c) EXPECT_EQ(f.v[c], 0);
  EXPECT_LT(ledger.error(), 1e-12);
}

/// A bar of 20 elements along x under the tension `stress`, in balance with dead loads on its ends, whose middle breaks
/// (elements 10 of 1..20) at the first step.
struct BrokenBar {
  static constexpr double length = 1, stress = 100e6, area = 0.05 * 0.05;
  std::unique_ptr<Mechanics> body;
  double wave_speed;

  BrokenBar() {
    MeshData mesh;
    if (communicator().rank() == 0) {
      mesh = generate(box({0, 0, 0}, {length, 0.05, 0.05}, {20, 1, 1}));
      BlockData& bar = mesh.blocks[0];
      BlockData left = bar, weak = bar, right = bar;
      const auto part = [&](BlockData& block, const char* name, int first, int last) {
        block.name = name;
        block.connectivity.assign(bar.connectivity.begin() + 8 * first, bar.connectivity.begin() + 8 * last);
        block.labels.assign(bar.labels.begin() + first, bar.labels.begin() + last);
      };
      part(left, "left", 0, 9), part(weak, "weak", 9, 10), part(right, "right", 10, 20);
      mesh.blocks = {left, weak, right};
    }
    const MaterialDescription strong = elastic_material(200e9, 0, 7850);
    MaterialDescription weak = strong;
    weak.failure.emplace().tensile_stress = 0.5 * stress;
    wave_speed = std::sqrt(200e9 / 7850);
    MechanicsOptions o;
    o.viscosity = {0.06, 0};
    o.loads.surface_loads = {
        {SurfaceLoad::Kind::reference_traction, {"x_min"}, {always(-stress), always(0), always(0)}, "left"},
        {SurfaceLoad::Kind::reference_traction, {"x_max"}, {always(stress), always(0), always(0)}, "right"}};
    InitialStress initial{{}, {}, "tension"};
    for (auto& s : initial.stress) s = always(0);
    initial.stress[0] = always(stress);
    o.loads.initial_stresses = {initial};
    o.blocks = {{"left", strong, {}, {}}, {"weak", weak, {}, {}}, {"right", strong, {}, {}}};
    body = std::make_unique<Mechanics>("bar", shared_mesh(std::move(mesh)), o);
    body->initialize();
  }
  /// Sum of m v along x, and of m |v|, of the nodes from `first` to `last`.
  std::pair<double, double> momentum(double first, double last) const {
    const std::vector<double> v = field(*body, "velocity");
    ExactSum sum, size;
    for (std::size_t n = 0; n < body->mesh().coordinates.size(); ++n) {
      const double x = body->mesh().coordinates[n][0], p = body->nodal_mass()[n] * v[3 * n];
      if (x > first && x < last) sum.add(p), size.add(std::abs(p));
    }
    return {sum.value(), size.value()};
  }
};

// (b) Each half feels only the load on its end, and the wave that was released runs through it.
TEST(Erosion, BothHalvesOfABarCarryTheReleasedWave) {
  BrokenBar bar;
  Mechanics& b = *bar.body;
  Ledger ledger(b);
  // The weak element fails in the first step; from then on the end loads alone push the halves.
  double impulse = 0, last = b.time_step();
  b.advance(last);
  while (b.time() < 0.3 / bar.wave_speed) {
    const double dt = b.time_step();
    impulse += BrokenBar::stress * BrokenBar::area * 0.5 * (last + dt);
    b.advance(dt);
    last = dt;
  }
  const std::vector<double> alive = field(b, "element_status"), stress = field(b, "stress"), v = field(b, "velocity");
  for (std::size_t e = 0; e < 20; ++e) EXPECT_EQ(alive[e], e == 9 ? 0 : 1) << e;
  const auto [all, size] = bar.momentum(-1, 2);
  EXPECT_LE(std::abs(all), 1e-12 * size);
  EXPECT_NEAR(bar.momentum(0.475, 2).first / impulse, 1, 1e-10);
  EXPECT_NEAR(bar.momentum(-1, 0.475).first / impulse, -1, 1e-10);
  // Behind the front: no stress, and the faces of the break part at stress/(rho c) each.
  const double released = BrokenBar::stress / (7850 * bar.wave_speed);
  for (std::size_t e = 0; e < 20; ++e) {
    if (e == 9) continue;
    const double from_break = e < 9 ? 0.45 - (0.05 * double(e) + 0.025) : 0.05 * double(e) + 0.025 - 0.5;
    if (from_break > 0.2 && from_break < 0.4) continue;  // the front
    EXPECT_NEAR(stress[6 * e], from_break < 0.2 ? 0 : BrokenBar::stress, 0.12 * BrokenBar::stress) << e;
  }
  double left = 0, right = 0;
  for (std::size_t n = 0; n < b.mesh().coordinates.size(); ++n) {
    const double x = b.mesh().coordinates[n][0];
    if (x > 0.3 && x < 0.42) left += v[3 * n] / 8;  // 2 planes of 4 nodes
    if (x > 0.52 && x < 0.62) right += v[3 * n] / 8;
  }
  std::printf("A13b released %.4f and %.4f m/s, exact %.4f\n", left, right, released);
  EXPECT_NEAR(left, -released, 0.03 * released);
  EXPECT_NEAR(right, released, 0.03 * released);
  EXPECT_LT(ledger.error(), 1e-12);
}

// (c) A cube that flies apart: its nodes keep mass, momentum and energy, and go straight on.
TEST(Erosion, NodesOfDeletedElementsFlyOn) {
  MaterialDescription metal = steel();
  metal.failure.emplace().tensile_stress = 1e3;
  MechanicsOptions o;
  o.initial_velocity_function = [](const Vec3& x) { return Vec3{7 + 100 * x[0], 50 * x[1] - 3, 20 * x[2] * x[0]}; };
  const auto b = body(shared_mesh(on_root(box({0, 0, 0}, {1, 1, 1}, {2, 1, 1}))), metal, o);
  b->initialize();
  Ledger ledger(*b);
  for (int s = 0; s < 20; ++s) b->advance(std::min(b->time_step(), 1e-5));
  for (const double alive : field(*b, "element_status")) ASSERT_EQ(alive, 0);
  const std::vector<double> v = field(*b, "velocity");
  const double kinetic = energy_rows(*b).at("kinetic_energy"), time = b->time();
  const std::vector<Vec3> before(b->current_coordinates().begin(), b->current_coordinates().end());
  for (int s = 0; s < 20; ++s) b->advance(std::min(b->time_step(), 1e-3));
  ExactSum mass;
  for (std::size_t n = 0; n < before.size(); ++n) {
    mass.add(b->nodal_mass()[n]);
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(b->current_coordinates()[n][c], before[n][c] + (b->time() - time) * v[3 * n + c], 1e-13) << n;
  }
  expect_same_bits(field(*b, "velocity"), v, "velocity");
  EXPECT_EQ(energy_rows(*b).at("kinetic_energy"), kinetic);
  EXPECT_NEAR(mass.value(), 7850, 1e-9);
  EXPECT_LT(ledger.error(), 1e-12);
}

}  // namespace
}  // namespace tenon::testing
