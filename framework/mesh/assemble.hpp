// SPDX-License-Identifier: BSD-3-Clause
// A distributed mesh from the parts that another code already holds on its ranks; nothing is gathered in one place.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "framework/mesh/mesh.hpp"

namespace tenon {

/// Elements of one block that this rank owns.
struct BlockPart {
  std::string name;
  ElementKind kind = ElementKind::hex8;
  std::span<const std::int64_t> connectivity;  ///< elements x topology(kind).nodes, by the code's own node ids
  /// The code's own element ids, each once in the block over all ranks. Empty: the block's elements have none (on any
  /// rank), and are told apart by their nodes.
  std::span<const std::int64_t> ids;
};

/// What this rank has. Ids are any 64-bit numbers. A node may be given on several ranks, with the same coordinates, and
/// must be given on one at least if an element uses it. A rank may give nothing, and leave out blocks of which it has
/// nothing. Everything need live only during the call.
struct MeshPart {
  std::span<const std::int64_t> node_ids;
  std::span<const Vec3> coordinates;  ///< m, of `node_ids`
  std::vector<BlockPart> blocks;
};

struct AssembleOptions {
  std::string source = "mesh";      ///< what messages call this mesh
  double coordinate_tolerance = 0;  ///< m; copies of a node that differ by no more count as the same
};

/// The mesh, and the way between the order in which this rank gave its nodes and elements ("given", elements of all
/// blocks one after the other) and the order of the mesh ("local", owned and ghost). Elements stay with the rank that
/// gave them; a node belongs to one of the ranks that own an element at it, or, without elements, to the first that
/// gave it. Nodes of the mesh are numbered from 0 in the order of the code's ids, blocks stand in the order of their
/// names, elements in them in the order of their ids, or of their nodes if they have none. So no number depends on
/// the ranks. Mesh::node_labels and ElementBlock::labels keep the code's ids (of elements without: their number + 1).
class AssembledMesh {
 public:
  std::shared_ptr<const Mesh> mesh;

  /// Collective. `components` values of each given node -> those of each local node, ghosts too. Where ranks gave
  /// the same node, that of the lowest rank counts.
  std::vector<double> nodes_to_mesh(std::span<const double> given, int components = 1) const;
  std::vector<Vec3> nodes_to_mesh(std::span<const Vec3> given) const;
  /// Collective. Values of each local node -> those of each given node, from the rank that owns it.
  std::vector<double> nodes_from_mesh(std::span<const double> local, int components = 1) const;
  /// Collective. The same for elements.
  std::vector<double> elements_to_mesh(std::span<const double> given, int components = 1) const;
  /// Local.
  std::vector<double> elements_from_mesh(std::span<const double> local, int components = 1) const;

  /// Collective. As above without allocation, for each step: arrays must have all places.
  void nodes_to_mesh(std::span<const double> given, std::span<double> local, int components) const;
  void nodes_from_mesh(std::span<const double> local, std::span<double> given, int components) const;

 private:
  friend class Assembly;
  ExchangePlan nodes_to_mesh_, nodes_from_mesh_, elements_to_mesh_;
  std::vector<LocalIndex> element_places_;  // of given elements, among the local elements of all blocks
  std::size_t given_nodes_ = 0;
};

/// Collective. Throws Error(file), the same on all ranks: for arrays whose sizes do not belong together, a block given
/// twice on a rank or with different kinds, a node that elements use and nobody gave, copies of a node at different
/// places, coordinates that are not finite, and an element given twice.
AssembledMesh assemble(const Communicator& comm, const MeshPart& part, const AssembleOptions& options = {});

}  // namespace tenon
