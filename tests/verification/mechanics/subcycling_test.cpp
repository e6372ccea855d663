// SPDX-License-Identifier: BSD-3-Clause
// Elements with steps of their own: momentum and energy kept, waves carried across, nothing that grows by itself.
#include "shell_case.hpp"
#include "solid_meshes.hpp"

namespace tenon::testing {
namespace {

using Kind = PrescribedMotion::Kind;

/// A bar of one row of elements, `fine` times shorter between a third and a half of its length.
MeshData stepped_bar(int coarse, int fine) {
  BoxShape box;
  std::vector<double> x{0};
  const double h = 1.0 / coarse;
  while (x.back() < 1 - 1e-9) {
    const bool inside = x.back() > 1.0 / 3 && x.back() < 0.5;
    x.push_back(std::min(1.0, x.back() + (inside ? h / fine : h)));
  }
  const int n = static_cast<int>(x.size()) - 1;
  box.high = {static_cast<double>(n), 1.0 / coarse, 1.0 / coarse};
  box.elements = {n, 1, 1};
  MeshData mesh = on_root(box);
  for (Vec3& p : mesh.coordinates) p[0] = x[static_cast<std::size_t>(std::lround(p[0]))];
  return mesh;
}

MechanicsOptions rollers() {
  MechanicsOptions options;
  for (const char* set : {"y_min", "y_max"}) options.motions.push_back(symmetry(set, {0, 1, 0}));
  for (const char* set : {"z_min", "z_max"}) options.motions.push_back(symmetry(set, {0, 0, 1}));
  options.viscosity = {0, 0};
  options.time_step.estimate = TimeStepOptions::Estimate::element;
  return options;
}

/// A pulse that starts inside (given displacement and velocity cannot both be had: a standing one splits in two halves)
/// runs over the short elements. Relative L2 error of the velocity at the end, and the ratio of updates to those of
/// equal steps.
std::pair<double, double> pulse_error(int coarse, int subcycling) {
  const double c = std::sqrt(steel().elastic->p_wave_modulus() / steel().density);
  const auto half = [](double s) { return 0.5e-6 * std::exp(-std::pow(s / 0.05, 2)); };
  MechanicsOptions options = rollers();
  options.time_step.subcycling = subcycling;
  options.initial_velocity_function = [&](const Vec3& x) { return Vec3{2 * half(x[0] - 0.25), 0, 0}; };
  const auto m = body(shared_mesh(stepped_bar(coarse, 5)), steel(), options);
  m->initialize();
  const double end = 0.45 / c;
  run_to(*m, end);
  // Velocities are those of half a step before.
  double error = 0, size = 0;
  const std::vector<double> v = field(*m, "velocity");
  for (std::size_t i = 0; i < m->mesh().coordinates.size(); ++i) {
    const double x = m->mesh().coordinates[i][0];
    if (x < 0.45) continue;  // the other half has met the near end
    const double exact = half(x - 0.25 - c * end);
    error += std::pow(v[3 * i] - exact, 2), size += exact * exact;
  }
  return {std::sqrt(error / size), static_cast<double>(m->work_done())};
}

TEST(Subcycling, CarriesWavesAcrossWithSecondOrder) {
  double last = 0, before = 0;
  for (const int n : {40, 80, 160}) {
    before = last;
    const auto [error, work] = pulse_error(n, 8);
    const auto [plain, plain_work] = pulse_error(n, 1);
    last = error;
    EXPECT_LT(error, 1.3 * plain + 1e-3) << n;
    EXPECT_LT(work, 0.75 * plain_work) << n;
  }
  EXPECT_GT(std::log2(before / last), 1.5);
}

/// Random boxes with slivers.
MechanicsOptions free_body(int subcycling) {
  MechanicsOptions options;
  options.viscosity = {0, 0};
  options.time_step.subcycling = subcycling;
  options.initial_velocity_function = [](const Vec3& x) {
    return Vec3{1e-3 * std::sin(40 * x[1]) + 1e-2, 1e-3 * std::cos(70 * x[0] + x[2]), 1e-3 * std::sin(50 * x[0])};
  };
  return options;
}

MeshData graded_box() {
  BoxShape box;
  box.high = {0.4, 0.05, 0.05};
  box.elements = {24, 4, 4};
  box.grading = {30, 1, 1};
  box.distortion = 0.15;
  return on_root(box);
}

Vec3 momentum(const Mechanics& m) {
  std::array<ExactSum, 3> sums;
  const std::vector<double> v = field(const_cast<Mechanics&>(m), "velocity");
  for (const LocalIndex node : m.mesh().owned_nodes)
    for (std::size_t c = 0; c < 3; ++c) {
      const auto n = static_cast<std::size_t>(node);
      sums[c].add(m.nodal_mass()[n] * v[3 * n + c]);
    }
  std::array<double, 3> total{};
  m.mesh().comm.sum(sums, total);
  return {total[0], total[1], total[2]};
}

TEST(Subcycling, KeepsMomentumAndEnergyWithoutDamping) {
  MechanicsOptions options = free_body(16);
  options.hourglass.form = HourglassOptions::Form::physical;
  const auto m = body(shared_mesh(graded_box()), steel(), options);
  m->initialize();
  ASSERT_TRUE(m->subcycling());
  EXPECT_GE(m->subcycling()->greatest(), 2);
  const Vec3 p = momentum(*m);
  const double start = energy_rows(*m)["kinetic_energy"];
  Ledger ledger(*m);
  double most = 0;
  for (int s = 0; s < long_run(3000); ++s) {
    m->advance(m->time_step());
    std::map<std::string, double> e = energy_rows(*m);
    most = std::max(most, e["kinetic_energy"] + e["internal_energy"] + e["hourglass_energy"]);
    ASSERT_LT(e["kinetic_energy"], 1.05 * start) << s;  // growth would draw it from ever more negative internal energy
    ASSERT_GT(e["internal_energy"], -0.05 * start) << s;
  }
  EXPECT_NEAR(most, start, 1e-9 * start);
  EXPECT_LT(ledger.error(), 1e-12);
  EXPECT_LT(norm(momentum(*m) - p), 1e-12 * norm(p) * 100);
}

// 2 (default) to 0.9 of the limit, all kinds: no growth over many steps. With the usual viscosity.
TEST(Subcycling, StaysBoundedForOtherElements) {
  for (const ElementKind kind : {ElementKind::tet4, ElementKind::wedge6, ElementKind::hex8}) {
    BoxShape box;
    box.high = {0.4, 0.05, 0.05};
    box.elements = {12, 3, 3};
    box.grading = {25, 1, 1};
    MechanicsOptions options = free_body(16);
    options.viscosity = BulkViscosity{};
    const auto m = solid_body(shared_mesh(solid_box(box, kind)), steel(), MechanicsOptions::Formulation::full, options);
    m->initialize();
    EXPECT_GE(m->subcycling()->greatest(), 1) << topology(kind).name;
    const double start = energy_rows(*m)["kinetic_energy"];
    for (int s = 0; s < long_run(1000); ++s) m->advance(m->time_step());
    EXPECT_LT(energy_rows(*m)["kinetic_energy"], start) << topology(kind).name;
  }
}

TEST(Subcycling, AboveTheLimitItStops) {
  MechanicsOptions options = free_body(16);
  options.time_step.scale = 1.4;
  const auto m = body(shared_mesh(graded_box()), steel(), options);
  m->initialize();
  EXPECT_THROW(
      {
        for (int s = 0; s < 20000; ++s) m->advance(m->time_step());
      },
      Error);
}

/// A shell strip with elements that become shorter and shorter, bending.
TEST(Subcycling, ShellsRingWithTheirFrequency) {
  const auto strip = [](int subcycling) {
    const MeshData data = shell_grid({30, 2, ShellGrid::Cells::quads}, [](double r, double s) {
      return Vec3{(std::exp(2.5 * r) - 1) / (std::exp(2.5) - 1), 0.4 * s, 0};
    });
    MechanicsOptions options;
    options.time_step.subcycling = subcycling;
    options.motions = {hold("r0", "xyzrxryrz")};
    options.initial_velocity_function = [](const Vec3& x) { return Vec3{0, 0, 0.01 * x[0] * x[0]}; };
    options.initial_spin_function = [](const Vec3& x) { return Vec3{0, -0.02 * x[0], 0}; };
    auto m = shell_body(shared_mesh(MeshData(data)), steel(), section(0.01), options);
    m->initialize();
    return m;
  };
  const auto plain = strip(1), split = strip(8);
  ASSERT_TRUE(split->subcycling());
  EXPECT_GE(split->subcycling()->greatest(), 2);
  const double end = 0.01;
  run_to(*plain, end);
  run_to(*split, end);
  const std::vector<double> a = in_global_order(*plain, "displacement"), b = in_global_order(*split, "displacement");
  double most = 0, off = 0;
  for (std::size_t i = 2; i < a.size(); i += 3)
    most = std::max(most, std::abs(a[i])), off = std::max(off, std::abs(a[i] - b[i]));
  EXPECT_LT(off, 0.01 * most);
  EXPECT_LT(split->work_done(), plain->work_done() * 2 / 3);
}

TEST(Subcycling, RefusesWhatNeedsAllForcesOrEqualSteps) {
  MechanicsOptions options = free_body(4);
  options.loads.damping.stiffness = 1e-9;
  EXPECT_THROW(body(shared_mesh(graded_box()), steel(), options), Error);
  options = free_body(4);
  options.time_step.fixed = 1e-8;
  EXPECT_THROW(body(shared_mesh(graded_box()), steel(), options), Error);
}

// The user's share holds for all levels, and the greatest step for the longest.
TEST(Subcycling, SharesAndTheGreatestStepHold) {
  const auto plain = body(shared_mesh(graded_box()), steel(), [] {
    MechanicsOptions options = free_body(1);
    options.time_step.estimate = TimeStepOptions::Estimate::element;
    options.time_step.scale = 0.5;
    return options;
  }());
  plain->initialize();
  MechanicsOptions options = free_body(16);
  options.time_step.scale = 0.5;
  const auto half = body(shared_mesh(graded_box()), steel(), options);
  half->initialize();
  EXPECT_NEAR(half->time_step() / half->subcycling()->steps(), plain->time_step(), 1e-12 * plain->time_step());
  options.time_step.maximum = 2.5 * plain->time_step();
  const auto bounded = body(shared_mesh(graded_box()), steel(), options);
  bounded->initialize();
  EXPECT_LE(bounded->time_step(), *options.time_step.maximum);
}

}  // namespace
}  // namespace tenon::testing
