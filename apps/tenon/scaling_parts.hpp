// SPDX-License-Identifier: BSD-3-Clause
// The parts of a scene as P ranks would hold them, by the partitions that a run uses, and what each phase does there.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "apps/tenon/build_simulation.hpp"
#include "apps/tenon/scaling_load.hpp"
#include "apps/tenon/trial_steps.hpp"
#include "framework/search/search_parts.hpp"

namespace tenon {

class Contact;
class Sph;

/// The mesh of a component in P parts.
struct MeshParts {
  int parts = 1;
  std::vector<int> element_part, node_part;     ///< owners
  std::vector<double> local_cost, local_nodes;  ///< of each part: of its elements and nodes, ghosts included
  Traffic ghosts{1};                            ///< one byte of each ghost node, from its owner
};
MeshParts divide_mesh(const Mesh& mesh, const BuiltScene::Division& division, int parts);

/// Counts of a trial that loads are made of.
struct ScalingTrial {
  const Trial& trial;
  SearchDecomposition decomposition;  ///< of search and enforcement, and of particles
  double least_work = 0;              ///< see ContactOptions
};

std::vector<PhaseLoad> mesh_loads(const Component& component, const BuiltScene::Division& division,
                                  const MeshParts& mesh, const Trial& trial);
std::vector<PhaseLoad> particle_loads(Sph& sph, const MeshParts& home, const ScalingTrial& trial, bool in_contact);
/// `homes`: of the parties, in their order.
std::vector<PhaseLoad> contact_loads(const Contact& contact, const std::vector<const MeshParts*>& homes,
                                     const ScalingTrial& trial);

}  // namespace tenon
