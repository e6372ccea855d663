// SPDX-License-Identifier: BSD-3-Clause
// Contact: boxes go to the parts of the search, pairs to those of the enforcement, places and velocities of nodes with
// pairs there in every step, impulses back.
#include <algorithm>
#include <array>
#include <map>
#include <numeric>

#include "apps/tenon/scaling_parts.hpp"
#include "components/contact/contact.hpp"

namespace tenon {

namespace {

using namespace contact;

// Of what one item costs in the search, as BoxPairSearch weighs it.
constexpr double work_of_box = 150, work_of_pair = 16;
constexpr double bytes_of_box = sizeof(Box) + sizeof(LocalIndex);

class ContactParts {
 public:
  ContactParts(const Contact& contact, const std::vector<const MeshParts*>& homes, const ScalingTrial& scaling)
      : contact_(contact),
        set_(contact.working_set()),
        scaling_(scaling),
        parts_(homes.front()->parts),
        ranks_(static_cast<std::size_t>(parts_)) {
    for (const SurfaceNode& node : contact.surfaces().nodes())
      home_.push_back(homes[static_cast<std::size_t>(node.party)]->node_part[static_cast<std::size_t>(node.node)]);
    searches_ = scaling.trial.count(contact.name() + ": searches");
    iterations_ = scaling.trial.count(contact.name() + ": iterations");
  }

  std::vector<PhaseLoad> loads() {
    std::vector<PhaseLoad> loads{check(), search()};
    share_out_nodes();
    loads.push_back(share_out());
    loads.push_back(touch());
    loads.push_back(solve());
    loads.push_back(exchange());
    loads.push_back(together());
    return loads;
  }

 private:
  PhaseLoad load_of(const std::string& phase, std::vector<double> work, double whole) const {
    PhaseLoad load;
    load.phase = contact_.name() + ": " + phase, load.group = "contact";
    load.seconds = scaling_.trial.phase(load.phase);
    load.work = std::move(work), load.whole = whole;
    return load;
  }
  std::vector<double> nothing() const { return std::vector<double>(ranks_, 0.0); }
  static double& of(std::vector<double>& work, int part) { return work[static_cast<std::size_t>(part)]; }

  PhaseLoad check() const {
    std::vector<double> work = nothing();
    for (const int p : home_) of(work, p) += 1;
    PhaseLoad load = load_of("check", work, static_cast<double>(home_.size()));
    load.reductions = 1 + searches_;
    return load;
  }

  struct Item {
    const Box* box;
    int home;
    double pairs = 0;
  };

  /// One of the two searches: work of its parts, and boxes on their way.
  void search_parts(std::vector<Item>& items, std::size_t first_set, double tests_of_pair, std::vector<double>& work,
                    Traffic& sent, Traffic& returned) const {
    std::vector<int> found;
    const auto take = [&](const Item& item, double clones) {
      for (const int r : found) {
        of(work, r) += work_of_box + (work_of_pair + tests_of_pair) * item.pairs / clones;
        sent.add(item.home, r, bytes_of_box), returned.add(r, item.home, sizeof(float));
      }
    };
    if (scaling_.decomposition == SearchDecomposition::owner_boxes && parts_ > 1) {
      std::vector<Box> bounds(ranks_);
      for (std::size_t i = 0; i < first_set; ++i)
        if (!items[i].box->empty()) bounds[static_cast<std::size_t>(items[i].home)].add(*items[i].box);
      const BoxTree tree(bounds);
      for (std::size_t i = 0; i < items.size(); ++i) {
        found.assign(1, items[i].home);
        if (i >= first_set || first_set == items.size()) {
          found.clear();
          tree.overlapping(*items[i].box, found);
          // Within one set, one of two ranks takes the other's.
          if (first_set == items.size())
            std::erase_if(found, [&](int r) {
              const int me = items[i].home;
              return r != me && (r < me) != ((r + me) % 2 == 0);
            });
        }
        take(items[i], std::max(1.0, static_cast<double>(found.size())));
      }
      return;
    }
    std::vector<Vec3> centres;
    std::vector<double> weights;
    for (const Item& item : items) {
      if (item.box->empty()) continue;
      centres.push_back(PackedBoxes::centre(*item.box));
      weights.push_back(work_of_box + (work_of_pair + tests_of_pair) * item.pairs);
    }
    SearchParts cuts(Communicator::self(), parts_);
    cuts.cut(scaling_.decomposition, centres, weights);
    for (const Item& item : items) {
      if (item.box->empty()) continue;
      cuts.ranks_meeting(*item.box, found);
      take(item, static_cast<double>(found.size()));
    }
  }

