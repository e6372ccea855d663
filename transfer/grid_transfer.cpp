// SPDX-License-Identifier: BSD-3-Clause
#include "transfer/grid_transfer.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

#include "transfer/grid_transfer_impl.hpp"
#include "transfer/spreading.hpp"

namespace tenon::transfer {

namespace {

std::optional<Error> coordinate_error(const Grid& grid, const char* which, const std::string& name) {
  const std::string& of = grid.mesh ? grid.mesh->source : grid.cloud->source;
  const std::size_t expected = grid.mesh ? static_cast<std::size_t>(grid.mesh->nodes()) : grid.cloud->ids.size();
  if (grid.coordinates.size() != expected)
    return Error(ExitCode::usage,
                 fmt::format("transfer '{}': {} coordinates for {} local {} of the {} {}", name,
                             grid.coordinates.size(), expected, grid.mesh ? "nodes" : "points", which, of));
  for (std::size_t n = 0; n < grid.coordinates.size(); ++n) {
    const Vec3& x = grid.coordinates[n];
    if (std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2])) continue;
    return Error(ExitCode::geometry,
                 fmt::format("transfer '{}': {} {} of the {} {} is at ({}, {}, {}), not a place; the run that moved "
                             "it has become unstable, or the file is damaged",
                             name, grid.mesh ? "node" : "point",
                             grid.mesh ? grid.mesh->node_labels[n] : grid.cloud->ids[n], which, of, x[0], x[1], x[2]));
  }
  return std::nullopt;
}

/// Collective.
void check_grid(const Grid& grid, const char* which, const std::string& name) {
  if (!grid.mesh && !grid.cloud) refuse(name, fmt::format("the {} has neither a mesh nor points", which));
  if (grid.mesh && grid.location != Location::node && grid.location != Location::element)
    refuse(name, fmt::format("the {} field lives on a {}; of a mesh only nodes and elements can be transferred", which,
                             to_string(grid.location)));
  if (!grid.mesh && grid.location != Location::particle)
    refuse(name, fmt::format("the {} field lives on a {}, but {} has only points: its location is particle", which,
                             to_string(grid.location), grid.cloud->source));
  const Communicator& comm = grid.mesh ? grid.mesh->comm : grid.cloud->comm;
  std::optional<Error> error = coordinate_error(grid, which, name);
  if (!error && !grid.mesh &&
      std::adjacent_find(grid.cloud->ids.begin(), grid.cloud->ids.end(), std::greater_equal<>()) !=
          grid.cloud->ids.end())
    error = Error(ExitCode::usage, fmt::format("transfer '{}': the ids of {} do not ascend", name, grid.cloud->source));
  comm.throw_if_any(error);
}

Partner partner_of(const Grid& grid) {
  Partner partner;
  partner.mesh = grid.mesh;
  partner.cloud = grid.mesh ? nullptr : grid.cloud;
  partner.location = grid.location;
  partner.choice = {grid.blocks, grid.sides};
  partner.nodes = grid.mesh ? items_of(*grid.mesh, Location::node) : items_of(*grid.cloud);
  if (grid.location == Location::element) partner.elements = items_of(*grid.mesh, grid.location);
  partner.coordinates = grid.coordinates;
  return partner;
}

}  // namespace

namespace {

/// Tells coordinates apart that differ in any bit, but for one chance in 2^64.
std::uint64_t fingerprint(std::span<const Vec3> coordinates) {
  std::uint64_t hash = coordinates.size();
  for (const Vec3& x : coordinates)
    for (const double c : x) hash = std::rotl((hash ^ std::bit_cast<std::uint64_t>(c)) * 0x9e3779b97f4a7c15, 29);
  return hash;
}

PointStatus status_of(const Placement& place, bool dropped) {
  if (dropped) return PointStatus::value;
  return place.state == PlaceState::outside ? PointStatus::nearest : PointStatus::extrapolated;
}

/// The faces that nearest_projection projects to: unless the user chose, surface elements, or the skin of solids.
ElementChoice surface_choice(const Partner& source, const std::string& name) {
  ElementChoice choice = source.choice;
  if (!choice.sides.empty()) return choice;
  std::vector<std::string> surfaces;
  for (const ElementBlock& block : source.mesh->blocks)
    if (topology(block.kind).dimension == 2 &&
        (choice.blocks.empty() ||
         std::find(choice.blocks.begin(), choice.blocks.end(), block.name) != choice.blocks.end()))
      surfaces.push_back(block.name);
  if (!surfaces.empty()) {
    choice.blocks = surfaces;
  } else {
    if (!source.mesh->find_side_set("skin"))
      refuse(name, fmt::format("{} has neither surface elements nor a side set 'skin' to project to; name a side set",
                               source.mesh->source));
    choice.sides = "skin";
  }
  return choice;
}

}  // namespace

