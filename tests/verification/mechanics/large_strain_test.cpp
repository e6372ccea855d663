// SPDX-License-Identifier: BSD-3-Clause
// Hypoelastic cube under large prescribed motion (case A06): the Jaumann rate's closed forms.
#include "mechanics_case.hpp"

namespace tenon::testing {
namespace {

using Kind = PrescribedMotion::Kind;

constexpr double youngs_modulus = 200e9, poissons_ratio = 0.3, shear_modulus = youngs_modulus / 2.6;
const std::vector<std::string> all_faces{"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};

double shear_error(int steps) {
  MechanicsOptions options;
  PrescribedMotion shear = motion(Kind::gradient, all_faces);
  shear.gradient[1] = 1;
  shear.factor = TimeFunction::table({{0, 0}, {1, 10}});
  options.motions.push_back(shear);
  options.time_step.fixed = 1.0 / steps;
  const auto m =
      body(shared_mesh(on_root(BoxShape{})), elastic_material(youngs_modulus, poissons_ratio, 7850), options);
  m->initialize();
  double error = 0;
  for (int s = 1; s <= steps; ++s) {
    m->advance(1.0 / steps);
    const double gamma = 10.0 * s / steps;
    const std::vector<double> stress = field(*m, "stress");
    if (stress.empty()) continue;  // the element is elsewhere
    error = std::max(error, std::abs(stress[3] / shear_modulus - std::sin(gamma)));
    error = std::max(error, std::abs(stress[0] / shear_modulus - (1 - std::cos(gamma))));
    error = std::max(error, std::abs(stress[1] / shear_modulus + (1 - std::cos(gamma))));
  }
  return communicator().max(error);
}

TEST(LargeStrain, SimpleShearFollowsTheJaumannSolution) {
  const double coarse = shear_error(2500), fine = shear_error(10000);
  EXPECT_LT(fine, 1e-4);
  EXPECT_NEAR(std::log(coarse / fine) / std::log(4.0), 2.0, 0.1);
}

TEST(LargeStrain, UniaxialStretchIsLogarithmic) {
  for (const double last : {0.5, 3.0}) {
    constexpr int steps = 10000;
    std::vector<std::pair<double, double>> axial, lateral;
    for (int s = 0; s <= steps; ++s) {
      const double t = static_cast<double>(s) / steps, stretch = 1 + (last - 1) * t;
      axial.emplace_back(t, stretch - 1);
      lateral.emplace_back(t, std::pow(stretch, -poissons_ratio) - 1);
    }
    MechanicsOptions options;
    PrescribedMotion along = motion(Kind::gradient, all_faces), across = motion(Kind::gradient, all_faces);
    along.components = {true, false, false}, across.components = {false, true, true};
    along.gradient[0] = across.gradient[4] = across.gradient[8] = 1;
    along.factor = TimeFunction::table(axial), across.factor = TimeFunction::table(lateral);
    options.motions = {along, across};
    options.time_step.fixed = 1.0 / steps;
    const auto m =
        body(shared_mesh(on_root(BoxShape{})), elastic_material(youngs_modulus, poissons_ratio, 7850), options);
    m->initialize();
    for (int s = 0; s < steps; ++s) m->advance(1.0 / steps);
    const std::vector<double> stress = field(*m, "stress");
    if (stress.empty()) continue;
    EXPECT_NEAR(stress[0] / youngs_modulus, std::log(last), 1e-4);
    EXPECT_NEAR(stress[1] / youngs_modulus, 0, 1e-4);
  }
}

}  // namespace
}  // namespace tenon::testing
