// SPDX-License-Identifier: BSD-3-Clause
#include "transfer/grid_transfer.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>

#include "transfer/grid_transfer_impl.hpp"

namespace tenon::transfer {

namespace {

[[noreturn]] void refuse(const std::string& name, const std::string& why) {
  throw Error(ExitCode::usage, fmt::format("transfer '{}': {}", name, why));
}

/// The method that the kind of the field asks for. Depends on arguments that are the same on every rank.
Method choose_method(const FieldDescription& field, const TransferOptions& options, const std::string& name) {
  if (field.kind == FieldKind::flux)
    refuse(name,
           fmt::format("'{}' is a flux; fluxes belong to surfaces, which cannot be transferred: give a total or a "
                       "density",
                       field.name));
  const bool interpolated = field.kind == FieldKind::point_value;
  Method method = options.method;
  if (method == Method::automatic) method = interpolated ? Method::interpolate : Method::conserve;
  if (method == Method::interpolate && field.kind == FieldKind::total)
    refuse(name, fmt::format("'{}' is a total, an amount per node or element, and cannot be interpolated; use method "
                             "conserve or automatic",
                             field.name));
  if (method == Method::conserve && interpolated)
    refuse(name,
           fmt::format("'{}' is a point value and has no amount to conserve; use method interpolate or automatic, "
                       "or transfer the amount itself (say, energy instead of temperature)",
                       field.name));
  if (method == Method::conserve && options.outside == OutsidePolicy::value)
    refuse(name, fmt::format("outside policy 'value' would lose the amounts of '{}' outside the target; use nearest, "
                             "extrapolate or error",
                             field.name));
  return method;
}

void check_options(const TransferOptions& options, const std::string& name) {
  if (!(options.tolerance >= 0 && options.tolerance < 0.1))
    refuse(name,
           fmt::format("tolerance {} is not a fraction of an element's size between 0 and 0.1", options.tolerance));
  if (!(options.greatest_distance >= 0))
    refuse(name, fmt::format("greatest distance {} m is negative", options.greatest_distance));
}

/// Collective.
void check_grid(const Grid& grid, const char* which, const std::string& name) {
  if (!grid.mesh) refuse(name, fmt::format("the {} has no mesh", which));
  if (grid.location != Location::node && grid.location != Location::element)
    refuse(name, fmt::format("the {} field lives on a {}; only nodes and elements can be transferred", which,
                             to_string(grid.location)));
  const Mesh& mesh = *grid.mesh;
  std::optional<Error> error;
  if (grid.coordinates.size() != static_cast<std::size_t>(mesh.nodes()))
    error = Error(ExitCode::usage, fmt::format("transfer '{}': {} coordinates for {} local nodes of the {} {}", name,
                                               grid.coordinates.size(), mesh.nodes(), which, mesh.source));
  for (std::size_t n = 0; !error && n < grid.coordinates.size(); ++n) {
    const Vec3& x = grid.coordinates[n];
    if (!std::isfinite(x[0]) || !std::isfinite(x[1]) || !std::isfinite(x[2]))
      error =
          Error(ExitCode::geometry,
                fmt::format("transfer '{}': node {} of the {} {} is at ({}, {}, {}), not a place; the run that moved "
                            "it has become unstable, or the file is damaged",
                            name, mesh.node_labels[n], which, mesh.source, x[0], x[1], x[2]));
  }
  mesh.comm.throw_if_any(error);
}

Partner partner_of(const Grid& grid) {
  Partner partner;
  partner.mesh = grid.mesh;
  partner.location = grid.location;
  partner.nodes = items_of(*grid.mesh, Location::node);
  if (grid.location == Location::element) partner.elements = items_of(*grid.mesh, grid.location);
  partner.coordinates.assign(grid.coordinates.begin(), grid.coordinates.end());
  return partner;
}

void refuse_misses(const Misses& misses, const TransferOptions& options, const std::string& name) {
  const bool too_far = options.outside != OutsidePolicy::value && misses.greatest_distance > options.greatest_distance;
  if (misses.outside == 0 || (options.outside != OutsidePolicy::error && !too_far)) return;
  const Vec3& x = misses.farthest;
  throw Error(
      ExitCode::geometry,
      fmt::format("transfer '{}': {} of {} points lie outside the mesh; the farthest is at ({:.6g}, {:.6g}, {:.6g}), "
                  "{:.6g} m away ({}); check the placement of the meshes, or choose another outside policy{}",
                  name, misses.outside, misses.targets, x[0], x[1], x[2], misses.greatest_distance,
                  too_far ? fmt::format("at most {:.6g} m allowed", options.greatest_distance)
                          : std::string("policy error allows none"),
                  too_far ? " or greatest distance" : ""));
}

}  // namespace

Misses count_misses(const Communicator& comm, const Sought& sought) {
  Misses misses;
  misses.targets = comm.sum(static_cast<std::int64_t>(sought.places.size()));
  misses.skipped = sought.skipped;
  std::int64_t outside = 0;
  std::size_t farthest = 0;
  double distance = -1;
  for (std::size_t i = 0; i < sought.places.size(); ++i) {
    if (!sought.places[i].outside) continue;
    ++outside;
    const double d = sought.places[i].distance;
    // Points of one item stand in canonical order, and items on one rank ascend.
    if (d > distance) distance = d, farthest = i;
  }
  misses.outside = comm.sum(outside);
  const double greatest = comm.max(distance);
  if (greatest < 0) return misses;
  misses.greatest_distance = greatest;
  const GlobalId none = std::numeric_limits<GlobalId>::max();
  const bool candidate = distance == greatest;
  const GlobalId first = comm.min(candidate ? sought.ids[farthest] : none);
  const double nowhere = -std::numeric_limits<double>::infinity();
  misses.farthest = {nowhere, nowhere, nowhere};
  if (candidate && sought.ids[farthest] == first) misses.farthest = sought.points[farthest];
  comm.max(std::span<double>(misses.farthest));
  return misses;
}

void GridTransfer::Impl::build() {
  Sought sought;
  const PlaceRules rules{options.tolerance, options.outside == OutsidePolicy::extrapolate};
  if (method == Method::interpolate) {
    map = interpolation_map(source.side(), target.side(), rules, options.outside == OutsidePolicy::value,
                            options.outside_value, name, sought);
    misses = count_misses(comm(), sought);
    refuse_misses(misses, options, name);
  } else {
    Rows rows = conservation_rows(source.side(), target.side(), rules, field.kind == FieldKind::density, name, sought);
    misses = count_misses(comm(), sought);
    refuse_misses(misses, options, name);
    sought = {};
    rows = share_rows(comm(), target.items(), std::move(rows), name + ".rows");
    map = RowMap(comm(), rows, name);
  }
  source.volumes.clear();
  target.volumes.clear();
  ++built;
}

void GridTransfer::Impl::apply(std::span<const TransferItem> fields) const {
  std::size_t width = 0;
  for (const TransferItem& f : fields) width += static_cast<std::size_t>(f.components);
  if (gathered.size() < width * map.slots()) gathered.resize(width * map.slots());
  messages.clear();
  double* place = gathered.data();
  for (const TransferItem& f : fields) {
    const auto n = static_cast<std::size_t>(f.components);
    assert(f.source.size() == n * source.items().ids.size() && f.target.size() == n * target.items().ids.size());
    messages.push_back(
        {reinterpret_cast<const std::byte*>(f.source.data()), reinterpret_cast<std::byte*>(place), n * sizeof(double)});
    place += n * map.slots();
  }
  map.gather().forward(std::span<const ExchangeItem>(messages));
  place = gathered.data();
  for (const TransferItem& f : fields) {
    const auto n = static_cast<std::size_t>(f.components);
    map.multiply({place, n * map.slots()}, f.target, f.components);
    place += n * map.slots();
  }
  ++applied;
}

GridTransfer::GridTransfer(const Grid& source, const Grid& target, const FieldDescription& field,
                           const TransferOptions& options, std::string name)
    : impl_(std::make_unique<Impl>()) {
  impl_->name = std::move(name);
  impl_->field = field;
  impl_->options = options;
  impl_->method = choose_method(field, options, impl_->name);
  check_options(options, impl_->name);
  check_grid(source, "source", impl_->name);
  check_grid(target, "target", impl_->name);
  impl_->source = partner_of(source);
  impl_->target = partner_of(target);
  impl_->build();
}

GridTransfer::~GridTransfer() = default;

void GridTransfer::apply(std::span<const double> source, std::span<double> target, int components) const {
  const TransferItem item{source, target, components};
  impl_->apply(std::span(&item, 1));
}

void GridTransfer::apply(std::span<const TransferItem> fields) const {
  impl_->apply(fields);
}

bool GridTransfer::update(std::span<const Vec3> source_coordinates, std::span<const Vec3> target_coordinates) {
  const auto moved = [](const Partner& partner, std::span<const Vec3> now) {
    return !std::equal(now.begin(), now.end(), partner.coordinates.begin(), partner.coordinates.end());
  };
  if (!impl_->comm().any(moved(impl_->source, source_coordinates) || moved(impl_->target, target_coordinates)))
    return false;
  check_grid({impl_->source.mesh, source_coordinates, impl_->source.location}, "source", impl_->name);
  check_grid({impl_->target.mesh, target_coordinates, impl_->target.location}, "target", impl_->name);
  impl_->source.coordinates.assign(source_coordinates.begin(), source_coordinates.end());
  impl_->target.coordinates.assign(target_coordinates.begin(), target_coordinates.end());
  impl_->build();
  return true;
}

std::int64_t GridTransfer::memory() const {
  const auto bytes = [](const auto& v) { return static_cast<std::int64_t>(v.capacity() * sizeof(v[0])); };
  std::int64_t sum = impl_->map.memory() + bytes(impl_->gathered) + bytes(impl_->messages);
  for (const Partner* p : {&impl_->source, &impl_->target}) {
    sum += bytes(p->coordinates) + bytes(p->volumes);
    for (const Items* items : {&p->nodes, &p->elements})
      sum += bytes(items->ids) + bytes(items->owners) + bytes(items->at_owner) + bytes(items->owned);
  }
  return sum;
}

std::int64_t GridTransfer::built() const {
  return impl_->built;
}

std::int64_t GridTransfer::applied() const {
  return impl_->applied;
}

Method GridTransfer::method() const {
  return impl_->method;
}

}  // namespace tenon::transfer
