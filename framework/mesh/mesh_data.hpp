// SPDX-License-Identifier: BSD-3-Clause
// A whole mesh in one place, as readers and generators make it. Lives on rank 0 until it is distributed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "framework/base/types.hpp"
#include "framework/mesh/topology.hpp"

namespace tenon {

/// Elements of one kind that share a name. Global element ids count through the blocks in order.
struct BlockData {
  std::string name;
  std::int64_t label = 0;  ///< id in the file
  ElementKind kind = ElementKind::hex8;
  std::vector<GlobalId> connectivity;  ///< elements x nodes, 0-based node numbers
  std::vector<std::int64_t> labels;    ///< element ids in the file
  std::size_t size() const { return labels.size(); }
};

struct NodeSetData {
  std::string name;
  std::int64_t label = 0;
  std::vector<GlobalId> nodes;  ///< ascending, unique
};

struct SideData {
  GlobalId element;
  int side;  ///< 0-based
  auto operator<=>(const SideData&) const = default;
};

struct SideSetData {
  std::string name;
  std::int64_t label = 0;
  std::vector<SideData> sides;  ///< ascending, unique
};

struct MeshData {
  std::string source;                     ///< file or generator, for messages
  std::vector<Vec3> coordinates;          ///< m
  std::vector<std::int64_t> node_labels;  ///< node ids in the file
  std::vector<double> volumes;            ///< of nodes that are particles, m^3 (2-D m^2, 1-D m); empty: none are
  std::vector<BlockData> blocks;
  std::vector<NodeSetData> node_sets;
  std::vector<SideSetData> side_sets;
  std::vector<std::string> warnings;  ///< what a reader left out or renamed, for the log

  std::size_t elements() const {
    std::size_t n = 0;
    for (const BlockData& b : blocks) n += b.size();
    return n;
  }
};

/// Names and sizes of a mesh, known to every rank before the mesh is distributed; what a scene is checked against.
struct MeshSummary {
  struct Entry {
    std::string name;
    std::int64_t label = 0;
    std::int64_t count = 0;
    ElementKind kind = ElementKind::hex8;  ///< of blocks
  };
  std::string source;
  std::int64_t nodes = 0, elements = 0;
  Vec3 low{}, high{};  ///< bounding box, m
  std::vector<Entry> blocks, node_sets, side_sets;
};
MeshSummary summarise(const MeshData& mesh);

/// Throws Error(geometry) naming the first elements (label, block, place) of a solid whose Jacobian determinant is not
/// positive at a corner, or a surface element without area; Error(file) for connectivity out of range, repeated nodes
/// in an element or coordinates not finite. Lists at most five of them and says how many there are.
void check(const MeshData& mesh);

/// Sides of solid elements that no other solid shares, ascending; surface elements give side 0.
std::vector<SideData> skin(const MeshData& mesh);
/// Adds the side set "skin" and, for every side set, a node set of the same name where there is none yet.
void add_derived_sets(MeshData& mesh);

}  // namespace tenon