  PhaseLoad search() const {
    const CandidateSearch& search = contact_.candidates();
    const ContactSurfaces& surfaces = contact_.surfaces();
    std::vector<Item> faces, edges;
    for (std::size_t n = 0; n < search.node_boxes().size(); ++n) faces.push_back({&search.node_boxes()[n], home_[n]});
    const std::size_t nodes = faces.size();
    for (std::size_t f = 0; f < search.face_boxes().size(); ++f)
      faces.push_back(
          {&search.face_boxes()[f], home_[static_cast<std::size_t>(surfaces.faces()[f].corners[0].home.index)]});
    for (const BoxPair& pair : search.node_faces()) {
      faces[static_cast<std::size_t>(pair.first.index)].pairs += 0.5;
      faces[nodes + static_cast<std::size_t>(pair.second.index)].pairs += 0.5;
    }
    for (std::size_t e = 0; e < search.edge_boxes().size(); ++e) {
      const SurfaceEdge& edge = surfaces.edges()[static_cast<std::size_t>(search.sharp_edges()[e])];
      edges.push_back({&search.edge_boxes()[e], home_[static_cast<std::size_t>(edge.ends[0].home.index)]});
    }
    for (const BoxPair& pair : search.edge_edges()) {
      edges[static_cast<std::size_t>(pair.first.index)].pairs += 0.5;
      edges[static_cast<std::size_t>(pair.second.index)].pairs += 0.5;
    }
    const auto pairs = static_cast<double>(search.node_faces().size() + search.edge_edges().size());
    const double tests = pairs > 0 ? static_cast<double>(search.work()) / pairs : 0;
    std::vector<double> work = nothing();
    Traffic node_boxes(parts_), edge_boxes(parts_), node_back(parts_), edge_back(parts_);
    search_parts(faces, nodes, tests, work, node_boxes, node_back);
    search_parts(edges, edges.size(), tests, work, edge_boxes, edge_back);
    PhaseLoad load =
        load_of("search", work,
                work_of_box * static_cast<double>(faces.size() + edges.size()) + (work_of_pair + tests) * pairs);
    node_boxes.book(load, 2 * searches_, 0.5);  // nodes and faces are two sets, each with its messages
    edge_boxes.book(load, searches_);
    node_back.book(load, 2 * searches_, 0.5), edge_back.book(load, searches_);
    load.reductions = 8 * searches_;  // skins, common velocity, judgement of the balance
    return load;
  }

  /// Nodes with pairs by their uses and work, as the working set does it.
  void share_out_nodes() {
    const auto nodes = static_cast<std::size_t>(set_.nodes());
    const std::vector<double> work = set_.work_of_nodes();
    std::vector<Vec3> places(nodes);
    part_.assign(nodes, 0), node_home_.assign(nodes, 0);
    for (std::size_t n = 0; n < nodes; ++n) {
      const auto home = static_cast<std::size_t>(set_.home(static_cast<LocalIndex>(n)).index);
      const SurfaceNode& node = contact_.surfaces().nodes()[home];
      places[n] = contact_.surfaces()
                      .parties()[static_cast<std::size_t>(node.party)]
                      ->contact_positions()[static_cast<std::size_t>(node.node)];
      node_home_[n] = home_[home];
    }
    if (nodes == 0) return;
    // Each search learns from the one before what ranks do beside the work of their own nodes.
    constexpr int searches = 4;
    std::vector<double> weights = work;
    for (int k = 0; k < searches; ++k) {
      cut_nodes(places, weights);
      send_pairs();
      if (scaling_.decomposition == SearchDecomposition::owner_boxes) return;
      const std::vector<double> beside = work_beside(work);
      for (std::size_t n = 0; n < nodes && k + 1 < searches; ++n)
        weights[n] = work[n] * beside[static_cast<std::size_t>(part_[n])];
    }
  }

  void cut_nodes(const std::vector<Vec3>& places, const std::vector<double>& weights) {
    const std::size_t nodes = places.size();
    if (scaling_.decomposition == SearchDecomposition::owner_boxes) {
      part_ = node_home_;
    } else if (scaling_.decomposition == SearchDecomposition::slices) {
      SearchParts cuts(Communicator::self(), parts_);
      cuts.cut(scaling_.decomposition, places, weights);
      std::vector<int> found;
      for (std::size_t n = 0; n < nodes; ++n) {
        cuts.ranks_meeting({places[n], places[n]}, found);
        if (!found.empty()) part_[n] = found.front();
      }
    } else {
      const double work = std::accumulate(weights.begin(), weights.end(), 0.0);
      const int parts = WorkingSet::parts_for(work / set_.counted_steps(), parts_, scaling_.least_work);
      part_ = Rcb(Communicator::self(), parts).partition(places, weights);
      for (int& part : part_) part = WorkingSet::rank_of(part, parts, parts_);
    }
  }