void GridTransfer::Impl::interpolate(bool again) {
  if (!source.mesh)
    refuse(name, fmt::format("{} has only points, no elements to interpolate in; use method moving_least_squares",
                             source.name()));
  const bool onto_surface = method == Method::nearest_projection;
  const PlaceRules rules{options.tolerance, options.outside == OutsidePolicy::extrapolate && !onto_surface};
  if (!again) {
    const ElementChoice choice = onto_surface ? surface_choice(source, name) : source.choice;
    containers = containers_of(*source.mesh, source.coordinates, choice, rules.tolerance, name);
    locator = std::make_unique<Locator>(comm(), rules, options.moving, name + ".locate");
  } else {
    move_containers(containers, *source.mesh, source.coordinates, name);
  }
  std::vector<Vec3> centres;
  std::span<const Vec3> points = target.coordinates;
  if (target.location == Location::element) centres = local_points(target.side()), points = centres;
  const std::vector<Placement>& places =
      again ? locator->find_again(containers, points, moved) : locator->find(containers, points);
  if (locator->decomposed()) moved = 0;
  const bool drop = options.outside == OutsidePolicy::value && !onto_surface;
  // Meshes of the same surface do not match: to be beside the other by less than an element is not to be outside.
  const auto counts = [&](const Placement& place) {
    return place.is_outside() && !(onto_surface && place.distance <= containers.mean_size);
  };
  MissCounter counter;
  for (const LocalIndex item : target.items().owned) {
    const auto i = static_cast<std::size_t>(item);
    counter.add(target.items().ids[i], points[i], places[i].distance, counts(places[i]));
  }
  outside.clear();
  for (std::size_t i = 0; i < places.size(); ++i)
    if (places[i].is_outside())
      outside.push_back({static_cast<LocalIndex>(i),
                         counts(places[i]) ? status_of(places[i], drop) : PointStatus::inside, places[i].distance});
  misses = counter.total(comm(), containers.skipped);
  refuse_misses(misses, options, name);
  const InterpolationSource from{containers.set, source.nodes, source.location, containers.set.stride,
                                 source.items().ids.size()};
  map = interpolation_map(comm(), from, places, drop, options.outside_value, map.take_rows(), name);
  mean_size = containers.mean_size;
  if (!options.moving) containers = {}, locator.reset();
}

void GridTransfer::Impl::conserve() {
  Sought sought;
  const PlaceRules rules{options.tolerance, options.outside == OutsidePolicy::extrapolate};
  if (!source.mesh && field.kind == FieldKind::density)
    refuse(name, fmt::format("'{}' is a density, but {} has points, which fill no volume; transfer a total", field.name,
                             source.name()));
  const bool density = field.kind == FieldKind::density;
  Rows rows = source.mesh ? conservation_rows(source.side(), target.side(), rules, density, name, sought)
                          : spreading_rows(spreading_points(source.items(), source.coordinates), target.side(), rules,
                                           density, name, sought);
  MissCounter counter;
  for (std::size_t i = 0; i < sought.places.size(); ++i) counter.add(sought.ids[i], sought.points[i], sought.places[i]);
  misses = counter.total(comm(), sought.skipped);
  refuse_misses(misses, options, name);
  sought = {};
  rows = share_rows(comm(), target.items(), std::move(rows), name + ".rows");
  map = RowMap(comm(), rows, name);
}

/// Where both sides are the same, values are copied whatever the method. False if they are not.
bool GridTransfer::Impl::copy() {
  // The same nodes do not make the same integrals: what has to keep them needs the same volumes, too.
  const bool integrals = field.kind == FieldKind::density || method == Method::project;
  const auto entries = matching_items(source, target, integrals);
  if (!entries) return false;
  misses = {};
  misses.targets = comm().sum(static_cast<std::int64_t>(target.items().owned.size()));
  outside.clear();
  PointRows rows = map.take_rows();
  rows.resize(1, entries->size());
  constexpr double one = 1;
  if (comm().size() == 1) {
    for (std::size_t i = 0; i < entries->size(); ++i)
      rows.set(i, std::span(&one, 1), [&](std::size_t) { return (*entries)[i].index; });
    map = RowMap(std::move(rows), 0, source.items().ids.size());
    return true;
  }
  SlotTable wanted;
  for (const DirectoryEntry& entry : *entries) wanted.mark(entry.rank, entry.index);
  wanted.number();
  for (std::size_t i = 0; i < entries->size(); ++i)
    rows.set(i, std::span(&one, 1), [&](std::size_t) { return wanted.slot((*entries)[i].rank, (*entries)[i].index); });
  map = RowMap(comm(), std::move(rows), 0, wanted, name);
  return true;
}

