// SPDX-License-Identifier: BSD-3-Clause
// The part of contact that one rank enforces: candidate pairs, their nodes, and where these live.
#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "components/contact/candidate_search.hpp"
#include "components/contact/contact_surfaces.hpp"
#include "framework/decomposition/rcb.hpp"

namespace tenon::contact {

/// Names a pair, the same on every rank; the order in which sums are taken.
struct PairKey {
  std::int64_t kind;            ///< 0 node and face, 1 node and rigid surface, 2 edge and edge, 3 ball and ball
  std::array<GlobalId, 4> ids;  ///< node, face | node, surface | ends of both edges | balls
  auto operator<=>(const PairKey&) const = default;
};

/// What a pair keeps from step to step.
struct PairMemory {
  Vec3 force{};       ///< N, on the first side, in the last step
  Vec3 slip{};        ///< m: way along the surface that sticking has yet to undo
  double energy = 0;  ///< J: taken at impact, given back at release
  bool empty() const { return force == Vec3{} && slip == Vec3{} && energy == 0; }
};

/// A node of a pair: who it is, where it lives, and which rank of the working sets sums for it.
struct NodeRef {
  GlobalId id = no_id;
  ItemHandle home{-1, no_index};
  std::int32_t part = -1;
};

/// A pair as it travels to the ranks that need it. Nodes: the node and the face's corners, the ends of both edges, or
/// two balls.
struct PairRecord {
  PairKey key;
  std::int32_t nodes = 0;  ///< count
  bool two_sided = false;
  bool shells = false;  ///< both sides, of one party
  std::int32_t first_surface = 0, second_surface = 0;
  std::array<NodeRef, 5> node;
  double clearance = 0;                    ///< m, between the mid-surfaces
  double depth = 0;                        ///< m
  double margin = 0;                       ///< m: pairs farther apart than this are of no interest
  Vec3 first_outward{}, second_outward{};  ///< of edges
  PairMemory memory;
};

/// A pair here; nodes are indices of the working set.
struct WorkingPair {
  PairKey key;
  std::int32_t nodes;
  bool two_sided, shells;
  std::int32_t first_surface, second_surface;
  std::array<LocalIndex, 5> node;
  double clearance, depth, margin;
  Vec3 first_outward, second_outward;
  PairMemory memory;
  bool primary;  ///< this rank sums for its first node: it reports the pair
};

/// What may be left out of a pair, or is known of it: false drops it. Sees surfaces and sets clearance and the like.
using PairFilter = std::function<bool(PairRecord&)>;

/// Pairs stand ascending by key, nodes ascending by id, the same on any number of ranks but for how many of them there
/// are. Every rank has all the candidates of a node of which it needs one.
class WorkingSet {
 public:
  WorkingSet(const Communicator& comm, const ContactSurfaces& surfaces, SearchDecomposition decomposition,
             double least_work);

  /// Collective. Takes what a search found, and what the pairs before remember. `work` of the nodes before sets the
  /// weights of the partition. Extra pairs (with rigid surfaces) come from the ranks that own the nodes.
  void build(const CandidateSearch& search, std::span<const PairRecord> extra, const PairFilter& filter,
             std::span<const std::pair<PairKey, PairMemory>> restored);

  const std::vector<WorkingPair>& pairs() const { return pairs_; }
  std::vector<WorkingPair>& pairs() { return pairs_; }
  LocalIndex nodes() const { return static_cast<LocalIndex>(ids_.size()); }
  bool sums(LocalIndex node) const { return parts_[static_cast<std::size_t>(node)] == comm_.rank(); }
  GlobalId id(LocalIndex node) const { return ids_[static_cast<std::size_t>(node)]; }

