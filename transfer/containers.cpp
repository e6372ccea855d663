// SPDX-License-Identifier: BSD-3-Clause
// Which elements of a mesh can contain points, and the refusal of those that are turned inside out.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "framework/base/pack.hpp"
#include "framework/mesh/shape_functions.hpp"
#include "transfer/element_set.hpp"

namespace tenon::transfer {

double CornerList::size() const {
  Box box;
  for (const Vec3& corner : span()) box.add(corner);
  return box.diagonal();
}

namespace {

enum class Shape { sound, flat, inverted };

/// Neighbours of each corner of a hex8, such that the three edges to them form a right-handed system.
constexpr int hex_neighbours[8][3] = {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7},
                                      {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}};

/// Midside nodes of the elements of second order, each between two corners, in order from the first of them.
constexpr int hex20_edges[12][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                                    {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
constexpr int tet10_edges[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};

double smallest_measure(ElementKind kind, double size) {
  return topology(kind).dimension == 3 ? 1e-14 * size * size * size : 1e-14 * size * size;
}

/// How far the element may lie beyond the box of its nodes: a parabola leaves the hull of its three points by an eighth
/// of their second difference, and there are three directions.
double bulge(ElementKind kind, std::span<const Vec3> x) {
  double greatest = 0;
  const auto edges = [&](const auto& table, std::size_t first) {
    for (std::size_t k = 0; k < std::size(table); ++k) {
      const Vec3 bend =
          x[static_cast<std::size_t>(table[k][0])] + x[static_cast<std::size_t>(table[k][1])] - 2.0 * x[first + k];
      greatest = std::max(greatest, norm(bend));
    }
  };
  if (kind == ElementKind::hex20) edges(hex20_edges, 8);
  if (kind == ElementKind::tet10) edges(tet10_edges, 4);
  return greatest;
}

/// An element that has volume is sound even if a corner is folded or edges have collapsed: points are found in it. One
/// without volume is flat if its Jacobian vanishes everywhere, else turned inside out.
Shape shape_of(ElementKind kind, std::span<const Vec3> corners, double size) {
  const double smallest = smallest_measure(kind, size);
  const double measure = element_measure(kind, corners);
  if (measure > smallest) return Shape::sound;
  if (topology(kind).dimension != 3) return Shape::flat;
  double absolute = 0;
  for (const QuadraturePoint& q : quadrature(kind))
    absolute += q.weight * std::abs(jacobian_determinant(kind, corners, q.xi));
  return absolute <= 2 * smallest ? Shape::flat : Shape::inverted;
}

/// What fit() finds on this rank.
struct Fitted {
  double sizes = 0;
  ExactSum exact_sizes;  ///< of surfaces, where the mean size decides
  std::int64_t sound = 0, flat = 0;
  LocalIndex inverted = no_index;  ///< the first
};

/// Large enough for points within the tolerance, and for the round-off of coordinates far from the origin.
double margin(double tolerance, double size, double farthest) {
  return (4 * tolerance + 1e-12) * size + 1e-14 * farthest;
}

void fit_one(ElementSet& set, LocalIndex e, double tolerance, Fitted& fitted) {
  const ElementKind kind = set.kind(e);
  const CornerList corners(set, e);
  Box box;
  double farthest = 0;
  for (const Vec3& corner : corners.span()) {
    box.add(corner);
    for (const double c : corner) farthest = std::max(farthest, std::abs(c));
  }
  const double size = box.diagonal();
  const Shape shape = shape_of(kind, corners.span(), size);
  if (shape == Shape::inverted && fitted.inverted == no_index) fitted.inverted = e;
  if (shape == Shape::flat) ++fitted.flat;
  Box& to = set.boxes[static_cast<std::size_t>(e)];
  to = Box{};
  if (shape != Shape::sound) return;
  ++fitted.sound;
  if (topology(kind).dimension == 2)
    fitted.exact_sizes.add(size);
  else
    fitted.sizes += size;
  box.inflate(margin(tolerance, size, farthest) + bulge(kind, corners.span()));
  to = box;
}

struct FourHexahedra {
  Pack x[8][3];
};

TENON_KERNEL FourHexahedra four_hexahedra(const ElementSet& set, LocalIndex first) {
  FourHexahedra at;
  const LocalIndex* const nodes = set.nodes_of(first);
  for (std::size_t a = 0; a < 8; ++a) {
    const auto corner = [&](std::size_t l) { return load(set.x[static_cast<std::size_t>(nodes[8 * l + a])].data()); };
    Pack p = corner(0), q = corner(1), r = corner(2), s = corner(3);
    transpose(p, q, r, s);
    at.x[a][0] = p, at.x[a][1] = q, at.x[a][2] = r;
  }
  return at;
}

/// Four hexahedra whose Jacobians are positive at all corners, which is enough for nearly all of a sound mesh. False,
/// and nothing done, if one is not so plain.
bool fit_four(ElementSet& set, LocalIndex first, double tolerance, Fitted& fitted) {
  const FourHexahedra at = four_hexahedra(set, first);
  Pack low[3], high[3], size = Pack{}, farthest = Pack{};
  for (int c = 0; c < 3; ++c) {
    low[c] = high[c] = at.x[0][c];
    for (int a = 1; a < 8; ++a) {
      low[c] = lesser_of(low[c], at.x[a][c]);
      high[c] = greater_of(high[c], at.x[a][c]);
    }
    size += (high[c] - low[c]) * (high[c] - low[c]);
    farthest = greater_of(farthest, greater_of(-low[c], high[c]));
  }
  size = square_root(size);
  const Pack smallest = 1e-14 * (size * size * size);
  PackMask plain = ~PackMask{};
  for (int a = 0; a < 8; ++a) {
    Pack edge[3][3];
    for (int k = 0; k < 3; ++k)
      for (int c = 0; c < 3; ++c) edge[k][c] = at.x[hex_neighbours[a][k]][c] - at.x[a][c];
    const Pack volume = edge[2][0] * (edge[0][1] * edge[1][2] - edge[0][2] * edge[1][1]) +
                        edge[2][1] * (edge[0][2] * edge[1][0] - edge[0][0] * edge[1][2]) +
                        edge[2][2] * (edge[0][0] * edge[1][1] - edge[0][1] * edge[1][0]);
    plain &= volume > smallest;
  }
  if (any(~plain)) return false;
  const Pack out = (4 * tolerance + 1e-12) * size + 1e-14 * farthest;
  for (int c = 0; c < 3; ++c) low[c] -= out, high[c] += out;
  for (std::size_t l = 0; l < 4; ++l) {
    Box& box = set.boxes[static_cast<std::size_t>(first) + l];
    box.low = {low[0][l], low[1][l], low[2][l]}, box.high = {high[0][l], high[1][l], high[2][l]};
    fitted.sizes += size[l];
  }
  fitted.sound += 4;
  return true;
}

Fitted fit(ElementSet& set, double tolerance) {
  Fitted fitted;
  set.boxes.resize(set.size());
  const auto count = static_cast<LocalIndex>(set.size());
  LocalIndex e = 0;
  if (set.hexahedra())
    for (; e + 4 <= count; e += 4)
      if (!fit_four(set, e, tolerance, fitted))
        for (LocalIndex l = 0; l < 4; ++l) fit_one(set, e + l, tolerance, fitted);
  for (; e < count; ++e) fit_one(set, e, tolerance, fitted);
  return fitted;
}

/// Label and block of an item of the mesh.
std::pair<std::int64_t, const ElementBlock*> element_of_item(const Mesh& mesh, LocalIndex item) {
  for (const ElementBlock& block : mesh.blocks) {
    if (item < block.size()) return {block.labels[static_cast<std::size_t>(item)], &block};
    item -= block.size();
  }
  return {0, nullptr};
}

Error inverted_error(const Mesh& mesh, const ElementSet& set, LocalIndex e, const std::string& transfer) {
  const CornerList corners(set, e);
  const Vec3 at = map_to_space(set.kind(e), corners.span(), element_centre(set.kind(e)));
  const auto [label, block] = element_of_item(mesh, set.items[static_cast<std::size_t>(e)]);
  return Error(
      ExitCode::geometry,
      fmt::format("transfer '{}': element {} of block '{}' of {} at ({:.6g}, {:.6g}, {:.6g}) is inverted (volume "
                  "{:.3g} m^3), so points cannot be found in it; repair the mesh, or limit its deformation",
                  transfer, label, block->name, mesh.source, at[0], at[1], at[2],
                  element_measure(set.kind(e), corners.span())));
}

[[noreturn]] void refuse_name(const std::string& transfer, const Mesh& mesh, const char* what, const std::string& name,
                              const std::string& known) {
  throw Error(ExitCode::usage, fmt::format("transfer '{}': {} has no {} '{}'; it has: {}", transfer, mesh.source, what,
                                           name, known.empty() ? "none" : known));
}

/// Whether the block is among those chosen.
bool chosen(const ElementChoice& choice, const ElementBlock& block) {
  return choice.blocks.empty() ||
         std::find(choice.blocks.begin(), choice.blocks.end(), block.name) != choice.blocks.end();
}

void check_choice(const ElementChoice& choice, const Mesh& mesh, const std::string& transfer) {
  std::string known;
  for (const ElementBlock& block : mesh.blocks) known += (known.empty() ? "" : ", ") + block.name;
  for (const std::string& name : choice.blocks)
    if (!mesh.find_block(name)) refuse_name(transfer, mesh, "block", name, known);
  known.clear();
  for (const SideSet& set : mesh.side_sets) known += (known.empty() ? "" : ", ") + set.name;
  if (!choice.sides.empty() && !mesh.find_side_set(choice.sides))
    refuse_name(transfer, mesh, "side set", choice.sides, known);
}

void take_blocks(ElementSet& set, const Mesh& mesh, const ElementChoice& choice) {
  bool mixed = false;
  ElementKind first = ElementKind::hex8;
  for (const ElementBlock& block : mesh.blocks) {
    if (!chosen(choice, block)) continue;
    mixed = mixed || (set.stride > 0 && block.kind != first);
    if (set.stride == 0) first = block.kind;
    set.stride = std::max(set.stride, static_cast<std::size_t>(topology(block.kind).nodes));
  }
  const auto most = static_cast<std::size_t>(mesh.elements());
  set.ids.reserve(most), set.items.reserve(most), set.nodes.reserve(most * set.stride);
  if (!mixed) set.kinds.assign(1, first);
  LocalIndex item = 0;
  for (const ElementBlock& block : mesh.blocks) {
    if (!chosen(choice, block)) {
      item += block.size();
      continue;
    }
    for (LocalIndex e = 0; e < block.size(); ++e, ++item) {
      if (block.owners[static_cast<std::size_t>(e)] != mesh.comm.rank()) continue;
      const auto nodes = block.nodes(e);
      set.ids.push_back(block.ids[static_cast<std::size_t>(e)]);
      set.items.push_back(item);
      set.nodes.insert(set.nodes.end(), nodes.begin(), nodes.end());
      set.nodes.resize(set.ids.size() * set.stride, nodes[0]);
      if (mixed) set.kinds.push_back(block.kind);
    }
  }
}

/// Faces of the owned elements of a side set. A face is named by its element and its place there.
void take_faces(ElementSet& set, const Mesh& mesh, const SideSet& sides) {
  std::vector<LocalIndex> first_item{0};
  for (const ElementBlock& block : mesh.blocks) first_item.push_back(first_item.back() + block.size());
  set.stride = max_side_nodes;
  for (const tenon::Side& side : sides.sides) {
    const ElementBlock& block = mesh.blocks[static_cast<std::size_t>(side.block)];
    const Topology& t = topology(block.kind);
    const auto e = static_cast<std::size_t>(side.element), s = static_cast<std::size_t>(side.side);
    if (block.owners[e] != mesh.comm.rank() || t.side_nodes[s] < 3) continue;
    const auto nodes = block.nodes(side.element);
    set.ids.push_back(block.ids[e] * max_sides + side.side);
    set.items.push_back(first_item[static_cast<std::size_t>(side.block)] + side.element);
    set.kinds.push_back(t.side_nodes[s] == 4 ? ElementKind::quad4 : ElementKind::tri3);
    for (std::size_t a = 0; a < max_side_nodes; ++a) {
      const auto corner = a < static_cast<std::size_t>(t.side_nodes[s]) ? a : 0;
      set.nodes.push_back(nodes[static_cast<std::size_t>(t.side[s][corner])]);
    }
  }
}

void refit(Containers& containers, const Mesh& mesh, std::span<const Vec3> coordinates, const std::string& transfer) {
  ElementSet& set = containers.set;
  set.x.resize(coordinates.size() + 1);
  std::copy(coordinates.begin(), coordinates.end(), set.x.begin());
  const Fitted fitted = fit(set, containers.tolerance);
  std::optional<Error> error;
  if (fitted.inverted != no_index) error = inverted_error(mesh, set, fitted.inverted, transfer);
  mesh.comm.throw_if_any(error);
  containers.skipped = mesh.comm.sum(fitted.flat);
  containers.count = mesh.comm.sum(fitted.sound);
  ExactSum sizes = fitted.exact_sizes;
  sizes.add(fitted.sizes);
  const double total = mesh.comm.sum(sizes);
  // Rounded, since sums of solids depend on the ranks in their last bits.
  const double mean = containers.count > 0 ? total / static_cast<double>(containers.count) : 0.0;
  containers.mean_size = static_cast<double>(static_cast<float>(mean));
}

}  // namespace

Containers containers_of(const Mesh& mesh, std::span<const Vec3> coordinates, const ElementChoice& choice,
                         double tolerance, const std::string& transfer) {
  check_choice(choice, mesh, transfer);
  Containers containers;
  containers.tolerance = tolerance;
  containers.set.rank = mesh.comm.rank();
  if (choice.sides.empty()) {
    take_blocks(containers.set, mesh, choice);
    for (const ElementBlock& block : mesh.blocks)
      containers.surfaces = containers.surfaces || (chosen(choice, block) && topology(block.kind).dimension == 2);
  } else {
    take_faces(containers.set, mesh, *mesh.find_side_set(choice.sides));
    containers.surfaces = true;
  }
  refit(containers, mesh, coordinates, transfer);
  return containers;
}

void move_containers(Containers& containers, const Mesh& mesh, std::span<const Vec3> coordinates,
                     const std::string& transfer) {
  refit(containers, mesh, coordinates, transfer);
}

}  // namespace tenon::transfer
