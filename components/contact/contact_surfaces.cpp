// SPDX-License-Identifier: BSD-3-Clause
#include "components/contact/contact_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <set>

namespace tenon::contact {

namespace {

/// What a face says about a corner of it, sent to the rank that owns the node.
struct NodeClaim {
  GlobalId node;  // of the party's mesh
  std::int32_t party, surface;
  GlobalId face;  // over all parties
  double size, area, radius;
};

/// An edge of a face, sent to the rank that owns the end of least id.
struct EdgeClaim {
  std::array<GlobalId, 2> ends;  // over all parties, ascending
  GlobalId face;
  ItemHandle face_home;
  std::array<GlobalId, 2> mesh_ends;  // of the party's mesh, in the same order
  std::int32_t party, surface;
  double radius, depth;
  std::int32_t two_sided;
};

double face_area(const std::array<Vec3, 4>& x, int corners) {
  return 0.5 * norm(corners == 3 ? cross(x[1] - x[0], x[2] - x[0]) : cross(x[2] - x[0], x[3] - x[1]));
}

/// Least height of a face, m: its area over its longest edge.
double face_height(const std::array<Vec3, 4>& x, int corners) {
  double longest = 0;
  for (int k = 0; k < corners; ++k)
    longest = std::max(longest, norm(x[static_cast<std::size_t>((k + 1) % corners)] - x[static_cast<std::size_t>(k)]));
  constexpr double least = 0.05;  // of the longest edge: slivers do not set the skin of all around them
  return longest > 0 ? std::max((corners == 3 ? 2 : 1) * face_area(x, corners) / longest, least * longest) : 0;
}

LocalIndex local_node(const Mesh& mesh, GlobalId id) {
  const auto found = std::ranges::lower_bound(mesh.node_ids, id);
  return found != mesh.node_ids.end() && *found == id ? static_cast<LocalIndex>(found - mesh.node_ids.begin())
                                                      : no_index;
}

}  // namespace

ContactSurfaces::ContactSurfaces(const Communicator& comm, std::vector<ContactParty*> parties,
                                 std::vector<std::string> party_names)
    : comm_(comm), parties_(std::move(parties)), node_offsets_{0}, face_offsets_{0}, surface_offsets_{0} {
  constexpr GlobalId sides = 8;  // ids of faces: 8 element + side
  for (ContactParty* party : parties_) {
    distant_.push_back(dynamic_cast<DistantParty*>(party));
    const Mesh& mesh = party->contact_mesh();
    node_offsets_.push_back(node_offsets_.back() + mesh.global_nodes);
    face_offsets_.push_back(face_offsets_.back() + sides * mesh.global_elements);
    surface_offsets_.push_back(surface_offsets_.back() + static_cast<std::int32_t>(party->surface_names().size()));
    const auto of_particles = [](const ElementBlock& block) { return block.kind == ElementKind::particle; };
    if (!mesh.blocks.empty() && std::ranges::all_of(mesh.blocks, of_particles))
      particle_parties_.push_back(static_cast<std::int32_t>(node_offsets_.size()) - 2);
  }
  name_surfaces(party_names);
}

void ContactSurfaces::name_surfaces(const std::vector<std::string>& party_names) {
  std::multiset<std::string> all;
  for (ContactParty* party : parties_)
    for (const std::string& name : party->surface_names()) all.insert(name);
  for (const ContactParty* party : parties_)
    for (std::size_t s = 0; s < party->surface_names().size(); ++s)
      effusivities_.push_back(party->effusivity(static_cast<std::int32_t>(s)));
  for (std::size_t p = 0; p < parties_.size(); ++p)
    for (const std::string& name : parties_[p]->surface_names())
      names_.push_back(all.count(name) > 1 ? party_names[p] + "." + name : name);
}

bool ContactSurfaces::stale() const {
  if (versions_.empty()) return true;
  for (std::size_t p = 0; p < parties_.size(); ++p)
    if (parties_[p]->surface_version() != versions_[p]) return true;
  return false;
}

void ContactSurfaces::build() {
  versions_.clear();
  for (const ContactParty* party : parties_) versions_.push_back(party->surface_version());
  take_faces();
  find_nodes();
  find_edges();
}

void ContactSurfaces::take_faces() {
  faces_.clear();
  std::vector<ContactFace> own;
  for (std::size_t p = 0; p < parties_.size(); ++p) {
    own.clear();
    parties_[p]->contact_faces(own);
    const Mesh& mesh = parties_[p]->contact_mesh();
    for (const ContactFace& face : own) {
      std::array<GlobalId, 4> behind;
      for (std::size_t k = 0; k < 4; ++k)
        behind[k] = face.behind[k] == no_index
                        ? no_id
                        : node_offsets_[p] + mesh.node_ids[static_cast<std::size_t>(face.behind[k])];
      faces_.push_back({face_offsets_[p] + face.id,
                        static_cast<std::int32_t>(p),
                        face.nodes,
                        {},
                        behind,
                        surface_offsets_[p] + face.surface,
                        0.5 * face.thickness,
                        face.depth,
                        face.two_sided});
    }
  }
}

// Owners of nodes learn from the faces which of them touch; the faces learn where their corners are kept.
void ContactSurfaces::find_nodes() {
  std::vector<int> to;
  std::vector<NodeClaim> claims;
  claim_faces_.clear();
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const SurfaceFace& face = faces_[f];
    const Mesh& mesh = parties_[static_cast<std::size_t>(face.party)]->contact_mesh();
    std::array<Vec3, 4> x{};
    for (int k = 0; k < face.count(); ++k)
      x[static_cast<std::size_t>(k)] =
          mesh.coordinates[static_cast<std::size_t>(face.nodes[static_cast<std::size_t>(k)])];
    const double size = face_height(x, face.count());
    for (int k = 0; k < face.count(); ++k) {
      const auto n = static_cast<std::size_t>(face.nodes[static_cast<std::size_t>(k)]);
      to.push_back(mesh.node_owners[n]);
      claim_faces_.push_back(static_cast<LocalIndex>(f));
      claims.push_back({mesh.node_ids[n], face.party, face.surface, face.id, size,
                        face_area(x, face.count()) / face.count(), face.radius});
    }
  }
  std::vector<ContactParticle> particles;
  for (std::size_t p = 0; p < parties_.size(); ++p) {
    particles.clear();
    parties_[p]->contact_particles(particles);
    const Mesh& mesh = parties_[p]->contact_mesh();
    for (const ContactParticle& particle : particles) {
      to.push_back(comm_.rank());
      claim_faces_.push_back(no_index);
      claims.push_back({mesh.node_ids[static_cast<std::size_t>(particle.node)], static_cast<std::int32_t>(p),
                        surface_offsets_[p] + particle.surface, no_id, 2 * particle.radius,
                        std::numbers::pi * particle.radius * particle.radius, particle.radius});
    }
  }
  const ExchangePlan plan = ExchangePlan::to_ranks(comm_, to, "contact surfaces");
  std::vector<NodeClaim> arrived(static_cast<std::size_t>(plan.received()));
  plan.forward<NodeClaim>(claims, arrived);

