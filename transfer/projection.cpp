// SPDX-License-Identifier: BSD-3-Clause
#include "transfer/projection.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "transfer/integral_keeper.hpp"
#include "transfer/projection_rows.hpp"

namespace tenon::transfer {

struct Projection::Impl {
  const Mesh* target = nullptr;
  bool to_nodes = true;
  ProjectionOptions options;
  ProjectionRows rows;
  MassMatrix mass;
  IntegralKeeper keeper;
  GlobalId points = 0, points_outside = 0;
  mutable ProjectionOutcome outcome;
  mutable std::vector<double> gathered, values, residual, low, high;

  void find_bounds(std::size_t components) const;
  void project(std::span<double> result, int components) const;
};

namespace {

void check_target(const Side& target, const std::string& name) {
  // Blocks are the same on every rank, so all of them throw.
  for (const ElementBlock& block : target.mesh.blocks)
    if (topology(block.kind).nodes > max_linear_nodes)
      throw Error(ExitCode::usage,
                  fmt::format("transfer '{}': block '{}' of {} consists of {} elements, onto which nothing can be "
                              "projected; use method interpolate, or a target of linear elements",
                              name, block.name, target.mesh.source, topology(block.kind).name));
}

/// Widens the bounds of each row by the values that it draws on.
void widen(const SparseRows<double>& rows, std::span<const double> values, std::size_t width, std::span<double> low,
           std::span<double> high) {
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t k = rows.first(i); k < rows.last(i); ++k)
      for (std::size_t c = 0; c < width; ++c) {
        const double v = values[static_cast<std::size_t>(rows.column[k]) * width + c];
        low[i * width + c] = std::min(low[i * width + c], v);
        high[i * width + c] = std::max(high[i * width + c], v);
      }
}

}  // namespace

Projection::Projection(const Side& source, const Side& target, const PlaceRules& rules,
                       const ProjectionOptions& options, const std::string& name, Sought& sought)
    : impl_(std::make_unique<Impl>()) {
  check_target(target, name);
  impl_->target = &target.mesh;
  impl_->to_nodes = target.location == Location::node;
  impl_->options = options;
  const Side nodes{target.mesh, target.coordinates, Location::node, target.nodes, target.nodes};
  const RowMap interpolation = interpolation_map(source, nodes, rules, false, 0.0, name + ".values", sought);
  SampleTables tables;
  const TargetSamples samples =
      samples_in_target(source, target, {rules.tolerance, false}, options.points_per_edge, tables, name);
  impl_->points = samples.points, impl_->points_outside = samples.outside;
  NodeElements around;
  if (impl_->to_nodes) {
    around = node_elements(target.mesh);
    impl_->mass = MassMatrix(target, around);
  }
  std::vector<double> volumes = item_volumes(target.mesh, target.coordinates, target.location);
  impl_->rows = projection_rows(source, target, interpolation, samples, tables, around, impl_->mass, volumes, name);
  impl_->keeper = IntegralKeeper(source, target, std::move(volumes));
}

Projection::Projection(Projection&&) noexcept = default;
Projection& Projection::operator=(Projection&&) noexcept = default;
Projection::~Projection() = default;

void Projection::Impl::find_bounds(std::size_t width) const {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const std::size_t size = rows.values.size() * width;
  low.assign(size, infinite), high.assign(size, -infinite);
  widen(rows.values, gathered, width, low, high);
  if (to_nodes) widen(rows.residual, gathered, width, low, high);
}

/// To all owned nodes, or all local elements.
void Projection::Impl::project(std::span<double> result, int components) const {
  if (!to_nodes) return rows.values.multiply(gathered, result, components);
  const auto width = static_cast<std::size_t>(components);
  values.resize(rows.values.size() * width), residual.resize(values.size());
  rows.values.multiply(gathered, values, components);
  rows.residual.multiply(gathered, residual, components);
  mass.solve(residual, result, components);
  for (std::size_t k = 0; k < target->owned_nodes.size(); ++k)
    for (std::size_t c = 0; c < width; ++c)
      result[static_cast<std::size_t>(target->owned_nodes[k]) * width + c] += values[k * width + c];
}

void Projection::apply(std::span<const double> source, std::span<double> target, int components) const {
  const Impl& impl = *impl_;
  const auto width = static_cast<std::size_t>(components);
  impl.gathered.resize(impl.rows.columns * width);
  impl.rows.gather.forward(source, std::span<double>(impl.gathered), components);
  impl.project(target, components);
  impl.outcome = {};
  if (impl.options.bounded) {
    impl.find_bounds(width);
    impl.keeper.clip(target, components, impl.low, impl.high, impl.outcome);
    if (impl.to_nodes)
      impl.keeper.give_to_neighbours(impl.mass.rows(), impl.target->node_halo, target, components, impl.low, impl.high);
    if (impl.options.keep_integral)
      impl.keeper.keep_within(source, target, components, impl.low, impl.high, impl.outcome);
  } else if (impl.options.keep_integral) {
    impl.keeper.keep(source, target, components, impl.outcome);
  }
  if (impl.to_nodes && impl.target->comm.size() > 1)
    impl.target->node_halo.forward(std::span<const double>(target), target, components);
}

const ProjectionOutcome& Projection::outcome() const {
  return impl_->outcome;
}

GlobalId Projection::points() const {
  return impl_->points;
}

GlobalId Projection::points_outside() const {
  return impl_->points_outside;
}

std::int64_t Projection::memory() const {
  std::int64_t bytes =
      impl_->rows.values.memory() + impl_->rows.residual.memory() + impl_->mass.memory() + impl_->keeper.memory();
  for (const std::vector<double>* v : {&impl_->gathered, &impl_->values, &impl_->residual, &impl_->low, &impl_->high})
    bytes += static_cast<std::int64_t>(v->capacity() * sizeof(double));
  return bytes;
}

}  // namespace tenon::transfer
