// SPDX-License-Identifier: BSD-3-Clause
// State in a checkpoint: every kept column that is to be saved, by particle. The order of a restart is that of
// `reference`, so sums go on with the same bits.
#include <algorithm>

#include "components/sph/sph.hpp"

namespace tenon {

namespace {

/// Where each particle of a run stands in a file; those that are not there yet, behind the others, as zeros.
std::vector<GlobalId> with_waiting(const ParticleData& particles, const Mesh& mesh, const std::vector<char>& waits) {
  std::vector<GlobalId> ids(particles.ids.begin(),
                            particles.ids.begin() + static_cast<std::ptrdiff_t>(particles.owned()));
  if (waits.empty()) return ids;
  for (const LocalIndex n : mesh.owned_nodes)
    if (waits[static_cast<std::size_t>(n)] != 0) ids.push_back(mesh.node_ids[static_cast<std::size_t>(n)]);
  return ids;
}

}  // namespace

void Sph::save(CheckpointWriter& file) {
  const auto key = [&](const std::string& field) { return name() + "." + field; };
  file.scalar(key("previous_dt"), previous_dt_);
  file.integer(key("steps"), steps_);
  const std::size_t owned = particles_.owned();
  const std::vector<GlobalId> all = with_waiting(particles_, *mesh_, waits_);
  const GlobalOrder order(mesh_->comm, all, mesh_->global_nodes);
  std::vector<double> values;
  for (const Column& column : particles_.columns()) {
    if (!column.kept || !column.saved) continue;
    const auto n = static_cast<std::size_t>(column.components);
    values.assign(column.values.begin(), column.values.begin() + static_cast<std::ptrdiff_t>(n * owned));
    values.resize(n * all.size());
    file.array(key(column.name), order, values, column.components);
  }
  if (inflow_energy_) {
    values.assign(particles_.body.begin(), particles_.body.begin() + static_cast<std::ptrdiff_t>(owned));
    values.resize(all.size());
    file.array(key("body"), order, values, 1);
  }
  if (!waits_.empty()) save_waiting(file);
  formulation_->save(file);
  if (!contact_) return;
  std::vector<GlobalId> ids;
  std::vector<double> work, slip, heat;
  ContactFields* const fields = contact_->fields();
  for (const LocalIndex n : mesh_->owned_nodes) {
    const auto i = static_cast<std::size_t>(n);
    ids.push_back(mesh_->node_ids[i]);
    work.push_back(contact_->node_work()[i]);
    for (std::size_t c = 0; c < 3; ++c) slip.push_back(fields ? fields->slip[i][c] : 0);
    heat.push_back(fields ? fields->friction_heat[i] : 0);
  }
  const GlobalOrder nodes(mesh_->comm, ids, mesh_->global_nodes);
  file.array(key("contact_work"), nodes, work, 1);
  file.array(key("contact_slip"), nodes, slip, 3);
  file.array(key("friction_heat"), nodes, heat, 1);
}

void Sph::load(const CheckpointReader& file) {
  const auto key = [&](const std::string& field) { return name() + "." + field; };
  previous_dt_ = file.scalar(key("previous_dt"));
  steps_ = file.integer(key("steps"));
  if (!waits_.empty()) load_waiting(file);
  const std::size_t owned = particles_.owned();
  const GlobalOrder order(mesh_->comm, std::span(particles_.ids).first(owned), mesh_->global_nodes);
  for (Column& column : particles_.columns())
    if (column.kept && column.saved)
      file.array(key(column.name), order,
                 std::span(column.values).first(owned * static_cast<std::size_t>(column.components)),
                 column.components);
  if (inflow_energy_) {
    std::vector<double> body(owned);
    file.array(key("body"), order, body, 1);
    std::ranges::copy(body, particles_.body.begin());
  }
  formulation_->load(file);
  loaded_ = true;
  if (!contact_) return;
  std::vector<GlobalId> ids;
  for (const LocalIndex n : mesh_->owned_nodes) ids.push_back(mesh_->node_ids[static_cast<std::size_t>(n)]);
  std::vector<double> work(ids.size()), slip(3 * ids.size()), heat(ids.size());
  const GlobalOrder nodes(mesh_->comm, ids, mesh_->global_nodes);
  file.array(key("contact_work"), nodes, work, 1);
  file.array(key("contact_slip"), nodes, slip, 3);
  file.array(key("friction_heat"), nodes, heat, 1);
  ContactFields* const fields = contact_->fields();
  for (std::size_t k = 0; k < ids.size(); ++k) {
    const auto i = static_cast<std::size_t>(mesh_->owned_nodes[k]);
    contact_->node_work()[i] = work[k];
    for (std::size_t c = 0; fields && c < 3; ++c) fields->slip[i][c] = slip[3 * k + c];
    if (fields) fields->friction_heat[i] = heat[k];
  }
}

}  // namespace tenon
