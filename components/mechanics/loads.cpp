// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/loads.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "components/mechanics/nodal_load.hpp"
#include "components/mechanics/non_reflecting.hpp"
#include "components/mechanics/stiffness_damping.hpp"
#include "components/mechanics/surface_load.hpp"

namespace tenon {

namespace {

bool is_implicit(const Connector& c) {
  return c.kind == Connector::Kind::dashpot && c.ends == Connector::Ends::ground && is_linear(c);
}

void subtract(const std::vector<ForceRow>& from, const std::vector<LocalIndex>& nodes, std::vector<ForceRow>& to) {
  for (const LocalIndex node : nodes)
    for (int c = 0; c < 3; ++c) to[static_cast<std::size_t>(node)].v[c] -= from[static_cast<std::size_t>(node)].v[c];
}

double power(const ForceRow& f, const Vec3& v) {
  return f.v[0] * v[0] + f.v[1] * v[1] + f.v[2] * v[2];
}

}  // namespace

Loads::Loads(const Mesh& mesh, const LoadOptions& options, const ElementGroups& groups) : options_(options) {
  for (const NodalForce& force : options.nodal_forces) add("external_work", std::make_unique<NodalLoad>(mesh, force));
  for (const SurfaceLoad& load : options.surface_loads)
    add("external_work", std::make_unique<SurfaceForce>(mesh, load));
  for (const BodyForce& force : options.body_forces) add("body_work", std::make_unique<NodalLoad>(mesh, force, groups));
  for (const Connector& connector : options.connectors) {
    if (is_implicit(connector)) continue;
    const bool spring = connector.kind == Connector::Kind::spring;
    auto force = std::make_unique<ConnectorForce>(mesh, connector);
    (spring ? springs_ : dashpots_).push_back(force.get());
    add(spring ? "spring_energy" : "damping_energy", std::move(force));
  }
  if (options.damping.stiffness > 0)
    add("damping_energy", std::make_unique<StiffnessDamping>(mesh, groups, options.damping.stiffness));
}

std::size_t Loads::row(const std::string& name) {
  using Role = EnergyTerm::Role;
  const auto found = std::ranges::find(rows_, name, &Row::name);
  if (found != rows_.end()) return static_cast<std::size_t>(found - rows_.begin());
  const bool supplied = name == "external_work" || name == "body_work";
  rows_.push_back({name, supplied ? Role::supplied : Role::stored, supplied ? 1.0 : -1.0, {}, {}, {}, {}});
  return rows_.size() - 1;
}

void Loads::add(const std::string& name, std::unique_ptr<Load> load) {
  rows_[row(name)].loads.push_back(std::move(load));
}

void Loads::finish(const Mesh& mesh, const NodalState& nodes, const ElementGroups& groups,
                   std::span<const double> inverse_mass) {
  const std::size_t size = nodes.size();
  std::vector<SymmetricTensor<double>> dashpots(size), absorbing(size);
  for (const NonReflecting& boundary : options_.non_reflecting) {
    add_non_reflecting(mesh, boundary, groups, absorbing);
    absorbed_row_ = row("absorbed_energy");
  }
  bool damped = options_.damping.mass > 0;
  for (const Connector& connector : options_.connectors) {
    if (!is_implicit(connector)) continue;
    damped = true;
    const double c = connector.law[1].second / connector.law[1].first;
    const Vec3 direction = connector.direction.value_or(Vec3{1, 0, 0});
    for (const Link& link : find_links(mesh, connector)) {
      const auto n =
          static_cast<std::size_t>(std::ranges::lower_bound(mesh.node_ids, link.first) - mesh.node_ids.begin());
      dashpots[n] = dashpots[n] + transverse_isotropic(c, connector.direction ? 0 : c, direction);
    }
  }
  if (damped) damping_row_ = row("damping_energy");
  std::vector<NodalDamping::Entry> entries;
  for (std::size_t n = 0; n < size; ++n) {
    if (nodes.mass[n] == 0) absorbing[n] = {};  // tied or rigid: its share of the boundary reflects
    if (trace(dashpots[n]) > 0 || trace(absorbing[n]) > 0)
      entries.push_back({static_cast<LocalIndex>(n), dashpots[n], absorbing[n]});
  }
  std::optional<Error> error;
  for (const NodalDamping::Entry& entry : entries)
    if (nodes.mass[static_cast<std::size_t>(entry.node)] == 0 && mesh.owns_node(entry.node) && !error)
      error = Error(ExitCode::usage, fmt::format("dashpots: node {} is tied or belongs to a rigid body and has no mass "
                                                 "of its own; put the damper elsewhere",
                                                 mesh.node_labels[static_cast<std::size_t>(entry.node)]));
  mesh.comm.throw_if_any(error);
  damping_ = NodalDamping(options_.damping.mass, std::move(entries), nodes);
  if (damping_.damps_spin() && nodes.has_rotations()) damping_moment_.resize(size), spin_before_.resize(size);
  find_nodes(size);
  find_bounds(mesh, inverse_mass);
}

void Loads::find_nodes(std::size_t size) {
  for (Row& row : rows_) {
    for (const auto& load : row.loads) {
      const std::vector<LocalIndex> more = load->nodes();
      row.nodes.insert(row.nodes.end(), more.begin(), more.end());
    }
    if (row.name == "damping_energy" || row.name == "absorbed_energy")
      for (const NodalDamping::Entry& entry : damping_.entries()) row.nodes.push_back(entry.node);
    std::ranges::sort(row.nodes);
    row.nodes.erase(std::unique(row.nodes.begin(), row.nodes.end()), row.nodes.end());
    row.force.resize(size), row.work.resize(size);
  }
  if (!rows_.empty()) before_.resize(size);
}

void Loads::find_bounds(const Mesh& mesh, std::span<const double> inverse_mass) {
  const auto bound = [&](const std::vector<const ConnectorForce*>& forces) {
    if (forces.empty()) return 0.0;
    std::vector<double> sums(inverse_mass.size());
    for (const ConnectorForce* force : forces) force->add_bounds(sums);
    double most = 0;
    std::optional<Error> error;
    for (const LocalIndex node : mesh.owned_nodes) {
      const auto n = static_cast<std::size_t>(node);
      if (sums[n] > 0 && inverse_mass[n] < 0 && !error)
        error = Error(
            ExitCode::usage,
            fmt::format("springs and dashpots: node {} is tied; use a node of the face instead", mesh.node_labels[n]));
      most = std::max(most, sums[n] * inverse_mass[n]);
    }
    mesh.comm.throw_if_any(error);
    return mesh.comm.max(most);
  };
  spring_frequency_squared_ = bound(springs_);
  explicit_damping_ = bound(dashpots_);
}

double Loads::stable_step(double step) const {
  const double own = 4 / (step * step);
  const double half = 0.5 * (explicit_damping_ + options_.damping.stiffness * own);
  if (half == 0 && spring_frequency_squared_ == 0) return step;
  return 2 / (std::sqrt(own + spring_frequency_squared_ + half * half) + half);
}

void Loads::apply(NodalState& nodes, const ElementGroups& groups, double time, double kick) {
  for (Row& row : rows_) {
    for (const LocalIndex n : row.nodes) row.force[static_cast<std::size_t>(n)] = {};
    for (const auto& load : row.loads) load->add_forces({nodes, groups, time}, row.force);
    subtract(row.force, row.nodes, nodes.force);
  }
  if (!damping_.empty()) apply_damping(nodes, kick);
}

// Sees the sum of all other forces; its own go into rows that may hold explicit ones already.
void Loads::apply_damping(NodalState& nodes, double kick) {
  Row* damping = damping_row_ ? &rows_[*damping_row_] : nullptr;
  Row* absorbed = absorbed_row_ ? &rows_[*absorbed_row_] : nullptr;
  for (const NodalDamping::Entry& entry : damping_.entries()) {
    const auto n = static_cast<std::size_t>(entry.node);
    const NodalDamping::Forces f = damping_.forces(entry, nodes, kick);
    for (std::size_t c = 0; c < 3; ++c) {
      if (damping) damping->force[n].v[c] += f.damping[c];
      if (absorbed) absorbed->force[n].v[c] += f.absorbing[c];
      nodes.force[n].v[c] -= f.damping[c] + f.absorbing[c];
    }
  }
  if (damping_moment_.empty()) return;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const Vec3 moment = damping_.moment(nodes, n, kick);
    for (std::size_t c = 0; c < 3; ++c) damping_moment_[n].v[c] = moment[c], nodes.moment[n].v[c] -= moment[c];
  }
}

