// SPDX-License-Identifier: BSD-3-Clause
// Particles that wait until an element becomes them.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "components/sph/sph.hpp"

namespace tenon {

namespace {

/// On its way to the rank where the particle's node is.
struct Wakened {
  Debris debris;
  LocalIndex node;
};

}  // namespace

// Collective where some wait.
void Sph::find_waiting() {
  if (std::ranges::none_of(options_.bodies, &SphBody::waits)) return;
  if (options_.formulation == SphFormulation::total_lagrangian)
    throw Error(ExitCode::usage, name() +
                                     ": particles that elements become have no neighbours at the start; take "
                                     "another formulation than total_lagrangian");
  waits_.resize(node_body_.size());
  for (std::size_t n = 0; n < waits_.size(); ++n)
    waits_[n] = options_.bodies[static_cast<std::size_t>(node_body_[n])].waits ? 1 : 0;
  std::vector<GlobalId> ids;
  for (const LocalIndex n : mesh_->owned_nodes) ids.push_back(mesh_->node_ids[static_cast<std::size_t>(n)]);
  homes_ = std::make_unique<Directory>(mesh_->comm, ids, mesh_->owned_nodes);
}

std::int32_t Sph::body_of_block(const std::string& block) const {
  for (std::size_t b = 0; b < mesh_->blocks.size(); ++b)
    if (mesh_->blocks[b].name == block && options_.bodies[b].waits) return static_cast<std::int32_t>(b);
  throw Error(ExitCode::usage,
              fmt::format("{}: there is no block '{}' of particles that wait for elements to fail", name(), block));
}

GlobalId Sph::waiting(const std::string& block) const {
  return mesh_->blocks[static_cast<std::size_t>(body_of_block(block))].global_count;
}

// Nodes of a block of particles are numbered as its elements. What wakes is undeformed: all of the energy that is not
// in its motion is heat.
void Sph::wake(const std::string& block, std::span<const Debris> debris) {
  const auto body = static_cast<std::size_t>(body_of_block(block));
  std::vector<GlobalId> ids;
  for (const Debris& d : debris) ids.push_back(mesh_->blocks[body].first_id + d.element);
  const std::vector<DirectoryEntry> entries = homes_->find(ids);
  std::vector<int> ranks;
  std::vector<Wakened> leaving;
  for (std::size_t k = 0; k < debris.size(); ++k)
    ranks.push_back(entries[k].rank), leaving.push_back({debris[k], entries[k].index});
  const ExchangePlan plan = ExchangePlan::to_ranks(mesh_->comm, ranks, name() + " debris");
  std::vector<Wakened> arrived(static_cast<std::size_t>(plan.received()));
  plan.forward<Wakened>(leaving, arrived);
  if (!mesh_->comm.any(!arrived.empty())) return;
  for (const Wakened& one : arrived) {
    const std::size_t i = particles_.owned();
    particles_.resize(i + 1, 0);
    for (Column& column : particles_.columns())
      std::fill_n(column.values.end() - column.components, column.components, 0.0);
    place(i, one.node);
    waits_[static_cast<std::size_t>(one.node)] = 0;
    const Vec3 velocity = (1 / one.debris.mass) * one.debris.momentum;
    particles_.mass[i] = one.debris.mass;
    particles_.position.set(i, one.debris.place);
    particles_.velocity.set(i, velocity);
    const double heat = one.debris.energy - 0.5 * one.debris.mass * dot(velocity, velocity);
    (*debris_work_)[i] = one.debris.energy;
    (*debris_heat_)[i] = heat - formulation_->wake(i, heat);
  }
  decomposition_->renew();
  shown_steps_ = -1;
  if (contact_) contact_->renew();
  choose_step();
}

void Sph::show_nothing_of_waiting(std::span<double> nodes, int components) const {
  for (std::size_t n = 0; n < waits_.size(); ++n)
    if (waits_[n] != 0) std::fill_n(nodes.begin() + static_cast<std::ptrdiff_t>(n) * components, components, 0.0);
}

void Sph::save_waiting(CheckpointWriter& file) {
  std::vector<GlobalId> ids;
  std::vector<double> waits;
  for (const LocalIndex n : mesh_->owned_nodes) {
    ids.push_back(mesh_->node_ids[static_cast<std::size_t>(n)]);
    waits.push_back(waits_[static_cast<std::size_t>(n)]);
  }
  file.array(name() + ".waits", GlobalOrder(mesh_->comm, ids, mesh_->global_nodes), waits, 1);
}

void Sph::load_waiting(const CheckpointReader& file) {
  std::vector<GlobalId> ids(mesh_->node_ids);
  std::vector<double> waits(ids.size());
  file.array(name() + ".waits", GlobalOrder(mesh_->comm, ids, mesh_->global_nodes), waits, 1);
  waits_.assign(waits.begin(), waits.end());
  particles_.resize(0, 0);
  for (const LocalIndex n : mesh_->owned_nodes) {
    if (waits_[static_cast<std::size_t>(n)] != 0) continue;
    particles_.resize(particles_.owned() + 1, 0);
    place(particles_.owned() - 1, n);
  }
}

}  // namespace tenon