  /// Nodes of this rank's surfaces that are in some pair, ascending: indices of ContactSurfaces::nodes().
  const std::vector<LocalIndex>& busy() const { return busy_; }
  /// Values of busy nodes (as busy()) to all ranks that need them (as nodes of the set).
  const ExchangePlan& from_home() const { return from_home_; }
  /// The way back of those that this rank sums for: `reverse` of this plan.
  const ExchangePlan& results() const { return results_; }
  /// From the rank that sums for a node to the others that have it.
  const ExchangePlan& halo() const { return halo_; }
  /// The other ranks that have a pair, ascending.
  std::span<const std::int32_t> others_with(std::size_t pair) const {
    const auto g = static_cast<std::size_t>(group_of_pair_[pair]);
    return std::span(group_ranks_).subspan(first_rank_[g], first_rank_[g + 1] - first_rank_[g]);
  }
  /// The rank that sums for a node.
  std::int32_t part(LocalIndex node) const { return parts_[static_cast<std::size_t>(node)]; }
  int rank() const { return comm_.rank(); }
  /// Where a node of the set is kept.
  const ItemHandle& home(LocalIndex node) const { return homes_[static_cast<std::size_t>(node)]; }
  /// Whether any rank has a pair.
  bool any() const { return any_; }
  /// Pairs on this rank that were left out since they face the same way, or are too far apart to meet.
  std::int64_t turned_away() const { return turned_away_; }
  /// J: of pairs that were remembered and are no more, on this rank, since the last `build`.
  std::span<const double> lost() const { return lost_; }
  /// Local. A step is taken with this set; a pair is looked at; its constraint is visited by iterations.
  void count_step() { ++steps_; }
  void count_look(std::size_t pair) { looks_[pair] += 1; }
  void count_visits(std::size_t pair, int iterations) { visits_[pair] += static_cast<float>(iterations); }
  /// Of each pair since the last partition.
  std::span<const float> looks() const { return looks_; }
  std::span<const float> visits() const { return visits_; }
  double counted_steps() const { return static_cast<double>(std::max<std::int64_t>(1, steps_)); }
  /// Work is counted in visits of a constraint by the iteration: what pairs and nodes take in a step, and a look at a
  /// pair, as measured on one core (docs/performance.md).
  static constexpr double work_of_node = 2.5, work_of_pair = 0.03, work_of_look = 2.5;
  /// Of so many ranks, how many parts are made of a step's work; see ContactOptions::least_work.
  static int parts_for(double work, int ranks, double least_work);
  /// The rank of a part.
  static int rank_of(int part, int parts, int ranks) {
    return static_cast<int>(static_cast<std::int64_t>(part) * ranks / parts);
  }
  /// Of a pair since the last partition, wherever it is.
  double work_of(std::size_t pair) const {
    return work_of_pair * counted_steps() + work_of_look * static_cast<double>(looks_[pair]) +
           static_cast<double>(visits_[pair]);
  }
  /// Of each node since the last partition: its own, and its share in that of its pairs.
  std::vector<double> work_of_nodes() const;
  std::int64_t memory() const;

 private:
  void gather_records(const CandidateSearch& search, const PairFilter& filter);
  struct FaceRecord;
  FaceRecord record_of(const CandidateSearch& search, LocalIndex face) const;
  bool may_press(const CandidateSearch& search, LocalIndex node, const Vec3& normal, bool two_sided) const;
  bool may_meet(const CandidateSearch& search, LocalIndex node, const FaceRecord& face) const;
  void add_node_faces(const CandidateSearch& search);
  void add_pair(const ItemHandle& home, const FaceRecord& face);
  void add_edges(const CandidateSearch& search);
  void add_balls(const CandidateSearch& search);
  void collect_work();
  void remember(std::span<const std::pair<PairKey, PairMemory>> restored);
  void partition();
  void send_records();
  void connect();
  void list_others();

  Communicator comm_;
  const ContactSurfaces& surfaces_;
  SearchDecomposition decomposition_;
  double least_work_;
  int parts_made_;
  Rcb rcb_;
  bool any_ = false;
  std::int64_t turned_away_ = 0;
  std::int64_t steps_ = 0;                                // since the last partition
  std::vector<PairRecord> records_;                       // at the homes of first nodes, ascending by key
  std::vector<std::pair<PairKey, PairMemory>> memories_;  // of the pairs before, likewise
  std::vector<double> lost_;
  std::vector<LocalIndex> busy_;
  std::vector<LocalIndex> busy_slot_;    // of all home nodes: place in busy_, or no_index
  std::vector<std::int32_t> home_part_;  // of home nodes
  /// Of a node since the last partition, and what its rank did for each unit of work of its own nodes: pairs across a
  /// cut are looked at on both sides.
  struct NodeWork {
    float work = 0, beside = 0;
  };
  std::vector<NodeWork> home_work_;
  std::vector<WorkingPair> pairs_;
  std::vector<PairRecord> arrived_;
  std::vector<GlobalId> ids_;
  std::vector<ItemHandle> homes_;
  std::vector<std::int32_t> parts_;
  std::vector<float> looks_, visits_;
  std::vector<std::int32_t> group_of_pair_, group_ranks_;  // pairs that go to the same ranks, and which these are
  std::vector<std::size_t> first_rank_;
  ExchangePlan from_home_, results_, halo_;
};

}  // namespace tenon::contact