  std::vector<std::size_t> order(arrived.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto id_of = [&](const NodeClaim& claim) {
    return node_offsets_[static_cast<std::size_t>(claim.party)] + claim.node;
  };
  std::ranges::sort(order, {}, [&](std::size_t i) { return std::pair(id_of(arrived[i]), arrived[i].face); });
  nodes_.clear(), claim_first_.clear();
  std::vector<LocalIndex> answers(arrived.size());
  std::size_t seen = 0;
  for (const std::size_t i : order) {
    const NodeClaim& claim = arrived[i];
    const GlobalId id = id_of(claim);
    if (nodes_.empty() || nodes_.back().id != id) {
      const Mesh& mesh = parties_[static_cast<std::size_t>(claim.party)]->contact_mesh();
      nodes_.push_back({id, claim.party, local_node(mesh, claim.node), claim.surface, claim.size, 0, claim.radius});
    }
    if (claim_first_.size() < nodes_.size()) claim_first_.push_back(seen);
    ++seen;
    SurfaceNode& node = nodes_.back();
    node.surface = std::min(node.surface, claim.surface);
    node.area += claim.area;
    node.size = std::min(node.size, claim.size), node.radius = std::max(node.radius, claim.radius);
    answers[i] = static_cast<LocalIndex>(nodes_.size() - 1);
  }
  claim_first_.push_back(seen);
  claim_order_ = std::move(order), claim_plan_ = plan;
  std::vector<LocalIndex> places(claims.size());
  plan.reverse<LocalIndex>(answers, places);

  // Each corner pulls from a place of its own: a place more for some nodes, but no search.
  std::vector<int> owners;
  std::vector<LocalIndex> index, into;
  face_slots_.assign(faces_.size(), {});
  std::map<std::pair<int, LocalIndex>, LocalIndex> remote;
  corner_count_ = 0;
  std::vector<LocalIndex> slot_of_own(nodes_.size(), no_index);
  std::size_t c = 0;
  for (std::size_t f = 0; f < faces_.size(); ++f)
    for (int k = 0; k < faces_[f].count(); ++k, ++c) {
      Corner& corner = faces_[f].corners[static_cast<std::size_t>(k)];
      corner.id = node_offsets_[static_cast<std::size_t>(claims[c].party)] + claims[c].node;
      corner.home = {to[c], places[c]};
      LocalIndex* slot = nullptr;
      if (to[c] == comm_.rank())
        slot = &slot_of_own[static_cast<std::size_t>(places[c])];
      else
        slot = &remote.try_emplace({to[c], places[c]}, no_index).first->second;
      if (*slot == no_index) {
        *slot = corner_count_++;
        owners.push_back(to[c]), index.push_back(places[c]), into.push_back(*slot);
      }
      face_slots_[f][static_cast<std::size_t>(k)] = *slot;
    }
  corner_plan_ = ExchangePlan::from_owners(comm_, owners, index, into, "contact corners");
}

void ContactSurfaces::find_edges() {
  std::vector<int> to;
  std::vector<EdgeClaim> claims;
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const SurfaceFace& face = faces_[f];
    const Mesh& mesh = parties_[static_cast<std::size_t>(face.party)]->contact_mesh();
    for (int k = 0; k < face.count(); ++k) {
      auto a = static_cast<std::size_t>(k), b = static_cast<std::size_t>((k + 1) % face.count());
      if (face.corners[b].id < face.corners[a].id) std::swap(a, b);
      if (face.corners[a].id == face.corners[b].id) continue;
      to.push_back(face.corners[a].home.rank);
      claims.push_back({{face.corners[a].id, face.corners[b].id},
                        face.id,
                        {comm_.rank(), static_cast<LocalIndex>(f)},
                        {mesh.node_ids[static_cast<std::size_t>(face.nodes[a])],
                         mesh.node_ids[static_cast<std::size_t>(face.nodes[b])]},
                        face.party,
                        face.surface,
                        face.radius,
                        face.depth,
                        face.two_sided ? 1 : 0});
    }
  }
  const ExchangePlan plan = ExchangePlan::to_ranks(comm_, to, "contact edges");
  std::vector<EdgeClaim> arrived(static_cast<std::size_t>(plan.received()));
  plan.forward<EdgeClaim>(claims, arrived);
  std::ranges::sort(arrived, [](const EdgeClaim& a, const EdgeClaim& b) {
    return a.ends != b.ends ? a.ends < b.ends : a.face < b.face;
  });

