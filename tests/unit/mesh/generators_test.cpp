// SPDX-License-Identifier: BSD-3-Clause
// Generated meshes: positive Jacobians, exact volumes and surfaces, conforming, complete sets, refusals.
#include "framework/mesh/generators.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "framework/base/error.hpp"
#include "framework/mesh/shape_functions.hpp"
#include "tests/unit/mesh/mesh_samples.hpp"

namespace tenon::testing {
namespace {

std::vector<Vec3> corners(const MeshData& mesh, GlobalId element) {
  const BlockData& b = mesh.blocks.front();
  const auto n = static_cast<std::size_t>(topology(b.kind).nodes);
  std::vector<Vec3> x;
  for (std::size_t i = 0; i < n; ++i)
    x.push_back(mesh.coordinates[static_cast<std::size_t>(b.connectivity[static_cast<std::size_t>(element) * n + i])]);
  return x;
}

std::vector<GlobalId> side_nodes(const MeshData& mesh, const SideData& side) {
  const BlockData& b = mesh.blocks.front();
  const Topology& t = topology(b.kind);
  std::vector<GlobalId> nodes;
  for (int i = 0; i < t.side_nodes[static_cast<std::size_t>(side.side)]; ++i)
    nodes.push_back(b.connectivity[static_cast<std::size_t>(
        side.element * t.nodes + t.side[static_cast<std::size_t>(side.side)][static_cast<std::size_t>(i)])]);
  return nodes;
}

double volume(const MeshData& mesh) {
  double sum = 0;
  for (GlobalId e = 0; e < static_cast<GlobalId>(mesh.elements()); ++e)
    sum += element_measure(mesh.blocks.front().kind, corners(mesh, e));
  return sum;
}

/// Area of a side set of plane or nearly plane sides, m^2.
double area(const MeshData& mesh, const SideSetData& set) {
  double sum = 0;
  for (const SideData& side : set.sides) {
    std::vector<Vec3> x;
    for (const GlobalId n : side_nodes(mesh, side)) x.push_back(mesh.coordinates[static_cast<std::size_t>(n)]);
    sum += element_measure(x.size() == 4 ? ElementKind::quad4 : ElementKind::tri3, x);
  }
  return sum;
}

const SideSetData& side_set(const MeshData& mesh, const std::string& name) {
  return *std::find_if(mesh.side_sets.begin(), mesh.side_sets.end(), [&](const auto& s) { return s.name == name; });
}
const NodeSetData& node_set(const MeshData& mesh, const std::string& name) {
  return *std::find_if(mesh.node_sets.begin(), mesh.node_sets.end(), [&](const auto& s) { return s.name == name; });
}

/// Least over all corners of det / product of edge lengths: 1 of a cube, 0 of a degenerate corner.
double worst_scaled_jacobian(const MeshData& mesh) {
  double worst = 1;
  for (GlobalId e = 0; e < static_cast<GlobalId>(mesh.elements()); ++e) {
    const std::vector<Vec3> x = corners(mesh, e);
    constexpr int next[8][3] = {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7}, {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}};
    for (std::size_t a = 0; a < 8; ++a) {
      std::array<Vec3, 3> edge;
      for (std::size_t i = 0; i < 3; ++i) edge[i] = x[static_cast<std::size_t>(next[a][i])] - x[a];
      worst = std::min(worst, dot(edge[0], cross(edge[1], edge[2])) / (norm(edge[0]) * norm(edge[1]) * norm(edge[2])));
    }
  }
  return worst;
}

TEST(Generators, SetsAreAscendingUniqueAndOnTheSkin) {
  for (const MeshSample& sample : mesh_samples()) {
    const MeshData mesh = sample.make();
    const std::vector<SideData> all = skin(mesh);
    EXPECT_FALSE(mesh.side_sets.empty());
    EXPECT_EQ(mesh.node_sets.size(), mesh.side_sets.size());
    for (std::size_t s = 0; s < mesh.side_sets.size(); ++s) {
      const SideSetData& sides = mesh.side_sets[s];
      const NodeSetData& nodes = mesh.node_sets[s];
      EXPECT_EQ(sides.name, nodes.name);
      EXPECT_FALSE(sides.sides.empty()) << sample.name << sides.name;
      EXPECT_EQ(std::adjacent_find(sides.sides.begin(), sides.sides.end(), std::greater_equal<>()), sides.sides.end());
      EXPECT_EQ(std::adjacent_find(nodes.nodes.begin(), nodes.nodes.end(), std::greater_equal<>()), nodes.nodes.end());
      std::set<GlobalId> of_sides;
      for (const SideData& side : sides.sides) {
        for (const GlobalId n : side_nodes(mesh, side)) of_sides.insert(n);
        EXPECT_TRUE(topology(mesh.blocks[0].kind).dimension == 2 || std::binary_search(all.begin(), all.end(), side))
            << sample.name;
      }
      EXPECT_EQ(std::vector<GlobalId>(of_sides.begin(), of_sides.end()), nodes.nodes) << sample.name << sides.name;
    }
  }
}

TEST(Generators, SidesOfSolidsAreCoveredByTheSets) {
  for (const MeshSample& sample : mesh_samples()) {
    const MeshData mesh = sample.make();
    if (topology(mesh.blocks[0].kind).dimension == 2) continue;
    std::size_t covered = 0;
    for (const SideSetData& s : mesh.side_sets) covered += s.sides.size();
    EXPECT_EQ(covered, skin(mesh).size()) << sample.name;
  }
}

TEST(Generators, SimplicesFillTheSameSpaceAndFitEachOther) {
  const std::vector<MeshSample> samples = mesh_samples();
  for (std::size_t i = 0; i < samples.size() / 2; ++i) {
    const MeshData whole = samples[i].make(), cut = samples[i + samples.size() / 2].make();
    const bool solid = topology(whole.blocks[0].kind).dimension == 3;
    EXPECT_EQ(cut.elements(), whole.elements() * (solid ? 6 : 2));
    if (solid) {
      // A gap or an overlap anywhere would leave a side without its partner: twice as many sides as quadrilaterals.
      EXPECT_EQ(skin(cut).size(), 2 * skin(whole).size()) << samples[i].name;
    }
    for (std::size_t s = 0; s < whole.side_sets.size(); ++s) {
      EXPECT_EQ(cut.side_sets[s].sides.size(), whole.side_sets[s].sides.size() * (solid ? 2 : 1));
      EXPECT_EQ(cut.node_sets[s].nodes, whole.node_sets[s].nodes);
    }
  }
}

TEST(BoxGenerator, CountsVolumeAndFaces) {
  for (const bool tets : {false, true})
    for (const double distortion : {0.0, 0.2}) {
      BoxShape shape;
      shape.low = {-1, 2, 0}, shape.high = {1, 3, 0.5};
      shape.elements = {6, 5, 4}, shape.grading = {1, 4, 0.25}, shape.tetrahedra = tets, shape.distortion = distortion;
      const MeshData mesh = generate(shape);
      EXPECT_EQ(mesh.coordinates.size(), 7u * 6 * 5);
      EXPECT_EQ(mesh.elements(), 6u * 5 * 4 * (tets ? 6 : 1));
      EXPECT_NEAR(volume(mesh), 1, 1e-13);
      EXPECT_NEAR(area(mesh, side_set(mesh, "x_min")), 0.5, 1e-14);
      EXPECT_NEAR(area(mesh, side_set(mesh, "z_max")), 2, 1e-14);
      for (const GlobalId n : node_set(mesh, "y_max").nodes)
        EXPECT_EQ(mesh.coordinates[static_cast<std::size_t>(n)][1], 3);
    }
}

TEST(BoxGenerator, DistortionIsKeyedByNodeAndSeed) {
  // Node 13 is the centre of 2 x 2 x 2 cells. The three numbers follow from splitmix64 alone, worked out in Python with
  // integers of any length.
  BoxShape shape;
  shape.elements = {2, 2, 2}, shape.distortion = 0.2;
  const Vec3 centre = generate(shape).coordinates[13];
  const std::array<double, 3> u{0.18604921104499028, 0.4019926589660898, 0.2871144473627836};
  for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(centre[c], 0.5 + 0.2 * 0.5 * (2 * u[c] - 1));
  shape.seed = 2;
  EXPECT_NE(generate(shape).coordinates[13], centre);
}

TEST(BoxGenerator, GradingIsTheRatioOfTheLastToTheFirstInterval) {
  BoxShape shape;
  shape.elements = {8, 1, 1}, shape.grading = {5, 1, 1};
  const MeshData mesh = generate(shape);
  const auto x = [&](std::size_t i) { return mesh.coordinates[i][0]; };
  EXPECT_NEAR((x(8) - x(7)) / (x(1) - x(0)), 5, 1e-12);
  for (std::size_t i = 2; i <= 8; ++i)
    EXPECT_NEAR((x(i) - x(i - 1)) / (x(i - 1) - x(i - 2)), std::pow(5, 1. / 7), 1e-12);
  EXPECT_EQ(x(0), 0);
  EXPECT_EQ(x(8), 1);
}

TEST(CylinderGenerator, IsWellShapedForManyParameters) {
  for (const double fraction : {1.0, 0.25})
    for (const int core : {1, 2, 3, 4, 8, 16})
      for (const int shell : {1, 2, 5, 12}) {
        if (fraction != 1 && core % 2 != 0) continue;
        CylinderShape shape;
        shape.radius = 3.2e-3, shape.length = 1e-2, shape.core = core, shape.shell = shell, shape.axial = 2;
        shape.fraction = fraction;
        const MeshData mesh = generate(shape);
        EXPECT_GT(worst_scaled_jacobian(mesh), core == 1 ? 0.3 : 0.6) << fraction << " " << core << " " << shell;
        // The section is a polygon with 4 core equal sides.
        const double turn = 2 * std::numbers::pi, sides = 4.0 * core;
        const double section = 0.5 * sides * std::sin(turn / sides) * 3.2e-3 * 3.2e-3 * fraction;
        EXPECT_NEAR(volume(mesh), section * 1e-2, 1e-13 * section) << core << shell;
        shape.tetrahedra = true;
        EXPECT_NEAR(volume(generate(shape)), section * 1e-2, 1e-13 * section);
      }
}

TEST(CylinderGenerator, BoundaryNodesLieOnTheBoundary) {
  for (const double fraction : {1.0, 0.25}) {
    CylinderShape shape;
    shape.radius = 0.7, shape.length = 3, shape.core = 6, shape.shell = 3, shape.fraction = fraction;
    const MeshData mesh = generate(shape);
    for (const GlobalId n : node_set(mesh, "outer").nodes) {
      const Vec3& x = mesh.coordinates[static_cast<std::size_t>(n)];
      EXPECT_NEAR(std::hypot(x[0], x[1]), 0.7, 2e-16);
    }
    for (const Vec3& x : mesh.coordinates) EXPECT_LE(std::hypot(x[0], x[1]), 0.7 + 2e-16);
    EXPECT_EQ(node_set(mesh, "bottom").nodes.size(), node_set(mesh, "top").nodes.size());
    EXPECT_EQ(node_set(mesh, "bottom").nodes.size() * 9, mesh.coordinates.size());
    if (fraction == 1) continue;
    EXPECT_EQ(node_set(mesh, "x_min").nodes.size(), 9u * (4 + 3));
    EXPECT_NEAR(area(mesh, side_set(mesh, "y_min")), 0.7 * 3, 1e-14);
  }
}

TEST(CylinderGenerator, IsSymmetricToTheBit) {
  CylinderShape shape;
  shape.core = 6, shape.shell = 3, shape.axial = 1;
  const MeshData mesh = generate(shape);
  std::set<Vec3> places(mesh.coordinates.begin(), mesh.coordinates.end());
  EXPECT_EQ(places.size(), mesh.coordinates.size());
  for (const Vec3& x : mesh.coordinates) {
    EXPECT_TRUE(places.count({-x[0], x[1], x[2]}) == 1 || x[0] == 0);
    EXPECT_TRUE(places.count({x[1], x[0], x[2]}) == 1);
  }
}

TEST(SphereGenerator, IsWellShapedForManyParameters) {
  for (const int core : {1, 2, 3, 4, 7})
    for (const int shell : {1, 2, 4, 9}) {
      SphereShape shape;
      shape.core = core, shape.shell = shell, shape.radius = 2;
      const MeshData mesh = generate(shape);
      EXPECT_GT(worst_scaled_jacobian(mesh), 0.35) << core << " " << shell;
      EXPECT_EQ(mesh.elements(), static_cast<std::size_t>(core * core * core + 6 * core * core * shell));
      for (const GlobalId n : node_set(mesh, "outer").nodes)
        EXPECT_NEAR(norm(mesh.coordinates[static_cast<std::size_t>(n)]), 2, 1e-15);
      shape.tetrahedra = true;
      EXPECT_EQ(generate(shape).elements(), mesh.elements() * 6);
    }
  SphereShape fine;
  fine.core = 16, fine.shell = 8;
  EXPECT_NEAR(volume(generate(fine)), 4 * std::numbers::pi / 3, 0.02);
}

TEST(AnnulusGenerator, VolumeRadiiAndSets) {
  for (const int around : {3, 8, 17, 32}) {
    AnnulusShape shape;
    shape.circumferential = around, shape.radial_grading = 3, shape.axial_grading = 0.5;
    const MeshData mesh = generate(shape);
    const double turn = 2 * std::numbers::pi;
    EXPECT_NEAR(volume(mesh), 0.5 * around * std::sin(turn / around) * (1 - 0.25), 1e-13);
    for (const GlobalId n : node_set(mesh, "inner").nodes) {
      const Vec3& x = mesh.coordinates[static_cast<std::size_t>(n)];
      EXPECT_NEAR(std::hypot(x[0], x[1]), 0.5, 2e-16);
    }
    EXPECT_EQ(node_set(mesh, "outer").nodes.size(), static_cast<std::size_t>(around) * 9);
    EXPECT_EQ(side_set(mesh, "top").sides.size(), static_cast<std::size_t>(around) * 4);
  }
}

TEST(PlateGenerator, AreaAndEdges) {
  for (const bool triangles : {false, true}) {
    PlateShape shape;
    shape.length_x = 3, shape.length_y = 2, shape.elements_x = 6, shape.elements_y = 4, shape.triangles = triangles;
    const MeshData mesh = generate(shape);
    EXPECT_NEAR(volume(mesh), 6, 1e-14);
    EXPECT_EQ(mesh.blocks[0].kind, triangles ? ElementKind::tri3 : ElementKind::quad4);
    const std::map<std::string, std::pair<std::size_t, double>> edges{
        {"x_min", {0, 0}}, {"x_max", {0, 3}}, {"y_min", {1, 0}}, {"y_max", {1, 2}}};
    for (const auto& [name, at] : edges) {
      EXPECT_EQ(side_set(mesh, name).sides.size(), at.first == 0 ? 4u : 6u);
      for (const SideData& side : side_set(mesh, name).sides) {
        EXPECT_EQ(side_nodes(mesh, side).size(), 2u);
        for (const GlobalId n : side_nodes(mesh, side))
          EXPECT_EQ(mesh.coordinates[static_cast<std::size_t>(n)][at.first], at.second);
      }
    }
  }
}

TEST(CanGenerator, CountsDoubleWithEachDirectionAndTheVolumeIsThatOfTheSheet) {
  CanShape shape;
  shape.radius = 0.1, shape.length = 0.25, shape.thickness = 0.005, shape.hole = 0.02;
  EXPECT_EQ(generate(shape).elements(), 1800u);
  shape.circumferential *= 2;
  EXPECT_EQ(generate(shape).elements(), 3600u);
  shape.axial *= 2, shape.lid *= 2;
  EXPECT_EQ(generate(shape).elements(), 7200u);
  shape.through *= 2;
  const MeshData mesh = generate(shape);
  EXPECT_EQ(mesh.elements(), 14400u);
  // Half of the prism of 80 sides whose corners lie on the circles.
  const double half_section = 0.5 * 80 * std::sin(2 * std::numbers::pi / 80) / 2;
  const double exact = half_section * (2 * (0.1 * 0.1 - 0.02 * 0.02) * 0.005 + (0.01 - 0.095 * 0.095) * (0.25 - 0.01));
  EXPECT_NEAR(volume(mesh), exact, 1e-15);
  EXPECT_EQ(side_set(mesh, "outer").sides.size(), 40u * 40);
  EXPECT_EQ(side_set(mesh, "bottom").sides.size(), 40u * 10);
  EXPECT_EQ(side_set(mesh, "symmetry").sides.size(), 2u * 6 * (40 + 2 * 10));
  EXPECT_EQ(skin(mesh).size(), 2u * 40 * 60 + 2 * 6 * 60 + 2 * 40 * 6);
}

TEST(ProjectileGenerator, HasTheShapeOfTheOgiveAndParts) {
  ProjectileShape shape;
  shape.radius = 6.45, shape.length = 88.9, shape.core = 8, shape.shell = 6, shape.nose = 24, shape.axial = 60,
  shape.tip = 0.2;
  const MeshData solid = generate(shape);
  // Volume of the pointed ogive: pi int r^2 dz, r = sqrt(arc^2 - s^2) - (arc - R); the tip that is missing is small.
  const double arc = 6 * 6.45, base = 6.45 * std::sqrt(11.0);
  double nose = 0;
  for (int i = 0; i < 10000; ++i) {
    const double s = base * (i + 0.5) / 10000, r = std::sqrt(arc * arc - s * s) - (arc - 6.45);
    nose += std::numbers::pi * r * r * base / 10000;
  }
  const double exact = nose + std::numbers::pi * 6.45 * 6.45 * (88.9 - base);
  EXPECT_NEAR(volume(solid) / exact, 1, 0.015);  // sides of a polygon: 0.6 %
  for (const GlobalId n : node_set(solid, "outer").nodes) {
    const Vec3& x = solid.coordinates[static_cast<std::size_t>(n)];
    const double s = std::max(base - x[2], 0.0);
    EXPECT_NEAR(std::hypot(x[0], x[1]), std::sqrt(arc * arc - s * s) - (arc - 6.45), 1e-12);
  }
  EXPECT_GT(worst_scaled_jacobian(solid), 0.2);

  shape.wall = 1.5, shape.wall_elements = 2, shape.filled_nose = 8;
  const MeshData filled = generate(shape);
  ASSERT_EQ(filled.blocks.size(), 2u);
  EXPECT_EQ(filled.elements(), solid.elements());
  EXPECT_EQ(filled.blocks[1].size(), (8u * 8 + 4 * 8 * 4) * (60 - 2 + 8));
  const std::set<GlobalId> of_case(filled.blocks[0].connectivity.begin(), filled.blocks[0].connectivity.end());
  std::set<Vec3> corners_of_case;
  for (const GlobalId n : of_case) corners_of_case.insert(filled.coordinates[static_cast<std::size_t>(n)]);
  std::size_t touching = 0;
  for (const GlobalId n :
       std::set<GlobalId>(filled.blocks[1].connectivity.begin(), filled.blocks[1].connectivity.end())) {
    EXPECT_EQ(of_case.count(n), 0u);
    touching += corners_of_case.count(filled.coordinates[static_cast<std::size_t>(n)]);
  }
  EXPECT_EQ(touching, 32u * 67 + 2 * (9 * 9 + 3 * 32));  // around and at both ends
  EXPECT_EQ(side_set(filled, "tail").sides.size(), 8u * 8 + 4 * 8 * 6);

  // A mesh of half the elements each way (that of heat) has the same filling, but for polygons and the curve of the
  // nose.
  const auto of_filling = [](const MeshData& mesh) {
    MeshData part = mesh;
    part.blocks.erase(part.blocks.begin());
    return volume(part);
  };
  ProjectileShape coarse = shape;
  coarse.core = 4, coarse.shell = 3, coarse.wall_elements = 1, coarse.nose = 12, coarse.axial = 30;
  coarse.filled_nose = 4, coarse.base_layers = 1;
  EXPECT_NEAR(of_filling(generate(coarse)) / of_filling(filled), 1, 0.03);
  coarse.shell = 1;  // no ring is left for the filling
  EXPECT_THROW(generate(coarse), Error);
}

TEST(FoamGenerator, IsOneLatticeOfStruts) {
  FoamShape shape;
  shape.cell = 2, shape.strut_radius = 0.2, shape.cells = {2, 1, 3};
  const MeshData mesh = generate(shape);
  // Edges of Kelvin's cells are equally far from three points of the body-centred lattice, so what lies within a radius
  // of an edge is from the third one at most two radii farther than from the first.
  double filled = 0;
  for (GlobalId e = 0; e < static_cast<GlobalId>(mesh.elements()); ++e) {
    const std::vector<Vec3> x = corners(mesh, e);
    filled += element_measure(ElementKind::hex8, x);
    Vec3 middle{0, 0, 0};
    for (const Vec3& corner : x) middle = middle + 0.125 * corner;
    std::vector<double> distances;
    for (int k = -2; k <= 8; ++k)
      for (int j = -2; j <= 4; ++j)
        for (int i = -2; i <= 6; ++i)
          if ((i - j) % 2 == 0 && (j - k) % 2 == 0) distances.push_back(norm(middle - Vec3{1.0 * i, 1.0 * j, 1.0 * k}));
    std::sort(distances.begin(), distances.end());
    EXPECT_LT(distances[2] - distances[0], 2 * 0.2 + 0.05);
  }
  // 24 struts a cell, of the length cell/sqrt(8); they share what lies in the joints.
  const double struts = 24 * std::numbers::pi * 0.1 * 0.1 / std::sqrt(8.0);
  EXPECT_GT(filled / 48, 0.5 * struts);
  EXPECT_LT(filled / 48, 0.9 * struts);
  for (const char* end : {"bottom", "top"}) EXPECT_GT(side_set(mesh, end).sides.size(), 50u);

  shape.irregularity = 0.15;
  const MeshData shifted = generate(shape);
  EXPECT_EQ(shifted.blocks[0].connectivity, mesh.blocks[0].connectivity);
  const Vec3 high{4, 2, 6};
  for (std::size_t n = 0; n < mesh.coordinates.size(); ++n)
    for (std::size_t c = 0; c < 3; ++c) {
      const double x = mesh.coordinates[n][c];
      if (x != 0 && x != high[c]) continue;
      EXPECT_EQ(shifted.coordinates[n][c], x);
    }
}

TEST(Tetrahedralise, FitsHoweverTheElementsAreTurned) {
  // Random node numbers turn the diagonals of neighbouring bricks in every possible way.
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    BoxShape shape;
    shape.elements = {3, 3, 3};
    MeshData mesh = generate(shape);
    std::vector<GlobalId> number(mesh.coordinates.size());
    for (std::size_t i = 0; i < number.size(); ++i) number[i] = static_cast<GlobalId>(i);
    std::uint64_t state = seed;
    for (std::size_t i = number.size(); i > 1; --i) {
      state = state * 6364136223846793005ULL + 1442695040888963407ULL;
      std::swap(number[i - 1], number[(state >> 33) % i]);
    }
    std::vector<Vec3> coordinates(number.size());
    for (std::size_t i = 0; i < number.size(); ++i)
      coordinates[static_cast<std::size_t>(number[i])] = mesh.coordinates[i];
    mesh.coordinates = coordinates;
    for (GlobalId& n : mesh.blocks[0].connectivity) n = number[static_cast<std::size_t>(n)];
    mesh.node_sets.clear();
    const MeshData cut = tetrahedralise(mesh);
    EXPECT_NO_THROW(check(cut));
    EXPECT_EQ(cut.elements(), 27u * 6);
    EXPECT_EQ(skin(cut).size(), 2 * skin(mesh).size());
    EXPECT_NEAR(volume(cut), 1, 1e-14);
    for (const SideSetData& s : cut.side_sets) EXPECT_NEAR(area(cut, s), 1, 1e-14);
  }
}

