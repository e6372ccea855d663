// SPDX-License-Identifier: BSD-3-Clause
#include "projection_testing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "transfer/element_points.hpp"

namespace tenon::transfer::testing {

ProjectionPair::ProjectionPair(const Pair& pair, const ProjectionOptions& options)
    : pair_(pair),
      source_nodes_(items_of(*pair.source, Location::node)),
      source_items_(items_of(*pair.source, pair.from)),
      target_nodes_(items_of(*pair.target, Location::node)),
      target_items_(items_of(*pair.target, pair.to)),
      projection_(source(), target(), PlaceRules{1e-9, true}, options, "test", sought_) {}

std::vector<double> ProjectionPair::operator()(const std::vector<double>& values, int components) const {
  // Poisoned, so that a value that is never set shows.
  std::vector<double> result(target_items_.ids.size() * static_cast<std::size_t>(components),
                             std::numeric_limits<double>::quiet_NaN());
  projection_.apply(values, result, components);
  return result;
}

MeshData with_middle_nodes(MeshData mesh) {
  std::map<std::pair<GlobalId, GlobalId>, GlobalId> middle;
  for (BlockData& block : mesh.blocks) {
    const auto corners = static_cast<std::size_t>(topology(block.kind).nodes);
    block.kind = block.kind == ElementKind::hex8 ? ElementKind::hex20 : ElementKind::tet10;
    std::vector<GlobalId> connectivity;
    for (std::size_t first = 0; first < block.connectivity.size(); first += corners) {
      const auto element = std::span(block.connectivity).subspan(first, corners);
      connectivity.insert(connectivity.end(), element.begin(), element.end());
      for (const auto& pair : middle_nodes(block.kind)) {
        const GlobalId a = element[static_cast<std::size_t>(pair[0])], b = element[static_cast<std::size_t>(pair[1])];
        const auto [place, added] =
            middle.try_emplace(std::minmax({a, b}), static_cast<GlobalId>(mesh.coordinates.size()));
        connectivity.push_back(place->second);
        if (!added) continue;
        mesh.coordinates.push_back(
            0.5 * (mesh.coordinates[static_cast<std::size_t>(a)] + mesh.coordinates[static_cast<std::size_t>(b)]));
        mesh.node_labels.push_back(static_cast<std::int64_t>(mesh.coordinates.size()));
      }
    }
    block.connectivity = std::move(connectivity);
  }
  return mesh;
}

double integral(const Mesh& mesh, Location location, const std::vector<double>& values, int components, int component) {
  const std::vector<double> volumes = item_volumes(mesh, mesh.coordinates, location);
  ExactSum sum;
  for (const LocalIndex i : items_of(mesh, location).owned)
    sum.add_product(volumes[static_cast<std::size_t>(i)], values[static_cast<std::size_t>(i * components + component)]);
  return mesh.comm.sum(sum);
}

double integral_of_magnitude(const Mesh& mesh, Location location, std::vector<double> values, int components,
                             int component) {
  for (double& v : values) v = std::abs(v);
  return integral(mesh, location, values, components, component);
}

double relative_l2_error(const Mesh& mesh, Location location, const std::vector<double>& values, const Function& f) {
  ExactSum error, whole;
  for_each_element(mesh, [&](LocalIndex item, const ElementBlock& block, LocalIndex e) {
    if (block.owners[static_cast<std::size_t>(e)] != mesh.comm.rank()) return;
    const Corners corners = corners_of(block, e, mesh.coordinates);
    const auto nodes = block.nodes(e);
    for (const TabulatedPoint& q : subdivision_points(block.kind, 3)) {
      const double w = q.weight * measure(q, block.kind, corners);
      const double exact = f(position(q, static_cast<int>(nodes.size()), corners));
      double value = location == Location::element ? values[static_cast<std::size_t>(item)] : 0.0;
      if (location == Location::node)
        for (std::size_t a = 0; a < nodes.size(); ++a) value += q.value[a] * values[static_cast<std::size_t>(nodes[a])];
      error.add(w * (value - exact) * (value - exact));
      whole.add(w * exact * exact);
    }
  });
  return std::sqrt(mesh.comm.sum(error) / mesh.comm.sum(whole));
}

}  // namespace tenon::transfer::testing
