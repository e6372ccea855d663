// SPDX-License-Identifier: BSD-3-Clause
// State in a checkpoint. Masses and forces are computed again, to the same bits.
#include <fmt/core.h>

#include <algorithm>
#include <sstream>

#include "components/mechanics/mechanics.hpp"

namespace tenon {

namespace {

/// Global ids of a rank's items in one order; those of other ranks left out when writing.
std::vector<GlobalId> chosen_ids(const std::vector<GlobalId>& ids, const std::vector<int>& owners, int rank,
                                 GlobalId first, std::vector<LocalIndex>& chosen) {
  std::vector<GlobalId> result;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (rank >= 0 && owners[i] != rank) continue;
    result.push_back(ids[i] - first);
    chosen.push_back(static_cast<LocalIndex>(i));
  }
  return result;
}

constexpr int every_rank = -1;

/// Collective. The state of a group, the same list on every rank: one without elements of the block cannot tell from
/// its empty arrays which ones there are.
std::vector<StateArray> agreed_state(const Communicator& comm, ElementGroup* group) {
  const int root = static_cast<int>(comm.min(static_cast<std::int64_t>(group ? comm.rank() : comm.size())));
  if (root == comm.size()) return {};
  std::vector<StateArray> arrays;
  if (group) arrays = group->state();
  std::string list;
  for (const StateArray& array : arrays) list += array.name + ' ' + std::to_string(array.rows) + '\n';
  comm.broadcast(list, root);
  if (group) return arrays;
  std::istringstream text(list);
  StateArray array{"", 0, nullptr};
  while (text >> array.name >> array.rows) arrays.push_back(array);
  return arrays;
}

}  // namespace

void Mechanics::save(CheckpointWriter& file) {
  const auto key = [&](const std::string& field) { return name() + "." + field; };
  file.scalar(key("previous_dt"), previous_dt_);
  file.scalar(key("first_estimate"), first_estimate_);
  file.integer(key("steps"), steps_);
  file.scalar(key("verified_step"), verified_step_);
  file.integer(key("searched_at"), searched_at_);
  file.integer(key("search_interval"), search_interval_);
  std::vector<LocalIndex> chosen;
  const GlobalOrder nodes(mesh_->comm, chosen_ids(mesh_->node_ids, mesh_->node_owners, mesh_->comm.rank(), 0, chosen),
                          mesh_->global_nodes);
  std::vector<double> values;
  const auto node_array = [&](const std::string& field, int components, auto get) {
    values.clear();
    for (const LocalIndex n : chosen)
      for (int c = 0; c < components; ++c)
        values.push_back(get(static_cast<std::size_t>(n), static_cast<std::size_t>(c)));
    file.array(key(field), nodes, values, components);
  };
  node_array("position", 3, [&](std::size_t n, std::size_t c) { return nodes_.position()[n][c]; });
  node_array("velocity", 3, [&](std::size_t n, std::size_t c) { return nodes_.velocity()[n][c]; });
  if (nodes_.has_rotations()) node_array("spin", 3, [&](std::size_t n, std::size_t c) { return nodes_.spin()[n][c]; });
  node_array("internal_work", 1, [&](std::size_t n, std::size_t) { return nodes_.internal_work[n]; });
  if (conditions_.has_motions())
    node_array("boundary_work", 1, [&](std::size_t n, std::size_t) { return conditions_.boundary_work()[n]; });
  if (conditions_.has_walls())
    node_array("wall_work", 1, [&](std::size_t n, std::size_t) { return conditions_.wall_work()[n]; });
  rigid_->save(file, key("rigid"));
  if (relaxation_) {
    const KineticRelaxation::State state = relaxation_->state();
    file.scalar(key("relaxation.energy"), state.energy);
    file.scalar(key("relaxation.energy_before"), state.energy_before);
    file.integer(key("relaxation.turning"), state.turning);
    file.integer(key("relaxation.steps"), state.steps);
    file.integer(key("relaxation.peaks"), state.peaks);
    node_array("relaxation_energy", 1, [&](std::size_t n, std::size_t) { return relaxation_->taken()[n]; });
  }
  for (const Loads::Row& row : loads_->rows())
    node_array(row.name, 1, [&](std::size_t n, std::size_t) { return row.work[n]; });
  if (loose_ && removed_[0] > 0) {
    file.integer(key("removes"), 1);
    std::vector<LooseNodes::Removed> removed = loose_->removed();
    removed.resize(nodes_.size());
    node_array("removed_mass", 1, [&](std::size_t n, std::size_t) { return removed[n].mass; });
    node_array("removed_momentum", 3, [&](std::size_t n, std::size_t c) { return removed[n].momentum[c]; });
    node_array("removed_energy", 1, [&](std::size_t n, std::size_t) { return removed[n].energy; });
  }
  if (contact_) {
    node_array("contact_work", 1, [&](std::size_t n, std::size_t) { return contact_->node_work()[n]; });
    file.scalar(key("contact_body_work"), contact_->body_work());
    ContactFields* fields = contact_->fields();
    file.integer(key("contact_fields"), fields ? 1 : 0);
    if (fields) {
      node_array("contact_slip", 3, [&](std::size_t n, std::size_t c) { return fields->slip[n][c]; });
      node_array("friction_heat", 1, [&](std::size_t n, std::size_t) { return fields->friction_heat[n]; });
    }
  }
  save_departed(file);
  if (subcycling_) save_levels(file);
  for (std::size_t b = 0; b < mesh_->blocks.size(); ++b) {
    const ElementBlock& block = mesh_->blocks[b];
    chosen.clear();
    const GlobalOrder elements(mesh_->comm,
                               chosen_ids(block.ids, block.owners, mesh_->comm.rank(), block.first_id, chosen),
                               block.global_count);
    GroupStates states;
    const std::vector<StateArray> agreed = agreed_state(mesh_->comm, any_group(b));
    for (std::size_t a = 0; a < agreed.size(); ++a) {
      values.clear();
      for (const LocalIndex e : chosen) {
        const ElementGroups::Place place = groups_.place(b, e);
        const StateArray& array = states.of(*place.group)[a];
        for (int row = 0; row < array.rows; ++row) values.push_back(array.at(place.element, row));
      }
      file.array(key(block.name + "." + agreed[a].name), elements, values, agreed[a].rows);
    }
  }
}

