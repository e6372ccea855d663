// SPDX-License-Identifier: BSD-3-Clause
// Bodies of particles: lattices, regions, inside or not, walls, relaxation.
#include "framework/mesh/particle_bodies.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <numeric>

#include "framework/base/error.hpp"
#include "framework/mesh/generators.hpp"

namespace tenon {
namespace {

double volume(const MeshData& mesh) {
  return std::accumulate(mesh.volumes.begin(), mesh.volumes.end(), 0.0);
}

/// Distance of each particle to the nearest other one: least and greatest.
std::pair<double, double> nearest_distances(const MeshData& mesh) {
  double least = std::numeric_limits<double>::infinity(), greatest = 0;
  for (std::size_t i = 0; i < mesh.coordinates.size(); ++i) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < mesh.coordinates.size(); ++j)
      if (j != i) nearest = std::min(nearest, norm(mesh.coordinates[i] - mesh.coordinates[j]));
    least = std::min(least, nearest), greatest = std::max(greatest, nearest);
  }
  return {least, greatest};
}

ParticleFill fill_of(double spacing, ParticleLattice lattice = ParticleLattice::cubic, int dimension = 3) {
  ParticleFill fill;
  fill.spacing = spacing, fill.lattice = lattice, fill.dimension = dimension;
  return fill;
}

TEST(ParticleBodies, ABoxIsFilledExactly) {
  const MeshData cubic = fill_box({0, 0, 0}, {1, 0.52, 0.31}, fill_of(0.1));
  EXPECT_EQ(cubic.coordinates.size(), 10u * 5u * 3u);
  EXPECT_NEAR(volume(cubic), 1 * 0.52 * 0.31, 1e-14);
  const MeshData flat = fill_box({0, 0, 0}, {1, 2, 0}, fill_of(0.05, ParticleLattice::cubic, 2));
  EXPECT_EQ(flat.coordinates.size(), 20u * 40u);
  EXPECT_NEAR(volume(flat), 2, 1e-13);
  const MeshData row = fill_box({-0.5, 0, 0}, {0, 0, 0}, fill_of(1.0 / 640, ParticleLattice::cubic, 1));
  EXPECT_EQ(row.coordinates.size(), 320u);
}

TEST(ParticleBodies, HexagonalLatticesAreClosePacked) {
  const double spacing = 0.05;
  const MeshData solid = fill_box({0, 0, 0}, {0.5, 0.5, 0.5}, fill_of(spacing, ParticleLattice::hexagonal));
  const auto [least, greatest] = nearest_distances(solid);
  const double expected = std::pow(2.0, 1.0 / 6) * spacing;  // of spheres with 12 neighbours
  EXPECT_NEAR(least, expected, 0.08 * expected);             // fitted to the box
  EXPECT_NEAR(greatest, expected, 0.08 * expected);
  EXPECT_NEAR(volume(solid), 0.125, 1e-14);
  for (const Vec3& x : solid.coordinates)
    for (const double c : x) EXPECT_TRUE(c > 0 && c < 0.5);
}

TEST(ParticleBodies, AMeshIsFilledAsTheShapeThatItHas) {
  CylinderShape shape;
  shape.radius = 0.4, shape.length = 1, shape.core = 8, shape.shell = 4, shape.axial = 6;
  for (const bool tetrahedra : {false, true}) {
    shape.tetrahedra = tetrahedra;
    const ParticleRegion region = mesh_region(generate(shape), 3);
    const ParticleRegion exact = cylinder_region({0, 0, 0}, {0, 0, 2}, 0, 0.4, 1);
    EXPECT_NEAR(region.measure, exact.measure, 0.02 * exact.measure);  // a polygon of 32 sides
    const MeshData filled = fill_region(region, fill_of(0.05)), round = fill_region(exact, fill_of(0.05));
    EXPECT_NEAR(volume(filled), region.measure, 1e-12);
    EXPECT_NEAR(static_cast<double>(filled.coordinates.size()), static_cast<double>(round.coordinates.size()),
                0.03 * static_cast<double>(round.coordinates.size()));
    for (const Vec3& x : filled.coordinates) EXPECT_TRUE(exact.inside(x));
  }
}

