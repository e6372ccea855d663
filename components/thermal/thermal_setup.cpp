// SPDX-License-Identifier: BSD-3-Clause
// What is prepared once: capacity, loads, held nodes, initial temperatures.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "components/thermal/thermal.hpp"
#include "framework/mesh/shape_functions.hpp"

namespace tenon {
namespace {

const NodeSet& node_set(const Mesh& mesh, const std::string& name) {
  const NodeSet* set = mesh.find_node_set(name);
  if (!set)
    throw Error(ExitCode::usage, fmt::format("heat conduction: the mesh {} has no node set '{}'", mesh.source, name));
  return *set;
}

const ElementBlock& block_named(const Mesh& mesh, const std::string& name) {
  const ElementBlock* block = mesh.find_block(name);
  if (!block)
    throw Error(ExitCode::usage, fmt::format("heat conduction: the mesh {} has no block '{}'", mesh.source, name));
  return *block;
}

}  // namespace

void Thermal::find_blocks() {
  for (const ElementBlock& block : mesh_->blocks) {
    const auto found = std::ranges::find(options_.blocks, block.name, &ThermalBlock::block);
    block_options_.push_back(static_cast<std::size_t>(found - options_.blocks.begin()));
    owned_elements_ += std::ranges::count(block.owners, mesh_->comm.rank());
  }
}

void Thermal::check_stepper() const {
  const auto refuse = [this](const char* what) {
    throw Error(ExitCode::usage, fmt::format("component '{}': {}", name(), what));
  };
  const bool theta_method =
      options_.stepper == ThermalStepper::backward_euler || options_.stepper == ThermalStepper::crank_nicolson;
  if (theta_method && !options_.fixed_step) refuse("this implicit stepper needs time_step.fixed");
  if (is_explicit() && is_nonlinear())
    refuse(
        "the explicit stepper knows no properties over temperature, change of phase or radiation; choose `stepper: "
        "tr_bdf2`");
  if (is_steady() && options_.prescribed.empty() && options_.convection.empty() && options_.radiation.empty())
    refuse("nothing determines the steady temperature; prescribe one, or add convection or radiation");
}

// Enthalpy of the nodes: mass of each block at each of them.
thermal::HeatContent Thermal::make_content(const std::vector<std::map<LocalIndex, double>>& masses) const {
  std::vector<thermal::Enthalpy> enthalpies;
  for (const std::size_t b : block_options_) {
    const ThermalBlock& m = options_.blocks[b];
    enthalpies.push_back({m.specific_heat_over_temperature.value_or(TemperatureTable(m.specific_heat)), m.latent_heat,
                          m.solidus, m.liquidus});
  }
  std::vector<LocalIndex> offsets{0};
  std::vector<thermal::HeatContent::Share> shares;
  for (const std::map<LocalIndex, double>& row : masses) {
    for (const auto& [block, mass] : row) shares.push_back({block, mass});
    offsets.push_back(static_cast<LocalIndex>(shares.size()));
  }
  return {std::move(enthalpies), std::move(offsets), std::move(shares)};
}

// Elements add to their nodes in ascending order. Capacity is that of the reference configuration: mass is kept.
void Thermal::make_capacity() {
  std::array<Vec3, max_linear_nodes> corners;
  std::array<double, max_linear_nodes> volumes{};
  std::vector<std::array<double, max_linear_nodes>> of_elements;
  const bool linear = std::ranges::all_of(
      options_.blocks, [](const ThermalBlock& m) { return !m.specific_heat_over_temperature && m.latent_heat == 0; });
  std::vector<std::map<LocalIndex, double>> masses(linear ? 0 : capacity_.size());
  for (std::size_t b = 0; b < mesh_->blocks.size(); ++b) {
    const ElementBlock& block = mesh_->blocks[b];
    const ThermalBlock& material = options_.blocks[block_options_[b]];
    const double per_volume = material.density * material.specific_heat;  // without a table
    for (LocalIndex e = 0; e < block.size(); ++e) {
      const auto nodes = block.nodes(e);
      for (std::size_t a = 0; a < nodes.size(); ++a) corners[a] = coordinates_[static_cast<std::size_t>(nodes[a])];
      thermal::nodal_volumes(block.kind, std::span(corners).first(nodes.size()),
                             std::span(volumes).first(nodes.size()));
      std::array<double, max_linear_nodes> mine{};
      for (std::size_t a = 0; a < nodes.size(); ++a) {
        mine[a] = per_volume * volumes[a];
        const LocalIndex row = matrix_.row_of_node()[static_cast<std::size_t>(nodes[a])];
        if (row == no_index) continue;
        volume_[static_cast<std::size_t>(row)] += volumes[a];
        capacity_[static_cast<std::size_t>(row)] += mine[a];
        if (!linear) masses[static_cast<std::size_t>(row)][static_cast<LocalIndex>(b)] += material.density * volumes[a];
      }
      if (is_explicit()) of_elements.push_back(mine);
    }
  }
  if (is_explicit()) matrix_.bound_with(std::move(of_elements));
  if (!linear) content_ = make_content(masses);
}

void Thermal::make_loads() {
  for (const SurfaceFlux& f : options_.fluxes) flux_loads_.push_back({thermal::Surface(*mesh_, f.side_set), f.flux});
  for (const Convection& c : options_.convection)
    convection_loads_.push_back({thermal::Surface(*mesh_, c.side_set), c.coefficient, c.ambient});
  for (const Radiation& r : options_.radiation)
    radiation_loads_.push_back({thermal::Surface(*mesh_, r.side_set), r.emissivity, r.ambient});
  std::array<Vec3, max_linear_nodes> corners;
  std::array<double, max_linear_nodes> volumes{};
  for (const HeatSource& s : options_.sources) {
    const ElementBlock& block = block_named(*mesh_, s.block);
    std::map<LocalIndex, double> volume_of_row;
    for (LocalIndex e = 0; e < block.size(); ++e) {
      const auto nodes = block.nodes(e);
      for (std::size_t a = 0; a < nodes.size(); ++a) corners[a] = coordinates_[static_cast<std::size_t>(nodes[a])];
      thermal::nodal_volumes(block.kind, std::span(corners).first(nodes.size()),
                             std::span(volumes).first(nodes.size()));
      for (std::size_t a = 0; a < nodes.size(); ++a) {
        const LocalIndex row = matrix_.row_of_node()[static_cast<std::size_t>(nodes[a])];
        if (row != no_index) volume_of_row[row] += volumes[a];
      }
    }
    SourceLoad& load = source_loads_.emplace_back();
    load.power = s.power;
    for (const auto& [row, volume] : volume_of_row) {
      load.rows.push_back(row);
      load.volumes.push_back(volume);
    }
  }
  booked_ = {true,
             !flux_loads_.empty(),
             !convection_loads_.empty(),
             !source_loads_.empty() || options_.source_function,
             !options_.prescribed.empty(),
             !radiation_loads_.empty(),
             is_steady()};
  for (std::size_t kind = 0; kind < supplies; ++kind)
    if (booked_[kind]) supplied_[kind].assign(capacity_.size(), 0.0);
}

void Thermal::make_held() {
  std::map<LocalIndex, std::size_t> function_of_row;
  for (std::size_t f = 0; f < options_.prescribed.size(); ++f)
    for (const LocalIndex n : node_set(*mesh_, options_.prescribed[f].node_set).nodes)
      if (const LocalIndex row = matrix_.row_of_node()[static_cast<std::size_t>(n)]; row != no_index)
        function_of_row[row] = f;
  for (const auto& [row, f] : function_of_row) held_.push_back({row, f});
}

void Thermal::set_initial(const InitialTemperature& initial) {
  const auto set = [&](LocalIndex n) {
    const LocalIndex row = matrix_.row_of_node()[static_cast<std::size_t>(n)];
    if (row == no_index) return;
    const Vec3& x = mesh_->coordinates[static_cast<std::size_t>(n)];
    initial_[static_cast<std::size_t>(row)] = initial.value + dot(initial.gradient, x);
  };
  if (!initial.node_set.empty()) {
    for (const LocalIndex n : node_set(*mesh_, initial.node_set).nodes) set(n);
  } else if (!initial.block.empty()) {
    for (const LocalIndex n : block_named(*mesh_, initial.block).connectivity) set(n);
  } else {
    for (const LocalIndex n : mesh_->owned_nodes) set(n);
  }
}

// A node between two blocks starts at the reference temperature of the first one.
void Thermal::set_initial_temperatures() {
  for (std::size_t b = mesh_->blocks.size(); b-- > 0;)
    set_initial({mesh_->blocks[b].name, "", options_.blocks[block_options_[b]].reference_temperature, {}});
  for (const InitialTemperature& initial : options_.initial) set_initial(initial);
  if (options_.initial_function)
    for (std::size_t k = 0; k < initial_.size(); ++k)
      initial_[k] = options_.initial_function(mesh_->coordinates[static_cast<std::size_t>(mesh_->owned_nodes[k])]);
  for (const Held& held : held_)
    initial_[static_cast<std::size_t>(held.row)] = options_.prescribed[held.function].temperature(time());
}

void Thermal::initialize() {
  assemble_time_ = &phase("assemble");
  load_time_ = &phase("loads");
  solve_time_ = &phase("solve");
  update_time_ = &phase("update");
  if (!loaded_) set_initial_temperatures();
  show_temperatures();
  assemble();
  if (loaded_) multigrid_stale_ = loaded_stale_;
  prepare_solution();
  check_fixed_step();
}

// Nodes that are held, and nodes of no element, have no equation of their own.
void Thermal::prepare_solution() {
  for (std::size_t k = 0; k < capacity_.size(); ++k) inverse_diagonal_[k] = capacity_[k] > 0 ? 1 / capacity_[k] : 0;
  for (const Held& held : held_) inverse_diagonal_[static_cast<std::size_t>(held.row)] = 0;
  ExactSum free;
  for (std::size_t k = 0; k < capacity_.size(); ++k)
    if (inverse_diagonal_[k] > 0) free.add(capacity_[k]);
  free_capacity_ = mesh_->comm.sum(free);
}

void Thermal::check_fixed_step() {
  if (!is_explicit() || !options_.fixed_step) return;
  if (const double limit = stable_limit(); *options_.fixed_step > limit)
    throw Error(
        ExitCode::usage,
        fmt::format("component '{}': time_step.fixed is {:.6g} s, but the explicit stepper is stable only up to "
                    "{:.6g} s; give less, leave it out, or choose `stepper: backward_euler`",
                    name(), *options_.fixed_step, limit));
}

}  // namespace tenon
