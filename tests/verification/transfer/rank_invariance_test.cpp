// SPDX-License-Identifier: BSD-3-Clause
// The values are bitwise the same on any number of ranks: each case leaves a fingerprint on one rank (the fixture),
// with which the runs on more ranks are compared.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <map>

#include "transfer_testing.hpp"

namespace tenon::transfer {
namespace {

using testing::box;
using testing::communicator;
using testing::Pair;

const char* const file_name = "transfer_rank_invariance.txt";

double smooth(const Vec3& x) {
  return std::sin(5 * x[0] + 1) * std::exp(x[1]) / (1.5 + x[2]);
}

/// With its skin.
testing::MeshPointer distributed(MeshData mesh, PartitionMethod method = PartitionMethod::rcb) {
  add_derived_sets(mesh);
  return testing::distributed(std::move(mesh), method);
}

struct Case {
  std::string name;
  FieldKind kind;
  TransferOptions options;
};

std::vector<Case> cases() {
  return {{"nearest", FieldKind::point_value, {}},
          {"extrapolate", FieldKind::point_value, {.outside = OutsidePolicy::extrapolate}},
          {"value", FieldKind::point_value, {.outside = OutsidePolicy::value, .outside_value = 3}},
          {"total", FieldKind::total, {}},
          {"density", FieldKind::density, {}},
          {"skin", FieldKind::point_value, {.method = Method::nearest_projection}},
          {"projection", FieldKind::point_value, {.method = Method::project}},
          {"bounded projection", FieldKind::density, {.method = Method::project, .bounded = true}},
          {"moving least squares", FieldKind::point_value, {.method = Method::moving_least_squares}}};
}

std::vector<std::pair<std::string, Pair>> pairs() {
  MeshData turned = box(6, {.distortion = 0.2, .seed = 2});
  testing::rotate(turned, 30, {0.5, 0.5, 0.5});
  const auto hex = box(5, {.distortion = 0.2});
  const auto cylinder = [](int core, bool tetrahedra) {
    return generate(CylinderShape{.core = core, .shell = 3, .axial = 2 * core, .tetrahedra = tetrahedra});
  };
  return {{"hex to turned hex", {distributed(hex), distributed(turned, PartitionMethod::graph)}},
          {"cylinders", {distributed(cylinder(2, false), PartitionMethod::graph), distributed(cylinder(4, true))}},
          {"mixed to tet", {distributed(testing::mixed_box(3)), distributed(box(4, {.tetrahedra = true}))}},
          {"one element", {distributed(box(1)), distributed(turned)}},
          // Targets far apart: more elements around a few of them than one search takes.
          {"fine to coarse",
           {distributed(box(10, {.distortion = 0.2})),
            distributed(box(3, {.distortion = 0.2, .seed = 5}), PartitionMethod::graph)}},
          // Targets on faces, edges and vertices of the source, and at its nodes.
          {"lattice to half lattice", {distributed(box(4)), distributed(box(8), PartitionMethod::graph)}},
          {"to one element", {distributed(hex), distributed(box(1), PartitionMethod::graph)}}};
}

/// Fingerprint of every case, by name.
std::map<std::string, std::uint64_t> fingerprints() {
  std::map<std::string, std::uint64_t> result;
  const std::array<Location, 2> both{Location::node, Location::element};
  for (const auto& [mesh_name, meshes] : pairs())
    for (const Case& c : cases())
      for (const Location from : both)
        for (const Location to : both) {
          Pair pair = meshes;
          pair.from = from, pair.to = to;
          const std::vector<double> values = testing::sampled(*pair.source, from, smooth);
          const GridTransfer map = testing::make_transfer(pair, c.kind, c.options);
          std::vector<double> target(testing::places(*pair.target, to).size(), std::nan(""));
          map.apply(values, target, 1);
          const TransferReport r = map.report(values, target, 1);
          const std::string name =
              mesh_name + ", " + c.name + ", " + std::string(to_string(from)) + " to " + std::string(to_string(to));
          result[name] = testing::fingerprint(*pair.target, to, target);
          std::uint64_t& report = result[name + ", report"];
          for (const double v :
               {r.source_integral, r.target_integral, r.mismatch, r.error_estimate, r.greatest_distance, r.farthest[0],
                r.farthest[1], r.farthest[2], static_cast<double>(r.outside)})
            report = report * 0x100000001b3 ^ std::bit_cast<std::uint64_t>(v);
        }
  return result;
}

TEST(RankInvariance, ValuesAndReportsAreBitwiseThoseOfOneRank) {
  const std::map<std::string, std::uint64_t> mine = fingerprints();
  ASSERT_EQ(mine.size(), 504u);
  testing::expect_bits_of_one_rank(file_name, mine);
}

}  // namespace
}  // namespace tenon::transfer
