// SPDX-License-Identifier: BSD-3-Clause
// Nearly incompressible blocks do not lock, and their pressure does not alternate (case A14 d).
#include "mechanics_case.hpp"

namespace tenon::testing {
namespace {

using Kind = PrescribedMotion::Kind;

TEST(Incompressible, AnUpsetBlockKeepsItsVolume) {
  for (const double nu : {0.499, 0.4999}) {
    BoxShape box;
    box.elements = {4, 4, 4};
    const MaterialDescription rubber = elastic_material(10e6, nu, 1000);
    MechanicsOptions options;
    PrescribedMotion press = motion(Kind::displacement, {"z_max"});
    press.components = {false, false, true};
    const double end = 0.2;
    press.value[2] = TimeFunction::smooth_step(0, -0.05, 0, end);
    options.motions = {symmetry("x_min", {1, 0, 0}), symmetry("y_min", {0, 1, 0}), symmetry("z_min", {0, 0, 1}), press};
    const auto m = body(shared_mesh(on_root(box)), rubber, options);
    m->initialize();
    run_to(*m, end);
    const std::vector<double> density = field(*m, "density"), pressure = field(*m, "pressure");
    ExactSum volume, mean;
    for (std::size_t e = 0; e < density.size(); ++e) volume.add(1000.0 / 64 / density[e]), mean.add(pressure[e] / 64);
    EXPECT_NEAR(volume.value(), 1, 1e-3) << nu;
    const double expected = -10e6 * std::log(0.95) / 3;  // uniaxial stress
    EXPECT_NEAR(mean.value(), expected, 0.02 * expected) << nu;
    for (std::size_t e = 0; e < pressure.size(); ++e) EXPECT_NEAR(pressure[e], mean.value(), 0.02 * expected) << nu;
  }
}

}  // namespace
}  // namespace tenon::testing
