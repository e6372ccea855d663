// SPDX-License-Identifier: BSD-3-Clause
// What `tenon transfer` writes, against exact fields: values, units, sums, misses.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "apps/tenon/commands.hpp"
#include "framework/fields/root_order.hpp"
#include "framework/io/vtk_output.hpp"
#include "framework/io/vtk_result.hpp"
#include "framework/mesh/generators.hpp"
#include "framework/mesh_files/readers.hpp"
#include "tests/support/test_communicator.hpp"

namespace tenon {
namespace {

double linear(const Vec3& x) {
  return 300 + 20 * x[0] - 7 * x[1] + 3 * x[2];
}

MeshData box(const Vec3& high, std::array<int, 3> elements, bool tetrahedra) {
  BoxShape shape;
  shape.high = high;
  shape.elements = elements, shape.distortion = 0.2, shape.tetrahedra = tetrahedra;
  return generate(shape);
}

class TransferCommand : public ::testing::Test {
 protected:
  /// A unit cube with three fields as source.pvtu; the same cube of other elements, in mm, as target.exo.
  void SetUp() override {
    folder_ = fmt::format("transfer_command_np{}/", comm_.size());
    comm_.vote_on_root([&] {
      std::filesystem::remove_all(folder_);
      std::filesystem::create_directories(folder_);
      MeshData target = box({1, 1, 1}, {6, 5, 4}, true);
      for (Vec3& x : target.coordinates) x = 1000.0 * x;
      write_exodus(target, folder_ + "target.exo");
    });
    const auto mesh = distribute(comm_, comm_.rank() == 0 ? box({1, 1, 1}, {5, 7, 6}, false) : MeshData{}, {});
    std::vector<double> temperature, velocity, heat(static_cast<std::size_t>(mesh->elements()), 0.125);
    for (const Vec3& x : mesh->coordinates) {
      temperature.push_back(linear(x));
      for (const double factor : {1, 2, 4}) velocity.push_back(factor * linear(x));
    }
    write_pvtu(comm_, folder_ + "source.pvtu",
               {"source",
                mesh.get(),
                mesh->coordinates,
                {{{"temperature", Location::node, FieldKind::point_value, 1, "K"}, temperature},
                 {{"velocity", Location::node, FieldKind::point_value, 3, "m/s"}, velocity},
                 {{"plastic_heat", Location::element, FieldKind::total, 1, "J"}, heat}}});
    arguments_.source = folder_ + "source.pvtu", arguments_.target = folder_ + "target.exo";
    arguments_.target_unit = "mm", arguments_.output = folder_ + "result.vtu";
  }
  /// Nobody clears the folder for the next test while others still read.
  void TearDown() override { comm_.barrier(); }
  ResultData transferred() {
    transfer_results(comm_, arguments_);
    return read_vtk_result(arguments_.output, {}, "");
  }