/// A map that follows motion keeps the coordinates that it was built for, so the caller's may change.
void GridTransfer::Impl::keep_built() {
  if (!options.moving) return;
  source.coordinates = source.built, target.coordinates = target.built;
}

void GridTransfer::Impl::build(bool again) {
  copied = copy();
  projection.reset();
  if (copied) {
    locator.reset();
  } else if (method == Method::copy) {
    refuse(name, fmt::format("method copy needs the same items at the same places on both sides, with the same ids; {} "
                             "and {} differ: use method automatic",
                             source.name(), target.name()));
  } else if (method == Method::conserve) {
    target.mesh ? conserve() : conserve_onto_points();
  } else if (method == Method::project) {
    project();
  } else if (method == Method::moving_least_squares) {
    fit();
  } else {
    interpolate(again && options.moving && locator != nullptr);
  }
  if (options.moving && !locator) mean_size = mean_spacing(target);
  for (Partner* partner : {&source, &target}) {
    if (!options.moving) partner->built_fingerprint = fingerprint(partner->coordinates);
    if (options.moving) partner->built.assign(partner->coordinates.begin(), partner->coordinates.end());
  }
  keep_built();
  source.volumes.clear();
  target.volumes.clear();
  ++built;
}

void GridTransfer::Impl::apply(std::span<const TransferItem> fields) const {
  std::size_t width = 0;
  for (const TransferItem& f : fields) {
    const auto n = static_cast<std::size_t>(f.components);
    if (f.source.size() != n * source.items().ids.size() || f.target.size() != n * target.items().ids.size())
      refuse(name,
             fmt::format("apply() was given {} values of the source and {} of the target, of {} components; this "
                         "rank has {} and {} local items",
                         f.source.size(), f.target.size(), n, source.items().ids.size(), target.items().ids.size()));
    width += n;
  }
  if (broken) refuse(name, "its last update failed, so there is no map to apply");
  ++applied;
  if (projection) {
    for (const TransferItem& f : fields) projection->apply(f.source, f.target, f.components);
    return;
  }
  if (map.direct()) {
    for (const TransferItem& f : fields) map.multiply(f.source, f.target, f.components);
    return;
  }
  if (gathered.size() < width * map.slots()) gathered.resize(width * map.slots());
  messages.clear();
  double* place = gathered.data();
  for (const TransferItem& f : fields) {
    const auto n = static_cast<std::size_t>(f.components);
    messages.push_back(
        {reinterpret_cast<const std::byte*>(f.source.data()), reinterpret_cast<std::byte*>(place), n * sizeof(double)});
    place += n * map.slots();
  }
  map.gather(messages);
  place = gathered.data();
  for (const TransferItem& f : fields) {
    const auto n = static_cast<std::size_t>(f.components);
    map.multiply({place, n * map.slots()}, f.target, f.components);
    place += n * map.slots();
  }
}

GridTransfer::GridTransfer(const Grid& source, const Grid& target, const FieldDescription& field,
                           const TransferOptions& options, std::string name)
    : impl_(std::make_unique<Impl>()) {
  impl_->name = std::move(name);
  impl_->field = field;
  impl_->options = options;
  check_options(options, impl_->name);
  check_grid(source, "source", impl_->name);
  check_grid(target, "target", impl_->name);
  impl_->method = choose_method(field, source, options, impl_->name);
  impl_->source = partner_of(source);
  impl_->target = partner_of(target);
  impl_->build(false);
}

GridTransfer::~GridTransfer() = default;
GridTransfer::GridTransfer(GridTransfer&&) noexcept = default;
GridTransfer& GridTransfer::operator=(GridTransfer&&) noexcept = default;

void GridTransfer::apply(std::span<const double> source, std::span<double> target, int components) const {
  const TransferItem item{source, target, components};
  impl_->apply(std::span(&item, 1));
}