  edges_.clear();
  std::vector<int> owners;
  std::vector<LocalIndex> index, into;
  edge_face_count_ = 0;
  for (const EdgeClaim& claim : arrived) {
    if (edges_.empty() || edges_.back().ends[0].id != claim.ends[0] || edges_.back().ends[1].id != claim.ends[1]) {
      const Mesh& mesh = parties_[static_cast<std::size_t>(claim.party)]->contact_mesh();
      SurfaceEdge edge{};
      edge.party = claim.party, edge.surface = claim.surface;
      edge.face_slots = {no_index, no_index};
      for (std::size_t e = 0; e < 2; ++e) {
        edge.nodes[e] = local_node(mesh, claim.mesh_ends[e]);
        edge.ends[e].id = claim.ends[e];
      }
      edges_.push_back(edge);
    }
    SurfaceEdge& edge = edges_.back();
    edge.radius = std::max(edge.radius, claim.radius), edge.depth = std::max(edge.depth, claim.depth);
    edge.two_sided = edge.two_sided || claim.two_sided != 0;
    if (edge.faces < 2) {
      edge.face_slots[static_cast<std::size_t>(edge.faces)] = edge_face_count_;
      owners.push_back(claim.face_home.rank), index.push_back(claim.face_home.index), into.push_back(edge_face_count_);
      ++edge_face_count_;
    }
    ++edge.faces;
  }
  edge_face_plan_ = ExchangePlan::from_owners(comm_, owners, index, into, "contact edge normals");

