// SPDX-License-Identifier: BSD-3-Clause
// VERIFICATION E02 for L2 projections: the order, and errors as small as those of exact projections.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "projection_testing.hpp"

namespace tenon::transfer {
namespace {

using std::numbers::pi;
using testing::box;
using testing::distributed;
using testing::Pair;
using testing::ProjectionPair;

/// E02: f = product of sin(pi x) exp(x/2).
double e02(const Vec3& x) {
  double f = 1;
  for (const double c : x) f *= std::sin(pi * c) * std::exp(c / 2);
  return f;
}

double error_of(const Pair& pair, const ProjectionOptions& options = {}) {
  const auto values = testing::sampled(*pair.source, pair.from, e02);
  const auto result = ProjectionPair(pair, options)(values);
  return testing::relative_l2_error(*pair.target, pair.to, result, e02);
}

Pair e02_pair(int n, bool source_tets = false, bool target_tets = false) {
  const int m = static_cast<int>(1.37 * n + 0.5);
  return {distributed(box(n, {.tetrahedra = source_tets})),
          distributed(box(m, {.tetrahedra = target_tets, .distortion = 0.15, .seed = 3}))};
}

TEST(ProjectionOrder, SecondWithTheReferenceErrors) {
  // Reference: exact projections, E02_oneway_order.csv (other random shifts of the target nodes).
  const std::array<double, 3> reference{0.039955472, 0.010125959, 0.0025456966};
  std::array<double, 3> error{};
  for (std::size_t k = 0; k < 3; ++k) {
    error[k] = error_of(e02_pair(8 << k));
    EXPECT_NEAR(error[k] / reference[k], 1.0, 0.06) << "n = " << (8 << k);
  }
  for (std::size_t k = 1; k < 3; ++k) EXPECT_NEAR(std::log2(error[k - 1] / error[k]), 2.0, 0.15);
}

TEST(ProjectionOrder, SecondBetweenAllKinds) {
  for (const auto& [source_tets, target_tets] : {std::pair(true, false), {false, true}, {true, true}}) {
    const double coarse = error_of(e02_pair(6, source_tets, target_tets)),
                 fine = error_of(e02_pair(12, source_tets, target_tets));
    EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.25);
  }
  const auto mixed = [](int n) {
    return error_of({distributed(testing::mixed_box(n)), distributed(testing::mixed_box(n + n / 2))});
  };
  EXPECT_NEAR(std::log2(mixed(6) / mixed(12)), 2.0, 0.25);
}

TEST(ProjectionOrder, OfBoundedSmoothFieldsToo) {
  const double coarse = error_of(e02_pair(8), {.bounded = true}), fine = error_of(e02_pair(16), {.bounded = true});
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.2);
}

TEST(ProjectionOrder, FirstForElementData) {
  for (const auto& [from, to] : {std::pair(Location::element, Location::node),
                                 {Location::element, Location::element},
                                 {Location::node, Location::element}}) {
    Pair coarse = e02_pair(6), fine = e02_pair(12);
    coarse.from = fine.from = from, coarse.to = fine.to = to;
    const double order = std::log2(error_of(coarse) / error_of(fine));
    EXPECT_GT(order, 0.85);
  }
}

TEST(ProjectionOrder, BeatsInterpolation) {
  // The mean over a coarse target's elements, rather than samples at its nodes.
  const Pair pair{distributed(box(16)), distributed(box(6, {.distortion = 0.15, .seed = 3}))};
  const auto values = testing::sampled(*pair.source, Location::node, e02);
  const double interpolated = testing::relative_l2_error(
      *pair.target, Location::node, testing::transferred(pair, FieldKind::point_value, values), e02);
  EXPECT_LT(error_of(pair), 0.6 * interpolated);
}

}  // namespace
}  // namespace tenon::transfer