void Mechanics::load(const CheckpointReader& file) {
  const auto key = [&](const std::string& field) { return name() + "." + field; };
  previous_dt_ = file.scalar(key("previous_dt"));
  first_estimate_ = file.scalar(key("first_estimate"));
  steps_ = file.integer(key("steps"));
  verified_step_ = file.scalar(key("verified_step"));
  searched_at_ = file.integer(key("searched_at"));
  search_interval_ = file.integer(key("search_interval"));
  std::vector<LocalIndex> chosen;
  const GlobalOrder nodes(mesh_->comm, chosen_ids(mesh_->node_ids, mesh_->node_owners, every_rank, 0, chosen),
                          mesh_->global_nodes);
  std::vector<double> values;
  const auto node_array = [&](const std::string& field, int components, auto set) {
    values.resize(nodes_.size() * static_cast<std::size_t>(components));
    file.array(key(field), nodes, values, components);
    auto from = values.begin();
    for (std::size_t n = 0; n < nodes_.size(); ++n)
      for (int c = 0; c < components; ++c) set(n, static_cast<std::size_t>(c)) = *from++;
  };
  node_array("position", 3, [&](std::size_t n, std::size_t c) -> double& { return nodes_.position()[n][c]; });
  node_array("velocity", 3, [&](std::size_t n, std::size_t c) -> double& { return nodes_.velocity()[n][c]; });
  if (nodes_.has_rotations())
    node_array("spin", 3, [&](std::size_t n, std::size_t c) -> double& { return nodes_.spin()[n][c]; });
  node_array("internal_work", 1, [&](std::size_t n, std::size_t) -> double& { return nodes_.internal_work[n]; });
  if (conditions_.has_motions())
    node_array("boundary_work", 1,
               [&](std::size_t n, std::size_t) -> double& { return conditions_.boundary_work()[n]; });
  if (conditions_.has_walls())
    node_array("wall_work", 1, [&](std::size_t n, std::size_t) -> double& { return conditions_.wall_work()[n]; });
  rigid_->load(file, key("rigid"));
  if (relaxation_) {
    relaxation_->restore({file.scalar(key("relaxation.energy")), file.scalar(key("relaxation.energy_before")),
                          file.integer(key("relaxation.turning")), file.integer(key("relaxation.steps")),
                          file.integer(key("relaxation.peaks"))});
    node_array("relaxation_energy", 1, [&](std::size_t n, std::size_t) -> double& { return relaxation_->taken()[n]; });
  }
  for (Loads::Row& row : loads_->rows())
    node_array(row.name, 1, [&](std::size_t n, std::size_t) -> double& { return row.work[n]; });
  if (loose_ && file.has(key("removes"))) {
    std::vector<LooseNodes::Removed>& removed = loose_->removed();
    removed.resize(nodes_.size());
    node_array("removed_mass", 1, [&](std::size_t n, std::size_t) -> double& { return removed[n].mass; });
    node_array("removed_momentum", 3, [&](std::size_t n, std::size_t c) -> double& { return removed[n].momentum[c]; });
    node_array("removed_energy", 1, [&](std::size_t n, std::size_t) -> double& { return removed[n].energy; });
    for (LocalIndex n = 0; n < mesh_->nodes(); ++n)
      if (!mesh_->owns_node(n)) removed[static_cast<std::size_t>(n)] = {};
    loose_->restore(nodes_);
    sum_removed();
  }
  // A run that goes on without contact keeps the work of that before; one that begins with it starts from none.
  if (file.has(key("contact_body_work")) && options_.time_step.subcycling == 1) {
    contact_party();
    node_array("contact_work", 1, [&](std::size_t n, std::size_t) -> double& { return contact_->node_work()[n]; });
    contact_->body_work() = file.scalar(key("contact_body_work"));
    if (file.integer(key("contact_fields")) != 0) {
      ContactFields& fields = contact_->contact_fields();
      node_array("contact_slip", 3, [&](std::size_t n, std::size_t c) -> double& { return fields.slip[n][c]; });
      node_array("friction_heat", 1, [&](std::size_t n, std::size_t) -> double& { return fields.friction_heat[n]; });
    }
  }
  const std::int64_t subcycling = file.has(key("subcycling")) ? file.integer(key("subcycling")) : 1;
  if (subcycling > 1 && subcycling != options_.time_step.subcycling)
    throw Error(ExitCode::usage, fmt::format("{}: the checkpoint was written with time_step.subcycling: {}; continue "
                                             "with the same",
                                             name(), subcycling));
  if (subcycling > 1) load_levels(file);
  load_departed(file);
  for (std::size_t b = 0; b < mesh_->blocks.size(); ++b) {
    const ElementBlock& block = mesh_->blocks[b];
    chosen.clear();
    const GlobalOrder elements(mesh_->comm, chosen_ids(block.ids, block.owners, every_rank, block.first_id, chosen),
                               block.global_count);
    GroupStates states;
    const std::vector<StateArray> agreed = agreed_state(mesh_->comm, any_group(b));
    for (std::size_t a = 0; a < agreed.size(); ++a) {
      values.resize(block.ids.size() * static_cast<std::size_t>(agreed[a].rows));
      file.array(key(block.name + "." + agreed[a].name), elements, values, agreed[a].rows);
      auto from = values.begin();
      for (LocalIndex e = 0; e < block.size(); ++e) {
        const ElementGroups::Place place = groups_.place(b, e);
        const StateArray& array = states.of(*place.group)[a];
        for (int row = 0; row < array.rows; ++row) array.at(place.element, row) = *from++;
      }
    }
  }
  for (const auto& group : groups_) {
    group->fill_padding();
    group->verified_step = verified_step_;
  }
  loaded_ = started_ = true;
}