  std::int64_t copies_of(int part) const {
    const std::int64_t nodes = set_.nodes();
    return std::ranges::lower_bound(copies_, (part + 1) * nodes) - std::ranges::lower_bound(copies_, part * nodes);
  }

  /// Counted work of a part: looks, visits and what nodes take, wherever it is done.
  std::vector<double> work_of_parts() const {
    std::vector<double> all = nothing();
    for (std::size_t q = 0; q < pair_parts_.size(); ++q)
      for (const int r : pair_parts_[q]) of(all, r) += set_.work_of(q);
    const double of_node = WorkingSet::work_of_node * set_.counted_steps();
    for (int r = 0; r < parts_; ++r) of(all, r) += of_node * static_cast<double>(copies_of(r));
    return all;
  }

  /// Of each part: what it does over the work of its own nodes.
  std::vector<double> work_beside(const std::vector<double>& work) const {
    std::vector<double> own = nothing(), beside = work_of_parts();
    for (std::size_t n = 0; n < work.size(); ++n) of(own, part_[n]) += work[n];
    for (std::size_t r = 0; r < ranks_; ++r) beside[r] = own[r] > 0 ? beside[r] / own[r] : 1;
    return beside;
  }

  /// All faces of a node go to each rank that sums for a node of one of them; other pairs for themselves.
  void send_pairs() {
    const std::vector<WorkingPair>& pairs = set_.pairs();
    pair_parts_.assign(pairs.size(), {});
    std::vector<int> ranks;
    for (std::size_t begin = 0, end = 0; begin < pairs.size(); begin = end) {
      ranks.clear();
      const auto together = [&](const PairKey& key) {
        return key == pairs[begin].key ||
               (key.kind == 0 && pairs[begin].key.kind == 0 && key.ids[0] == pairs[begin].key.ids[0]);
      };
      for (end = begin; end < pairs.size() && together(pairs[end].key); ++end)
        for (std::int32_t k = 0; k < pairs[end].nodes; ++k)
          ranks.push_back(part_[static_cast<std::size_t>(pairs[end].node[static_cast<std::size_t>(k)])]);
      std::ranges::sort(ranks);
      ranks.erase(std::unique(ranks.begin(), ranks.end()), ranks.end());
      for (std::size_t q = begin; q < end; ++q) pair_parts_[q] = ranks;
    }
    std::vector<std::int64_t> copies;  // of nodes: part and node
    const std::int64_t nodes = set_.nodes();
    for (std::size_t q = 0; q < pairs.size(); ++q)
      for (const int r : pair_parts_[q])
        for (std::int32_t k = 0; k < pairs[q].nodes; ++k)
          copies.push_back(r * nodes + pairs[q].node[static_cast<std::size_t>(k)]);
    std::ranges::sort(copies);
    copies.erase(std::unique(copies.begin(), copies.end()), copies.end());
    copies_ = std::move(copies);
  }

  PhaseLoad share_out() const {
    const std::vector<WorkingPair>& pairs = set_.pairs();
    const std::vector<BoxPair>& candidates = contact_.candidates().node_faces();
    std::vector<double> work = nothing();
    for (const BoxPair& pair : candidates) of(work, home_[static_cast<std::size_t>(pair.first.index)]) += 1;
    Traffic records(parts_);
    for (std::size_t q = 0; q < pairs.size(); ++q) {
      const int home = node_home_[static_cast<std::size_t>(pairs[q].node[0])];
      for (const int r : pair_parts_[q]) {
        of(work, r) += 1;
        records.add(home, r, sizeof(PairRecord));
      }
    }
    PhaseLoad load = load_of("share out", work, static_cast<double>(candidates.size() + pairs.size()));
    records.book(load, searches_);
    load.reductions = 12 * searches_;  // plans find their partners, and cuts are made
    return load;
  }

  /// A pair is looked at wherever one of its nodes is.
  PhaseLoad touch() const {
    std::vector<double> work = nothing();
    double whole = 0;
    for (std::size_t q = 0; q < pair_parts_.size(); ++q) {
      const double looks = set_.work_of(q) - static_cast<double>(set_.visits()[q]);
      for (const int r : pair_parts_[q]) of(work, r) += looks;
      whole += looks;
    }
    return load_of("touch", work, whole);
  }

