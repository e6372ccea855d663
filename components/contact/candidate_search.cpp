// SPDX-License-Identifier: BSD-3-Clause
#include "components/contact/candidate_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tenon::contact {

namespace {

// Of the least height of a node's faces: a fifth costs few candidates beyond the touching ones, and a body that
// deforms slowly keeps its candidates for tens of steps.
constexpr double relative_skin = 0.2;
// What moves fast, an impactor, gets skins for so many steps, as long as they stay below half of that height: wider
// ones would find all the neighbours on the node's own surface.
constexpr double steps_ahead = 30, greatest_relative_skin = 0.5;
// A search must be right for its own step, and for a sudden kick in it.
constexpr double step_margin = 2;
// While nothing at all is near, skins grow up to so many times.
constexpr double greatest_widening = 64;
// Faces that meet at more than 30 degrees have an edge that can meet another one before any node meets a face.
constexpr double cosine_of_sharp = 0.8660254037844387;

Vec3 unit(const Vec3& a) {
  const double length = norm(a);
  return length > 0 ? (1 / length) * a : Vec3{};
}

double squared(const Vec3& a) {
  return dot(a, a);
}

}  // namespace

CandidateSearch::CandidateSearch(const Communicator& comm, const ContactSurfaces& surfaces,
                                 SearchDecomposition decomposition)
    : comm_(comm),
      surfaces_(surfaces),
      face_search_(comm, decomposition, "contact search"),
      edge_search_(comm, decomposition, "contact edge search"),
      ball_search_(comm, decomposition, "contact particle search") {}

Vec3 CandidateSearch::place(const SurfaceNode& node) const {
  return surfaces_.parties()[static_cast<std::size_t>(node.party)]
      ->contact_positions()[static_cast<std::size_t>(node.node)];
}

Vec3 CandidateSearch::velocity(const SurfaceNode& node) const {
  return surfaces_.parties()[static_cast<std::size_t>(node.party)]
      ->contact_velocities()[static_cast<std::size_t>(node.node)];
}

double CandidateSearch::used(double dt) const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (!sought_) return infinity;
  double greatest = 0;
  bool lost = false;
  const Vec3 before = since_ * common_, step = dt * common_;
  constexpr std::ptrdiff_t ahead = 16;
  auto next = sought_nodes_.begin();
  for (std::size_t p = 0; p < surfaces_.parties().size(); ++p) {
    if (const DistantParty* const distant = surfaces_.distant()[p]; distant && distant->resting()) {
      greatest = std::max(greatest, distant->used_squared(before, step, dt));
      while (next != sought_nodes_.end() && next->party == static_cast<std::int32_t>(p)) ++next;
      continue;
    }
    const std::span<const Vec3> x = surfaces_.parties()[p]->contact_positions();
    const std::span<const Vec3> v = surfaces_.parties()[p]->contact_velocities();
    for (; next != sought_nodes_.end() && next->party == static_cast<std::int32_t>(p); ++next) {
      const auto i = static_cast<std::size_t>(next->node);
      if (sought_nodes_.end() - next > ahead) {  // nodes of a surface are scattered over a body
        const SoughtNode& later = next[ahead];
        if (later.party == next->party) {
          __builtin_prefetch(&x[static_cast<std::size_t>(later.node)]);
          __builtin_prefetch(&v[static_cast<std::size_t>(later.node)]);
        }
      }
      const Vec3 moved = x[i] - next->place - before;
      // At the end of the step and at its start; in this order what is not a number stays so.
      const double share = std::max(squared(moved + (dt * v[i] - step)), squared(moved)) * next->inverse_square;
      greatest = std::max(greatest, share);
      lost = lost || !(share < infinity);  // what is not a number has left its skin, too
    }
  }
  return std::sqrt(comm_.max(lost ? infinity : greatest));
}

void CandidateSearch::run(double dt) {
  since_ = 0;
  choose_skins(dt);
  make_boxes();
  face_search_.find(node_boxes_, face_boxes_, node_faces_);
  surfaces_.around_nodes(face_normal_, around_);
  find_sharp_edges();
  edge_search_.find_within(edge_boxes_, edge_edges_);
  find_balls();
  sought_ = true;
}

void CandidateSearch::choose_skins(double dt) {
  const std::vector<SurfaceNode>& nodes = surfaces_.nodes();
  std::array<ExactSum, 3> sums;
  std::vector<Vec3> v(nodes.size());
  sought_nodes_.resize(nodes.size());
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    sought_nodes_[n].place = place(nodes[n]), v[n] = velocity(nodes[n]);
    for (std::size_t c = 0; c < 3; ++c) sums[c].add(v[n][c]);
  }
  std::array<double, 3> total{};
  comm_.sum(sums, total);
  const std::int64_t count = comm_.sum(static_cast<std::int64_t>(nodes.size()));
  for (std::size_t c = 0; c < 3; ++c) common_[c] = count > 0 ? total[c] / static_cast<double>(count) : 0;
  skin_.resize(nodes.size());
  const auto share_of = [&](std::size_t n, double way) {
    const double size = nodes[n].size;
    return std::min(std::max(relative_skin * size, steps_ahead * way), greatest_relative_skin * size);
  };
  // Whichever node leaves its skin first ends all of them: none needs more than the fastest would go until then.
  double steps = std::numeric_limits<double>::infinity(), fastest = 0;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const double way = dt * norm(v[n] - common_);
    if (way > 0) steps = std::min(steps, share_of(n, way) / way);
    fastest = std::max(fastest, way);
  }
  std::array<double, 2> greatest{-steps, fastest};
  comm_.max(std::span<double>(greatest));
  const double enough = greatest[1] > 0 ? -greatest[0] * greatest[1] : std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const double way = dt * norm(v[n] - common_);
    const double share = std::min(share_of(n, way), enough);
    const double expected = expected_.empty() ? 0 : expected_[n];
    skin_[n] = std::max(widening_ * share, step_margin * (way + expected));
    sought_nodes_[n].inverse_square = 1 / (skin_[n] * skin_[n]);
    sought_nodes_[n].node = nodes[n].node, sought_nodes_[n].party = nodes[n].party;
  }
  surfaces_.at_corners<double>(skin_, corner_skin_);
  surfaces_.at_far_ends<double>(skin_, far_skin_);
}

