// SPDX-License-Identifier: BSD-3-Clause
// VERIFICATION E02 and E05: second order of interpolated point values, first order of element values, and an error
// estimate that can be believed.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "transfer_testing.hpp"

namespace tenon::transfer {
namespace {

using std::numbers::pi;
using testing::box;
using testing::distributed;
using testing::Pair;

struct Outcome {
  double error = 0, estimate = 0, defect = 0;
};

Outcome run(const Pair& pair, const testing::Function& f) {
  const std::vector<double> values = testing::sampled(*pair.source, pair.from, f);
  const GridTransfer map = testing::make_transfer(pair, FieldKind::point_value);
  std::vector<double> result(testing::places(*pair.target, pair.to).size());
  map.apply(values, result, 1);
  const TransferReport report = map.report(values, result, 1);
  return {testing::greatest_error(*pair.target, pair.to, result, f), report.error_estimate,
          (report.target_integral - report.source_integral) / report.source_integral};
}

/// E02: f = product of sin(pi x) exp(x/2).
double e02(const Vec3& x) {
  double f = 1;
  for (const double c : x) f *= std::sin(pi * c) * std::exp(c / 2);
  return f;
}
/// Its greatest value, at tan(pi x) = -2 pi in every direction.
double e02_greatest() {
  const double x = 1 - std::atan(2 * pi) / pi;
  return e02({x, x, x});
}

Pair e02_pair(int n, bool tetrahedra) {
  const int m = static_cast<int>(1.37 * n + 0.5);
  // The graph partition of a large mesh costs more than the transfer.
  const PartitionMethod other = n > 8 ? PartitionMethod::rcb : PartitionMethod::graph;
  return {distributed(box(n, {.tetrahedra = tetrahedra}), PartitionMethod::rcb),
          distributed(box(m, {.distortion = 0.15, .seed = 3}), other)};
}

TEST(Order, NodalInterpolationIsSecondOrderWithTheReferenceErrors) {
  // Reference: E02_oneway_order.csv (other random shifts of the target nodes).
  const std::array<double, 3> reference{0.050805264, 0.014796296, 0.0036765326};
  std::array<double, 3> error{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Outcome outcome = run(e02_pair(8 << k, false), e02);
    error[k] = outcome.error / e02_greatest();
    EXPECT_NEAR(error[k] / reference[k], 1.0, 0.15) << "n = " << (8 << k);
    EXPECT_GT(outcome.estimate / outcome.error, 0.5) << "n = " << (8 << k);
    EXPECT_LT(outcome.estimate / outcome.error, 2.0) << "n = " << (8 << k);
  }
  EXPECT_NEAR(std::log2(error[0] / error[2]) / 2, 2.0, 0.15);
}

TEST(Order, IntegralDefectOfInterpolationIsSecondOrderToo) {
  const double coarse = run(e02_pair(8, false), e02).defect, fine = run(e02_pair(32, false), e02).defect;
  EXPECT_NEAR(std::log2(std::abs(coarse / fine)) / 2, 2.0, 0.3);
}

TEST(Order, TetrahedralSourceIsSecondOrder) {
  const Outcome coarse = run(e02_pair(8, true), e02), fine = run(e02_pair(16, true), e02);
  EXPECT_NEAR(std::log2(coarse.error / fine.error), 2.0, 0.3);
  for (const Outcome& o : {coarse, fine}) {
    EXPECT_GT(o.estimate / o.error, 0.5);
    EXPECT_LT(o.estimate / o.error, 2.0);
  }
}

TEST(Order, ElementDataIsFirstOrder) {
  std::array<double, 2> error{};
  for (std::size_t k = 0; k < 2; ++k) {
    Pair pair = e02_pair(8 << k, false);
    pair.from = Location::element;
    const Outcome outcome = run(pair, e02);
    error[k] = outcome.error;
    EXPECT_GT(outcome.estimate / outcome.error, 0.5);
    EXPECT_LT(outcome.estimate / outcome.error, 2.0);
  }
  EXPECT_NEAR(std::log2(error[0] / error[1]), 1.0, 0.2);
}

TEST(Order, RotatedTarget) {
  // Reference: E05_rotated_target.csv.
  const std::array<double, 3> reference{0.12581964, 0.033090851, 0.0087621878};
  const auto f = [](const Vec3& x) { return std::sin(pi * x[0] / 2) * std::cos(pi * x[1] / 2) * std::exp(x[2] / 2); };
  for (std::size_t k = 0; k < 3; ++k) {
    const int n = 4 << k;
    MeshData target = box(n + 3, {.low = {-0.5, -0.5, -0.5}, .high = {0.5, 0.5, 0.5}});
    testing::rotate(target, 30, {0, 0, 0});
    const Pair pair{distributed(box(n, {.low = {-1, -1, -1}}), PartitionMethod::graph), distributed(std::move(target))};
    const Outcome outcome = run(pair, f);
    EXPECT_NEAR(outcome.error / reference[k], 1.0, 1e-6) << "n = " << n;
    EXPECT_GT(outcome.estimate / outcome.error, 0.5) << "n = " << n;
    EXPECT_LT(outcome.estimate / outcome.error, 2.0) << "n = " << n;
  }
}

}  // namespace
}  // namespace tenon::transfer
