// SPDX-License-Identifier: BSD-3-Clause
// Box of bricks or tetrahedra, and flat plate of quadrilaterals or triangles.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "framework/base/error.hpp"
#include "framework/mesh/generator_tools.hpp"
#include "framework/mesh/generators.hpp"

namespace tenon {

namespace {

/// Lattice points of a rectangle, x fastest.
std::vector<std::array<double, 2>> lattice(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<std::array<double, 2>> points;
  for (const double b : y)
    for (const double a : x) points.push_back({a, b});
  return points;
}

/// Its cells, positive seen from above.
std::vector<std::array<GlobalId, 4>> cells(int nx, int ny) {
  std::vector<std::array<GlobalId, 4>> quads;
  const GlobalId row = nx + 1;
  for (GlobalId j = 0; j < ny; ++j)
    for (GlobalId i = 0; i < nx; ++i) {
      const GlobalId n = j * row + i;
      quads.push_back({n, n + 1, n + 1 + row, n + row});
    }
  return quads;
}

/// splitmix64 [SLF14], the finaliser as a hash.
std::uint64_t mix(std::uint64_t z) {
  z += 0x9E3779B97F4A7C15ULL;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

void distort(MeshData& mesh, const BoxShape& shape, const std::array<std::vector<double>, 3>& place) {
  std::array<std::size_t, 3> n;
  for (std::size_t c = 0; c < 3; ++c) n[c] = place[c].size();
  const std::uint64_t base = mix(shape.seed);
  for (std::size_t id = 0; id < mesh.coordinates.size(); ++id) {
    const std::array<std::size_t, 3> at{id % n[0], id / n[0] % n[1], id / (n[0] * n[1])};
    bool inside = true;
    for (std::size_t c = 0; c < 3; ++c) inside = inside && at[c] > 0 && at[c] + 1 < n[c];
    if (!inside) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const double u = static_cast<double>(mix(base + 4 * id + c) >> 11) * 0x1p-53;
      const double interval = std::min(place[c][at[c]] - place[c][at[c] - 1], place[c][at[c] + 1] - place[c][at[c]]);
      mesh.coordinates[id][c] += shape.distortion * interval * (2 * u - 1);
    }
  }
}

void check_shape(const BoxShape& shape) {
  const std::array<std::string, 3> axis{"x", "y", "z"};
  for (std::size_t c = 0; c < 3; ++c) {
    require_count("box", "elements along " + axis[c], shape.elements[c], 1);
    require_positive("box", "grading along " + axis[c], shape.grading[c]);
    require_positive("box", "length along " + axis[c], shape.high[c] - shape.low[c]);
  }
  if (!(shape.distortion >= 0 && shape.distortion < 0.5))
    throw Error(ExitCode::usage,
                fmt::format("box: distortion = {}, but at least 0 and below 0.5 expected", shape.distortion));
}

/// The side set of one edge of a plate: side `side` of the cells first, first + stride ...
SideSetData plate_edge(const std::string& name, std::int64_t label, GlobalId first, GlobalId stride, int count,
                       int side) {
  SideSetData set{name, label, {}};
  for (int i = 0; i < count; ++i) set.sides.push_back({first + i * stride, side});
  return set;
}

NodeSetData plate_nodes(const std::string& name, std::int64_t label, GlobalId first, GlobalId stride, int count) {
  NodeSetData set{name, label, {}};
  for (int i = 0; i < count; ++i) set.nodes.push_back(first + i * stride);
  return set;
}

}  // namespace

MeshData generate(const BoxShape& shape) {
  check_shape(shape);
  std::array<std::vector<double>, 3> place;
  for (std::size_t c = 0; c < 3; ++c)
    place[c] = between(shape.low[c], shape.high[c], graded(shape.elements[c], shape.grading[c]));
  MeshData mesh = extrude(lattice(place[0], place[1]), cells(shape.elements[0], shape.elements[1]), place[2]);
  mesh.source = "generated box";
  mesh.blocks[0].name = "box";
  mesh.blocks[0].label = 1;

  const std::array<std::string, 3> axis{"x", "y", "z"};
  const std::vector<SideData> sides = skin(mesh);
  std::vector<char> marked(mesh.coordinates.size());
  for (std::size_t c = 0; c < 3; ++c)
    for (const bool last : {false, true}) {
      const double value = last ? shape.high[c] : shape.low[c];
      std::transform(mesh.coordinates.begin(), mesh.coordinates.end(), marked.begin(),
                     [&](const Vec3& x) { return static_cast<char>(x[c] == value); });
      add_face_sets(mesh, sides, axis[c] + (last ? "_max" : "_min"), marked);
    }
  if (shape.distortion > 0) distort(mesh, shape, place);
  return finish(std::move(mesh), shape.tetrahedra);
}

MeshData generate(const PlateShape& shape) {
  require_positive("plate", "length_x", shape.length_x);
  require_positive("plate", "length_y", shape.length_y);
  require_count("plate", "elements_x", shape.elements_x, 1);
  require_count("plate", "elements_y", shape.elements_y, 1);
  require_positive("plate", "grading_x", shape.grading_x);
  require_positive("plate", "grading_y", shape.grading_y);
  const int nx = shape.elements_x, ny = shape.elements_y;

  MeshData mesh;
  mesh.source = "generated plate";
  for (const auto& [x, y] : lattice(between(0, shape.length_x, graded(nx, shape.grading_x)),
                                    between(0, shape.length_y, graded(ny, shape.grading_y))))
    mesh.coordinates.push_back({x, y, 0});
  BlockData block{"plate", 1, ElementKind::quad4, {}, {}};
  for (const std::array<GlobalId, 4>& quad : cells(nx, ny))
    block.connectivity.insert(block.connectivity.end(), quad.begin(), quad.end());
  mesh.blocks.push_back(std::move(block));
  number_from_one(mesh);

  const GlobalId row = nx + 1, last_row = static_cast<GlobalId>(ny) * row,
                 last_cells = static_cast<GlobalId>(ny - 1) * nx;
  mesh.node_sets = {plate_nodes("x_min", 1, 0, row, ny + 1), plate_nodes("x_max", 2, nx, row, ny + 1),
                    plate_nodes("y_min", 3, 0, 1, nx + 1), plate_nodes("y_max", 4, last_row, 1, nx + 1)};
  // Sides of quad4: 0 and 1 its faces, 2 to 5 its edges from node 0 on.
  mesh.side_sets = {plate_edge("x_min", 1, 0, nx, ny, 5), plate_edge("x_max", 2, nx - 1, nx, ny, 3),
                    plate_edge("y_min", 3, 0, 1, nx, 2), plate_edge("y_max", 4, last_cells, 1, nx, 4)};
  return finish(std::move(mesh), shape.triangles);
}

}  // namespace tenon
