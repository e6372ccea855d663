// SPDX-License-Identifier: BSD-3-Clause
// Case C02 on the mesh that it names, five elements over the radius of contact at an approach of 0.2 mm, to 0.4 mm.
#include "hertz_case.hpp"

namespace tenon::testing {
namespace {

TEST(HertzNightly, FineBall) {
  press_ball(0.28e-3, 0.4e-3, 0.09e-3);
}

TEST(HertzNightly, ErrorsFallWithTheElements) {
  const double coarse = press_ball(0.4e-3, 0.2e-3, 0.14e-3), fine = press_ball(0.28e-3, 0.2e-3, 0.14e-3);
  EXPECT_LE(fine, 0.8 * coarse);
}

}  // namespace
}  // namespace tenon::testing
