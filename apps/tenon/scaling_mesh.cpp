// SPDX-License-Identifier: BSD-3-Clause
// Components on meshes: each rank computes its elements and the ghosts around its nodes; velocities of ghost nodes come
// from their owners once a step.
#include <algorithm>

#include "apps/tenon/scaling_parts.hpp"
#include "components/thermal/thermal.hpp"
#include "framework/mesh/dual_graph.hpp"

namespace tenon {

namespace {

/// The whole mesh, which one rank holds: local numbers are global ones.
MeshData whole(const Mesh& mesh) {
  MeshData data;
  data.coordinates = mesh.coordinates;
  for (const ElementBlock& block : mesh.blocks) {
    BlockData b;
    b.name = block.name, b.kind = block.kind, b.labels = block.labels;
    b.connectivity.assign(block.connectivity.begin(), block.connectivity.end());
    data.blocks.push_back(std::move(b));
  }
  return data;
}

constexpr double vector_bytes = 24;

bool is_shell(ElementKind kind) {
  return kind == ElementKind::quad4 || kind == ElementKind::tri3;
}

PhaseLoad load_of(const Component& component, const std::string& phase, const Trial& trial,
                  const std::vector<double>& work, double all) {
  PhaseLoad load;
  load.phase = component.name() + ": " + phase;
  load.group = component.type() == "explicit_mechanics" ? "finite elements" : std::string(component.type());
  load.seconds = trial.phase(load.phase);
  load.whole = all, load.work = work;
  return load;
}

}  // namespace

MeshParts divide_mesh(const Mesh& mesh, const BuiltScene::Division& division, int parts) {
  const MeshData data = whole(mesh);
  MeshParts result;
  result.parts = parts;
  const auto count = static_cast<std::size_t>(parts);
  const Communicator alone = Communicator::self();
  if (parts == 1)
    result.element_part.assign(data.elements(), 0);
  else
    result.element_part = partition_graph(
        alone, dual_graph(data, division.cost, division.method != PartitionMethod::rcb), parts, division.method);
  result.node_part = node_owners(data, result.element_part);
  result.local_cost.assign(count, 0), result.local_nodes.assign(count, 0);
  std::vector<std::int64_t> ghosts;  // part and node
  const auto nodes_of_mesh = static_cast<std::int64_t>(data.coordinates.size());
  std::vector<int> ranks;
  std::size_t element = 0;
  for (const BlockData& block : data.blocks) {
    const auto nodes = static_cast<std::size_t>(topology(block.kind).nodes);
    const double cost = division.cost ? division.cost(block.name, block.kind) : 1.0;
    for (std::size_t e = 0; e < block.size(); ++e, ++element) {
      const std::span<const GlobalId> corners(block.connectivity.data() + e * nodes, nodes);
      ranks.assign(1, result.element_part[element]);
      for (const GlobalId n : corners) {
        const int owner = result.node_part[static_cast<std::size_t>(n)];
        if (std::ranges::find(ranks, owner) == ranks.end()) ranks.push_back(owner);
      }
      for (const int rank : ranks) {
        result.local_cost[static_cast<std::size_t>(rank)] += cost;
        for (const GlobalId n : corners)
          if (result.node_part[static_cast<std::size_t>(n)] != rank) ghosts.push_back(rank * nodes_of_mesh + n);
      }
    }
  }
  std::ranges::sort(ghosts);
  ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());
  for (const int owner : result.node_part) result.local_nodes[static_cast<std::size_t>(owner)] += 1;
  result.ghosts = Traffic(parts);
  for (const std::int64_t key : ghosts) {
    const auto rank = static_cast<int>(key / nodes_of_mesh);
    result.local_nodes[static_cast<std::size_t>(rank)] += 1;
    result.ghosts.add(result.node_part[static_cast<std::size_t>(key % nodes_of_mesh)], rank, 1);
  }
  return result;
}

std::vector<PhaseLoad> mesh_loads(const Component& component, const BuiltScene::Division& division,
                                  const MeshParts& mesh, const Trial& trial) {
  double elements = 0, vectors = 1, rounds = 1;
  for (const ElementBlock& block : component.mesh().blocks) {
    elements += static_cast<double>(block.size()) * (division.cost ? division.cost(block.name, block.kind) : 1.0);
    if (is_shell(block.kind)) vectors = 2;                                                 // and spins
    if (block.kind == ElementKind::tet4 || block.kind == ElementKind::wedge6) rounds = 2;  // nodal volumes
  }
  const auto nodes = static_cast<double>(component.mesh().nodes());
  std::vector<PhaseLoad> loads;
  if (const auto* const thermal = dynamic_cast<const Thermal*>(&component)) {
    for (const char* const phase : {"assemble", "loads"})
      loads.push_back(load_of(component, phase, trial, mesh.local_cost, elements));
    for (const char* const phase : {"solve", "update"})
      loads.push_back(load_of(component, phase, trial, mesh.local_nodes, nodes));
    // An iteration of conjugate gradients: a halo and two sums.
    const double iterations = thermal->steps_taken() > 0 ? static_cast<double>(thermal->solver_iterations()) /
                                                               static_cast<double>(thermal->steps_taken())
                                                         : 0.0;
    mesh.ghosts.book(loads[2], iterations, 8);
    loads[2].reductions = 2 * iterations;
    return loads;
  }
  loads.push_back(load_of(component, "forces", trial, mesh.local_cost, elements));
  loads.push_back(load_of(component, "update", trial, mesh.local_nodes, nodes));
  loads.push_back(load_of(component, "halo", trial, mesh.local_nodes, nodes));
  mesh.ghosts.book(loads.back(), rounds, vectors * vector_bytes);
  // The stable step of the assembled mesh is sought there, by sweeps over the elements.
  loads.push_back(load_of(component, "reduce", trial, mesh.local_cost, elements));
  loads.back().reductions = 1;
  return loads;
}

}  // namespace tenon