/// A group that has elements of a block on this rank, or null.
ElementGroup* Mechanics::any_group(std::size_t block) const {
  for (const auto& group : groups_)
    if (group->block() == block && group->size() > 0) return group.get();
  return nullptr;
}

// Levels of the elements, and where nodes between levels have been: mean velocities and spins.
void Mechanics::save_levels(CheckpointWriter& file) {
  const auto key = [&](const std::string& field) { return name() + "." + field; };
  file.integer(key("subcycling"), options_.time_step.subcycling);
  file.integer(key("leveled_at"), leveled_at_);
  file.integer(key("blends"), former_force_.empty() ? 0 : 1);
  file.scalar(key("leveled_shortest"), leveled_shortest_);
  std::vector<LocalIndex> chosen;
  std::vector<double> values;
  for (std::size_t b = 0; b < mesh_->blocks.size(); ++b) {
    const ElementBlock& block = mesh_->blocks[b];
    chosen.clear(), values.clear();
    const GlobalOrder order(mesh_->comm,
                            chosen_ids(block.ids, block.owners, mesh_->comm.rank(), block.first_id, chosen),
                            block.global_count);
    for (const LocalIndex e : chosen) values.push_back(levels_[b][static_cast<std::size_t>(e)]);
    file.array(key(block.name + ".level"), order, values, 1);
  }
  chosen.clear();
  const GlobalOrder order(mesh_->comm, chosen_ids(mesh_->node_ids, mesh_->node_owners, mesh_->comm.rank(), 0, chosen),
                          mesh_->global_nodes);
  std::vector<Vec3> means(nodes_.size());
  const auto write = [&](const std::string& field, int level) {
    values.clear();
    for (const LocalIndex n : chosen)
      for (const double v : means[static_cast<std::size_t>(n)]) values.push_back(v);
    file.array(key(fmt::format("{}_{}", field, level)), order, values, 3);
    std::ranges::fill(means, Vec3{});
  };
  const auto write_forces = [&](const std::string& field, const std::vector<ForceRow>& forces) {
    for (std::size_t n = 0; n < forces.size(); ++n) std::copy_n(forces[n].v, 3, means[n].begin());
    if (!forces.empty()) write(field, 0);
  };
  write_forces("former_force", former_force_);
  write_forces("former_moment", former_moment_);
  const auto keep = [&](LocalIndex n, const Vec3& v) { means[static_cast<std::size_t>(n)] = v; };
  for (int level = 1; level <= subcycling_->greatest(); ++level) {
    subcycling_->visit_means(level, keep);
    write("mean_velocity", level);
    if (!nodes_.has_rotations()) continue;
    subcycling_->visit_mean_spins(level, keep);
    write("mean_spin", level);
  }
}

