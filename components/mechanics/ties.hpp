// SPDX-License-Identifier: BSD-3-Clause
// Nodes that are bound to faces of another part of the mesh.
#pragma once

#include "components/mechanics/load_options.hpp"
#include "components/mechanics/nodal_state.hpp"
#include "components/mechanics/remote_nodes.hpp"

namespace tenon {

/// A tied node moves as the point of the face that it was found at: v = sum w_a v_a with the shape functions of the
/// face there. Its mass and its forces go to the nodes of the face by the same weights, so linear momentum is kept to
/// round-off, and so is angular momentum but for the distance between node and face. As the weights are convex, the
/// nodes of the face have at least the inertia of the constrained system, and no frequency rises.
///   gather   before the kick: forces to the faces, in ascending order of the tied nodes
///   follow   after it: velocities from the faces
/// Rotations of tied nodes stay free.
class Ties {
 public:
  /// Collective. Nodes (other than those of the faces themselves) are searched for within the tolerance. Throws
  /// Error(usage) if one has no face near, or is itself in a face that others are tied to.
  Ties(const Mesh& mesh, const std::vector<TiedSet>& sets);

  bool empty() const { return count_ == 0; }
  std::int64_t count() const { return count_; }  ///< of all ranks
  /// Owned nodes that are tied, ascending.
  const std::vector<LocalIndex>& nodes() const { return nodes_; }
  /// Owned nodes of faces that nodes are tied to, some more than once.
  std::vector<LocalIndex> face_nodes() const;
  /// Collective. Hands the masses over (once).
  void move_mass(NodalState& nodes) const;
  /// Collective.
  void gather(NodalState& nodes) const;
  void follow(NodalState& nodes) const;

  /// Local. Which of nodes() an owned node is, or -1.
  std::int32_t index_of(LocalIndex node) const;
  /// Collective. Per tied node, sum w_a^2 u_a of a value u per node (of all local nodes; owned ones count): what a unit
  /// force on it moves there, if u is the inverse mass.
  std::vector<double> compliance(std::span<const double> values) const;
  /// Collective. Hands vectors at tied nodes (of all local nodes; owned ones count) to the owned nodes of faces:
  /// visit(node, share), in ascending order of the tied nodes.
  template <typename Visit>
  void share(std::span<const Vec3> vectors, Visit visit) const {
    tied_.pull<Vec3>(vectors, vector_);
    for (const Share& s : shares_) visit(s.to, s.weight * vector_[static_cast<std::size_t>(s.from)]);
  }

  /// A node bound to a face.
  struct Record {
    GlobalId node = -1;
    int corners = 0;
    std::array<GlobalId, max_side_nodes> corner{};
    std::array<double, max_side_nodes> weight{};
  };

 private:
  std::vector<Record> find(const Mesh& mesh, const TiedSet& set) const;
  void send_records(const Mesh& mesh, const std::vector<Record>& mine);
  void refuse_chains(const Mesh& mesh, const std::vector<Record>& mine) const;

  struct Share {
    LocalIndex to;      // owned node of a face
    std::int32_t from;  // in what is pulled
    double weight;
  };
  std::int64_t count_ = 0;
  std::vector<LocalIndex> nodes_;
  std::vector<std::array<double, max_side_nodes>> weights_;  // as nodes_
  RemoteNodes corners_;                                      // four per tied node of this rank
  RemoteNodes tied_;                                         // nodes tied to faces with nodes of this rank
  std::vector<Share> shares_;                                // ascending by tied node
  mutable std::vector<Vec3> corner_velocity_;
  mutable std::vector<ForceRow> force_;
  mutable std::vector<Vec3> vector_;
};

}  // namespace tenon
