// SPDX-License-Identifier: BSD-3-Clause
// What ranks have given of the nodes of a mesh, kept in shares: numbers, places, owners. Private to the assembly.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "framework/mesh/assemble.hpp"

namespace tenon {

/// What a rank learns of a node that it gave or uses.
struct NodeAnswer {
  GlobalId id = no_id;  ///< in the mesh; no_id: nobody gave the node
  int owner = -1;
};

class NodeTable {
 public:
  /// Collective. `used`: ids of the nodes of this rank's elements, each once. Throws Error(file) on all ranks where
  /// copies of a node disagree.
  NodeTable(const Communicator& comm, const MeshPart& part, std::span<const std::int64_t> used,
            const AssembleOptions& options);

  const std::vector<NodeAnswer>& given() const { return given_; }  ///< of MeshPart::node_ids
  const std::vector<NodeAnswer>& used() const { return used_; }
  GlobalId count() const { return count_; }  ///< over all ranks

  /// The first rank that gave each node, and where it stands there.
  struct Givers {
    std::vector<int> ranks;
    std::vector<LocalIndex> places;
  };
  /// Collective. Fills in the local nodes that mesh.node_ids names; who gave them.
  Givers pull(Mesh& mesh, const std::string& name) const;

 private:
  void take_given(const ExchangePlan& plan, const MeshPart& part, const AssembleOptions& options);
  void choose_owners(const std::vector<std::int64_t>& labels, const std::vector<int>& ranks);

  Communicator comm_;
  std::vector<NodeAnswer> given_, used_;
  GlobalId count_ = 0, first_ = 0;
  std::vector<GlobalId> firsts_;  // first number of each rank's share
  // This rank's share, ascending by label.
  std::vector<std::int64_t> labels_;
  std::vector<Vec3> coordinates_;
  std::vector<int> owners_;
  Givers givers_;
};

/// Collective. Throws Error(file) on all ranks if any counts a problem: that of the lowest such rank, and the number
/// of all.
void refuse_if_any(const Communicator& comm, std::int64_t problems, const std::string& source, const std::string& what,
                   const std::string& first, const std::string& advice);

}  // namespace tenon