void GridTransfer::apply(std::span<const TransferItem> fields) const {
  impl_->apply(fields);
}

namespace {

/// Square of the greatest distance from where the map was built, m^2; infinite if a coordinate is no number.
double farthest_squared(const Partner& partner) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  double farthest = 0;
  for (std::size_t i = 0; i < partner.built.size(); ++i) {
    const Vec3 way = partner.coordinates[i] - partner.built[i];
    const double squared = dot(way, way);
    if (!(squared <= farthest)) farthest = squared < infinite ? squared : infinite;  // what is not a number, too
  }
  return farthest;
}

}  // namespace

/// How far anything has moved on any rank since the map was built, m.
double GridTransfer::Impl::farthest_motion(std::span<const Vec3> source_now, std::span<const Vec3> target_now) {
  const auto check = [&] {
    check_grid({source.mesh, source_now, source.location, source.cloud}, "source", name);
    check_grid({target.mesh, target_now, target.location, target.cloud}, "target", name);
  };
  const bool kept = source.built.size() == source_now.size() && target.built.size() == target_now.size();
  if (!options.moving || comm().any(!kept)) check();  // which also refuses arrays of another length
  source.coordinates = source_now, target.coordinates = target_now;
  if (!options.moving) {
    const auto same = [](const Partner& partner) {
      return fingerprint(partner.coordinates) == partner.built_fingerprint;
    };
    return comm().any(!same(source) || !same(target)) ? std::numeric_limits<double>::infinity() : 0.0;
  }
  const double farthest = comm().max(std::max(farthest_squared(source), farthest_squared(target)));
  if (!std::isfinite(farthest)) check();
  return std::sqrt(farthest);
}

bool GridTransfer::update(std::span<const Vec3> source_coordinates, std::span<const Vec3> target_coordinates) {
  Impl& impl = *impl_;
  const double farthest = impl.farthest_motion(source_coordinates, target_coordinates);
  if (farthest == 0 && !impl.broken) return impl.keep_built(), false;
  if (impl.options.moving && !impl.broken) {
    constexpr double rigid_tolerance = 1e-10;  // of an element's size
    if (moved_rigidly(impl.source, impl.target, rigid_tolerance * impl.mean_size)) {
      ++impl.rigid;
      return impl.keep_built(), false;
    }
    impl.moved += farthest;
  }
  const bool again = !impl.broken;
  impl.broken = true;  // unless the map gets done
  if (!again) impl.locator.reset();
  impl.build(again);
  impl.broken = false;
  return true;
}

std::int64_t GridTransfer::memory() const {
  const auto bytes = [](const auto& v) { return static_cast<std::int64_t>(v.capacity() * sizeof(v[0])); };
  std::int64_t sum = impl_->map.memory() + bytes(impl_->gathered) + bytes(impl_->messages) + bytes(impl_->outside);
  for (const Partner* p : {&impl_->source, &impl_->target})
    sum += bytes(p->built) + bytes(p->volumes) + p->nodes.memory() + p->elements.memory();
  const ElementSet& set = impl_->containers.set;
  sum += bytes(set.x) + bytes(set.nodes) + bytes(set.ids) + bytes(set.items) + bytes(set.boxes);
  if (impl_->projection) sum += impl_->projection->memory();
  return sum + (impl_->locator ? impl_->locator->memory() : 0);
}

std::int64_t GridTransfer::rigid_motions() const {
  return impl_->rigid;
}

std::int64_t GridTransfer::searched() const {
  return impl_->locator ? impl_->locator->searched() : 0;
}

void GridTransfer::status(std::span<PointStatus> status, std::span<double> distance) const {
  const std::size_t items = impl_->target.items().ids.size();
  if (status.size() != items || distance.size() != items)
    refuse(impl_->name, fmt::format("status() was given {} and {} places; this rank has {} local target items",
                                    status.size(), distance.size(), items));
  std::fill(status.begin(), status.end(), PointStatus::inside);
  std::fill(distance.begin(), distance.end(), 0.0);
  for (const OutsideItem& item : impl_->outside) {
    status[static_cast<std::size_t>(item.item)] = item.status;
    distance[static_cast<std::size_t>(item.item)] = item.distance;
  }
}

std::span<const Vec3> GridTransfer::built_source() const {
  return impl_->source.built;
}

std::span<const Vec3> GridTransfer::built_target() const {
  return impl_->target.built;
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