std::optional<SymmetricTensor<double>> Loads::damping(LocalIndex node, const NodalState& nodes) const {
  const NodalDamping::Entry* const entry = damping_.find(node);
  if (!entry) return std::nullopt;
  return damping_.damper(*entry, nodes) + entry->absorbing;
}

Vec3 Loads::resist(LocalIndex node, const Vec3& dv, NodalState& nodes) {
  const NodalDamping::Entry* const entry = damping_.find(node);
  if (!entry) return {};
  const auto n = static_cast<std::size_t>(node);
  const Vec3 damper = 0.5 * times(damping_.damper(*entry, nodes), dv), absorbing = 0.5 * times(entry->absorbing, dv);
  for (std::size_t c = 0; c < 3; ++c) {
    if (damping_row_) rows_[*damping_row_].force[n].v[c] -= damper[c];
    if (absorbed_row_) rows_[*absorbed_row_].force[n].v[c] -= absorbing[c];
    nodes.force[n].v[c] += damper[c] + absorbing[c];
  }
  return damper + absorbing;
}

void Loads::remember(const NodalState& nodes) {
  std::ranges::copy(nodes.velocity(), before_.begin());
  if (!damping_moment_.empty()) std::ranges::copy(nodes.spin(), spin_before_.begin());
}

void Loads::book(const NodalState& nodes, double kick) {
  const std::span<const Vec3> after = nodes.velocity();
  for (Row& row : rows_)
    for (const LocalIndex node : row.nodes) {
      const auto n = static_cast<std::size_t>(node);
      row.work[n] += 0.5 * kick * power(row.force[n], before_[n] + after[n]);
    }
  for (std::size_t n = 0; n < damping_moment_.size(); ++n)
    rows_[*damping_row_].work[n] += 0.5 * kick * power(damping_moment_[n], spin_before_[n] + nodes.spin()[n]);
}

double Loads::work(std::size_t node) const {
  double sum = 0;
  for (const Row& row : rows_) sum += row.work[node];
  return sum;
}

Vec3 Loads::force(std::size_t node) const {
  Vec3 sum{};
  for (const Row& row : rows_) sum = sum + Vec3{row.force[node].v[0], row.force[node].v[1], row.force[node].v[2]};
  return sum;
}

std::int64_t Loads::memory() const {
  std::size_t bytes = (before_.size() + spin_before_.size()) * sizeof(Vec3) +
                      damping_moment_.size() * sizeof(ForceRow) +
                      damping_.entries().size() * sizeof(NodalDamping::Entry);
  for (const Row& row : rows_)
    bytes +=
        row.force.size() * sizeof(ForceRow) + row.work.size() * sizeof(double) + row.nodes.size() * sizeof(LocalIndex);
  return static_cast<std::int64_t>(bytes);
}

}  // namespace tenon
