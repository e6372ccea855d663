// SPDX-License-Identifier: BSD-3-Clause
// What the tests of mechanics have in common: materials, bodies, runs, ledgers, comparison in global order.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "components/mechanics/mechanics.hpp"
#include "framework/mesh/generators.hpp"
#include "tests/support/test_communicator.hpp"

namespace tenon::testing {

/// Steps of a long run: all on one rank, a share on more, where ranks may wait for each other on few cores.
inline int long_run(int steps) {
  return communicator().size() == 1 ? steps : steps / 20;
}

inline MaterialDescription elastic_material(double youngs_modulus, double poissons_ratio, double density) {
  MaterialDescription m;
  m.name = "test";
  m.density = density;
  m.elastic = Elasticity{youngs_modulus, poissons_ratio, 0};
  return m;
}

inline MaterialDescription steel() {
  return elastic_material(210e9, 0.3, 7850);
}

/// The copper of case A07.
inline MaterialDescription copper() {
  MaterialDescription m = elastic_material(117e9, 0.35, 8930);
  m.plasticity = LinearHardeningParameters{400e6, 100e6};
  m.thermal = ThermalProperties{390, 385, 293.15, 0.9};
  return m;
}

/// Only rank 0 makes the mesh.
template <typename Shape>
MeshData on_root(const Shape& shape) {
  return communicator().rank() == 0 ? generate(shape) : MeshData{};
}

inline std::shared_ptr<const Mesh> shared_mesh(MeshData&& data) {
  return distribute(communicator(), std::move(data), {});
}

/// The whole mesh on rank 0, nothing on the others: a run on it does what one rank would do.
inline std::shared_ptr<const Mesh> whole_mesh(const MeshData& data) {
  const Communicator& comm = communicator();
  auto mesh = std::make_shared<Mesh>(comm);
  std::vector<std::int64_t> counts{static_cast<std::int64_t>(data.coordinates.size()),
                                   static_cast<std::int64_t>(data.elements())};
  comm.broadcast(counts);
  mesh->global_nodes = counts[0], mesh->global_elements = counts[1];
  // Names must be known everywhere.
  MeshSummary summary = comm.rank() == 0 ? summarise(data) : MeshSummary{};
  summary = broadcast_summary(comm, summary);
  GlobalId first = 0;
  for (std::size_t b = 0; b < summary.blocks.size(); ++b) {
    ElementBlock block;
    block.name = summary.blocks[b].name;
    block.kind = summary.blocks[b].kind;
    block.global_count = summary.blocks[b].count;
    block.first_id = first;
    first += block.global_count;
    if (comm.rank() == 0) {
      for (const GlobalId n : data.blocks[b].connectivity) block.connectivity.push_back(static_cast<LocalIndex>(n));
      block.labels = data.blocks[b].labels;
      for (GlobalId e = 0; e < block.global_count; ++e) block.ids.push_back(block.first_id + e);
      block.owners.assign(block.ids.size(), 0);
    }
    mesh->blocks.push_back(std::move(block));
  }
  for (std::size_t s = 0; s < summary.node_sets.size(); ++s) {
    NodeSet set;
    set.name = summary.node_sets[s].name;
    set.global_count = summary.node_sets[s].count;
    if (comm.rank() == 0)
      for (const GlobalId n : data.node_sets[s].nodes) set.nodes.push_back(static_cast<LocalIndex>(n));
    mesh->node_sets.push_back(std::move(set));
  }
  for (std::size_t s = 0; s < summary.side_sets.size(); ++s) {
    SideSet set{summary.side_sets[s].name, {}, summary.side_sets[s].count};
    for (std::size_t i = 0; comm.rank() == 0 && i < data.side_sets[s].sides.size(); ++i) {
      const SideData& side = data.side_sets[s].sides[i];
      std::size_t b = 0;
      while (side.element >= mesh->blocks[b].first_id + mesh->blocks[b].global_count) ++b;
      set.sides.push_back(
          {static_cast<LocalIndex>(b), static_cast<LocalIndex>(side.element - mesh->blocks[b].first_id), side.side});
    }
    mesh->side_sets.push_back(std::move(set));
  }
  if (comm.rank() == 0) {
    mesh->coordinates = data.coordinates;
    mesh->node_labels = data.node_labels;
    for (std::size_t n = 0; n < data.coordinates.size(); ++n) {
      mesh->node_ids.push_back(static_cast<GlobalId>(n));
      mesh->owned_nodes.push_back(static_cast<LocalIndex>(n));
    }
    mesh->node_owners.assign(data.coordinates.size(), 0);
  }
  mesh->node_halo = ExchangePlan::from_owners(comm, {}, {}, {}, "test halo");
  return mesh;
}

/// A body of one material in all blocks; `initialize` is the caller's.
inline std::unique_ptr<Mechanics> body(std::shared_ptr<const Mesh> mesh, const MaterialDescription& material,
                                       MechanicsOptions options) {
  for (const ElementBlock& block : mesh->blocks) options.blocks.push_back({block.name, material, {}, {}});
  return std::make_unique<Mechanics>("body", std::move(mesh), std::move(options));
}

inline PrescribedMotion motion(PrescribedMotion::Kind kind, std::vector<std::string> sets) {
  PrescribedMotion m;
  m.kind = kind;
  m.label = "motion " + std::to_string(static_cast<int>(kind)) + " of " + sets.front();
  m.node_sets = std::move(sets);
  return m;
}

inline PrescribedMotion symmetry(const std::string& set, const Vec3& normal) {
  PrescribedMotion m = motion(PrescribedMotion::Kind::symmetry, {set});
  m.normal = normal;
  return m;
}

/// Steps to `end` as the simulation does; returns the number of steps.
inline int run_to(Mechanics& body, double end) {
  int steps = 0;
  while (body.time() < end) {
    const double left = end - body.time(), dt = body.time_step();
    body.advance(dt >= left * (1 - 1e-9) ? left : dt);
    ++steps;
  }
  return steps;
}

inline std::map<std::string, double> energy_rows(Mechanics& body) {
  std::vector<EnergyTerm> terms;
  body.energies(terms);
  std::map<std::string, double> rows;
  for (const EnergyTerm& term : terms) rows[term.row] = body.mesh().comm.sum(term.local);
  return rows;
}

/// Follows the residual of a body's ledger.
class Ledger {
 public:
  explicit Ledger(Mechanics& body) : body_(body), initial_(balance(scale_)) {}
  /// |stored - initial - supplied| relative to the greatest sum of |rows| so far.
  double error() {
    double size = 0;
    const double residual = balance(size) - initial_;
    scale_ = std::max(scale_, size);
    return std::abs(residual) / scale_;
  }