void Mechanics::load_levels(const CheckpointReader& file) {
  const auto key = [&](const std::string& field) { return name() + "." + field; };
  leveled_at_ = file.integer(key("leveled_at"));
  leveled_shortest_ = file.scalar(key("leveled_shortest"));
  std::vector<LocalIndex> chosen;
  std::vector<double> values;
  ElementLevels levels(mesh_->blocks.size());
  for (std::size_t b = 0; b < mesh_->blocks.size(); ++b) {
    const ElementBlock& block = mesh_->blocks[b];
    chosen.clear();
    const GlobalOrder order(mesh_->comm, chosen_ids(block.ids, block.owners, every_rank, block.first_id, chosen),
                            block.global_count);
    values.resize(block.ids.size());
    file.array(key(block.name + ".level"), order, values, 1);
    levels[b].assign(values.begin(), values.end());
  }
  split(levels);
  chosen.clear();
  const GlobalOrder order(mesh_->comm, chosen_ids(mesh_->node_ids, mesh_->node_owners, every_rank, 0, chosen),
                          mesh_->global_nodes);
  values.resize(3 * nodes_.size());
  const auto read_forces = [&](const std::string& field, std::vector<ForceRow>& forces) {
    forces.resize(nodes_.size());
    file.array(key(field + "_0"), order, values, 3);
    for (std::size_t n = 0; n < forces.size(); ++n)
      std::copy_n(values.begin() + 3 * static_cast<std::ptrdiff_t>(n), 3, forces[n].v);
  };
  if (file.integer(key("blends")) != 0) {
    read_forces("former_force", former_force_);
    if (nodes_.has_rotations()) read_forces("former_moment", former_moment_);
  }
  const auto take = [&](LocalIndex n, Vec3& v) {
    std::copy_n(values.begin() + 3 * static_cast<std::ptrdiff_t>(n), 3, v.begin());
  };
  for (int level = 1; level <= subcycling_->greatest(); ++level) {
    file.array(key(fmt::format("mean_velocity_{}", level)), order, values, 3);
    subcycling_->visit_means(level, take);
    if (!nodes_.has_rotations()) continue;
    file.array(key(fmt::format("mean_spin_{}", level)), order, values, 3);
    subcycling_->visit_mean_spins(level, take);
  }
}

std::int64_t Mechanics::memory() const {
  std::int64_t bytes =
      conditions_.memory() + loads_->memory() + static_cast<std::int64_t>(nodes_.size() * (6 + 3 + 4) * sizeof(double));
  if (nodes_.has_rotations()) bytes += static_cast<std::int64_t>(nodes_.size() * (3 + 2 + 4) * sizeof(double));
  for (const auto& group : groups_) bytes += group->memory();
  if (contact_) bytes += contact_->memory();
  if (subcycling_) bytes += subcycling_->memory();
  return bytes;
}

}  // namespace tenon