TEST(Tetrahedralise, TakesEverySolidKind) {
  // A pyramid on a brick, a wedge beside it.
  MeshData mesh;
  mesh.coordinates = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0},   {0, 1, 0}, {0, 0, 1}, {1, 0, 1},
                      {1, 1, 1}, {0, 1, 1}, {.5, .5, 2}, {2, 0, 0}, {2, 0, 1}};
  for (int n = 1; n <= 11; ++n) mesh.node_labels.push_back(n);
  mesh.blocks = {{"brick", 1, ElementKind::hex8, {0, 1, 2, 3, 4, 5, 6, 7}, {1}},
                 {"roof", 2, ElementKind::pyramid5, {4, 5, 6, 7, 8}, {2}},
                 {"ramp", 3, ElementKind::wedge6, {1, 9, 2, 5, 10, 6}, {3}}};
  mesh.side_sets = {{"all", 1, skin(mesh)}};
  EXPECT_EQ(mesh.side_sets[0].sides.size(), 4u + 4 + 4);  // brick 6 - 2, pyramid 5 - 1, wedge 5 - 1
  check(mesh);
  const MeshData cut = tetrahedralise(mesh);
  check(cut);
  EXPECT_EQ(cut.blocks[0].size(), 6u);
  EXPECT_EQ(cut.blocks[1].size(), 2u);
  EXPECT_EQ(cut.blocks[2].size(), 3u);
  EXPECT_EQ(cut.side_sets[0].sides, skin(cut));
}