 private:
  double balance(double& size) {
    std::vector<EnergyTerm> terms;
    body_.energies(terms);
    double sum = 0;
    size = 0;
    for (const EnergyTerm& term : terms) {
      const double value = body_.mesh().comm.sum(term.local);
      if (term.role == EnergyTerm::Role::memo) continue;
      sum += term.role == EnergyTerm::Role::stored ? value : -value;
      size += std::abs(value);
    }
    return sum;
  }
  Mechanics& body_;
  double scale_ = 0;
  double initial_;
};

/// Local values of a field, nodes or elements.
inline std::vector<double> field(Mechanics& body, const std::string& name) {
  for (const ExportPort& port : body.exports()) {
    if (port.field.name != name) continue;
    const auto items =
        static_cast<std::size_t>(port.field.location == Location::node ? body.mesh().nodes() : body.mesh().elements());
    std::vector<double> values(items * static_cast<std::size_t>(port.field.components));
    port.read(values);
    return values;
  }
  ADD_FAILURE() << "no field " << name;
  return {};
}

/// A field in global order on rank 0, from the owners.
inline std::vector<double> in_global_order(Mechanics& body, const std::string& name) {
  const Mesh& mesh = body.mesh();
  const std::vector<double> values = field(body, name);
  std::vector<GlobalId> ids, owned;
  std::vector<int> owners;
  const auto ports = body.exports();
  const auto port = std::ranges::find(ports, name, [](const ExportPort& p) { return p.field.name; });
  if (port == ports.end()) return {};
  const bool nodal = port->field.location == Location::node;
  if (nodal) {
    ids = mesh.node_ids, owners = mesh.node_owners;
  } else {
    for (const ElementBlock& block : mesh.blocks) {
      ids.insert(ids.end(), block.ids.begin(), block.ids.end());
      owners.insert(owners.end(), block.owners.begin(), block.owners.end());
    }
  }
  const auto components = static_cast<std::size_t>(port->field.components);
  std::vector<double> mine;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (owners[i] != mesh.comm.rank()) continue;
    owned.push_back(ids[i]);
    for (std::size_t c = 0; c < components; ++c) mine.push_back(values[components * i + c]);
  }
  const std::vector<GlobalId> all_ids = mesh.comm.gather<GlobalId>(owned);
  const std::vector<double> all = mesh.comm.gather<double>(mine);
  std::vector<double> sorted(all.size());
  for (std::size_t i = 0; i < all_ids.size(); ++i)
    for (std::size_t c = 0; c < components; ++c)
      sorted[components * static_cast<std::size_t>(all_ids[i]) + c] = all[components * i + c];
  return sorted;
}

/// Equal to the last bit; says where not.
inline void expect_same_bits(const std::vector<double>& a, const std::vector<double>& b, const std::string& what) {
  ASSERT_EQ(a.size(), b.size()) << what;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (std::memcmp(&a[i], &b[i], sizeof(double)) != 0) {
      ADD_FAILURE() << what << "[" << i << "]: " << a[i] << " against " << b[i];
      return;
    }
}

}  // namespace tenon::testing
