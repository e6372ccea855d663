// SPDX-License-Identifier: BSD-3-Clause
// VERIFICATION E01: constant and linear fields between any two meshes.
#include <gtest/gtest.h>

#include <cmath>

#include "transfer_testing.hpp"

namespace tenon::transfer {
namespace {

using testing::box;
using testing::distributed;
using testing::Pair;

double linear(const Vec3& x) {
  return 1 + 2 * x[0] - 3 * x[1] + 0.5 * x[2];
}

/// Greatest error of the linear field, with points outside extrapolated.
double linear_error(const Pair& pair) {
  const std::vector<double> values = testing::sampled(*pair.source, pair.from, linear);
  const std::vector<double> result =
      testing::transferred(pair, FieldKind::point_value, values, {.outside = OutsidePolicy::extrapolate});
  return testing::greatest_error(*pair.target, pair.to, result, linear);
}

void expect_exact(const MeshData& source, const MeshData& target) {
  Pair pair{distributed(source, PartitionMethod::rcb), distributed(target, PartitionMethod::graph)};
  for (const Location to : {Location::node, Location::element}) {
    pair.to = to;
    EXPECT_LT(linear_error(pair), 1e-14 * 6);  // greatest value of the field is about 6 in all cases
    const std::vector<double> constant(pair.source->node_ids.size(), 293.15);
    EXPECT_EQ(testing::greatest_error(*pair.target, to, testing::transferred(pair, FieldKind::point_value, constant),
                                      [](const Vec3&) { return 293.15; }),
              0.0);
  }
}

MeshData rotated(MeshData mesh) {
  testing::rotate(mesh, 30, {0.5, 0.5, 0.5});
  return mesh;
}

TEST(Exactness, HexToFinerHexAndTet) {
  expect_exact(box(5), box(7));
  expect_exact(box(5), box(6, {.tetrahedra = true}));
}

TEST(Exactness, TetToHexAndTet) {
  expect_exact(box(4, {.tetrahedra = true}), box(5));
  expect_exact(box(4, {.tetrahedra = true, .distortion = 0.2}),
               box(5, {.tetrahedra = true, .distortion = 0.2, .seed = 2}));
}

TEST(Exactness, DistortedAndRotated) {
  expect_exact(box(5, {.distortion = 0.2}), box(6, {.distortion = 0.2, .seed = 2}));
  expect_exact(box(5, {.distortion = 0.2}), rotated(box(6, {.distortion = 0.2, .seed = 2})));
  expect_exact(rotated(box(5, {.distortion = 0.2})), box(4, {.tetrahedra = true}));
}

TEST(Exactness, MixedKinds) {
  expect_exact(testing::mixed_box(4), box(5, {.distortion = 0.2}));
  expect_exact(rotated(testing::mixed_box(3)), testing::mixed_box(4));
  expect_exact(box(4, {.distortion = 0.2}), testing::mixed_box(3));
}

TEST(Exactness, MatchingLatticesMeetOnFacesEdgesAndCorners) {
  expect_exact(box(3), box(6));
  expect_exact(box(6), box(3, {.tetrahedra = true}));
  expect_exact(box(4, {.tetrahedra = true}), box(8));
}

TEST(Exactness, IdenticalMeshIsTheIdentityBitwise) {
  const auto wild = [](const Vec3& x) { return std::exp(3 * x[0]) * std::sin(50 * x[1]) / (x[2] + 1e-3); };
  for (const MeshData& data : {box(4, {.distortion = 0.2}), box(4, {.tetrahedra = true}), testing::mixed_box(3)}) {
    Pair pair{distributed(data, PartitionMethod::rcb), distributed(data, PartitionMethod::graph)};
    for (const Location location : {Location::node, Location::element}) {
      pair.from = pair.to = location;
      const std::vector<double> values = testing::sampled(*pair.source, location, wild);
      EXPECT_EQ(testing::greatest_error(*pair.target, location,
                                        testing::transferred(pair, FieldKind::point_value, values), wild),
                0.0);
    }
    pair.from = pair.to = Location::node;
    const std::vector<double> totals = testing::sampled(*pair.source, Location::node, wild);
    EXPECT_EQ(testing::greatest_error(*pair.target, Location::node,
                                      testing::transferred(pair, FieldKind::total, totals), wild),
              0.0);
  }
}

TEST(Exactness, LinearDensityOfConstantValueIsKeptOnIdenticalElements) {
  const MeshData data = box(4, {.distortion = 0.2});
  const Pair pair{distributed(data, PartitionMethod::rcb), distributed(data, PartitionMethod::graph), Location::element,
                  Location::element};
  const std::vector<double> values = testing::sampled(*pair.source, Location::element, linear);
  EXPECT_LT(testing::greatest_error(*pair.target, Location::element,
                                    testing::transferred(pair, FieldKind::density, values), linear),
            1e-14 * 6);
}

}  // namespace
}  // namespace tenon::transfer
