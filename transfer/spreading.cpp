// SPDX-License-Identifier: BSD-3-Clause
#include "transfer/spreading.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "transfer/element_points.hpp"

namespace tenon::transfer {

namespace {

constexpr int fewest = 2, most = 6;  // sub-cells along an edge

class Spreader {
 public:
  Spreader(const Side& source, double spacing, bool density) : source_(source), spacing_(spacing), density_(density) {}

  void nodes() {
    for (const LocalIndex n : source_.items.owned) {
      const auto i = static_cast<std::size_t>(n);
      open_group(source_.items.ids[i], {&source_.coordinates[i], 1});
      share(source_.items, i, 1.0, 0.0, [](std::size_t) { return 1.0; });
      close_group();
    }
  }

  void element(const ElementBlock& block, LocalIndex e, LocalIndex item) {
    const Corners corners = corners_of(block, e, source_.coordinates);
    const auto connectivity = block.nodes(e);
    const int nodes = static_cast<int>(connectivity.size());
    const double volume = std::max(0.0, element_measure(block.kind, std::span(corners).first(connectivity.size())));
    const std::vector<TabulatedPoint>& table = points_for(block.kind, volume);
    places_.clear(), volumes_.clear();
    double sum = 0;
    for (const TabulatedPoint& point : table) {
      places_.push_back(position(point, nodes, corners));
      volumes_.push_back(point.weight * std::max(measure(point, block.kind, corners), 0.0));
      sum += volumes_.back();
    }
    const bool by_node = source_.location == Location::node;
    if (!(sum > 0)) {
      // No volume: a total sits at the centre, a density means nothing.
      if (density_) return;
      places_.assign(1, centre_of(block.kind, corners)), volumes_.assign(1, 1.0);
    }
    open_group(block.ids[static_cast<std::size_t>(e)], places_);
    if (!by_node) {
      share(source_.items, static_cast<std::size_t>(item), density_ ? volume : 1.0, volume,
            [&](std::size_t q) { return volumes_[q]; });
    } else {
      const std::array<double, max_nodes> part = node_volumes(block.kind, corners);
      for (std::size_t a = 0; a < connectivity.size(); ++a)
        share(source_.nodes, static_cast<std::size_t>(connectivity[a]), part[a], part[a],
              [&](std::size_t q) { return volumes_[q] * table[q].value[a]; });
    }
    close_group();
  }

  SpreadingPoints take() { return std::move(result_); }

 private:
  const std::vector<TabulatedPoint>& points_for(ElementKind kind, double volume) {
    // The 0.01 keeps equal meshes at the fewest in spite of round-off.
    const double cells = volume > 0 && spacing_ > 0 ? std::ceil(edge_of(kind, volume) / spacing_ - 0.01) : 0.0;
    const int n = static_cast<int>(std::clamp(cells, double{fewest}, double{most}));
    std::vector<TabulatedPoint>& table = subdivisions_[{kind, n}];
    if (table.empty()) table = subdivision_points(kind, n);
    return table;
  }

  /// Integrals of the shape functions over the element, m^3.
  std::array<double, max_nodes> node_volumes(ElementKind kind, const Corners& corners) {
    std::vector<TabulatedPoint>& rule = rules_[kind];
    if (rule.empty()) rule = quadrature_points(kind);
    std::array<double, max_nodes> part{};
    const auto nodes = static_cast<std::size_t>(topology(kind).nodes);
    for (const TabulatedPoint& point : rule) {
      const double w = point.weight * measure(point, kind, corners);
      for (std::size_t a = 0; a < nodes; ++a) part[a] += w * point.value[a];
    }
    return part;
  }

  void open_group(GlobalId id, std::span<const Vec3> places) {
    result_.points.insert(result_.points.end(), places.begin(), places.end());
    result_.ids.insert(result_.ids.end(), places.size(), id);
  }
  /// `weight(q)` of the points of the open group, in any scale.
  template <typename Weight>
  void share(const Items& items, std::size_t item, double amount, double volume, Weight&& weight) {
    const std::size_t count = result_.points.size() - result_.begin.back();
    double sum = 0;
    for (std::size_t q = 0; q < count; ++q) sum += weight(q);
    if (!(sum > 0)) return;
    result_.shares.push_back(
        {items.ids[item], items.owners[item], items.at_owner[item], amount, volume, result_.weights.size()});
    for (std::size_t q = 0; q < count; ++q) result_.weights.push_back(weight(q) / sum);
  }
  void close_group() {
    result_.begin.push_back(result_.points.size());
    result_.first_share.push_back(result_.shares.size());
  }

  const Side& source_;
  double spacing_;
  bool density_;
  SpreadingPoints result_;
  std::map<std::pair<ElementKind, int>, std::vector<TabulatedPoint>> subdivisions_;
  std::map<ElementKind, std::vector<TabulatedPoint>> rules_;
  std::vector<Vec3> places_;
  std::vector<double> volumes_;
};

}  // namespace

SpreadingPoints spreading_points(const Side& source, const Side& target, bool density) {
  // Two points along each edge of a target element, for its nodes; three if it is the element that counts them.
  const double points_per_edge = target.location == Location::node ? 2 : 3;
  Spreader spreader(source, mean_edge(target.mesh, target.coordinates) / points_per_edge, density);
  if (source.location == Location::node && !density) {
    spreader.nodes();
  } else {
    for_each_element(source.mesh, [&](LocalIndex item, const ElementBlock& block, LocalIndex e) {
      if (block.owners[static_cast<std::size_t>(e)] == source.mesh.comm.rank()) spreader.element(block, e, item);
    });
  }
  return spreader.take();
}

SpreadingPoints spreading_points(const Items& points, std::span<const Vec3> places) {
  SpreadingPoints result;
  for (const LocalIndex p : points.owned) {
    const auto i = static_cast<std::size_t>(p);
    result.points.push_back(places[i]);
    result.ids.push_back(points.ids[i]);
    result.shares.push_back({points.ids[i], points.owners[i], points.at_owner[i], 1.0, 0.0, result.weights.size()});
    result.weights.push_back(1.0);
    result.begin.push_back(result.points.size());
    result.first_share.push_back(result.shares.size());
  }
  return result;
}

}  // namespace tenon::transfer
