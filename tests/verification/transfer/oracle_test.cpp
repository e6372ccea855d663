// SPDX-License-Identifier: BSD-3-Clause
// Random distorted single elements: every point inside is found, every point outside is not, down to 1e-13 beside the
// faces, decided by brute force in extended precision.
#include <gtest/gtest.h>

#include "oracle_case.hpp"

namespace tenon::transfer::testing {
namespace {

void expect_faultless(const OracleRun& run) {
  const OracleCount count = compare_with_oracle(run);
  EXPECT_EQ(count.elements, run.elements);
  EXPECT_GT(count.inside, 13 * run.elements);
  EXPECT_GT(count.outside, 8 * run.elements);
  EXPECT_GT(count.brute_forced, 5 * run.elements / run.thoroughly_each);
  EXPECT_EQ(count.lost, 0) << count.first;
  EXPECT_EQ(count.invented, 0) << count.first;
  EXPECT_EQ(count.disagreeing, 0);
}

TEST(Oracle, Hexahedra) {
  expect_faultless({ElementKind::hex8, 10000, 3, 100, 71});
}
TEST(Oracle, Tetrahedra) {
  expect_faultless({ElementKind::tet4, 2000, 1, 1, 72});
}
TEST(Oracle, Wedges) {
  expect_faultless({ElementKind::wedge6, 2000, 3, 20, 73});
}
TEST(Oracle, Pyramids) {
  expect_faultless({ElementKind::pyramid5, 2000, 3, 20, 74});
}
TEST(Oracle, HexahedraOfSecondOrder) {
  expect_faultless({ElementKind::hex20, 300, 3, 20, 75});
}
TEST(Oracle, TetrahedraOfSecondOrder) {
  expect_faultless({ElementKind::tet10, 1000, 3, 20, 76});
}

}  // namespace
}  // namespace tenon::transfer::testing
