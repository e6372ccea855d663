// SPDX-License-Identifier: BSD-3-Clause
// What the generators have in common.
#include "framework/mesh/generator_tools.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "framework/base/error.hpp"
#include "framework/mesh/generators.hpp"

namespace tenon {

void require_count(const std::string& shape, const std::string& name, int value, int least) {
  if (value < least)
    throw Error(ExitCode::usage, fmt::format("{}: {} = {}, but at least {} expected", shape, name, value, least));
}

void require_positive(const std::string& shape, const std::string& name, double value) {
  if (!(value > 0) || !std::isfinite(value))
    throw Error(ExitCode::usage, fmt::format("{}: {} = {}, but a number above 0 expected", shape, name, value));
}

std::vector<double> graded(int intervals, double grading) {
  const auto n = static_cast<std::size_t>(intervals);
  std::vector<double> t(n + 1);
  if (grading == 1 || n == 1) {
    for (std::size_t i = 0; i <= n; ++i) t[i] = static_cast<double>(i) / static_cast<double>(n);
    return t;
  }
  const double ratio = std::pow(grading, 1.0 / static_cast<double>(n - 1));
  double interval = 1;
  for (std::size_t i = 1; i <= n; ++i, interval *= ratio) t[i] = t[i - 1] + interval;
  for (std::size_t i = 1; i < n; ++i) t[i] /= t[n];
  t[n] = 1;
  return t;
}

std::vector<double> between(double low, double high, const std::vector<double>& t) {
  std::vector<double> x(t.size());
  for (std::size_t i = 0; i < t.size(); ++i) x[i] = low + (high - low) * t[i];
  x.back() = high;
  return x;
}

Direction part_of_turn(int j, int n) {
  j = (j % n + n) % n;
  const int quarter = 4 * j / n;         // turns by 90 degrees that are taken out
  const int rest = 4 * j - quarter * n;  // the angle left is rest / (4 n) of a turn, below 90 degrees
  const bool above = 2 * rest > n;       // above 45 degrees: mirrored there
  const int octant = above ? n - rest : rest;
  const double angle = std::numbers::pi / 2 * octant / n;
  double c = std::cos(angle), s = std::sin(angle);
  if (2 * octant == n) c = s = std::numbers::sqrt2 / 2;
  if (above) std::swap(c, s);
  switch (quarter) {
    case 1:
      return {-s, c};
    case 2:
      return {-c, -s};
    case 3:
      return {s, -c};
    default:
      return {c, s};
  }
}

void number_from_one(MeshData& mesh) {
  mesh.node_labels.resize(mesh.coordinates.size());
  std::iota(mesh.node_labels.begin(), mesh.node_labels.end(), 1);
  std::int64_t label = 1;
  for (BlockData& b : mesh.blocks) {
    b.labels.resize(b.connectivity.size() / static_cast<std::size_t>(topology(b.kind).nodes));
    for (std::int64_t& l : b.labels) l = label++;
  }
}

void add_face_sets(MeshData& mesh, const std::vector<SideData>& skin_sides, const std::string& name,
                   const std::vector<char>& marked) {
  NodeSetData nodes{name, static_cast<std::int64_t>(mesh.node_sets.size()) + 1, {}};
  for (std::size_t n = 0; n < marked.size(); ++n)
    if (marked[n]) nodes.nodes.push_back(static_cast<GlobalId>(n));
  mesh.node_sets.push_back(std::move(nodes));

  SideSetData sides{name, static_cast<std::int64_t>(mesh.side_sets.size()) + 1, {}};
  const BlockData& block = mesh.blocks.front();
  const Topology& t = topology(block.kind);
  for (const SideData& side : skin_sides) {
    const GlobalId* element = &block.connectivity[static_cast<std::size_t>(side.element * t.nodes)];
    const auto s = static_cast<std::size_t>(side.side);
    const auto* begin = t.side[s].begin();
    if (std::all_of(begin, begin + t.side_nodes[s],
                    [&](std::int8_t n) { return marked[static_cast<std::size_t>(element[n])] != 0; }))
      sides.sides.push_back(side);
  }
  mesh.side_sets.push_back(std::move(sides));
}

MeshData finish(MeshData&& mesh, bool simplices) {
  MeshData result = simplices ? tetrahedralise(mesh) : std::move(mesh);
  check(result);
  return result;
}

MeshData extrude(const std::vector<std::array<double, 2>>& layer, const std::vector<std::array<GlobalId, 4>>& quads,
                 const std::vector<double>& z) {
  MeshData mesh;
  for (const double height : z)
    for (const auto& [x, y] : layer) mesh.coordinates.push_back({x, y, height});
  BlockData block;
  const auto per_layer = static_cast<GlobalId>(layer.size());
  for (GlobalId k = 0; k + 1 < static_cast<GlobalId>(z.size()); ++k)
    for (const std::array<GlobalId, 4>& quad : quads)
      for (const GlobalId level : {k, k + 1})
        for (const GlobalId n : quad) block.connectivity.push_back(level * per_layer + n);
  mesh.blocks.push_back(std::move(block));
  number_from_one(mesh);
  return mesh;
}

}  // namespace tenon
