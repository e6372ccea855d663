// SPDX-License-Identifier: BSD-3-Clause
// Everything that may touch, where the parties keep it: nodes, faces and edges of all their surfaces.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "framework/comm/exchange_plan.hpp"
#include "framework/search/box_pairs.hpp"
#include "framework/simulation/contact_party.hpp"
#include "framework/simulation/distant_party.hpp"

namespace tenon::contact {

/// A node of a surface, on the rank that owns it.
struct SurfaceNode {
  GlobalId id;  ///< over all parties
  std::int32_t party;
  LocalIndex node;       ///< in the party's mesh
  std::int32_t surface;  ///< the least of its faces
  double size;           ///< m: least height of its faces, undeformed
  double area;           ///< m^2: its share of its faces, undeformed
  double radius;         ///< m: half the greatest thickness of its faces, or that of a particle
};

/// A corner of a face or an edge: who it is and where it is kept.
struct Corner {
  GlobalId id = no_id;
  ItemHandle home{-1, no_index};  ///< rank that owns it, and index in its nodes()
};

/// A face, on the rank that owns its element.
struct SurfaceFace {
  GlobalId id;  ///< over all parties
  std::int32_t party;
  std::array<LocalIndex, 4> nodes;  ///< in the party's mesh; [3] no_index for a triangle
  std::array<Corner, 4> corners;
  std::array<GlobalId, 4> behind;  ///< nodes of a solid's element that are not on the face, or no_id
  std::int32_t surface;
  double radius;  ///< m: half the thickness
  double depth;   ///< m
  bool two_sided;
  int count() const { return nodes[3] == no_index ? 3 : 4; }
};

/// An edge of faces, on the rank that owns its end of least id; ends ascend by id.
struct SurfaceEdge {
  std::int32_t party;
  std::array<LocalIndex, 2> nodes;  ///< in the party's mesh
  std::array<Corner, 2> ends;
  std::int32_t surface;
  double radius;  ///< m
  double depth;   ///< m
  bool two_sided;
  std::int32_t faces;                    ///< that meet here
  std::array<LocalIndex, 2> face_slots;  ///< of the first two, by ascending id: in edge_face_normals
};

/// Global ids of nodes ascend with the party and the mesh's ids, those of faces likewise; nothing depends on the ranks.
class ContactSurfaces {
 public:
  ContactSurfaces(const Communicator& comm, std::vector<ContactParty*> parties, std::vector<std::string> party_names);

  /// Collective. Takes the faces of all parties as they are now.
  void build();
  /// Local; the same on every rank. Some party's faces have changed since.
  bool stale() const;

  const std::vector<ContactParty*>& parties() const { return parties_; }
  /// Of each party: what it is beside a ContactParty, or null.
  const std::vector<DistantParty*>& distant() const { return distant_; }
  const std::vector<SurfaceNode>& nodes() const { return nodes_; }  ///< ascending by id
  const std::vector<SurfaceFace>& faces() const { return faces_; }  ///< ascending by id
  const std::vector<SurfaceEdge>& edges() const { return edges_; }  ///< ascending by ids of their ends
  double effusivity(std::int32_t surface) const { return effusivities_[static_cast<std::size_t>(surface)]; }
  /// Of all parties: "plate"; "car.plate" where several parties have a block of that name.
  const std::vector<std::string>& names() const { return names_; }

  /// Parties that consist of particles, ascending: their particles may meet those of other such parties as balls.
  const std::vector<std::int32_t>& particle_parties() const { return particle_parties_; }

  /// Collective. A value of every corner of faces(): from the node's owner; index corner_slot().
  template <typename T>
  void at_corners(std::span<const T> of_nodes, std::vector<T>& result) const {
    result.resize(static_cast<std::size_t>(corner_count_));
    corner_plan_.forward<T>(of_nodes, result);
  }
  LocalIndex corner_slot(std::size_t face, int corner) const {
    return face_slots_[face][static_cast<std::size_t>(corner)];
  }
  /// Collective. A value of every face that meets at an edge: from the face's owner; index SurfaceEdge::face_slots.
  template <typename T>
  void at_edge_faces(std::span<const T> of_faces, std::vector<T>& result) const {
    result.resize(static_cast<std::size_t>(edge_face_count_));
    edge_face_plan_.forward<T>(of_faces, result);
  }

  /// Collective. The normals of the faces around every node, by ascending id of the faces: those of nodes()[n] are
  /// normals_of(result, n). Of shells and particles zero: they have no outside.
  void around_nodes(std::span<const Vec3> face_normals, std::vector<Vec3>& result) const;
  std::span<const Vec3> normals_of(const std::vector<Vec3>& around, std::size_t node) const {
    return std::span(around).subspan(claim_first_[node], claim_first_[node + 1] - claim_first_[node]);
  }
  /// Collective. A value of the second end of every edge: from the node's owner; index as edges().
  template <typename T>
  void at_far_ends(std::span<const T> of_nodes, std::vector<T>& result) const {
    result.resize(edges_.size());
    far_end_plan_.forward<T>(of_nodes, result);
  }

  /// Where a node is among nodes(), or no_index.
  LocalIndex find_node(GlobalId id) const;
  GlobalId node_count() const { return node_offsets_.back(); }
  /// Over all parties: id of a local node of a party, and number of a party's first surface.
  GlobalId node_id(std::size_t party, LocalIndex node) const {
    return node_offsets_[party] + parties_[party]->contact_mesh().node_ids[static_cast<std::size_t>(node)];
  }
  std::int32_t first_surface(std::size_t party) const { return surface_offsets_[party]; }
  std::int64_t memory() const;

 private:
  void take_faces();
  void find_nodes();
  void find_edges();
  void name_surfaces(const std::vector<std::string>& party_names);
  Corner corner_of(std::size_t party, LocalIndex node) const;

  Communicator comm_;
  std::vector<ContactParty*> parties_;
  std::vector<DistantParty*> distant_;
  std::vector<GlobalId> node_offsets_, face_offsets_;  // of each party, and the end
  std::vector<std::int32_t> surface_offsets_, particle_parties_;
  std::vector<std::int64_t> versions_;
  std::vector<std::string> names_;
  std::vector<double> effusivities_;
  std::vector<SurfaceNode> nodes_;
  std::vector<SurfaceFace> faces_;
  std::vector<SurfaceEdge> edges_;
  std::vector<std::array<LocalIndex, 4>> face_slots_;
  LocalIndex corner_count_ = 0, edge_face_count_ = 0;
  std::vector<std::size_t> claim_order_, claim_first_;  // of what faces say of nodes: by node and face
  std::vector<LocalIndex> claim_faces_;                 // whose claims these are; no_index: of particles
  ExchangePlan claim_plan_, corner_plan_, edge_face_plan_, far_end_plan_;
};

}  // namespace tenon::contact