  const Communicator& comm_ = testing::communicator();
  TransferArguments arguments_;
  std::string folder_;
};

TEST_F(TransferCommand, CarriesEveryFieldInItsKindWithItsUnit) {
  const ResultData result = transferred();
  ASSERT_EQ(result.fields.size(), 3u);
  const std::vector<Vec3>& x = result.mesh.coordinates;
  EXPECT_EQ(result.mesh.elements(), 6u * 5 * 4 * 6);
  EXPECT_EQ(result.fields[0].description.name, "temperature");
  EXPECT_EQ(result.fields[0].description.unit, "K");
  EXPECT_EQ(result.fields[1].description.unit, "m/s");
  EXPECT_EQ(result.fields[1].description.components, 3);
  for (std::size_t n = 0; n < x.size(); ++n) {
    EXPECT_NEAR(result.fields[0].values[n], linear(x[n]), 1e-11);
    EXPECT_NEAR(result.fields[1].values[3 * n + 2], 4 * linear(x[n]), 4e-11);
  }
  EXPECT_EQ(result.fields[2].description.name, "plastic_heat");
  EXPECT_EQ(result.fields[2].description.unit, "J");
  EXPECT_EQ(result.fields[2].description.location, Location::element);
  double sum = 0;
  for (const double heat : result.fields[2].values) sum += heat;
  EXPECT_NEAR(sum, 0.125 * 5 * 7 * 6, 1e-12);
}

TEST_F(TransferCommand, PiecesHoldTheSameValuesAsOneFile) {
  const ResultData one = transferred();
  arguments_.output = folder_ + "result.pvtu";
  const ResultData pieces = transferred();
  EXPECT_EQ(one.mesh.coordinates, pieces.mesh.coordinates);
  ASSERT_EQ(one.fields.size(), pieces.fields.size());
  for (std::size_t f = 0; f < one.fields.size(); ++f) EXPECT_EQ(one.fields[f].values, pieces.fields[f].values);
}

TEST_F(TransferCommand, TakesTheMethodThatAFieldNames) {
  arguments_.fields = {"temperature:project", "velocity:moving_least_squares"};
  const ResultData result = transferred();
  ASSERT_EQ(result.fields.size(), 2u);
  for (std::size_t n = 0; n < result.mesh.coordinates.size(); ++n) {
    EXPECT_NEAR(result.fields[0].values[n], linear(result.mesh.coordinates[n]), 1e-9);
    EXPECT_NEAR(result.fields[1].values[3 * n], linear(result.mesh.coordinates[n]), 1e-9);
  }
}

TEST_F(TransferCommand, PutsElementValuesAtNodesIfAsked) {
  arguments_.fields = {"plastic_heat"}, arguments_.at = "nodes";
  const ResultData result = transferred();
  ASSERT_EQ(result.fields.size(), 1u);
  EXPECT_EQ(result.fields[0].description.location, Location::node);
  double sum = 0;
  for (const double heat : result.fields[0].values) sum += heat;
  EXPECT_NEAR(sum, 0.125 * 5 * 7 * 6, 1e-12);
}

TEST_F(TransferCommand, GivesPointsOutsideWhatThePolicySays) {
  arguments_.target_unit = "2 mm";  // a cube of 2 m
  arguments_.fields = {"temperature"};
  arguments_.status = true;
  for (const char* policy : {"nearest", "extrapolate", "value=-1"}) {
    arguments_.outside = policy;
    const ResultData result = transferred();
    ASSERT_EQ(result.fields.size(), 3u);
    EXPECT_EQ(result.fields[1].description.name, "transfer_status");
    EXPECT_EQ(result.fields[2].description.name, "transfer_distance");
    EXPECT_EQ(result.fields[2].description.unit, "m");
    for (std::size_t n = 0; n < result.mesh.coordinates.size(); ++n) {
      Vec3 x = result.mesh.coordinates[n];
      const bool outside = std::max({x[0], x[1], x[2]}) > 1 + 1e-9;
      const double status = policy[0] == 'n' ? 1 : policy[0] == 'e' ? 2 : 3;
      const Vec3 beyond{std::max(x[0] - 1, 0.0), std::max(x[1] - 1, 0.0), std::max(x[2] - 1, 0.0)};
      EXPECT_EQ(result.fields[1].values[n], outside ? status : 0);
      EXPECT_NEAR(result.fields[2].values[n], outside ? norm(beyond) : 0, 1e-9);
      if (outside && policy[0] == 'v') {
        EXPECT_EQ(result.fields[0].values[n], -1);
        continue;
      }
      if (policy[0] == 'n')
        for (double& c : x) c = std::min(c, 1.0);
      // Elements at the surface are bricks with curved faces inside, so extrapolation is linear-exact, too.
      EXPECT_NEAR(result.fields[0].values[n], linear(x), 1e-8) << policy;
    }
  }
  arguments_.outside = "nearest", arguments_.greatest_distance = "0.1 m";
  EXPECT_THROW(transfer_results(comm_, arguments_), Error);
}

}  // namespace
}  // namespace tenon
