// SPDX-License-Identifier: BSD-3-Clause
// No knob: two blocks hit each other at ratios of stiffness 1 to 10,000 and of meshes 1 to 20 together.
#include "ratios_case.hpp"

namespace tenon::testing {
namespace {

TEST(ContactRatios, Extremes) {
  for (const double stiffness : {1e-4, 1e4})
    for (const auto& [under, over] : {std::pair{1, 20}, {20, 1}}) hit({stiffness, under, over, 1});
}

}  // namespace
}  // namespace tenon::testing
