// SPDX-License-Identifier: BSD-3-Clause
#include "components/contact/working_set.hpp"

#include <algorithm>
#include <numeric>

#include "framework/mesh/halo.hpp"

namespace tenon::contact {

namespace {

/// An edge likewise.
struct EdgeRecord {
  std::array<NodeRef, 2> ends;
  std::int32_t surface, two_sided;
  double radius, depth, size;
  Vec3 outward;
};

// Of the least height of a node's faces: what is farther off is of no interest, not even as a gap.
constexpr double near_share = 0.1;

// Of the element behind a face: a node that is deeper came from elsewhere.
constexpr double reliable_depth = 0.5;

struct KeyedMemory {
  PairKey key;
  PairMemory memory;
};

/// A node can only press on a face that faces one of its own: not on one that goes on in the same plane, as where two
/// bodies meet edge to edge. Of a corner that points at a plane one normal has a share of 1/sqrt(3) in it.
bool faces_against(const Vec3& of_node, const Vec3& of_face) {
  return of_node == Vec3{} || dot(of_node, of_face) < -0.2;
}

/// The edge of a knife or the end of a needle: its faces turn away from whatever it meets.
bool is_pointed(std::span<const Vec3> around) {
  for (const Vec3& a : around)
    for (const Vec3& b : around)
      if (dot(a, b) < -0.5) return true;
  return false;
}

NodeRef reference(const Corner& corner) {
  return {corner.id, corner.home, -1};
}

bool shares_node(const PairRecord& pair, std::size_t first) {
  for (std::size_t a = 0; a < first; ++a)
    for (auto b = first; b < static_cast<std::size_t>(pair.nodes); ++b)
      if (pair.node[a].id == pair.node[b].id) return true;
  return false;
}

/// Pairs that travel together end here: those of a node with all its faces, or one of any other kind.
template <typename Pair>
std::size_t end_of_group(const std::vector<Pair>& pairs, std::size_t begin) {
  std::size_t end = begin + 1;
  while (pairs[begin].key.kind == 0 && end < pairs.size() && pairs[end].key.kind == 0 &&
         pairs[end].key.ids[0] == pairs[begin].key.ids[0])
    ++end;
  return end;
}

/// Ascending by key; the records are long, so keys are sorted in their place.
void sort_records(std::vector<PairRecord>& records) {
  if (std::ranges::is_sorted(records, {}, &PairRecord::key)) return;
  std::vector<std::pair<PairKey, std::size_t>> order;
  order.reserve(records.size());
  for (std::size_t i = 0; i < records.size(); ++i) order.emplace_back(records[i].key, i);
  std::ranges::sort(order, {}, &std::pair<PairKey, std::size_t>::first);
  std::vector<PairRecord> sorted;
  sorted.reserve(records.size());
  for (const auto& [key, i] : order) sorted.push_back(records[i]);
  records = std::move(sorted);
}

}  // namespace

/// A face as others need to know it.
struct WorkingSet::FaceRecord {
  GlobalId id;
  std::array<GlobalId, 4> behind;
  std::array<NodeRef, 4> corners;
  Vec3 normal;
  std::int32_t count, surface, two_sided, party;
  double radius, depth, skin;
  std::array<Vec3, 4> places;  // of the corners when sought, m
};

WorkingSet::WorkingSet(const Communicator& comm, const ContactSurfaces& surfaces, SearchDecomposition decomposition,
                       double least_work)
    : comm_(comm),
      surfaces_(surfaces),
      decomposition_(decomposition),
      least_work_(least_work),
      parts_made_(comm.size()),
      rcb_(comm) {}

void WorkingSet::build(const CandidateSearch& search, std::span<const PairRecord> extra, const PairFilter& filter,
                       std::span<const std::pair<PairKey, PairMemory>> restored) {
  collect_work();
  remember(restored);
  records_.insert(records_.end(), extra.begin(), extra.end());
  gather_records(search, filter);
  partition();
  send_records();
  connect();
}

/// Memories of the pairs of before go to the homes of their nodes, where the new pairs are made.
void WorkingSet::remember(std::span<const std::pair<PairKey, PairMemory>> restored) {
  std::vector<int> to;
  std::vector<KeyedMemory> send;
  for (const WorkingPair& pair : pairs_) {
    if (!pair.primary || pair.memory.empty()) continue;
    to.push_back(homes_[static_cast<std::size_t>(pair.node[0])].rank);
    send.push_back({pair.key, pair.memory});
  }
  const ExchangePlan plan = ExchangePlan::to_ranks(comm_, to, "contact memory");
  std::vector<KeyedMemory> arrived(static_cast<std::size_t>(plan.received()));
  plan.forward<KeyedMemory>(send, arrived);
  memories_.clear(), lost_.clear();
  for (const KeyedMemory& memory : arrived) memories_.emplace_back(memory.key, memory.memory);
  memories_.insert(memories_.end(), restored.begin(), restored.end());
  std::ranges::sort(memories_, {}, &std::pair<PairKey, PairMemory>::first);
  records_.clear();
}

void WorkingSet::gather_records(const CandidateSearch& search, const PairFilter& filter) {
  add_node_faces(search);
  add_edges(search);
  add_balls(search);
  sort_records(records_);
  std::size_t kept = 0;
  auto memory = memories_.begin();
  const auto pass = [&](const PairKey& key) {  // memories before it that no pair takes over
    for (; memory != memories_.end() && memory->first < key; ++memory) lost_.push_back(memory->second.energy);
  };
  for (PairRecord& record : records_) {
    pass(record.key);
    const bool remembers = memory != memories_.end() && memory->first == record.key;
    if (remembers) record.memory = memory++->second;
    if (filter(record))
      records_[kept++] = record;
    else if (remembers)
      lost_.push_back(record.memory.energy);
  }
  for (; memory != memories_.end(); ++memory) lost_.push_back(memory->second.energy);
  records_.resize(kept);
}

WorkingSet::FaceRecord WorkingSet::record_of(const CandidateSearch& search, LocalIndex index) const {
  const SurfaceFace& face = surfaces_.faces()[static_cast<std::size_t>(index)];
  FaceRecord record;
  record.id = face.id, record.count = face.count(), record.surface = face.surface;
  record.two_sided = face.two_sided ? 1 : 0, record.party = face.party;
  record.radius = face.radius, record.depth = reliable_depth * face.depth, record.behind = face.behind;
  record.normal = search.face_normals()[static_cast<std::size_t>(index)];
  record.skin = search.face_skins()[static_cast<std::size_t>(index)], record.places = search.sought_face(index).x;
  for (std::size_t k = 0; k < 4; ++k) record.corners[k] = reference(face.corners[k]);
  return record;
}

// The rank of the node asks the rank of the face what it is; most faces are its own.
void WorkingSet::add_node_faces(const CandidateSearch& search) {
  turned_away_ = 0;
  std::vector<BoxPair> found;
  if (comm_.size() > 1) {
    std::vector<int> to;
    for (const BoxPair& pair : search.node_faces()) to.push_back(pair.first.rank);
    const ExchangePlan plan = ExchangePlan::to_ranks(comm_, to, "contact candidates");
    found.resize(static_cast<std::size_t>(plan.received()));
    plan.forward<BoxPair>(search.node_faces(), found);
  }
  const std::span<const BoxPair> all = comm_.size() > 1 ? std::span<const BoxPair>(found) : search.node_faces();
  const std::vector<SurfaceFace>& faces = surfaces_.faces();
  std::vector<BoxPair> far;
  for (const BoxPair& pair : all) {
    if (pair.second.rank != comm_.rank()) {
      far.push_back(pair);
      continue;
    }
    // Most of what is near a node on its own surface is left out before anything is copied.
    const auto f = static_cast<std::size_t>(pair.second.index);
    const SurfaceNode& node = surfaces_.nodes()[static_cast<std::size_t>(pair.first.index)];
    if (faces[f].party == node.party && (std::ranges::find(faces[f].nodes, node.node) != faces[f].nodes.end() ||
                                         std::ranges::find(faces[f].behind, node.id) != faces[f].behind.end()))
      continue;
    if (!may_press(search, pair.first.index, search.face_normals()[f], faces[f].two_sided)) {
      ++turned_away_;
      continue;
    }
    const FaceRecord face = record_of(search, pair.second.index);
    if (may_meet(search, pair.first.index, face))
      add_pair(pair.first, face);
    else
      ++turned_away_;
  }
  if (comm_.size() == 1) return;

  std::vector<FaceRecord> own(faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f) own[f] = record_of(search, static_cast<LocalIndex>(f));
  std::vector<int> owners(far.size());
  std::vector<LocalIndex> index(far.size()), into(far.size());
  for (std::size_t i = 0; i < far.size(); ++i)
    owners[i] = far[i].second.rank, index[i] = far[i].second.index, into[i] = static_cast<LocalIndex>(i);
  const ExchangePlan pull = ExchangePlan::from_owners(comm_, owners, index, into, "contact candidates");
  std::vector<FaceRecord> of_pairs(far.size());
  pull.forward<FaceRecord>(own, of_pairs);
  for (std::size_t i = 0; i < far.size(); ++i) {
    const FaceRecord& face = of_pairs[i];
    const GlobalId node = surfaces_.nodes()[static_cast<std::size_t>(far[i].first.index)].id;
    const auto is_node = [&](const NodeRef& corner) { return corner.id == node; };
    if (std::ranges::any_of(face.corners, is_node) || std::ranges::find(face.behind, node) != face.behind.end())
      continue;
    if (may_press(search, far[i].first.index, face.normal, face.two_sided != 0) &&
        may_meet(search, far[i].first.index, face))
      add_pair(far[i].first, face);
    else
      ++turned_away_;
  }
}

bool WorkingSet::may_press(const CandidateSearch& search, LocalIndex node, const Vec3& normal, bool two_sided) const {
  if (two_sided) return true;
  const std::span<const Vec3> around = surfaces_.normals_of(search.normals_around(), static_cast<std::size_t>(node));
  return std::ranges::any_of(around, [&](const Vec3& of_node) { return faces_against(of_node, normal); }) ||
         is_pointed(around);
}

/// Boxes overlap beside faces that lie across the axes: what is farther apart than both skins reach is left out. Places
/// of a face move by its skin at most, being means of its corners.
bool WorkingSet::may_meet(const CandidateSearch& search, LocalIndex index, const FaceRecord& face) const {
  const SurfaceNode& node = surfaces_.nodes()[static_cast<std::size_t>(index)];
  const double near = node.radius + face.radius + near_share * node.size;
  const double reach = search.skins()[static_cast<std::size_t>(index)] + face.skin + std::max(near, face.depth);
  constexpr double round_off = 1 + 1e-9;
  return !(closest_point({face.count, face.places}, search.sought_place(index)).distance > round_off * reach);
}

void WorkingSet::add_pair(const ItemHandle& home, const FaceRecord& face) {
  const SurfaceNode& node = surfaces_.nodes()[static_cast<std::size_t>(home.index)];
  PairRecord pair;
  pair.key = {0, {node.id, face.id, 0, 0}};
  pair.nodes = 1 + face.count, pair.two_sided = face.two_sided != 0;
  pair.first_surface = node.surface, pair.second_surface = face.surface;
  pair.node[0] = {node.id, home, -1};
  std::copy_n(face.corners.begin(), face.count, pair.node.begin() + 1);
  pair.shells = pair.two_sided && node.radius > 0 && node.party == face.party;
  pair.clearance = node.radius + face.radius, pair.depth = face.depth, pair.margin = near_share * node.size;
  records_.push_back(pair);
}

// A pair of edges belongs to the rank of the first end of the lesser one.
void WorkingSet::add_edges(const CandidateSearch& search) {
  const std::vector<SurfaceEdge>& edges = surfaces_.edges();
  std::vector<EdgeRecord> own(search.sharp_edges().size());
  for (std::size_t s = 0; s < own.size(); ++s) {
    const SurfaceEdge& edge = edges[static_cast<std::size_t>(search.sharp_edges()[s])];
    own[s].ends = {reference(edge.ends[0]), reference(edge.ends[1])};
    own[s].surface = edge.surface, own[s].two_sided = edge.two_sided ? 1 : 0;
    own[s].radius = edge.radius, own[s].depth = reliable_depth * edge.depth;
    own[s].size = surfaces_.nodes()[static_cast<std::size_t>(edge.ends[0].home.index)].size;
    own[s].outward = search.outward()[s];
  }
  const std::vector<BoxPair>& found = search.edge_edges();
  std::array<std::vector<EdgeRecord>, 2> sides;
  for (std::size_t side = 0; side < 2; ++side) {
    std::vector<int> owners(found.size());
    std::vector<LocalIndex> index(found.size()), into(found.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      const ItemHandle& handle = side == 0 ? found[i].first : found[i].second;
      owners[i] = handle.rank, index[i] = handle.index, into[i] = static_cast<LocalIndex>(i);
    }
    const ExchangePlan pull = ExchangePlan::from_owners(comm_, owners, index, into, "contact candidates");
    sides[side].resize(found.size());
    pull.forward<EdgeRecord>(own, sides[side]);
  }
  std::vector<int> to;
  std::vector<PairRecord> send;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const EdgeRecord *a = &sides[0][i], *b = &sides[1][i];
    if (std::array{b->ends[0].id, b->ends[1].id} < std::array{a->ends[0].id, a->ends[1].id}) std::swap(a, b);
    PairRecord pair;
    pair.key = {2, {a->ends[0].id, a->ends[1].id, b->ends[0].id, b->ends[1].id}};
    pair.nodes = 4, pair.two_sided = a->two_sided != 0 || b->two_sided != 0;
    pair.first_surface = a->surface, pair.second_surface = b->surface;
    pair.node = {a->ends[0], a->ends[1], b->ends[0], b->ends[1], {}};
    if (shares_node(pair, 2)) continue;
    pair.clearance = a->radius + b->radius, pair.depth = std::min(a->depth, b->depth);
    pair.margin = near_share * std::min(a->size, b->size);
    pair.first_outward = a->outward, pair.second_outward = b->outward;
    to.push_back(pair.node[0].home.rank);
    send.push_back(pair);
  }
  const ExchangePlan plan = ExchangePlan::to_ranks(comm_, to, "contact candidates");
  const std::size_t before = records_.size();
  records_.resize(before + static_cast<std::size_t>(plan.received()));
  plan.forward<PairRecord>(send, std::span(records_).subspan(before));
}

