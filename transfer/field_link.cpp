// SPDX-License-Identifier: BSD-3-Clause
#include "transfer/field_link.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "transfer/mesh_items.hpp"

namespace tenon::transfer {

namespace {

template <typename Port>
Port take_port(std::vector<Port> ports, const std::string& field, const std::string& transfer,
               const Component& component, const char* verb) {
  std::string known;
  for (Port& port : ports) {
    if (port.field.name == field) return std::move(port);
    known += (known.empty() ? "" : ", ") + port.field.name;
  }
  throw Error(ExitCode::usage, fmt::format("transfer '{}': component '{}' {} no field '{}'; it {}: {}", transfer,
                                           component.name(), verb, field, verb, known.empty() ? "nothing" : known));
}

void check_pair(const std::string& name, const FieldDescription& from, const FieldDescription& to) {
  const auto refuse = [&](const std::string& why) {
    throw Error(ExitCode::usage,
                fmt::format("transfer '{}': '{}' does not fit '{}': {}", name, from.name, to.name, why));
  };
  if (from.components != to.components) refuse(fmt::format("{} components against {}", from.components, to.components));
  if (from.unit != to.unit) refuse(fmt::format("unit {} against {}", from.unit, to.unit));
  if (from.kind != to.kind) refuse(fmt::format("a {} against a {}", to_string(from.kind), to_string(to.kind)));
}

std::size_t items_at(const Mesh& mesh, Location location) {
  return static_cast<std::size_t>(location == Location::node ? mesh.nodes() : mesh.elements());
}

void accumulate(const std::vector<LocalIndex>& items, std::size_t width, const std::vector<double>& values,
                std::vector<double>& sums) {
  for (std::size_t i = 0; i < items.size(); ++i)
    for (std::size_t c = 0; c < width; ++c)
      sums[i * width + c] += values[static_cast<std::size_t>(items[i]) * width + c];
}

ExactSum exact(const std::vector<double>& values, std::size_t width, std::size_t component) {
  ExactSum sum;
  for (std::size_t i = component; i < values.size(); i += width) sum.add(values[i]);
  return sum;
}

std::string suffix(std::size_t width, std::size_t component) {
  return width == 1 ? "" : std::string("_") + "xyzuvw"[component % 6];
}

/// The places of owned nodes as a checkpoint keeps them.
std::vector<double> owned_coordinates(const Mesh& mesh, std::span<const Vec3> coordinates) {
  std::vector<double> values;
  values.reserve(3 * mesh.owned_nodes.size());
  for (const LocalIndex n : mesh.owned_nodes)
    for (const double c : coordinates[static_cast<std::size_t>(n)]) values.push_back(c);
  return values;
}

void save_coordinates(CheckpointWriter& file, const std::string& name, const Mesh& mesh,
                      std::span<const Vec3> coordinates) {
  const OwnedItems owned = owned_items(mesh, Location::node);
  file.array(name, GlobalOrder(mesh.comm, owned.ids, owned.global_count), owned_coordinates(mesh, coordinates), 3);
}

std::vector<Vec3> load_coordinates(const CheckpointReader& file, const std::string& name, const Mesh& mesh) {
  std::vector<double> values(3 * mesh.node_ids.size());
  file.array(name, GlobalOrder(mesh.comm, mesh.node_ids, mesh.global_nodes), std::span<double>(values), 3);
  std::vector<Vec3> coordinates(mesh.node_ids.size());
  for (std::size_t n = 0; n < coordinates.size(); ++n)
    coordinates[n] = {values[3 * n], values[3 * n + 1], values[3 * n + 2]};
  return coordinates;
}

/// Particles fill no elements in which a point could be sought: they are points. Local; the same on every rank.
bool is_cloud(const Mesh& mesh) {
  return std::ranges::all_of(mesh.blocks,
                             [](const ElementBlock& block) { return block.kind == ElementKind::particle; });
}

/// Of particles, each of which is on one rank only.
PointCloud points_of(const Component& component) {
  const Mesh& mesh = component.mesh();
  return {mesh.comm, is_cloud(mesh) ? mesh.node_ids : std::vector<GlobalId>{}, component.name()};
}

}  // namespace

OwnedItems owned_items(const Mesh& mesh, Location location) {
  OwnedItems owned;
  if (location == Location::node) {
    owned.items = mesh.owned_nodes;
    owned.global_count = mesh.global_nodes;
    for (const LocalIndex n : owned.items) owned.ids.push_back(mesh.node_ids[static_cast<std::size_t>(n)]);
    return owned;
  }
  owned.global_count = mesh.global_elements;
  LocalIndex item = 0;
  for (const ElementBlock& block : mesh.blocks)
    for (std::size_t e = 0; e < block.ids.size(); ++e, ++item)
      if (block.owners[e] == mesh.comm.rank()) {
        owned.items.push_back(item);
        owned.ids.push_back(block.ids[e]);
      }
  return owned;
}

FieldLink::FieldLink(std::string name, Component& source, Component& target, FieldLinkOptions options)
    : Coupling(std::move(name), source, target, options.schedule),
      options_(std::move(options)),
      export_(take_port(source.exports(), options_.source_field, this->name(), source, "gives")),
      import_(take_port(target.imports(), options_.target_field, this->name(), target, "takes")),
      source_points_(points_of(source)),
      target_points_(points_of(target)) {
  check_pair(this->name(), export_.field, import_.field);
  if (options_.schedule == CouplingSchedule::slower_step && !import_.at_source_steps.empty())
    throw Error(ExitCode::usage, fmt::format("transfer '{}': {}, or let it run `every: source_step`", this->name(),
                                             import_.at_source_steps));
  if (linear() && total() && !import_.at_source_steps.empty())
    throw Error(ExitCode::usage, fmt::format("transfer '{}': {}; `between_samples: linear` would keep part of it back",
                                             this->name(), import_.at_source_steps));
  const auto width = static_cast<std::size_t>(export_.field.components);
  source_values_.resize(items_at(source.mesh(), export_.field.location) * width);
  target_values_.resize(items_at(target.mesh(), import_.field.location) * width);
  source_owned_ = owned_items(source.mesh(), export_.field.location).items;
  target_owned_ = owned_items(target.mesh(), import_.field.location).items;
  if (linear()) {
    prepared_values_.resize(target_values_.size());
    if (total())
      release_ = SteadyRelease(target_values_.size());
    else
      line_ = LinearInTime(target_values_.size());
  }
  if (total()) {
    sent_.assign(source_owned_.size() * width, 0.0);
    received_.assign(target_owned_.size() * width, 0.0);
  }
}

void FieldLink::initialize() {
  if (!release_.loaded()) release_.start(source().time());
  build();
}

Grid FieldLink::grid_of(const Component& component, std::span<const Vec3> coordinates, Location location) const {
  Grid grid;
  grid.coordinates = coordinates, grid.location = location;
  if (!is_cloud(component.mesh())) {
    grid.mesh = &component.mesh();
    return grid;
  }
  grid.location = Location::particle;
  grid.cloud = &component == &source() ? &source_points_ : &target_points_;
  return grid;
}

void FieldLink::build() {
  const bool current = options_.configuration == Configuration::current;
  const auto place = [current](const Component& c) {
    return current ? c.current_coordinates() : std::span<const Vec3>(c.mesh().coordinates);
  };
  // After a restart the map is first that of the interrupted run, so that it goes on as if nothing had happened.
  const bool restored = current && restored_;
  Grid from =
      grid_of(source(), restored ? std::span<const Vec3>(source_built_) : place(source()), export_.field.location);
  from.blocks = options_.blocks, from.sides = options_.side_set;
  const Grid to =
      grid_of(target(), restored ? std::span<const Vec3>(target_built_) : place(target()), import_.field.location);
  options_.transfer.moving = current;
  map_ = std::make_unique<GridTransfer>(from, to, export_.field, options_.transfer, name());
}

/// The map goes where the meshes have gone.
void FieldLink::follow() {
  if (options_.configuration != Configuration::current) return;
  if (!map_->update(source().current_coordinates(), target().current_coordinates())) ++updates_skipped_;
  source_built_ = {}, target_built_ = {};
  restored_ = false;
}

void FieldLink::run() {
  const ScopedTimer scope(timer());
  follow();
  export_.read(source_values_);
  map_->apply(source_values_, target_values_, export_.field.components);
  const auto width = static_cast<std::size_t>(export_.field.components);
  if (total()) accumulate(source_owned_, width, source_values_, sent_);
  if (linear() && total()) {
    release_.take(source().time(), target().time(), target_values_);
    return;
  }
  import_.write(target_values_);
  if (total()) accumulate(target_owned_, width, target_values_, received_);
  if (linear()) line_.take(source().time(), target_values_);
}

void FieldLink::prepare(double time) {
  if (!linear() || (!total() && !line_.moves(time))) return;
  if (!total()) {
    line_.at(time, prepared_values_);
    import_.write(prepared_values_);
    return;
  }
  release_.give(target().time(), time, prepared_values_);
  import_.write(prepared_values_);
  accumulate(target_owned_, static_cast<std::size_t>(export_.field.components), prepared_values_, received_);
}

std::vector<double> FieldLink::waiting() const {
  std::vector<double> owned;
  if (!linear() || !total()) return owned;
  const auto width = static_cast<std::size_t>(export_.field.components);
  for (const LocalIndex i : target_owned_)
    for (std::size_t c = 0; c < width; ++c)
      owned.push_back(release_.waiting()[static_cast<std::size_t>(i) * width + c]);
  return owned;
}

std::vector<std::string> FieldLink::report() {
  const TransferReport r = map_->report(source_values_, target_values_, export_.field.components,
                                        options_.full_report ? Thoroughness::full : Thoroughness::sampled);
  std::vector<std::string> lines;
  lines.push_back(fmt::format("{}.{} -> {}.{}: map built {} times, {} rebuilds skipped, applied {} times{}",
                              source().name(), export_.field.name, target().name(), import_.field.name, map_->built(),
                              updates_skipped_, runs(), linear() ? ", linear between samples" : ""));
  lines.push_back(fmt::format("{} points sought, {} outside (greatest distance {:.3g} m at ({:.4g}, {:.4g}, {:.4g}))",
                              r.targets, r.outside, r.greatest_distance, r.farthest[0], r.farthest[1], r.farthest[2]));
  const std::string& unit = export_.field.unit;
  if (total()) {
    const auto width = static_cast<std::size_t>(export_.field.components);
    for (std::size_t c = 0; c < width; ++c) {
      const double sent = source().mesh().comm.sum(exact(sent_, width, c));
      const double arrived = source().mesh().comm.sum(exact(received_, width, c));
      const double waits = source().mesh().comm.sum(exact(waiting(), width, c));
      const double scale = std::max(std::abs(sent), std::abs(arrived));
      lines.push_back(fmt::format("sent{} {:.10g} {}, arrived {:.10g} {}{}, relative mismatch {:.1e}", suffix(width, c),
                                  sent, unit, arrived, unit,
                                  linear() ? fmt::format(", waiting {:.10g} {}", waits, unit) : std::string(),
                                  scale > 0 ? std::abs(sent - arrived - waits) / scale : 0.0));
    }
  } else {
    lines.push_back(
        fmt::format("last values: integral {:.6g} at the source, {:.6g} at the target (mismatch {:.1e}), "
                    "estimated greatest error {:.3g} {}",
                    r.source_integral, r.target_integral, r.mismatch, r.error_estimate, unit));
  }
  if (r.clipped > 0 || r.spread > 0)
    lines.push_back(fmt::format("{} values kept within bounds, {:.1e} of the integral spread over the target",
                                r.clipped, r.spread));
  if (options_.full_report) lines.push_back(round_trip());
  return lines;
}

/// How much the last values lose on the way to the target's mesh and back.
std::string FieldLink::round_trip() const {
  const bool current = options_.configuration == Configuration::current;
  const auto place = [current](const Component& c) {
    return current ? c.current_coordinates() : std::span<const Vec3>(c.mesh().coordinates);
  };
  TransferOptions options = options_.transfer;
  options.moving = false;
  if (options.outside == OutsidePolicy::error) options.outside = OutsidePolicy::nearest;
  options.greatest_distance = std::numeric_limits<double>::infinity();
  try {
    const GridTransfer back(grid_of(target(), place(target()), import_.field.location),
                            grid_of(source(), place(source()), export_.field.location), export_.field, options,
                            name() + ".back");
    return fmt::format("forth and back: values change by {:.3g} {} at most",
                       map_->round_trip_error(back, source_values_, export_.field.components), export_.field.unit);
  } catch (const Error& error) {  // on all ranks
    return std::string("forth and back: there is no way back: ") + error.what();
  }
}

std::vector<std::pair<std::string, ExactSum>> FieldLink::amounts() {
  std::vector<std::pair<std::string, ExactSum>> all;
  if (!total()) return all;
  const auto width = static_cast<std::size_t>(export_.field.components);
  for (std::size_t c = 0; c < width; ++c) {
    all.emplace_back("transfer." + name() + ".sent" + suffix(width, c), exact(sent_, width, c));
    all.emplace_back("transfer." + name() + ".arrived" + suffix(width, c), exact(received_, width, c));
    if (linear()) all.emplace_back("transfer." + name() + ".waiting" + suffix(width, c), exact(waiting(), width, c));
  }
  return all;
}

std::vector<ExportPort> FieldLink::shown_on_target() {
  if (!options_.show_outside) return {};
  const auto port = [&](const char* what, const char* unit, auto&& value) {
    ExportPort result;
    result.field = {"transfer_" + name() + what, import_.field.location, FieldKind::point_value, 1, unit};
    result.read = [this, value](std::span<double> values) {
      std::vector<PointStatus> status(values.size());
      std::vector<double> distance(values.size());
      map_->status(status, distance);
      for (std::size_t i = 0; i < values.size(); ++i) values[i] = value(status[i], distance[i]);
    };
    return result;
  };
  return {port("_status", "1", [](PointStatus status, double) { return static_cast<double>(status); }),
          port("_distance", "m", [](PointStatus, double distance) { return distance; })};
}

void FieldLink::save(CheckpointWriter& file) {
  if (options_.configuration == Configuration::current) {
    save_coordinates(file, "transfer." + name() + ".source_built", source().mesh(), map_->built_source());
    save_coordinates(file, "transfer." + name() + ".target_built", target().mesh(), map_->built_target());
  }
  if (!total() && !linear()) return;
  const OwnedItems to = owned_items(target().mesh(), import_.field.location);
  if (linear()) {
    const GlobalOrder order(target().mesh().comm, to.ids, to.global_count);
    const std::string what = "transfer." + name();
    if (total())
      release_.save(file, what, order, target_owned_, export_.field.components);
    else
      line_.save(file, what, order, target_owned_, export_.field.components);
  }
  if (!total()) return;
  const OwnedItems from = owned_items(source().mesh(), export_.field.location);
  file.array("transfer." + name() + ".sent", GlobalOrder(source().mesh().comm, from.ids, from.global_count), sent_,
             export_.field.components);
  file.array("transfer." + name() + ".arrived", GlobalOrder(target().mesh().comm, to.ids, to.global_count), received_,
             export_.field.components);
}

void FieldLink::load(const CheckpointReader& file) {
  if (options_.configuration == Configuration::current) {
    source_built_ = load_coordinates(file, "transfer." + name() + ".source_built", source().mesh());
    target_built_ = load_coordinates(file, "transfer." + name() + ".target_built", target().mesh());
    restored_ = true;
  }
  if (!total() && !linear()) return;
  const OwnedItems to = owned_items(target().mesh(), import_.field.location);
  if (linear()) {
    const GlobalOrder order(target().mesh().comm, items_of(target().mesh(), import_.field.location).ids,
                            to.global_count);
    const std::string what = "transfer." + name();
    if (total())
      release_.load(file, what, order, export_.field.components);
    else
      line_.load(file, what, order, export_.field.components);
  }
  if (!total()) return;
  const OwnedItems from = owned_items(source().mesh(), export_.field.location);
  file.array("transfer." + name() + ".sent", GlobalOrder(source().mesh().comm, from.ids, from.global_count), sent_,
             export_.field.components);
  file.array("transfer." + name() + ".arrived", GlobalOrder(target().mesh().comm, to.ids, to.global_count), received_,
             export_.field.components);
}

std::int64_t FieldLink::memory() const {
  return (map_ ? map_->memory() : 0) +
         static_cast<std::int64_t>(sizeof(double) *
                                   (source_values_.size() + target_values_.size() + sent_.size() + received_.size() +
                                    prepared_values_.size() + release_.waiting().size() + line_.values()));
}

}  // namespace tenon::transfer
