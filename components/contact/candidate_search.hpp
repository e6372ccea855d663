// SPDX-License-Identifier: BSD-3-Clause
// Which nodes and faces, and which edges, may meet in the next steps: a search that is kept while skins prove that it
// misses nothing.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "components/contact/contact_options.hpp"
#include "components/contact/contact_surfaces.hpp"
#include "components/contact_geometry/closest_point.hpp"

namespace tenon::contact {

/// Every node has a skin. Boxes of nodes, faces and sharp edges are grown by the skins of their nodes; pairs of boxes
/// that overlap are candidates. As long as no node has moved farther than its skin from where it was, beside a motion
/// that is common to all, no other pair can have met.
class CandidateSearch {
 public:
  CandidateSearch(const Communicator& comm, const ContactSurfaces& surfaces, SearchDecomposition decomposition);

  /// Collective. Finds candidates for steps of about `dt` from the present places; node velocities as the parties show
  /// them.
  void run(double dt);
  /// Collective. How much of their skins the nodes have used up during a step of length dt with the velocities that the
  /// parties show now, its start included: up to 1 the candidates are still all. Infinite before the first search.
  double used(double dt) const;
  /// Local. A search is needed.
  void forget() { sought_ = false; }
  bool sought() const { return sought_; }
  /// Local. Time has passed by a step of length dt (s).
  void passed(double dt) { since_ += dt; }
  /// Local. Skins of the next search, in terms of the usual ones: wider while nothing is near.
  void widen(double by) { widening_ = by; }

  /// Local. Ways (m; of nodes(), or none) that the nodes may go in a step beside those by their velocities: the next
  /// searches have skins for them.
  void expect(std::vector<double> ways) { expected_ = std::move(ways); }
  /// Of a node of this rank: where it was when sought, and its skin.
  struct Sought {
    Vec3 place;             ///< m
    double inverse_square;  ///< 1/m^2
  };
  Sought sought(std::size_t node) const { return {sought_nodes_[node].place, sought_nodes_[node].inverse_square}; }

  /// Pairs on this rank, whoever they belong to: (node, face) and (edge, edge).
  const std::vector<BoxPair>& node_faces() const { return node_faces_; }
  const std::vector<BoxPair>& edge_edges() const { return edge_edges_; }
  /// Particles of different components that may meet; the indices of either side count in balls(side), which are
  /// indices of ContactSurfaces::nodes().
  const std::vector<BoxPair>& ball_balls() const { return ball_balls_; }
  const std::vector<LocalIndex>& balls(std::size_t side) const { return balls_[side]; }
  /// Edges that are sharp, as indices of ContactSurfaces::edges(): what the indices of edge_edges() count in.
  const std::vector<LocalIndex>& sharp_edges() const { return sharp_; }
  /// Of each of the sharp edges: mean outward normal of its faces; zero where both sides count.
  const std::vector<Vec3>& outward() const { return outward_; }
  /// Normals of the faces of this rank, and of those around its nodes (ContactSurfaces::around_nodes), when sought.
  std::span<const Vec3> face_normals() const { return face_normal_; }
  const std::vector<Vec3>& normals_around() const { return around_; }
  /// Of nodes of this rank, m; and of its faces: the greatest of their corners.
  std::span<const double> skins() const { return skin_; }
  std::span<const double> face_skins() const { return face_skin_; }
  /// Local, during the search: present place of a node of this rank, m; and a face of this rank.
  const Vec3& sought_place(LocalIndex node) const { return sought_nodes_[static_cast<std::size_t>(node)].place; }
  FaceShape sought_face(LocalIndex face) const;
  /// Boxes of the last search on this rank: of nodes(), of faces(), of the sharp edges.
  std::span<const Box> node_boxes() const { return node_boxes_; }
  std::span<const Box> face_boxes() const { return face_boxes_; }
  std::span<const Box> edge_boxes() const { return edge_boxes_; }
  /// Counted work of the last searches on this rank: box tests.
  std::int64_t work() const {
    return face_search_.work().tests + edge_search_.work().tests + ball_search_.work().tests;
  }
  /// Velocity that all nodes have in common, m/s: their skins move with it. And the time since the search, s.
  const Vec3& common() const { return common_; }
  double since() const { return since_; }
  std::int64_t memory() const;

 private:
  void choose_skins(double dt);
  void make_boxes();
  void find_sharp_edges();
  void find_balls();
  Vec3 place(const SurfaceNode& node) const;
  Vec3 velocity(const SurfaceNode& node) const;

  Communicator comm_;
  const ContactSurfaces& surfaces_;
  BoxPairSearch face_search_, edge_search_, ball_search_;
  /// Plane of a face, and its middle.
  struct FacePlane {
    Vec3 normal, centre;
  };

  bool sought_ = false;
  double widening_ = 1;  // of skins, while nothing is near
  Vec3 common_{};        // velocity that all share, m/s
  double since_ = 0;     // time since the search, s
  /// What the check of a step reads of a node, in one place.
  struct SoughtNode {
    Vec3 place;             // when sought, m
    double inverse_square;  // of the skin, 1/m^2
    LocalIndex node;
    std::int32_t party;
  };
  std::vector<SoughtNode> sought_nodes_;
  std::vector<double> skin_, corner_skin_, far_skin_, expected_, face_skin_;
  std::vector<Vec3> face_normal_, around_;
  std::vector<FacePlane> planes_, edge_planes_;
  std::vector<Box> node_boxes_, face_boxes_, edge_boxes_;
  std::vector<LocalIndex> sharp_;
  std::vector<Vec3> outward_;
  std::array<std::vector<LocalIndex>, 2> balls_;
  std::array<std::vector<Box>, 2> ball_boxes_;
  std::vector<BoxPair> node_faces_, edge_edges_, ball_balls_;
};

}  // namespace tenon::contact
