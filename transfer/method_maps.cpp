// SPDX-License-Identifier: BSD-3-Clause
// Maps of GridTransfer that are made by other means than a search in elements alone: projection and moving least
// squares.
#include <fmt/core.h>

#include "transfer/element_points.hpp"
#include "transfer/grid_transfer_impl.hpp"
#include "transfer/moving_least_squares.hpp"

namespace tenon::transfer {

namespace {

/// Places of the owned items.
std::vector<Vec3> owned_places(const Partner& partner) {
  const std::vector<Vec3> all = places_of(partner);
  std::vector<Vec3> owned;
  owned.reserve(partner.items().owned.size());
  for (const LocalIndex i : partner.items().owned) owned.push_back(all[static_cast<std::size_t>(i)]);
  return owned;
}

}  // namespace

void GridTransfer::Impl::project() {
  if (!source.mesh || !target.mesh)
    refuse(name, fmt::format("{} has only points, and a projection integrates over elements of both sides; use method "
                             "moving_least_squares",
                             source.mesh ? target.name() : source.name()));
  if (options.outside == OutsidePolicy::value)
    refuse(name, "outside policy 'value' would lose what the projection keeps; use nearest, extrapolate or error");
  Sought sought;
  const PlaceRules rules{options.tolerance, options.outside == OutsidePolicy::extrapolate};
  ProjectionOptions how;
  how.bounded = options.bounded;
  projection = std::make_unique<Projection>(source.side(), target.side(), rules, how, name, sought);
  MissCounter counter;
  for (std::size_t i = 0; i < sought.places.size(); ++i) counter.add(sought.ids[i], sought.points[i], sought.places[i]);
  misses = counter.total(comm(), sought.skipped);
  refuse_misses(misses, options, name);
  outside.clear();
  if (target.location != Location::node) return;
  std::vector<double> distance(target.coordinates.size(), 0.0);
  const std::span<const LocalIndex> owned = target.nodes.owned;
  for (std::size_t k = 0; k < owned.size(); ++k)
    if (sought.places[k].is_outside()) distance[static_cast<std::size_t>(owned[k])] = sought.places[k].distance;
  target.mesh->node_halo.forward(std::span<const double>(distance), std::span<double>(distance));
  for (std::size_t i = 0; i < distance.size(); ++i)
    if (distance[i] > 0)
      outside.push_back({static_cast<LocalIndex>(i),
                         rules.extrapolate ? PointStatus::extrapolated : PointStatus::nearest, distance[i]});
}

void GridTransfer::Impl::fit() {
  const std::vector<Vec3> cloud = owned_places(source), targets = places_of(target);
  MovingLeastSquaresOptions how;
  how.neighbours = options.neighbours;
  std::vector<FittedPoint> fitted;
  Rows rows = moving_least_squares_rows(comm(), source.items(), cloud, targets, how, name, fitted);
  MissCounter counter;
  for (const LocalIndex item : target.items().owned) {
    const auto i = static_cast<std::size_t>(item);
    counter.add(target.items().ids[i], targets[i], fitted[i].outside ? fitted[i].distance : 0, fitted[i].outside);
  }
  misses = counter.total(comm(), 0);
  refuse_misses(misses, options, name);
  outside.clear();
  std::vector<Vec3> outer;
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    if (!fitted[i].outside) continue;
    const PointStatus status = options.outside == OutsidePolicy::value         ? PointStatus::value
                               : options.outside == OutsidePolicy::extrapolate ? PointStatus::extrapolated
                                                                               : PointStatus::nearest;
    outside.push_back({static_cast<LocalIndex>(i), status, fitted[i].distance});
    outer.push_back(targets[i]);
  }
  if (options.outside != OutsidePolicy::extrapolate && misses.outside > 0) {
    // Outside, the nearest point's own value, or none.
    Rows others;
    if (options.outside == OutsidePolicy::nearest) {
      how.neighbours = 1;
      others = moving_least_squares_rows(comm(), source.items(), cloud, outer, how, name + ".nearest", fitted);
    } else {
      others.begin.assign(outer.size() + 1, 0);
    }
    rows = with_rows_replaced(rows, outside, others);
  }
  map = RowMap(comm(), rows, name, options.outside == OutsidePolicy::value ? options.outside_value : 0.0);
}

Rows with_rows_replaced(const Rows& rows, std::span<const OutsideItem> items, const Rows& others) {
  Rows result;
  result.terms.reserve(rows.terms.size());
  std::size_t next = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool replaced = next < items.size() && static_cast<std::size_t>(items[next].item) == i;
    const std::span<const Term> row = replaced ? others.row(next++) : rows.row(i);
    result.terms.insert(result.terms.end(), row.begin(), row.end());
    result.begin.push_back(static_cast<std::int64_t>(result.terms.size()));
  }
  return result;
}

void GridTransfer::Impl::conserve_onto_points() {
  if (field.kind != FieldKind::total)
    refuse(name, fmt::format("'{}' is a density, but {} has points, which fill no volume; transfer a total", field.name,
                             target.name()));
  // Each source item lets its amount go at its place: the transpose of a fit at that place.
  const std::vector<Vec3> from = owned_places(source);
  const Items& items = source.items();
  std::vector<SpreadPoint> points;
  for (std::size_t k = 0; k < from.size(); ++k) {
    const auto i = static_cast<std::size_t>(items.owned[k]);
    points.push_back({from[k], items.ids[i], items.owners[i], items.at_owner[i], 1.0});
  }
  MovingLeastSquaresOptions how;
  how.neighbours = options.neighbours;
  std::vector<FittedPoint> fitted;
  const std::vector<Vec3> cloud = owned_places(target);
  Rows rows = moving_least_squares_transpose(comm(), target.items(), cloud, points, how, name, fitted);
  MissCounter counter;
  for (std::size_t k = 0; k < points.size(); ++k)
    counter.add(points[k].source, points[k].x, fitted[k].outside ? fitted[k].distance : 0, fitted[k].outside);
  misses = counter.total(comm(), 0);
  refuse_misses(misses, options, name);
  outside.clear();
  map = RowMap(comm(), share_rows(comm(), target.items(), std::move(rows), name + ".rows"), name);
}

}  // namespace tenon::transfer
