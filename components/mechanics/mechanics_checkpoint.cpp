// SPDX-License-Identifier: BSD-3-Clause
// State in a checkpoint. Masses and forces are computed again, to the same bits.
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
std::vector<StateArray> agreed_state(const Communicator& comm, ElementGroup& group) {
  const int root = static_cast<int>(comm.min(static_cast<std::int64_t>(group.size() > 0 ? comm.rank() : comm.size())));
  if (root == comm.size()) return {};
  std::vector<StateArray> arrays;
  if (group.size() > 0) arrays = group.state();
  std::string list;
  for (const StateArray& array : arrays) list += array.name + ' ' + std::to_string(array.rows) + '\n';
  comm.broadcast(list, root);
  if (group.size() > 0) return arrays;
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
  for (const auto& group : groups_) {
    const ElementBlock& block = group->elements();
    chosen.clear();
    const GlobalOrder elements(mesh_->comm,
                               chosen_ids(block.ids, block.owners, mesh_->comm.rank(), block.first_id, chosen),
                               block.global_count);
    for (const StateArray& array : agreed_state(mesh_->comm, *group)) {
      values.clear();
      for (const LocalIndex e : chosen)
        for (int row = 0; row < array.rows; ++row) values.push_back(array.at(e, row));
      file.array(key(block.name + "." + array.name), elements, values, array.rows);
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
  for (const auto& group : groups_) {
    const ElementBlock& block = group->elements();
    chosen.clear();
    const GlobalOrder elements(mesh_->comm, chosen_ids(block.ids, block.owners, every_rank, block.first_id, chosen),
                               block.global_count);
    for (const StateArray& array : agreed_state(mesh_->comm, *group)) {
      values.resize(block.ids.size() * static_cast<std::size_t>(array.rows));
      file.array(key(block.name + "." + array.name), elements, values, array.rows);
      auto from = values.begin();
      for (LocalIndex e = 0; e < block.size(); ++e)
        for (int row = 0; row < array.rows; ++row) array.at(e, row) = *from++;
    }
    group->fill_padding();
    group->verified_step = verified_step_;
  }
  loaded_ = started_ = true;
}

std::int64_t Mechanics::memory() const {
  std::int64_t bytes =
      conditions_.memory() + loads_->memory() + static_cast<std::int64_t>(nodes_.size() * (6 + 3 + 4) * sizeof(double));
  if (nodes_.has_rotations()) bytes += static_cast<std::int64_t>(nodes_.size() * (3 + 2 + 4) * sizeof(double));
  for (const auto& group : groups_) bytes += group->memory();
  return bytes;
}

}  // namespace tenon