// Points on the nodes, edges and faces of the mesh, and rays along them: each point of the whole is in exactly one of
// the two halves, however these are cut.
TEST(ParticleBodies, NoPointLeaksThroughEdgesAndCorners) {
  for (const bool tetrahedra : {false, true}) {
    BoxShape left, right;
    left.high = {0.5, 1, 1}, left.elements = {2, 4, 4}, left.tetrahedra = tetrahedra;
    right.low = {0.5, 0, 0}, right.high = {1, 1, 1}, right.elements = {2, 4, 4}, right.tetrahedra = tetrahedra;
    const ParticleRegion a = mesh_region(generate(left), 3), b = mesh_region(generate(right), 3);
    int inside = 0;
    for (int i = 0; i <= 16; ++i)
      for (int j = 0; j <= 16; ++j)
        for (int k = 0; k <= 16; ++k) {
          const Vec3 x{i / 16.0, j / 16.0, k / 16.0};
          const bool in = i < 16 && j < 16 && k < 16;  // half open
          EXPECT_EQ(a.inside(x) + b.inside(x), in ? 1 : 0) << i << ' ' << j << ' ' << k;
          inside += a.inside(x) + b.inside(x);
        }
    EXPECT_EQ(inside, 16 * 16 * 16);
  }
}

TEST(ParticleBodies, AFlatMeshIsFilledInItsPlane) {
  PlateShape plate;
  plate.length_x = 2, plate.length_y = 1, plate.elements_x = 7, plate.elements_y = 3;
  for (const bool triangles : {false, true}) {
    plate.triangles = triangles;
    const ParticleRegion region = mesh_region(generate(plate), 2);
    EXPECT_NEAR(region.measure, 2, 1e-12);
    EXPECT_EQ(fill_region(region, fill_of(0.1, ParticleLattice::cubic, 2)).coordinates.size(), 200u);
  }
}

TEST(ParticleBodies, ASurfaceThatIsNotClosedIsRefused) {
  try {
    mesh_region(generate(PlateShape{}), 3);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::geometry);
    EXPECT_NE(std::string(error.what()).find("not closed"), std::string::npos) << error.what();
  }
  EXPECT_THROW(fill_region(ball_region({0, 0, 0}, 0.09, 0.1, 3), fill_of(1)), Error);
  EXPECT_THROW(ball_region({0, 0, 0}, 0.2, 0.1, 3), Error);
}

TEST(ParticleBodies, WallsGoOnWithTheLatticeInside) {
  TankShape tank;
  tank.high = {1, 0.5, 0}, tank.spacing = 0.1, tank.dimension = 2, tank.layers = 3, tank.open[3] = true;
  const MeshData walls = tank_walls(tank);
  EXPECT_EQ(walls.coordinates.size(), 16u * 8u - 10u * 5u);
  double top = 0;
  for (const Vec3& x : walls.coordinates) {
    top = std::max(top, x[1]);
    EXPECT_FALSE(x[0] > 0 && x[0] < 1 && x[1] > 0) << x[0] << ' ' << x[1];
    EXPECT_NEAR(std::remainder(x[0] - 0.05, 0.1), 0, 1e-12);
  }
  EXPECT_NEAR(top, 0.45, 1e-12);
}

TEST(ParticleBodies, RelaxedParticlesFollowTheSurface) {
  const double radius = 0.5, spacing = 0.1;
  ParticleFill fill = fill_of(spacing);
  const ParticleRegion region = ball_region({0.1, 0.2, 0.3}, 0, radius, 3);
  const MeshData lattice = fill_region(region, fill);
  fill.relaxed = true;
  const MeshData relaxed = fill_region(region, fill);
  ASSERT_EQ(relaxed.coordinates.size(), lattice.coordinates.size());
  const auto outermost = [&](const MeshData& mesh) {
    // Of particles within a spacing of the surface: scatter of their depths.
    double least = 1, greatest = 0;
    for (const Vec3& x : mesh.coordinates) {
      const double depth = -region.surface(x).distance;
      if (depth < 0.8 * spacing) least = std::min(least, depth), greatest = std::max(greatest, depth);
    }
    return greatest - least;
  };
  const auto [least, greatest] = nearest_distances(relaxed);
  std::printf("relaxed ball: nearest %.3f to %.3f spacings, scatter of the outer layer %.3f (lattice %.3f)\n",
              least / spacing, greatest / spacing, outermost(relaxed) / spacing, outermost(lattice) / spacing);
  EXPECT_GT(least, 0.65 * spacing);
  EXPECT_LT(greatest, 1.3 * spacing);
  EXPECT_LT(outermost(relaxed), 0.5 * outermost(lattice));
}

}  // namespace
}  // namespace tenon
