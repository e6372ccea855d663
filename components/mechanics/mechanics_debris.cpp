// SPDX-License-Identifier: BSD-3-Clause
// Elements that leave the body when they fail, with their mass, momentum and energy, to go on as particles.
#include <fmt/core.h>

#include <algorithm>

#include "components/mechanics/mechanics.hpp"

namespace tenon {

std::size_t Mechanics::giving_block(const std::string& block) const {
  std::size_t b = 0;
  while (b < mesh_->blocks.size() && mesh_->blocks[b].name != block) ++b;
  if (b < mesh_->blocks.size()) return b;
  throw Error(ExitCode::usage, fmt::format("{}: there is no block '{}'", name(), block));
}

void Mechanics::give_up(const std::string& block) {
  const std::size_t b = giving_block(block);
  const auto refuse = [&](const std::string& why) {
    throw Error(ExitCode::usage, fmt::format("{}: elements of '{}' cannot become particles: {}", name(), block, why));
  };
  if (options_.time_step.subcycling > 1) refuse("the component has subcycling; leave it out");
  if (!options_.loads.rigid_bodies.empty() || !options_.loads.ties.empty() || options_.loads.mass_scaling)
    refuse("masses of the component belong to rigid bodies, ties or mass scaling; leave these out");
  if (options_.heat == HeatMode::exported)
    refuse("their heat is given to another component (`heat: exported`); take `adiabatic`");
  ElementGroup& group = *groups_[b];
  if (!group.can_die) refuse("they never fail; give their material a `failure`, or the component `erosion`");
  if (group.has_rotations()) refuse("they are shells; solid elements can");
  given_up_.resize(mesh_->blocks.size());
  GivenUp& given = given_up_[b];
  given.any = true, given.followed = death_events_;
  given.departed.resize(static_cast<std::size_t>(group.size()));
  given.energy.resize(static_cast<std::size_t>(group.size()));
}

bool Mechanics::has_debris(const std::string& block) const {
  return given_up_[giving_block(block)].followed < death_events_;
}

// Every rank takes the mass of all elements around its nodes, and speaks for those that it owns.
std::vector<Debris> Mechanics::take_debris(const std::string& block) {
  const std::size_t b = giving_block(block);
  GivenUp& given = given_up_[b];
  given.followed = death_events_;
  const ElementGroup& group = *groups_[b];
  const ElementBlock& elements = group.elements();
  const std::span<const Vec3> x = nodes_.position(), v = nodes_.velocity();
  std::vector<Debris> debris;
  bool any = false;
  for (LocalIndex e = 0; e < group.size(); ++e) {
    char& departed = given.departed[static_cast<std::size_t>(e)];
    if (value_of(group.dead, e) == 0 || departed != 0) continue;
    const std::span<const LocalIndex> nodes = elements.nodes(e);
    const double share = value_of(group.mass, e) / static_cast<double>(nodes.size());
    Debris left;
    left.element = elements.ids[static_cast<std::size_t>(e)] - elements.first_id;
    left.mass = value_of(group.mass, e);
    left.energy = value_of(group.internal_energy, e);
    for (const LocalIndex n : nodes) {
      const auto i = static_cast<std::size_t>(n);
      left.place = left.place + (1.0 / static_cast<double>(nodes.size())) * x[i];
      left.momentum = left.momentum + share * v[i];
      left.energy += 0.5 * share * dot(v[i], v[i]);
    }
    departed = 1, any = true;
    given.energy[static_cast<std::size_t>(e)] = left.energy;
    if (elements.owners[static_cast<std::size_t>(e)] == mesh_->comm.rank()) debris.push_back(left);
  }
  if (mesh_->comm.any(any)) {
    drop_gone_masses();
    if (contact_) contact_->change_surface();
    choose_step();
  }
  return debris;
}

bool Mechanics::any_gone() const {
  return std::ranges::any_of(given_up_, [](const GivenUp& given) {
    return std::ranges::any_of(given.departed, [](char c) { return c != 0; });
  });
}

// Sums anew: what is left of a difference could be a mass of round-off. A mesh that has lost mass may be stiffer for it
// than it was when its limit was found, so from now on the elements alone decide on the step.
void Mechanics::drop_gone_masses() {
  for (const auto& group : groups_) group->verified_step = 0;
  std::ranges::fill(nodes_.mass, 0.0);
  std::ranges::fill(nodes_.inertia, 0.0);
  for (std::size_t b = 0; b < groups_.size(); ++b) {
    const ElementGroup& group = *groups_[b];
    if (!given_up_[b].any) {
      group.add_masses({nodes_.mass, nodes_.inertia});
      continue;
    }
    for (LocalIndex e = 0; e < group.size(); ++e) {
      if (given_up_[b].departed[static_cast<std::size_t>(e)] != 0) continue;
      const std::span<const LocalIndex> nodes = group.elements().nodes(e);
      const double share = value_of(group.mass, e) / static_cast<double>(nodes.size());
      for (const LocalIndex n : nodes) nodes_.mass[static_cast<std::size_t>(n)] += share;
    }
  }
  invert_masses();
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    if (nodes_.mass[n] != 0) continue;
    nodes_.velocity()[n] = {};
    if (nodes_.has_rotations()) nodes_.spin()[n] = {};
  }
  assembled_.reset();
  verified_step_ = 0;
}

void Mechanics::save_departed(CheckpointWriter& file) const {
  for (std::size_t b = 0; b < given_up_.size(); ++b) {
    if (!given_up_[b].any) continue;
    const ElementBlock& block = mesh_->blocks[b];
    std::vector<GlobalId> ids;
    std::vector<double> values;
    for (const LocalIndex e : owned_elements(block, mesh_->comm.rank())) {
      const auto i = static_cast<std::size_t>(e);
      ids.push_back(block.ids[i] - block.first_id);
      values.push_back(given_up_[b].departed[i]), values.push_back(given_up_[b].energy[i]);
    }
    file.array(name() + "." + block.name + ".departed", GlobalOrder(mesh_->comm, ids, block.global_count), values, 2);
  }
}

void Mechanics::load_departed(const CheckpointReader& file) {
  for (std::size_t b = 0; b < given_up_.size(); ++b) {
    if (!given_up_[b].any) continue;
    const ElementBlock& block = mesh_->blocks[b];
    std::vector<GlobalId> ids(block.ids);
    for (GlobalId& id : ids) id -= block.first_id;
    std::vector<double> values(2 * ids.size());
    file.array(name() + "." + block.name + ".departed", GlobalOrder(mesh_->comm, ids, block.global_count),
               std::span<double>(values), 2);
    for (std::size_t e = 0; e < ids.size(); ++e) {
      given_up_[b].departed[e] = values[2 * e] != 0 ? 1 : 0;
      given_up_[b].energy[e] = values[2 * e + 1];
    }
  }
}

}  // namespace tenon