// All faces of a node go to every rank that sums for a node of one of these pairs: the choice among them needs them
// all. Other pairs stand for themselves.
void WorkingSet::send_records() {
  if (comm_.size() == 1) {
    arrived_.swap(records_);
    any_ = !arrived_.empty();
    return;
  }
  std::vector<int> to;
  std::vector<LocalIndex> which;
  std::vector<int> ranks;
  for (std::size_t begin = 0, end = 0; begin < records_.size(); begin = end) {
    ranks.clear();
    end = end_of_group(records_, begin);
    for (std::size_t i = begin; i < end; ++i)
      for (std::int32_t k = 0; k < records_[i].nodes; ++k)
        ranks.push_back(records_[i].node[static_cast<std::size_t>(k)].part);
    std::ranges::sort(ranks);
    ranks.erase(std::unique(ranks.begin(), ranks.end()), ranks.end());
    for (const int rank : ranks)
      for (std::size_t i = begin; i < end; ++i) to.push_back(rank), which.push_back(static_cast<LocalIndex>(i));
  }
  const ExchangePlan plan = ExchangePlan::to_ranks(comm_, to, which, "contact pairs");
  arrived_.resize(static_cast<std::size_t>(plan.received()));
  plan.forward<PairRecord>(records_, arrived_);
  sort_records(arrived_);
  any_ = comm_.any(!arrived_.empty());
}