void CandidateSearch::make_boxes() {
  const std::vector<SurfaceNode>& nodes = surfaces_.nodes();
  const std::vector<SurfaceFace>& faces = surfaces_.faces();
  node_boxes_.assign(nodes.size(), Box{});
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    node_boxes_[n].add(sought_nodes_[n].place);
    node_boxes_[n].inflate(skin_[n] + nodes[n].radius);
  }
  face_boxes_.assign(faces.size(), Box{});
  planes_.resize(faces.size()), face_normal_.resize(faces.size()), face_skin_.resize(faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const std::span<const Vec3> x = surfaces_.parties()[static_cast<std::size_t>(faces[f].party)]->contact_positions();
    std::array<Vec3, 4> corner{};
    double skin = 0;
    for (int k = 0; k < faces[f].count(); ++k) {
      const auto i = static_cast<std::size_t>(k);
      corner[i] = x[static_cast<std::size_t>(faces[f].nodes[i])];
      face_boxes_[f].add(corner[i]);
      skin = std::max(skin, corner_skin_[static_cast<std::size_t>(surfaces_.corner_slot(f, k))]);
    }
    face_skin_[f] = skin;
    face_boxes_[f].inflate(skin + faces[f].radius);
    const bool triangle = faces[f].count() == 3;
    planes_[f].normal = unit(triangle ? cross(corner[1] - corner[0], corner[2] - corner[0])
                                      : cross(corner[2] - corner[0], corner[3] - corner[1]));
    face_normal_[f] = planes_[f].normal;
    planes_[f].centre = triangle ? (1.0 / 3) * (corner[0] + corner[1] + corner[2])
                                 : 0.25 * (corner[0] + corner[1] + corner[2] + corner[3]);
  }
}

FaceShape CandidateSearch::sought_face(LocalIndex face) const {
  const SurfaceFace& of = surfaces_.faces()[static_cast<std::size_t>(face)];
  const std::span<const Vec3> x = surfaces_.parties()[static_cast<std::size_t>(of.party)]->contact_positions();
  FaceShape shape{of.count(), {}};
  for (int k = 0; k < of.count(); ++k)
    shape.x[static_cast<std::size_t>(k)] = x[static_cast<std::size_t>(of.nodes[static_cast<std::size_t>(k)])];
  return shape;
}

// Rims of shells, edges between shells that meet at an angle, and edges of solids that stand out.
void CandidateSearch::find_sharp_edges() {
  const std::vector<SurfaceEdge>& edges = surfaces_.edges();
  surfaces_.at_edge_faces<FacePlane>(planes_, edge_planes_);
  sharp_.clear(), outward_.clear(), edge_boxes_.clear();
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const SurfaceEdge& edge = edges[e];
    const std::span<const Vec3> x = surfaces_.parties()[static_cast<std::size_t>(edge.party)]->contact_positions();
    Vec3 outward{};
    if (!edge.two_sided && edge.faces != 2) continue;  // beside what is tied, or where blocks meet at an edge
    if (edge.faces == 2) {
      const FacePlane& a = edge_planes_[static_cast<std::size_t>(edge.face_slots[0])];
      const FacePlane& b = edge_planes_[static_cast<std::size_t>(edge.face_slots[1])];
      const double cosine = dot(a.normal, b.normal);
      if ((edge.two_sided ? std::abs(cosine) : cosine) > cosine_of_sharp) continue;
      const Vec3& end = x[static_cast<std::size_t>(edge.nodes[0])];
      if (!edge.two_sided && dot(a.normal, b.centre - end) + dot(b.normal, a.centre - end) >= 0) continue;
      if (!edge.two_sided) outward = 0.5 * (a.normal + b.normal);
    }
    Box box;
    for (const LocalIndex n : edge.nodes) box.add(x[static_cast<std::size_t>(n)]);
    box.inflate(std::max(skin_[static_cast<std::size_t>(edge.ends[0].home.index)], far_skin_[e]) + edge.radius);
    sharp_.push_back(static_cast<LocalIndex>(e));
    outward_.push_back(outward);
    edge_boxes_.push_back(box);
  }
}

std::int64_t CandidateSearch::memory() const {
  return static_cast<std::int64_t>(
      (node_boxes_.capacity() + face_boxes_.capacity() + edge_boxes_.capacity() + ball_boxes_[0].capacity() +
       ball_boxes_[1].capacity()) *
          sizeof(Box) +
      sought_nodes_.capacity() * sizeof(SoughtNode) + outward_.capacity() * sizeof(Vec3) +
      (planes_.capacity() + edge_planes_.capacity()) * sizeof(FacePlane) +
      (skin_.capacity() + corner_skin_.capacity() + face_skin_.capacity()) * sizeof(double) +
      (node_faces_.capacity() + edge_edges_.capacity() + ball_balls_.capacity()) * sizeof(BoxPair));
}

}  // namespace tenon::contact
