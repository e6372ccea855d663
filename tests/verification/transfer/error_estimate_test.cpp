// SPDX-License-Identifier: BSD-3-Clause
// The error that a transfer estimates is between half and twice the true one for smooth fields, whatever the meshes and
// the method; few samples tell nearly as much.
#include "transfer/error_estimate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "projection_testing.hpp"

namespace tenon::transfer {
namespace {

using std::numbers::pi;
using testing::box;
using testing::distributed;
using testing::Function;
using testing::Pair;
using testing::ProjectionPair;

const std::vector<std::pair<std::string, Function>>& fields() {
  static const std::vector<std::pair<std::string, Function>> all{
      {"E02",
       [](const Vec3& x) {
         double f = 1;
         for (const double c : x) f *= std::sin(pi * c) * std::exp(c / 2);
         return f;
       }},
      {"hill",
       [](const Vec3& x) {
         const Vec3 d = x - Vec3{0.4, 0.5, 0.6};
         return std::exp(-8 * dot(d, d));
       }},
      {"wave", [](const Vec3& x) { return std::sin(4 * x[0] + 3 * x[1] - 2 * x[2]); }},
      {"cubic", [](const Vec3& x) { return x[0] * x[0] * x[1] + x[2] * x[2] * x[2] - x[0] * x[2]; }}};
  return all;
}

std::vector<std::pair<std::string, testing::MeshPointer>> sources() {
  return {{"hexahedra", distributed(box(9))},
          {"perturbed hexahedra", distributed(box(9, {.distortion = 0.25}))},
          {"perturbed tetrahedra", distributed(box(8, {.tetrahedra = true, .distortion = 0.2}))},
          {"hexahedra, wedges and pyramids", distributed(testing::mixed_box(9))}};
}

void expect_believable(double estimate, double error, const std::string& what) {
  EXPECT_GT(estimate, 0.5 * error) << what;
  EXPECT_LT(estimate, 2 * error) << what;
}

TEST(ErrorEstimate, OfInterpolation) {
  for (const auto& [mesh_name, source] : sources())
    for (const int m : {3, 7, 12, 18}) {
      const testing::MeshPointer target =
          distributed(box(m, {.tetrahedra = m == 7, .distortion = 0.15, .seed = 3}), PartitionMethod::rcb);
      for (const Location from : {Location::node, Location::element}) {
        const Pair pair{source, target, from, Location::node};
        const GridTransfer map = testing::make_transfer(pair, FieldKind::point_value);
        for (const auto& [field_name, f] : fields()) {
          const auto values = testing::sampled(*source, from, f);
          std::vector<double> result(target->node_ids.size());
          map.apply(values, result, 1);
          expect_believable(map.report(values, result, 1).error_estimate,
                            testing::greatest_error(*target, Location::node, result, f),
                            mesh_name + ", " + field_name + ", m = " + std::to_string(m));
        }
      }
    }
}

TEST(ErrorEstimate, OfConservedDensities) {
  for (const auto& [mesh_name, source] : sources())
    for (const int m : {6, 12}) {
      const testing::MeshPointer target = distributed(box(m, {.distortion = 0.15, .seed = 3}));
      const Pair pair{source, target};
      const GridTransfer map = testing::make_transfer(pair, FieldKind::density);
      for (const auto& [field_name, f] : fields()) {
        const auto values = testing::sampled(*source, Location::node, f);
        std::vector<double> result(target->node_ids.size());
        map.apply(values, result, 1);
        expect_believable(map.report(values, result, 1).error_estimate,
                          testing::greatest_error(*target, Location::node, result, f), mesh_name + ", " + field_name);
      }
    }
}

TEST(ErrorEstimate, OfProjections) {
  for (const auto& [mesh_name, source] : sources())
    for (const int m : {5, 12})
      for (const bool bounded : {false, true}) {
        const testing::MeshPointer target = distributed(box(m, {.distortion = 0.15, .seed = 3}));
        const ProjectionPair project({source, target}, {.bounded = bounded});
        const ErrorEstimate estimate(project.source(), project.target().items, item_points(project.target()),
                                     PlaceRules{1e-9, true}, 0, "estimate");
        for (const auto& [field_name, f] : fields()) {
          const auto values = testing::sampled(*source, Location::node, f), result = project(values);
          expect_believable(estimate(values, result, 1).greatest,
                            testing::greatest_error(*target, Location::node, result, f), mesh_name + ", " + field_name);
        }
      }
}

TEST(ErrorEstimate, AThousandSamplesTellNearlyAsMuch) {
  const testing::MeshPointer source = distributed(box(16, {.distortion = 0.2})),
                             target = distributed(box(22, {.distortion = 0.15, .seed = 3}));
  const Pair pair{source, target};
  const GridTransfer map = testing::make_transfer(pair, FieldKind::point_value);
  for (const auto& [field_name, f] : fields()) {
    const auto values = testing::sampled(*source, Location::node, f);
    std::vector<double> result(target->node_ids.size());
    map.apply(values, result, 1);
    const double full = map.report(values, result, 1).error_estimate,
                 sampled = map.report(values, result, 1, Thoroughness::sampled).error_estimate;
    EXPECT_LE(sampled, full) << field_name;
    EXPECT_GT(sampled, 0.6 * full) << field_name;
  }
  const ProjectionPair sides(pair);
  const auto samples = [&](GlobalId most) {
    return ErrorEstimate(sides.source(), sides.target().items, item_points(sides.target()), PlaceRules{}, most, "count")
        .samples();
  };
  EXPECT_EQ(samples(0), target->global_nodes);
  EXPECT_NEAR(static_cast<double>(samples(1000)), 1000, 150);
}

TEST(ErrorEstimate, OfLinearFieldsIsNothing) {
  const auto linear = [](const Vec3& x) { return 1 + 2 * x[0] - 3 * x[1] + 0.5 * x[2]; };
  for (const auto& [mesh_name, source] : sources()) {
    const testing::MeshPointer target = distributed(box(7, {.distortion = 0.15, .seed = 3}));
    const GridTransfer map = testing::make_transfer({source, target}, FieldKind::point_value);
    const auto values = testing::sampled(*source, Location::node, linear);
    std::vector<double> result(target->node_ids.size());
    map.apply(values, result, 1);
    EXPECT_LT(map.report(values, result, 1).error_estimate, 1e-12) << mesh_name;
  }
}

TEST(ErrorEstimate, TotalsAndCopiesHaveNone) {
  const testing::MeshPointer mesh = distributed(box(4)), target = distributed(box(5));
  const auto values = testing::sampled(*mesh, Location::node, fields().front().second);
  const auto estimate = [&](const Pair& pair, FieldKind kind) {
    const GridTransfer map = testing::make_transfer(pair, kind);
    std::vector<double> result(pair.target->node_ids.size());
    map.apply(values, result, 1);
    return map.report(values, result, 1).error_estimate;
  };
  EXPECT_EQ(estimate({mesh, target}, FieldKind::total), 0.0);
  EXPECT_EQ(estimate({mesh, mesh}, FieldKind::point_value), 0.0);
}

TEST(RoundTrip, ErrorIsThatOfThereAndBack) {
  const testing::MeshPointer source = distributed(box(8)), target = distributed(box(11, {.distortion = 0.15}));
  const auto& f = fields().front().second;
  const auto values = testing::sampled(*source, Location::node, f);
  const Pair forth{source, target}, back{target, source};
  const GridTransfer map = testing::make_transfer(forth, FieldKind::point_value),
                     reverse = testing::make_transfer(back, FieldKind::point_value);
  const double error = map.round_trip_error(reverse, values, 1);
  const auto returned =
      testing::transferred(back, FieldKind::point_value, testing::transferred(forth, FieldKind::point_value, values));
  EXPECT_EQ(error, testing::greatest_error(*source, Location::node, returned, f));
  EXPECT_GT(error, 0.005);
  EXPECT_EQ(map.applied(), 0);
  EXPECT_THROW(map.round_trip_error(map, values, 1), Error);
}

}  // namespace
}  // namespace tenon::transfer