TEST(Generators, RefuseShapesThatMakeNoSense) {
  const auto code = [](const auto& shape) {
    try {
      generate(shape);
    } catch (const Error& e) {
      return e.code();
    }
    return ExitCode::done;
  };
  BoxShape box;
  box.elements = {0, 1, 1};
  EXPECT_EQ(code(box), ExitCode::usage);
  box = {};
  box.high = {1, 1, -1};
  EXPECT_EQ(code(box), ExitCode::usage);
  box = {};
  box.distortion = 0.5;
  EXPECT_EQ(code(box), ExitCode::usage);
  box = {};
  box.elements = {12, 12, 12}, box.distortion = 0.499;
  EXPECT_EQ(code(box), ExitCode::geometry);
  CanShape can;
  can.hole = 1;
  EXPECT_EQ(code(can), ExitCode::usage);
  ProjectileShape projectile;
  projectile.tip = 1;
  EXPECT_EQ(code(projectile), ExitCode::usage);
  projectile = {};
  projectile.length = 3;
  EXPECT_EQ(code(projectile), ExitCode::usage);
  FoamShape foam;
  foam.irregularity = 0.3;
  EXPECT_EQ(code(foam), ExitCode::usage);
  foam = {};
  foam.strut_radius = 0.01;
  EXPECT_EQ(code(foam), ExitCode::usage);
  CylinderShape cylinder;
  cylinder.fraction = 0.5;
  EXPECT_EQ(code(cylinder), ExitCode::usage);
  cylinder = {};
  cylinder.core = 3, cylinder.fraction = 0.25;
  EXPECT_EQ(code(cylinder), ExitCode::usage);
  AnnulusShape annulus;
  annulus.inner_radius = 2;
  EXPECT_EQ(code(annulus), ExitCode::usage);
  annulus = {};
  annulus.circumferential = 2;
  EXPECT_EQ(code(annulus), ExitCode::usage);
  SphereShape sphere;
  sphere.radius = std::nan("");
  EXPECT_EQ(code(sphere), ExitCode::usage);
  PlateShape plate;
  plate.grading_x = 0;
  EXPECT_EQ(code(plate), ExitCode::usage);
}

}  // namespace
}  // namespace tenon::testing
