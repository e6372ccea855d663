// SPDX-License-Identifier: BSD-3-Clause
// The same as oracle_test.cpp with more elements, brute force for every point outside, and from more places.
#include <gtest/gtest.h>

#include "oracle_case.hpp"

namespace tenon::transfer::testing {
namespace {

void expect_faultless(const OracleRun& run) {
  const OracleCount count = compare_with_oracle(run);
  EXPECT_EQ(count.elements, run.elements);
  EXPECT_GT(count.brute_forced, 5 * run.elements / run.thoroughly_each);
  EXPECT_EQ(count.lost, 0) << count.first;
  EXPECT_EQ(count.invented, 0) << count.first;
  EXPECT_EQ(count.disagreeing, 0);
}

TEST(OracleNightly, Hexahedra) {
  expect_faultless({ElementKind::hex8, 20000, 3, 4, 171});
}
TEST(OracleNightly, Tetrahedra) {
  expect_faultless({ElementKind::tet4, 10000, 1, 1, 172});
}
TEST(OracleNightly, Wedges) {
  expect_faultless({ElementKind::wedge6, 10000, 4, 1, 173});
}
TEST(OracleNightly, Pyramids) {
  expect_faultless({ElementKind::pyramid5, 10000, 4, 1, 174});
}
TEST(OracleNightly, HexahedraOfSecondOrder) {
  expect_faultless({ElementKind::hex20, 2000, 4, 4, 175});
}
TEST(OracleNightly, TetrahedraOfSecondOrder) {
  expect_faultless({ElementKind::tet10, 5000, 5, 1, 176});
}

}  // namespace
}  // namespace tenon::transfer::testing
