// SPDX-License-Identifier: BSD-3-Clause
// State in a checkpoint. Masses and forces are computed again, to the same bits.
#include <functional>

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

/// Calls visit(name, components, access) for every array over the elements of a block; access(element, i) is a value
/// that can be read and assigned.
template <typename Visit>
void element_arrays(Hex8Block& block, ElementValues& heat_given, Visit visit) {
  struct Accessor {
    std::function<double(LocalIndex, int)> get;
    std::function<void(LocalIndex, int, double)> set;
  };
  visit("stress", 6,
        Accessor{[&](LocalIndex e, int i) { return block.stress(e, i); },
                 [&](LocalIndex e, int i, double x) { block.stress(e, i) = x; }});
  if (block.history_size() > 0)
    visit("history", block.history_size(),
          Accessor{[&](LocalIndex e, int i) { return block.history(e, i); },
                   [&](LocalIndex e, int i, double x) { block.set_history(e, i, x); }});
  if (block.hourglass_state_size() > 0)
    visit("hourglass_forces", block.hourglass_state_size(),
          Accessor{[&](LocalIndex e, int i) { return block.hourglass_state(e, i); },
                   [&](LocalIndex e, int i, double x) { block.set_hourglass_state(e, i, x); }});
  const auto values = [&](const char* name, ElementValues& v) {
    visit(name, 1,
          Accessor{[&v](LocalIndex e, int) { return value_of(v, e); },
                   [&v](LocalIndex e, int, double x) { value_of(v, e) = x; }});
  };
  values("temperature", block.temperature);
  values("temperature_used", block.temperature_used);
  values("plastic_work", block.plastic_work);
  values("hourglass_energy", block.hourglass_energy);
  values("viscosity_energy", block.viscosity_energy);
  if (!heat_given.empty()) values("heat_given", heat_given);
}

}  // namespace

void Mechanics::save(CheckpointWriter& file) {
  const auto key = [&](const std::string& field) { return name() + "." + field; };
  file.scalar(key("previous_dt"), previous_dt_);
  file.scalar(key("first_estimate"), first_estimate_);
  file.integer(key("steps"), steps_);
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
  node_array("internal_work", 1, [&](std::size_t n, std::size_t) { return nodes_.internal_work[n]; });
  if (conditions_.has_motions())
    node_array("boundary_work", 1, [&](std::size_t n, std::size_t) { return conditions_.boundary_work()[n]; });
  if (conditions_.has_walls())
    node_array("wall_work", 1, [&](std::size_t n, std::size_t) { return conditions_.wall_work()[n]; });
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const ElementBlock& block = mesh_->blocks[b];
    chosen.clear();
    const GlobalOrder elements(mesh_->comm,
                               chosen_ids(block.ids, block.owners, mesh_->comm.rank(), block.first_id, chosen),
                               block.global_count);
    element_arrays(*blocks_[b], heat_given_[b], [&](const char* field, int components, const auto& array) {
      values.clear();
      for (const LocalIndex e : chosen)
        for (int c = 0; c < components; ++c) values.push_back(array.get(e, c));
      file.array(key(block.name + "." + field), elements, values, components);
    });
  }
}

void Mechanics::load(const CheckpointReader& file) {
  const auto key = [&](const std::string& field) { return name() + "." + field; };
  previous_dt_ = file.scalar(key("previous_dt"));
  first_estimate_ = file.scalar(key("first_estimate"));
  steps_ = file.integer(key("steps"));
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
  node_array("internal_work", 1, [&](std::size_t n, std::size_t) -> double& { return nodes_.internal_work[n]; });
  if (conditions_.has_motions())
    node_array("boundary_work", 1,
               [&](std::size_t n, std::size_t) -> double& { return conditions_.boundary_work()[n]; });
  if (conditions_.has_walls())
    node_array("wall_work", 1, [&](std::size_t n, std::size_t) -> double& { return conditions_.wall_work()[n]; });
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const ElementBlock& block = mesh_->blocks[b];
    chosen.clear();
    const GlobalOrder elements(mesh_->comm, chosen_ids(block.ids, block.owners, every_rank, block.first_id, chosen),
                               block.global_count);
    element_arrays(*blocks_[b], heat_given_[b], [&](const char* field, int components, const auto& array) {
      values.resize(block.ids.size() * static_cast<std::size_t>(components));
      file.array(key(block.name + "." + field), elements, values, components);
      auto from = values.begin();
      for (LocalIndex e = 0; e < block.size(); ++e)
        for (int c = 0; c < components; ++c) array.set(e, c, *from++);
    });
    blocks_[b]->fill_padding();
  }
  loaded_ = started_ = true;
}

std::int64_t Mechanics::memory() const {
  std::int64_t bytes = conditions_.memory() + static_cast<std::int64_t>(nodes_.size() * (6 + 3 + 4) * sizeof(double));
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    bytes += blocks_[b]->memory() + static_cast<std::int64_t>(heat_given_[b].size() * sizeof(Batch<1>));
  return bytes;
}

}  // namespace tenon
