// SPDX-License-Identifier: BSD-3-Clause
// Construction, geometry and the choice of the step.
#include "components/thermal/thermal.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "framework/mesh/shape_functions.hpp"

namespace tenon {
namespace {

constexpr GlobalId no_element = std::numeric_limits<GlobalId>::max();

std::vector<thermal::Conductivity> conductivities(const Mesh& mesh, const ThermalOptions& options) {
  std::vector<thermal::Conductivity> of_block;
  for (const ElementBlock& block : mesh.blocks) {
    const auto found = std::ranges::find(options.blocks, block.name, &ThermalBlock::block);
    if (found == options.blocks.end())
      throw Error(ExitCode::usage,
                  fmt::format("heat conduction: block '{}' of the mesh {} has no material", block.name, mesh.source));
    if (topology(block.kind).dimension != 3)
      throw Error(ExitCode::usage, fmt::format("heat conduction: block '{}' of the mesh {} consists of {}; only solid "
                                               "elements conduct",
                                               block.name, mesh.source, topology(block.kind).name));
    if (!middle_nodes(block.kind).empty())
      throw Error(ExitCode::usage, fmt::format("heat conduction: block '{}' of the mesh {} consists of {}; expected "
                                               "elements of first order: hex8, tet4, wedge6 or pyramid5",
                                               block.name, mesh.source, topology(block.kind).name));
    thermal::Conductivity& k = of_block.emplace_back(found->conductivity);
    if (found->conductivity_over_temperature) k.over_temperature = *found->conductivity_over_temperature;
    k.tensor = found->conductivity_tensor;
  }
  return of_block;
}

}  // namespace

Thermal::Thermal(std::string name, std::shared_ptr<const Mesh> mesh, ThermalOptions options)
    : Component(std::move(name)),
      mesh_(std::move(mesh)),
      options_(std::move(options)),
      matrix_(*mesh_, conductivities(*mesh_, options_)),
      solver_(*mesh_) {
  const auto nodes = static_cast<std::size_t>(mesh_->nodes());
  const std::size_t rows = mesh_->owned_nodes.size();
  coordinates_ = mesh_->coordinates;
  displacement_.assign(3 * nodes, 0.0);
  temperature_.assign(nodes, 0.0);
  increment_.assign(nodes, 0.0);
  for (std::vector<double>* v : {&initial_, &rise_, &capacity_, &volume_, &film_, &waiting_heat_, &right_side_,
                                 &residual_, &diagonal_, &inverse_diagonal_})
    v->assign(rows, 0.0);
  for (std::size_t b = 0; b < mesh_->blocks.size(); ++b)
    warm_conductivity_ = warm_conductivity_ || !matrix_.conductivity(b).is_constant();
  find_blocks();
  make_capacity();
  check_stepper();
  make_loads();
  make_held();
  if (!options_.contacts.empty()) contact_ = std::make_unique<thermal::ContactConductance>(*mesh_, options_.contacts);
  if (contact_) passed_.assign(rows, 0.0);
  if (contact_ && contact_->needs_pressure()) pressure_.assign(nodes, 0.0);
  if (!goes_by_stages()) return;
  for (std::vector<double>* v :
       {&rate_, &first_rate_, &mid_rate_, &target_, &start_rise_, &start_energy_, &given_, &received_})
    v->assign(rows, 0.0);
  for (std::size_t kind = 0; kind < supplies; ++kind) pending_[kind].assign(supplied_[kind].size(), 0.0);
}

double Thermal::theta() const {
  switch (options_.stepper) {
    case ThermalStepper::explicit_euler:
      return 0;
    case ThermalStepper::crank_nicolson:
      return 0.5;
    default:
      break;
  }
  return 1;
}

double Thermal::stable_limit() {
  refresh_geometry();
  follow_contacts(time());
  return stiffest_ > 0 ? 2 / stiffest_ : std::numeric_limits<double>::infinity();
}

double Thermal::time_step() {
  refresh_geometry();
  if (!is_explicit()) {
    if (options_.fixed_step) return *options_.fixed_step;
    if (is_steady()) return std::numeric_limits<double>::infinity();
    if (next_step_ == 0) first_step();
    return next_step_;
  }
  const double limit = options_.step_scale * stable_limit();
  return options_.fixed_step ? std::min(*options_.fixed_step, limit) : limit;
}

bool Thermal::ends_step(double now) {
  hastened_ = chooses_step() && withheld_change(now) >= options_.control.tolerance;
  return hastened_;
}

StepLimiter Thermal::limiter() {
  const double dt = time_step();
  if (options_.fixed_step && dt == *options_.fixed_step) return {dt, "time_step.fixed"};
  if (is_steady()) return {dt, "nothing: the state is steady"};
  if (!is_explicit()) return {dt, fmt::format("time_step.tolerance, {:.3g} K", options_.control.tolerance)};
  const auto& mine = matrix_.stiffest();
  const double greatest = mesh_->comm.max(mine.block == no_index ? 0.0 : mine.eigenvalue);
  const bool has_it = mine.block != no_index && mine.eigenvalue == greatest;
  const GlobalId id =
      has_it ? mesh_->blocks[static_cast<std::size_t>(mine.block)].ids[static_cast<std::size_t>(mine.element)]
             : no_element;
  const std::int64_t first = mesh_->comm.min(std::int64_t{id});
  const bool speaks = has_it && id == first;
  const auto root = mesh_->comm.min(std::int64_t{speaks ? mesh_->comm.rank() : mesh_->comm.size()});
  if (root == mesh_->comm.size()) return {dt, "nothing: there are no elements"};
  std::string text = speaks ? describe(mine.block, mine.element) : "";
  mesh_->comm.broadcast(text, static_cast<int>(root));
  return {dt, text};
}

void Thermal::refresh_geometry() {
  if (!displaced_) return;
  displaced_ = false;
  const bool moved = mesh_->comm.any(moved_here_);
  moved_here_ = false;
  if (!moved) return;
  mesh_->node_halo.forward(std::span<const double>(displacement_), std::span<double>(displacement_), 3);
  assemble();
}

// Collective.
void Thermal::assemble() {
  const ScopedTimer timer(*assemble_time_);
  for (std::size_t n = 0; n < coordinates_.size(); ++n)
    for (std::size_t c = 0; c < 3; ++c) coordinates_[n][c] = mesh_->coordinates[n][c] + displacement_[3 * n + c];
  for (FluxLoad& load : flux_loads_) load.surface.update(coordinates_);
  std::ranges::fill(film_, 0.0);
  for (ConvectionLoad& load : convection_loads_) {
    load.surface.update(coordinates_);
    const auto rows = load.surface.rows();
    for (std::size_t i = 0; i < rows.size(); ++i)
      film_[static_cast<std::size_t>(rows[i])] += load.coefficient * load.surface.areas()[i];
  }
  for (RadiationLoad& load : radiation_loads_) load.surface.update(coordinates_);
  if (contact_) find_contacts();
  throw_if_inverted(assemble_matrix());
  assembled_ = multigrid_stale_ = true;
  find_stiffest();
}

// The bounds of conduction, convection and contact add up: the greatest eigenvalue of a sum is not above the sum of
// theirs. Collective.
void Thermal::find_stiffest() {
  if (!is_explicit()) return;
  double film = 0;
  for (std::size_t k = 0; k < film_.size(); ++k)
    if (capacity_[k] > 0) film = std::max(film, film_[k] / capacity_[k]);
  const double contact = contact_ ? contact_->greatest_eigenvalue(capacity_, matrix_) : 0;
  std::array<double, 3> greatest{matrix_.stiffest().eigenvalue, film, contact};
  mesh_->comm.max(greatest);
  stiffest_ = greatest[0] + greatest[1] + greatest[2];
}

// Local: geometry, surfaces and temperatures are up to date.
thermal::ConductionMatrix::BadElement Thermal::assemble_matrix() {
  const auto bad = matrix_.assemble(coordinates_, temperature_);
  for (const ConvectionLoad& load : convection_loads_) add_film_links(load);
  if (contact_) contact_->add_to(matrix_);
  matrix_.finish();
  return bad;
}

// The film matrix is the mean of the lumped and the consistent one, whose leading errors along a surface cancel
// [HUG87]. It is the lumped one plus links between the nodes of each side, which only move heat among them.
void Thermal::add_film_links(const ConvectionLoad& load) {
  constexpr double share = 0.5;
  const double factor = share * load.coefficient;
  load.surface.links(coordinates_, [this, factor](LocalIndex i, LocalIndex j, double integral) {
    matrix_.add_link(i, j, factor * integral);
  });
}

void Thermal::throw_if_inverted(const thermal::ConductionMatrix::BadElement& bad) const {
  if (!mesh_->comm.any(bad.id != no_id)) return;
  const GlobalId first = mesh_->comm.min(std::int64_t{bad.id == no_id ? no_element : bad.id});
  std::optional<Error> mine;
  if (bad.id == first)
    mine = Error(ExitCode::geometry,
                 fmt::format("component '{}' at time {:.6g} s: {} has no positive volume everywhere; the displacement "
                             "that it received has inverted it. A smaller time step or a finer mesh of the moving body "
                             "may help.",
                             name(), time(), describe(bad.block, bad.element)));
  mesh_->comm.throw_if_any(mine);
}

std::string Thermal::describe(LocalIndex b, LocalIndex element) const {
  const ElementBlock& block = mesh_->blocks[static_cast<std::size_t>(b)];
  Vec3 centre{};
  const auto nodes = block.nodes(element);
  for (const LocalIndex n : nodes)
    centre = centre + (1.0 / static_cast<double>(nodes.size())) * coordinates_[static_cast<std::size_t>(n)];
  return fmt::format("element {} of block {} at ({:.6g}, {:.6g}, {:.6g}) m",
                     block.labels[static_cast<std::size_t>(element)], block.name, centre[0], centre[1], centre[2]);
}

}  // namespace tenon
