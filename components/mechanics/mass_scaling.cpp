// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/mass_scaling.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace tenon {

namespace {

/// Steps of the elements one by one. Forces that come along are dropped by the next step, which starts from zero.
void find_steps(const Mesh& mesh, const ElementGroups& groups, NodalState& nodes) {
  int passes = 1;
  for (const auto& group : groups) passes = std::max(passes, group->passes());
  for (int pass = 0; pass + 1 < passes; ++pass)
    for (const auto& group : groups) {
      if (group->rigid || pass + 1 >= group->passes()) continue;
      group->prepare(pass, nodes.arrays(), 0);
      mesh.node_halo.forward<Vec3>(group->nodal_values(), group->nodal_values());
    }
  for (const auto& group : groups)
    if (!group->rigid) group->advance(nodes.arrays(), 0);
}

}  // namespace

AddedMass scale_masses(const Mesh& mesh, const MassScaling& options, double scale, const ElementGroups& groups,
                       NodalState& nodes) {
  const double wanted = options.time_step / scale;
  std::vector<ElementValues> original;
  for (const auto& group : groups) {
    original.push_back(group->mass);
    group->steps.resize(group->mass.size());
  }
  constexpr int most_rounds = 20;  // one is enough where nothing but stiffness limits the step
  bool again = true;
  for (int round = 0; again && round < most_rounds; ++round) {
    find_steps(mesh, groups, nodes);
    again = false;
    for (const auto& group : groups)
      for (LocalIndex e = 0; e < group->size() && !group->rigid; ++e) {
        const double step = value_of(group->steps, e);
        if (!(step > 0) || step >= wanted * (1 - 1e-12)) continue;
        value_of(group->mass, e) *= (wanted / step) * (wanted / step);
        again = true;
      }
    for (const auto& group : groups) group->fill_padding_of(group->mass);
    again = mesh.comm.any(again);
  }
  ExactSum before, added;
  std::int64_t elements = 0;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    groups[g]->steps.clear();
    for (LocalIndex e = 0; e < groups[g]->size(); ++e) {
      if (groups[g]->elements().owners[static_cast<std::size_t>(e)] != mesh.comm.rank()) continue;
      const double old = value_of(original[g], e), now = value_of(groups[g]->mass, e);
      before.add(old), added.add(now), added.add(-old);
      elements += now != old ? 1 : 0;
    }
  }
  const AddedMass result{mesh.comm.sum(added), mesh.comm.sum(before), mesh.comm.sum(elements)};
  if (result.added > options.limit * result.before)
    throw Error(
        ExitCode::usage,
        fmt::format("mass_scaling: a step of {:.4g} s needs {:.4g} kg in {} elements, {:.3g} % of the mass of the "
                    "body; the limit is {:.3g} %: take a smaller step, or raise mass_scaling.limit",
                    options.time_step, result.added, result.elements, 100 * result.added / result.before,
                    100 * options.limit));
  return result;
}

void set_initial_stress(const Mesh& mesh, const InitialStress& initial, const ElementGroups& groups) {
  for (const std::string& name : initial.blocks)
    if (!mesh.find_block(name))
      throw Error(ExitCode::usage, fmt::format("{}: the mesh has no block '{}'", initial.label, name));
  for (const auto& group : groups) {
    const ElementBlock& block = group->elements();
    if (!initial.blocks.empty() && std::ranges::find(initial.blocks, block.name) == initial.blocks.end()) continue;
    const MaterialModel& model = group->model();
    if (topology(block.kind).dimension != 3 || model.needs_deformation_gradient() || model.needs_volume_ratio())
      throw Error(ExitCode::usage,
                  fmt::format("{}: block '{}' cannot start under stress; expected solids whose material adds up stress "
                              "step by step",
                              initial.label, block.name));
    for (LocalIndex e = 0; e < group->size(); ++e) {
      Vec3 centre{};
      const std::span<const LocalIndex> nodes = block.nodes(e);
      for (const LocalIndex n : nodes) centre = centre + mesh.coordinates[static_cast<std::size_t>(n)];
      centre = (1 / static_cast<double>(nodes.size())) * centre;
      for (int p = 0; p < group->points.points(); ++p)
        for (std::size_t c = 0; c < 6; ++c)
          group->points.stress(static_cast<std::size_t>(e / lanes), p)[c][e % lanes] = initial.stress[c](0, centre);
    }
    group->fill_padding();
  }
}

}  // namespace tenon
