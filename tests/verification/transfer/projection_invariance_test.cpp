// SPDX-License-Identifier: BSD-3-Clause
// Projected values are bitwise the same on any number of ranks: each case leaves a fingerprint on one rank (the
// fixture), with which the runs on more ranks are compared.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <map>

#include "projection_testing.hpp"

namespace tenon::transfer {
namespace {

using testing::box;
using testing::communicator;
using testing::distributed;
using testing::Pair;
using testing::ProjectionPair;

const char* const file_name = "projection_rank_invariance.txt";

double smooth(const Vec3& x) {
  return std::sin(5 * x[0] + 1) * std::exp(x[1]) / (1.5 + x[2]) - 0.3;
}
double step(const Vec3& x) {
  return x[0] + 0.3 * x[1] < 0.6 ? 1.0 : -2.0;
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
          {"tet to mixed", {distributed(box(4, {.tetrahedra = true})), distributed(testing::mixed_box(3))}},
          {"one element", {distributed(box(1)), distributed(turned)}},
          {"to one element", {distributed(hex), distributed(box(1), PartitionMethod::graph)}}};
}

std::map<std::string, std::uint64_t> fingerprints() {
  std::map<std::string, std::uint64_t> result;
  const std::array<Location, 2> both{Location::node, Location::element};
  const std::array<testing::Function, 2> functions{smooth, step};
  for (const auto& [mesh_name, meshes] : pairs())
    for (const bool bounded : {false, true})
      for (const Location from : both)
        for (const Location to : both) {
          Pair pair = meshes;
          pair.from = from, pair.to = to;
          const ProjectionPair project(pair, {.bounded = bounded});
          const auto values = testing::sampled(*pair.source, from, std::span<const testing::Function>(functions));
          const auto target = project(values, 2);
          const std::string name = mesh_name + (bounded ? ", bounded, " : ", ") + std::string(to_string(from)) +
                                   " to " + std::string(to_string(to));
          result[name] = testing::fingerprint(*pair.target, to, target, 2);
          const ProjectionOutcome& outcome = project.projection().outcome();
          std::uint64_t& report = result[name + ", outcome"];
          for (const double v : {outcome.spread, outcome.unplaced, static_cast<double>(outcome.clipped),
                                 static_cast<double>(project.projection().points()),
                                 static_cast<double>(project.projection().points_outside())})
            report = report * 0x100000001b3 ^ std::bit_cast<std::uint64_t>(v);
        }
  return result;
}

TEST(ProjectionInvariance, ValuesAndOutcomesAreBitwiseThoseOfOneRank) {
  const std::map<std::string, std::uint64_t> mine = fingerprints();
  ASSERT_EQ(mine.size(), 96u);
  testing::expect_bits_of_one_rank(file_name, mine);
}

}  // namespace
}  // namespace tenon::transfer
