// SPDX-License-Identifier: BSD-3-Clause
// The rendezvous: where the points of all ranks lie in the elements of all ranks.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "framework/mesh/mesh.hpp"
#include "transfer/place.hpp"

namespace tenon::transfer {

/// The elements of a mesh that can contain points, where they stand now.
struct Containers {
  std::vector<ElementPacket> elements;  ///< owned by this rank
  std::vector<Box> boxes;               ///< of them, a little larger
  double mean_size = 0;                 ///< over all ranks, m
  GlobalId skipped = 0;                 ///< elements without volume, over all ranks
};

/// Collective. Throws Error(geometry) naming an inverted element, Error(usage) for elements that are not solids.
Containers containers_of(const Mesh& mesh, std::span<const Vec3> coordinates, double tolerance,
                         const std::string& transfer);

/// Collective. The placement of each point of this rank, in order: every point gets an element if there is any at all,
/// however far, on any number of ranks. Points outside cost little while they are nearer than about half an element:
/// those are settled in the first rendezvous, only the others go to further ones, of doubling reach.
std::vector<Placement> locate(const Communicator& comm, const Containers& containers, std::span<const Vec3> points,
                              const PlaceRules& rules, const std::string& name);

/// The nodes of an element, where their owners keep them.
struct ElementNodes {
  std::array<GlobalId, max_nodes> id{};
  std::array<int, max_nodes> owner{};
  std::array<LocalIndex, max_nodes> at_owner{};
  std::int32_t nodes = 0;
  std::size_t count() const { return static_cast<std::size_t>(nodes); }
};

/// The nodes of the elements that points were placed in, fetched from the elements' owners.
class PlacedNodes {
 public:
  /// Collective. `nodes` are the items of the mesh that the points were placed in.
  PlacedNodes(const Mesh& mesh, const Items& nodes, std::span<const Placement> placements, const std::string& name);
  const ElementNodes& of(std::size_t placement) const {
    return nodes_[static_cast<std::size_t>(element_of_[placement])];
  }
  /// The distinct elements.
  std::size_t elements() const { return nodes_.size(); }
  const ElementNodes& element(std::size_t i) const { return nodes_[i]; }

 private:
  std::vector<LocalIndex> element_of_;
  std::vector<ElementNodes> nodes_;
};

}  // namespace tenon::transfer