void WorkingSet::connect() {
  std::vector<NodeRef> refs;
  for (const PairRecord& pair : arrived_) refs.insert(refs.end(), pair.node.begin(), pair.node.begin() + pair.nodes);
  std::ranges::sort(refs, {}, &NodeRef::id);
  refs.erase(std::unique(refs.begin(), refs.end(), [](const NodeRef& a, const NodeRef& b) { return a.id == b.id; }),
             refs.end());
  ids_.clear(), homes_.clear(), parts_.clear();
  for (const NodeRef& ref : refs) ids_.push_back(ref.id), homes_.push_back(ref.home), parts_.push_back(ref.part);

  const auto local = [&](GlobalId id) {
    return static_cast<LocalIndex>(std::ranges::lower_bound(ids_, id) - ids_.begin());
  };
  pairs_.clear();
  pairs_.reserve(arrived_.size());
  for (const PairRecord& record : arrived_) {
    WorkingPair pair{record.key,
                     record.nodes,
                     record.two_sided,
                     record.shells,
                     record.first_surface,
                     record.second_surface,
                     {no_index, no_index, no_index, no_index, no_index},
                     record.clearance,
                     record.depth,
                     record.margin,
                     record.first_outward,
                     record.second_outward,
                     record.memory,
                     record.node[0].part == comm_.rank()};
    for (std::int32_t k = 0; k < record.nodes; ++k)
      pair.node[static_cast<std::size_t>(k)] = local(record.node[static_cast<std::size_t>(k)].id);
    pairs_.push_back(pair);
  }

  looks_.assign(pairs_.size(), 0.0f), visits_.assign(pairs_.size(), 0.0f);

  const std::size_t count = ids_.size();
  std::vector<int> home_rank(count), result_rank(count, -1), halo_rank(count, -1);
  std::vector<LocalIndex> home_index(count), every(count);
  std::iota(every.begin(), every.end(), LocalIndex{0});
  for (std::size_t n = 0; n < count; ++n) {
    home_rank[n] = homes_[n].rank, home_index[n] = homes_[n].index;
    if (parts_[n] == comm_.rank())
      result_rank[n] = homes_[n].rank;
    else
      halo_rank[n] = parts_[n];
  }
  // Busy nodes travel, so their places among these are what counts.
  const ExchangePlan ask = ExchangePlan::from_owners(comm_, home_rank, home_index, every, "contact plans");
  std::vector<LocalIndex> slot(count);
  ask.forward<LocalIndex>(busy_slot_, slot);
  from_home_ = ExchangePlan::from_owners(comm_, home_rank, slot, every, "contact state");
  results_ = ExchangePlan::from_owners(comm_, result_rank, slot, every, "contact impulses");
  if (comm_.size() == 1) return;  // halo_ is empty
  list_others();
  const std::vector<LocalIndex> places = places_at_owners(comm_, parts_, ids_, ids_, "contact plans");
  halo_ = ExchangePlan::from_owners(comm_, halo_rank, places, every, "contact iteration");
}