  // The far end may be kept elsewhere; its owner says where.
  std::vector<int> far;
  std::vector<GlobalId> ids;
  for (SurfaceEdge& edge : edges_) {
    const Mesh& mesh = parties_[static_cast<std::size_t>(edge.party)]->contact_mesh();
    far.push_back(mesh.node_owners[static_cast<std::size_t>(edge.nodes[1])]);
    ids.push_back(edge.ends[1].id);
    edge.ends[0].home = {comm_.rank(), find_node(edge.ends[0].id)};
  }
  const ExchangePlan ask = ExchangePlan::to_ranks(comm_, far, "contact edge ends");
  std::vector<GlobalId> asked(static_cast<std::size_t>(ask.received()));
  ask.forward<GlobalId>(ids, asked);
  std::vector<LocalIndex> found(asked.size()), places(ids.size());
  for (std::size_t i = 0; i < asked.size(); ++i) found[i] = find_node(asked[i]);
  ask.reverse<LocalIndex>(found, places);
  std::vector<LocalIndex> every(edges_.size());
  std::iota(every.begin(), every.end(), LocalIndex{0});
  for (std::size_t e = 0; e < edges_.size(); ++e) edges_[e].ends[1].home = {far[e], places[e]};
  far_end_plan_ = ExchangePlan::from_owners(comm_, far, places, every, "contact edge ends");
}

void ContactSurfaces::around_nodes(std::span<const Vec3> face_normals, std::vector<Vec3>& result) const {
  const auto normal_of = [&](std::size_t claim) {
    const LocalIndex f = claim_faces_[claim];
    const auto face = static_cast<std::size_t>(f);
    return f == no_index || faces_[face].two_sided ? Vec3{} : face_normals[face];
  };
  result.resize(claim_order_.size());
  if (comm_.size() == 1) {  // what is claimed arrives as it is sent
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = normal_of(claim_order_[i]);
    return;
  }
  std::vector<Vec3> send(claim_faces_.size()), arrived(claim_order_.size());
  for (std::size_t c = 0; c < send.size(); ++c) send[c] = normal_of(c);
  claim_plan_.forward<Vec3>(send, arrived);
  for (std::size_t i = 0; i < arrived.size(); ++i) result[i] = arrived[claim_order_[i]];
}

LocalIndex ContactSurfaces::find_node(GlobalId id) const {
  const auto found = std::ranges::lower_bound(nodes_, id, {}, &SurfaceNode::id);
  return found != nodes_.end() && found->id == id ? static_cast<LocalIndex>(found - nodes_.begin()) : no_index;
}

std::int64_t ContactSurfaces::memory() const {
  return static_cast<std::int64_t>(nodes_.capacity() * sizeof(SurfaceNode) + faces_.capacity() * sizeof(SurfaceFace) +
                                   edges_.capacity() * sizeof(SurfaceEdge) +
                                   face_slots_.capacity() * sizeof(face_slots_[0]));
}

}  // namespace tenon::contact