  /// Constraints come and go from step to step: what they have been visited since the last partition stands for them,
  /// on all ranks that have the pair. Between two ranks a message goes in as many of the iterations as the constraint
  /// that lasts longest is there; a constraint that a rank has to itself needs none.
  PhaseLoad solve() const {
    std::vector<double> work = nothing();
    const std::vector<WorkingPair>& pairs = set_.pairs();
    const double most = set_.visits().empty() ? 0 : static_cast<double>(std::ranges::max(set_.visits()));
    double whole = 0;
    std::map<std::array<std::int64_t, 3>, double> sent;  // from, to, node: share of the iterations
    for (std::size_t q = 0; q < pairs.size(); ++q) {
      const auto visits = static_cast<double>(set_.visits()[q]);
      if (visits == 0) continue;
      for (const int r : pair_parts_[q]) of(work, r) += visits;
      whole += visits;
      for (std::int32_t k = 0; k < pairs[q].nodes; ++k) {
        const LocalIndex n = pairs[q].node[static_cast<std::size_t>(k)];
        const int from = part_[static_cast<std::size_t>(n)];
        for (const int to : pair_parts_[q])
          if (to != from) sent[{from, to, n}] = std::max(sent[{from, to, n}], visits / most);
      }
    }
    PhaseLoad load = load_of("solve", work, whole);
    if (iterations_ == 0) return load;
    Traffic iterated(parts_), settled(parts_);
    std::map<std::array<int, 2>, std::array<double, 2>> between;  // greatest share, and sum of the shares
    for (const auto& [key, share] : sent) {
      std::array<double, 2>& of_pair = between[{static_cast<int>(key[0]), static_cast<int>(key[1])}];
      of_pair = {std::max(of_pair[0], share), of_pair[1] + share};
    }
    for (const auto& [ranks, shares] : between) iterated.add(ranks[0], ranks[1], shares[1] * sizeof(Vec3), shares[0]);
    const std::int64_t nodes = set_.nodes();
    for (const std::int64_t copy : copies_)
      settled.add(part_[static_cast<std::size_t>(copy % nodes)], static_cast<int>(copy / nodes), sizeof(Vec3));
    iterated.book(load, iterations_ + 2);
    settled.book(load, 1);
    load.reductions = 8 + iterations_ / 4;
    return load;
  }

  /// Push-back as one, by its counted work, for its balance; its time is in the others.
  PhaseLoad together() const {
    const std::vector<double> work = work_of_parts();
    const std::vector<double> nodes = set_.work_of_nodes();
    PhaseLoad load;
    load.phase = contact_.name() + ": push-back", load.group = "contact";
    load.work = work, load.whole = std::accumulate(nodes.begin(), nodes.end(), 0.0);
    return load;
  }

  PhaseLoad exchange() const {
    // Homes collect what is known of their nodes and apply impulses; parts take them in.
    std::vector<double> work = nothing();
    Traffic state(parts_), impulses(parts_);
    const std::int64_t nodes = set_.nodes();
    for (const std::int64_t copy : copies_) {
      const auto n = static_cast<std::size_t>(copy % nodes);
      const auto r = static_cast<int>(copy / nodes);
      of(work, r) += 0.5;
      state.add(node_home_[n], r, sizeof(NodeState));
    }
    for (std::size_t n = 0; n < part_.size(); ++n) {
      of(work, node_home_[n]) += 0.5;
      impulses.add(part_[n], node_home_[n], sizeof(Vec3));
    }
    PhaseLoad load = load_of("exchange", work, static_cast<double>(nodes));
    state.book(load, 1);
    impulses.book(load, iterations_ > 0 ? 1 : 0);
    load.reductions = set_.any() ? 1 : 0;
    return load;
  }

  const Contact& contact_;
  const WorkingSet& set_;
  const ScalingTrial& scaling_;
  int parts_;
  std::size_t ranks_;
  std::vector<int> home_;              // of surface nodes
  std::vector<int> part_, node_home_;  // of the nodes of the working set
  std::vector<std::vector<int>> pair_parts_;
  std::vector<std::int64_t> copies_;
  double searches_ = 0, iterations_ = 0;
};

}  // namespace

std::vector<PhaseLoad> contact_loads(const Contact& contact, const std::vector<const MeshParts*>& homes,
                                     const ScalingTrial& trial) {
  return ContactParts(contact, homes, trial).loads();
}

}  // namespace tenon