// What any rank has of a group, all of these have.
void WorkingSet::list_others() {
  group_of_pair_.assign(pairs_.size(), 0);
  group_ranks_.clear(), first_rank_.assign(1, 0);
  for (std::size_t begin = 0, end = 0; begin < pairs_.size(); begin = end) {
    end = end_of_group(pairs_, begin);
    const auto first = static_cast<std::ptrdiff_t>(group_ranks_.size());
    for (std::size_t q = begin; q < end; ++q) {
      group_of_pair_[q] = static_cast<std::int32_t>(first_rank_.size() - 1);
      for (std::int32_t k = 0; k < pairs_[q].nodes; ++k) {
        const std::int32_t rank = part(pairs_[q].node[static_cast<std::size_t>(k)]);
        if (rank != comm_.rank() &&
            std::find(group_ranks_.begin() + first, group_ranks_.end(), rank) == group_ranks_.end())
          group_ranks_.push_back(rank);
      }
    }
    std::sort(group_ranks_.begin() + first, group_ranks_.end());
    first_rank_.push_back(group_ranks_.size());
  }
}

std::int64_t WorkingSet::memory() const {
  return static_cast<std::int64_t>(pairs_.capacity() * sizeof(WorkingPair) +
                                   (records_.capacity() + arrived_.capacity()) * sizeof(PairRecord) +
                                   ids_.capacity() * (sizeof(GlobalId) + sizeof(ItemHandle) + 8));
}

}  // namespace tenon::contact
