// SPDX-License-Identifier: BSD-3-Clause
// VERIFICATION E03: sums and integrals kept to round-off, with no negative values from positive ones.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "transfer/element_points.hpp"
#include "transfer_testing.hpp"

namespace tenon::transfer {
namespace {

using testing::box;
using testing::distributed;
using testing::Pair;

double smooth(const Vec3& x) {
  double f = 1;
  for (const double c : x) f *= std::sin(std::numbers::pi * c) * std::exp(c / 2);
  return f;
}

std::vector<Pair> pairs() {
  std::vector<Pair> all;
  const auto hex = box(5, {.distortion = 0.2});
  const auto tet = box(4, {.tetrahedra = true, .distortion = 0.2, .seed = 5});
  const auto fine = box(8, {.distortion = 0.15, .seed = 3});
  all.push_back({distributed(hex), distributed(tet, PartitionMethod::graph)});
  all.push_back({distributed(tet), distributed(hex, PartitionMethod::graph)});
  all.push_back({distributed(hex), distributed(fine, PartitionMethod::graph)});
  all.push_back({distributed(fine), distributed(testing::mixed_box(4), PartitionMethod::graph)});
  all.push_back({distributed(testing::mixed_box(3)), distributed(hex, PartitionMethod::graph)});
  // Curved bodies: gaps and overlaps all around.
  all.push_back({distributed(generate(CylinderShape{.core = 2, .shell = 2, .axial = 4})),
                 distributed(generate(CylinderShape{.core = 4, .shell = 2, .axial = 4, .tetrahedra = true}),
                             PartitionMethod::graph)});
  return all;
}

constexpr std::array<Location, 2> both{Location::node, Location::element};

TEST(Conservation, TotalsKeepTheirSumAndTheirSign) {
  for (Pair pair : pairs())
    for (const Location from : both)
      for (const Location to : both) {
        pair.from = from, pair.to = to;
        const auto values = testing::sampled(*pair.source, from, [](const Vec3& x) { return 1 + std::sin(9 * x[0]); });
        const auto result = testing::transferred(pair, FieldKind::total, values);
        const double sum = testing::global_sum(*pair.source, from, values);
        EXPECT_NEAR(testing::global_sum(*pair.target, to, result) / sum, 1.0, 1e-13);
        EXPECT_GE(testing::global_least(*pair.target, result), 0.0);
      }
}

TEST(Conservation, DensitiesKeepTheirIntegralAndTheirSign) {
  for (Pair pair : pairs())
    for (const Location from : both)
      for (const Location to : both) {
        pair.from = from, pair.to = to;
        const auto values = testing::sampled(*pair.source, from, [](const Vec3& x) { return 1 + std::sin(9 * x[0]); });
        const GridTransfer map = testing::make_transfer(pair, FieldKind::density);
        std::vector<double> result(testing::places(*pair.target, to).size());
        map.apply(values, result, 1);
        const TransferReport report = map.report(values, result, 1);
        EXPECT_LT(report.mismatch, 1e-13);
        EXPECT_GE(testing::global_least(*pair.target, result), 0.0);
        // The report's integral against one that is worked out here.
        std::vector<double> amount = item_volumes(*pair.target, pair.target->coordinates, to);
        for (std::size_t i = 0; i < amount.size(); ++i) amount[i] *= result[i];
        EXPECT_NEAR(testing::global_sum(*pair.target, to, amount) / report.source_integral, 1.0, 1e-13);
      }
}

TEST(Conservation, MomentumOfThreeComponents) {
  Pair pair = pairs().front();
  const std::array<testing::Function, 3> velocity{[](const Vec3& x) { return x[1] - 0.5; },
                                                  [](const Vec3& x) { return 0.5 - x[0]; },
                                                  [](const Vec3& x) { return x[2] * x[2]; }};
  const auto values = testing::sampled(*pair.source, Location::node, velocity);
  const auto result = testing::transferred(pair, FieldKind::total, values, {}, 3);
  for (std::size_t c = 0; c < 3; ++c) {
    const auto component = [c](const std::vector<double>& all) {
      std::vector<double> one;
      for (std::size_t i = c; i < all.size(); i += 3) one.push_back(all[i]);
      return one;
    };
    EXPECT_NEAR(testing::global_sum(*pair.target, Location::node, component(result)),
                testing::global_sum(*pair.source, Location::node, component(values)), 1e-12);
  }
}

TEST(Conservation, ForcesKeepTheirMomentAndVirtualWork) {
  // Nodal forces go by the transpose of interpolation: virtual work with any displacement interpolated the other way
  // is the same on both sides; with a rigid rotation, that is the moment.
  const Pair down{distributed(box(5, {.distortion = 0.2})),
                  distributed(box(4, {.tetrahedra = true}), PartitionMethod::graph)};
  const Pair up{down.target, down.source};
  const auto force =
      testing::sampled(*down.source, Location::node, [](const Vec3& x) { return std::sin(20 * x[0]) + x[1]; });
  const auto shape =
      testing::sampled(*up.source, Location::node, [](const Vec3& x) { return std::cos(7 * x[2]) - x[0]; });
  const auto force_there = testing::transferred(down, FieldKind::total, force);
  const auto shape_here = testing::transferred(up, FieldKind::point_value, shape);
  const auto work = [](const Mesh& mesh, std::vector<double> f, const std::vector<double>& u) {
    for (std::size_t i = 0; i < f.size(); ++i) f[i] *= u[i];
    return testing::global_sum(mesh, Location::node, f);
  };
  const double here = work(*down.source, force, shape_here), there = work(*down.target, force_there, shape);
  EXPECT_NEAR(here / there, 1.0, 1e-12);
}

TEST(Conservation, UniformHeatArrivesUniform) {
  // Heat in proportion to volume, as a uniform plastic power gives it, must not come out as a pattern of the meshes.
  for (const bool tetrahedra : {false, true}) {
    const Pair pair{
        distributed(box(6, {.distortion = 0.2})),
        distributed(box(8, {.tetrahedra = tetrahedra, .distortion = 0.15, .seed = 3}), PartitionMethod::graph),
        Location::element, Location::node};
    const auto heat = item_volumes(*pair.source, pair.source->coordinates, Location::element);
    auto density = testing::transferred(pair, FieldKind::total, heat);
    const auto volume = item_volumes(*pair.target, pair.target->coordinates, Location::node);
    for (std::size_t i = 0; i < density.size(); ++i) density[i] /= volume[i];
    EXPECT_LT(testing::greatest_error(*pair.target, Location::node, density, [](const Vec3&) { return 1.0; }), 2e-3);
  }
}

TEST(Conservation, PartlyCoveredTargetsGetTheirPart) {
  // A target twice as long as the source: what is beyond the source stays empty, and the sum is kept.
  const Pair pair{distributed(box(4)), distributed(box(6, {.high = {2, 1, 1}}), PartitionMethod::graph),
                  Location::element, Location::node};
  const auto heat = item_volumes(*pair.source, pair.source->coordinates, Location::element);
  const auto result = testing::transferred(pair, FieldKind::total, heat);
  EXPECT_NEAR(testing::global_sum(*pair.target, Location::node, result), 1.0, 1e-14);
  for (std::size_t i = 0; i < result.size(); ++i) {
    const bool beyond = pair.target->coordinates[i][0] > 1.2;
    EXPECT_EQ(result[i] == 0.0, beyond);
  }
}

TEST(Conservation, NodalDensityFollowsTheField) {
  // Conservation does not ruin the values: the greatest error of a smooth density is of first order.
  std::array<double, 2> error{};
  for (std::size_t k = 0; k < 2; ++k) {
    const int n = 8 << k;
    const Pair pair{distributed(box(n)), distributed(box(n + n / 4), PartitionMethod::graph)};
    const auto values = testing::sampled(*pair.source, Location::node, smooth);
    const auto result = testing::transferred(pair, FieldKind::density, values);
    error[k] = testing::greatest_error(*pair.target, Location::node, result, smooth);
  }
  EXPECT_LT(error[0], 0.25 * smooth({0.6, 0.6, 0.6}));
  EXPECT_LT(error[1], 0.6 * error[0]);
}

TEST(Conservation, ElementWithoutVolumeKeepsItsTotal) {
  const Pair pair{distributed(box(2)), distributed(box(3), PartitionMethod::graph), Location::element, Location::node};
  std::vector<Vec3> flat = pair.source->coordinates;
  for (Vec3& x : flat) x[2] = x[2] == 1.0 ? 0.5 : x[2];
  FieldDescription field;
  field.kind = FieldKind::total;
  const GridTransfer map({pair.source.get(), flat, pair.from}, {pair.target.get(), pair.target->coordinates, pair.to},
                         field, {}, "test");
  const std::vector<double> values(testing::places(*pair.source, pair.from).size(), 2.0);
  std::vector<double> result(pair.target->node_ids.size());
  map.apply(values, result, 1);
  EXPECT_NEAR(testing::global_sum(*pair.target, pair.to, result), 16.0, 1e-13);
}

}  // namespace
}  // namespace tenon::transfer
