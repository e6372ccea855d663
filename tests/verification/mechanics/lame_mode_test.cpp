// SPDX-License-Identifier: BSD-3-Clause
// Every kind of solid on the Lame mode of a free cube (case A04): order two, and no locking when nearly incompressible.
#include "lame_mode.hpp"

namespace tenon::testing {
namespace {

using Form = HourglassOptions::Form;
using Formulation = MechanicsOptions::Formulation;

/// The errors of the table: one point -9.97, -2.55, -0.64 %, full -4.35, -1.12, -0.28 % with 4, 8, 16 elements an edge.
TEST(LameMode, OnePointElementsFollowTheTable) {
  LameMode mode;
  mode.hourglass.form = Form::none;
  const double table[3] = {-9.97e-2, -2.55e-2, -0.64e-2};
  double before = 0;
  for (int i = 0, n = 4; i < 3; ++i, n *= 2) {
    const double error = mode.quotient_error(solid_box(lame_cube(n, 0), ElementKind::hex8));
    EXPECT_NEAR(error, table[i], 0.02 * std::abs(table[i]));
    EXPECT_TRUE(i == 0 || std::abs(std::log2(before / error) - 2) < 0.1) << before << " " << error;
    before = error;
  }
}

/// The mean volume strain makes the element softer than the table's, less so than one point.
TEST(LameMode, FullIntegrationIsBetweenTheRowsOfTheTable) {
  LameMode mode;
  mode.formulation = Formulation::full;
  const double one_point[3] = {-9.97e-2, -2.55e-2, -0.64e-2}, full[3] = {-4.35e-2, -1.12e-2, -0.28e-2};
  double before = 0;
  for (int i = 0, n = 4; i < 3; ++i, n *= 2) {
    const double error = mode.quotient_error(solid_box(lame_cube(n, 0), ElementKind::hex8));
    EXPECT_GT(error, one_point[i]);
    EXPECT_LT(error, full[i]);
    EXPECT_TRUE(i == 0 || std::abs(std::log2(before / error) - 2) < 0.1) << before << " " << error;
    before = error;
  }
}

TEST(LameMode, FrequencyOverTimeIsThatOfTheQuotient) {
  const double e8 = LameMode{}.frequency_error(solid_box(lame_cube(8, 0), ElementKind::hex8));
  EXPECT_NEAR(e8, -2.55e-2, 0.5 * 2.55e-2);
}

TEST(LameMode, DistortedElementsKeepTheOrder) {
  LameMode mode;
  mode.hourglass.form = Form::none;
  const double e8 = mode.quotient_error(solid_box(lame_cube(8, 0.15), ElementKind::hex8));
  EXPECT_NEAR(e8, -2.55e-2, 0.5 * 2.55e-2);
}

TEST(LameMode, PhysicalStabilisationConverges) {
  LameMode mode;
  mode.hourglass.form = Form::physical;
  const double e4 = mode.quotient_error(solid_box(lame_cube(4, 0), ElementKind::hex8)),
               e8 = mode.quotient_error(solid_box(lame_cube(8, 0), ElementKind::hex8));
  EXPECT_LT(std::abs(e8), 2.55e-2);
  EXPECT_NEAR(std::log2(std::abs(e4 / e8)), 2, 0.3);
}

class LameModeOfKind : public ::testing::TestWithParam<ElementKind> {};

TEST_P(LameModeOfKind, ConvergesWithOrderTwo) {
  const LameMode mode;
  const double e4 = mode.quotient_error(solid_box(lame_cube(4, 0), GetParam())),
               e8 = mode.quotient_error(solid_box(lame_cube(8, 0), GetParam()));
  EXPECT_LT(std::abs(e8), 0.04) << topology(GetParam()).name;
  EXPECT_GT(std::log2(std::abs(e4 / e8)), 1.6) << topology(GetParam()).name;
}

/// At Poisson's ratio 0.4999 the mode has the same frequency; an element that locks has a multiple of it.
TEST_P(LameModeOfKind, DoesNotLock) {
  LameMode mode;
  mode.material.elastic->poissons_ratio = 0.4999;
  mode.viscosity = {0.06, 0};
  const double e6 = mode.frequency_error(solid_box(lame_cube(6, 0.1), GetParam()));
  EXPECT_LT(std::abs(e6), 0.12) << topology(GetParam()).name;
}

INSTANTIATE_TEST_SUITE_P(Kinds, LameModeOfKind,
                         ::testing::Values(ElementKind::tet4, ElementKind::wedge6, ElementKind::pyramid5),
                         [](const auto& kind) { return std::string(topology(kind.param).name); });

/// The test above bites: plain tetrahedra lock.
TEST(LameMode, PlainTetrahedraLock) {
  LameMode mode;
  mode.formulation = Formulation::full;
  mode.material.elastic->poissons_ratio = 0.4999;
  mode.viscosity = {0.06, 0};
  EXPECT_GT(mode.frequency_error(solid_box(lame_cube(6, 0.1), ElementKind::tet4)), 0.2);
}

}  // namespace
}  // namespace tenon::testing
