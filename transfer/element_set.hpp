// SPDX-License-Identifier: BSD-3-Clause
// Elements that points are sought in: those that a rank owns, or those that have come to a rendezvous.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "framework/base/box.hpp"
#include "framework/mesh/mesh.hpp"
#include "transfer/mesh_items.hpp"

namespace tenon::transfer {

/// Flat arrays, an entry for each element. Corners are looked up through `nodes`, so that elements of one rank share
/// them.
struct ElementSet {
  std::vector<Vec3> x;             ///< places of nodes, m; one more entry stands behind them, to be read, not used
  std::vector<LocalIndex> nodes;   ///< elements x stride, into x
  std::size_t stride = 0;          ///< nodes of the largest kind
  std::vector<ElementKind> kinds;  ///< one entry if all are of the same kind
  std::vector<GlobalId> ids;       ///< global id of the element (of the face: see FaceId); ties go to the smallest
  std::vector<LocalIndex> items;   ///< place among all elements of the owner's mesh
  std::vector<LocalIndex> index;   ///< place in the owner's set; empty: this is the owner's set
  std::vector<int> owners;         ///< empty: this rank
  std::vector<Box> boxes;          ///< a little larger than the elements; empty (Box{}) where nothing is to be found
  int rank = 0;                    ///< this one

  std::size_t size() const { return ids.size(); }
  ElementKind kind(LocalIndex e) const {
    return kinds.size() == 1 ? kinds.front() : kinds[static_cast<std::size_t>(e)];
  }
  const LocalIndex* nodes_of(LocalIndex e) const { return nodes.data() + static_cast<std::size_t>(e) * stride; }
  std::size_t node_count(LocalIndex e) const { return static_cast<std::size_t>(topology(kind(e)).nodes); }
  GlobalId id(LocalIndex e) const { return ids[static_cast<std::size_t>(e)]; }
  int owner(LocalIndex e) const { return owners.empty() ? rank : owners[static_cast<std::size_t>(e)]; }
  LocalIndex at_owner(LocalIndex e) const { return index.empty() ? e : index[static_cast<std::size_t>(e)]; }
  bool hexahedra() const { return kinds.size() == 1 && kinds.front() == ElementKind::hex8; }
};

/// Corners of one element, in a row.
class CornerList {
 public:
  CornerList(const ElementSet& set, LocalIndex e) : count_(set.node_count(e)) {
    const LocalIndex* const nodes = set.nodes_of(e);
    for (std::size_t a = 0; a < count_; ++a) x_[a] = set.x[static_cast<std::size_t>(nodes[a])];
  }
  std::span<const Vec3> span() const { return {x_.data(), count_}; }
  /// Diagonal of the box of the corners, m.
  double size() const;

 private:
  std::array<Vec3, max_nodes> x_;
  std::size_t count_;
};

/// Which elements of a mesh hold points.
struct ElementChoice {
  std::vector<std::string> blocks;  ///< empty: all
  std::string sides;                ///< a side set: its faces are the elements (for nearest_projection); empty: none
};

/// The elements that a rank owns, where they stand, and what all ranks know of them.
struct Containers {
  ElementSet set;
  double mean_size = 0;   ///< over all ranks, m
  GlobalId count = 0;     ///< sound elements over all ranks
  GlobalId skipped = 0;   ///< elements without volume, over all ranks
  double tolerance = 0;   ///< that the boxes make room for
  bool surfaces = false;  ///< whether any is a surface element, on any rank
};

/// Collective. Throws Error(geometry) naming an inverted element, Error(usage) for a block or side set that is missing.
Containers containers_of(const Mesh& mesh, std::span<const Vec3> coordinates, const ElementChoice& choice,
                         double tolerance, const std::string& transfer);

/// Collective. The same elements elsewhere; checked as above.
void move_containers(Containers& containers, const Mesh& mesh, std::span<const Vec3> coordinates,
                     const std::string& transfer);

}  // namespace tenon::transfer
