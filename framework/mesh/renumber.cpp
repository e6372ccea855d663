// SPDX-License-Identifier: BSD-3-Clause
#include "framework/mesh/renumber.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include "framework/base/hilbert.hpp"

namespace tenon {

namespace {

// A file's order is left alone unless the curve saves this factor: an order by planes or by parts of a body, which
// fetches each group about twice, runs as fast, and people know their numbers.
constexpr double worthwhile = 2.5;
constexpr GlobalId group_size = 8;
constexpr std::int64_t cached_groups = 1024;

/// `order[new number]` = old number.
using Order = std::vector<GlobalId>;

std::size_t nodes_of(const BlockData& block) {
  return static_cast<std::size_t>(topology(block.kind).nodes);
}

Order identity(std::size_t size) {
  Order order(size);
  std::iota(order.begin(), order.end(), GlobalId{0});
  return order;
}

Order inverse(const Order& order) {
  Order places(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) places[static_cast<std::size_t>(order[i])] = static_cast<GlobalId>(i);
  return places;
}

/// Fisher and Yates; std::shuffle may differ from library to library.
Order shuffled(std::size_t size, std::uint64_t seed) {
  Order order = identity(size);
  std::mt19937_64 random(seed);
  for (std::size_t i = size; i > 1; --i) std::swap(order[i - 1], order[random() % i]);
  return order;
}

Order along_curve(const MeshData& mesh, const BlockData& block, const HilbertCurve& curve) {
  const std::size_t nodes = nodes_of(block);
  const std::vector<LocalIndex> places = curve.order(block.size(), [&](std::size_t e) {
    Vec3 centre{};
    for (std::size_t i = 0; i < nodes; ++i)
      centre = centre + mesh.coordinates[static_cast<std::size_t>(block.connectivity[e * nodes + i])];
    return (1.0 / static_cast<double>(nodes)) * centre;
  });
  return Order(places.begin(), places.end());
}

template <typename T>
void permute(std::vector<T>& values, const Order& order, std::size_t components = 1) {
  std::vector<T> moved(values.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(order[i]) * components),
                components, moved.begin() + static_cast<std::ptrdiff_t>(i * components));
  values.swap(moved);
}

/// One order per block, of its elements.
void order_elements(MeshData& mesh, const std::vector<Order>& orders) {
  Order place(mesh.elements());
  GlobalId first = 0;
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
    BlockData& block = mesh.blocks[b];
    for (std::size_t e = 0; e < orders[b].size(); ++e)
      place[static_cast<std::size_t>(first + orders[b][e])] = first + static_cast<GlobalId>(e);
    permute(block.connectivity, orders[b], nodes_of(block));
    permute(block.labels, orders[b]);
    first += static_cast<GlobalId>(block.size());
  }
  for (SideSetData& set : mesh.side_sets) {
    for (SideData& side : set.sides) side.element = place[static_cast<std::size_t>(side.element)];
    std::sort(set.sides.begin(), set.sides.end());
  }
}

void order_nodes(MeshData& mesh, const Order& order) {
  const Order place = inverse(order);
  permute(mesh.coordinates, order);
  if (!mesh.volumes.empty()) permute(mesh.volumes, order);
  permute(mesh.node_labels, order);
  for (BlockData& block : mesh.blocks)
    for (GlobalId& node : block.connectivity) node = place[static_cast<std::size_t>(node)];
  for (NodeSetData& set : mesh.node_sets) {
    for (GlobalId& node : set.nodes) node = place[static_cast<std::size_t>(node)];
    std::sort(set.nodes.begin(), set.nodes.end());
  }
}

Order by_first_use(const MeshData& mesh) {
  Order order;
  order.reserve(mesh.coordinates.size());
  std::vector<bool> used(mesh.coordinates.size(), false);
  const auto take = [&](GlobalId node) {
    if (!used[static_cast<std::size_t>(node)]) order.push_back(node);
    used[static_cast<std::size_t>(node)] = true;
  };
  for (const BlockData& block : mesh.blocks)
    for (const GlobalId node : block.connectivity) take(node);
  for (std::size_t n = 0; n < used.size(); ++n) take(static_cast<GlobalId>(n));
  return order;
}

void along_hilbert(MeshData& mesh) {
  Box bounds;
  for (const Vec3& x : mesh.coordinates) bounds.add(x);
  const HilbertCurve curve(bounds);
  std::vector<Order> orders;
  for (const BlockData& block : mesh.blocks) orders.push_back(along_curve(mesh, block, curve));
  order_elements(mesh, orders);
  order_nodes(mesh, by_first_use(mesh));
}

void shuffle(MeshData& mesh) {
  std::vector<Order> orders;
  for (const BlockData& block : mesh.blocks) orders.push_back(shuffled(block.size(), orders.size() + 2));
  order_elements(mesh, orders);
  order_nodes(mesh, shuffled(mesh.coordinates.size(), 1));
}

}  // namespace

double fetches_per_group(const MeshData& mesh) {
  const auto groups = (static_cast<GlobalId>(mesh.coordinates.size()) + group_size - 1) / group_size;
  if (groups == 0) return 0;
  std::vector<std::int64_t> last(static_cast<std::size_t>(groups), std::numeric_limits<std::int64_t>::min() / 2);
  std::int64_t fetches = 0;
  for (const BlockData& block : mesh.blocks)
    for (const GlobalId node : block.connectivity) {
      std::int64_t& fetched = last[static_cast<std::size_t>(node / group_size)];
      if (fetches - fetched >= cached_groups) fetched = fetches++;
    }
  return static_cast<double>(fetches) / static_cast<double>(groups);
}

NumberingReport renumber(MeshData& mesh, Numbering numbering) {
  NumberingReport report;
  if (numbering == Numbering::file) return report;
  report.before = report.after = fetches_per_group(mesh);
  if (numbering == Numbering::shuffled) {
    shuffle(mesh);
  } else {
    // Better than one fetch per group no order can be.
    if (numbering == Numbering::automatic && report.before < worthwhile) return report;
    MeshData file;
    if (numbering == Numbering::automatic) file = mesh;
    along_hilbert(mesh);
    report.after = fetches_per_group(mesh);
    if (numbering == Numbering::automatic && report.before < worthwhile * report.after) {
      mesh = std::move(file);
      report.after = report.before;
      return report;
    }
  }
  report.after = fetches_per_group(mesh);
  report.renumbered = true;
  return report;
}

std::string described(const NumberingReport& report) {
  if (!report.renumbered) return "";
  return fmt::format(
      "nodes and elements stand in another order than in the file (each group of nodes is fetched {:.1f} times instead "
      "of {:.1f}); all numbers shown are the file's",
      report.after, report.before);
}

}  // namespace tenon
