// SPDX-License-Identifier: BSD-3-Clause
// No knob: two blocks hit each other at ratios of stiffness 1 to 10,000, of meshes 1 to 20 and of density 1 to 1000.
#include "ratios_case.hpp"

namespace tenon::testing {
namespace {

TEST(ContactRatios, Stiffness) {
  for (const double stiffness : {1e-4, 1e-2, 1.0, 1e2, 1e4}) hit({stiffness, 4, 4, 1});
}

TEST(ContactRatios, Meshes) {
  for (const auto& [under, over] : {std::pair{1, 20}, {2, 10}, {4, 5}, {10, 2}, {20, 1}}) hit({1, under, over, 1});
}

TEST(ContactRatios, Density) {
  for (const double density : {1e-3, 1e3}) hit({1, 4, 4, density});
}

TEST(ContactRatios, MeshesAndStiffness) {
  for (const double stiffness : {1e-4, 1e4})
    for (const auto& [under, over] : {std::pair{1, 10}, {10, 1}}) hit({stiffness, under, over, 1});
}

}  // namespace
}  // namespace tenon::testing
