// SPDX-License-Identifier: BSD-3-Clause
// Half of a closed can: a strip that runs along a lid, the tube and the other lid, swept around half a turn.
#include <algorithm>
#include <cmath>

#include "framework/mesh/generator_tools.hpp"
#include "framework/mesh/generators.hpp"

namespace tenon {

namespace {

using Place = std::array<double, 2>;  ///< r and z

/// Outer line of the strip (from the lower hole out, up and in), or the inner one, a thickness inside of it.
std::vector<Place> outline(const CanShape& shape, double inset) {
  const double r = shape.radius - inset, low = inset, high = shape.length - inset;
  std::vector<Place> line;
  for (const double x : between(shape.hole, r, graded(shape.lid, 1))) line.push_back({x, low});
  line.pop_back();  // corners belong to two of the three parts
  for (const double z : between(low, high, graded(shape.axial, 1))) line.push_back({r, z});
  line.pop_back();
  for (const double x : between(r, shape.hole, graded(shape.lid, 1))) line.push_back({x, high});
  return line;
}

/// Nodes of the strip: `through` + 1 across at each place along it.
std::vector<Place> strip(const CanShape& shape) {
  const std::vector<Place> outer = outline(shape, 0), inner = outline(shape, shape.thickness);
  const std::vector<double> across = graded(shape.through, 1);
  std::vector<Place> nodes;
  for (std::size_t i = 0; i < outer.size(); ++i)
    for (const double t : across)
      nodes.push_back({outer[i][0] + (inner[i][0] - outer[i][0]) * t, outer[i][1] + (inner[i][1] - outer[i][1]) * t});
  return nodes;
}

}  // namespace

MeshData generate(const CanShape& shape) {
  require_positive("can", "thickness", shape.thickness);
  require_positive("can", "hole", shape.hole);
  require_positive("can", "radius - thickness - hole", shape.radius - shape.thickness - shape.hole);
  require_positive("can", "length - 2 thickness", shape.length - 2 * shape.thickness);
  require_count("can", "circumferential", shape.circumferential, 2);
  require_count("can", "axial", shape.axial, 1);
  require_count("can", "lid", shape.lid, 1);
  require_count("can", "through", shape.through, 1);

  const std::vector<Place> section = strip(shape);
  MeshData mesh;
  mesh.source = "generated can";
  for (int j = 0; j <= shape.circumferential; ++j) {
    const Direction d = part_of_turn(j, 2 * shape.circumferential);
    for (const auto& [r, z] : section) mesh.coordinates.push_back({r * d.cosine, r * d.sine, z});
  }
  BlockData block;
  block.name = "can";
  block.label = 1;
  const GlobalId across = shape.through + 1, along = static_cast<GlobalId>(section.size()) / across;
  const auto layer = static_cast<GlobalId>(section.size());
  for (GlobalId j = 0; j < shape.circumferential; ++j)
    for (GlobalId i = 0; i + 1 < along; ++i)
      for (GlobalId q = 0; q + 1 < across; ++q) {
        const GlobalId n = i * across + q;
        for (const GlobalId a : {j, j + 1})
          for (const GlobalId m : {n, n + 1, n + 1 + across, n + across}) block.connectivity.push_back(a * layer + m);
      }
  mesh.blocks.push_back(std::move(block));
  number_from_one(mesh);

  const std::vector<SideData> sides = skin(mesh);
  const auto marked = [&](const auto& is_in) {
    std::vector<char> marks;
    for (const Vec3& x : mesh.coordinates) marks.push_back(static_cast<char>(is_in(x)));
    return marks;
  };
  std::vector<char> outer(mesh.coordinates.size(), 0);
  for (std::size_t n = 0; n < outer.size(); ++n) {
    const GlobalId i = static_cast<GlobalId>(n) % layer / across;
    outer[n] =
        static_cast<char>(static_cast<GlobalId>(n) % across == 0 && i >= shape.lid && i <= shape.lid + shape.axial);
  }
  add_face_sets(mesh, sides, "bottom", marked([](const Vec3& x) { return x[2] == 0; }));
  add_face_sets(mesh, sides, "top", marked([&](const Vec3& x) { return x[2] == shape.length; }));
  add_face_sets(mesh, sides, "outer", outer);
  add_face_sets(mesh, sides, "symmetry", marked([](const Vec3& x) { return x[1] == 0; }));
  return finish(std::move(mesh), false);
}

}  // namespace tenon
