// SPDX-License-Identifier: BSD-3-Clause
// Who enforces what: work as it was counted, and the parts that share it.
#include <algorithm>

#include "components/contact/working_set.hpp"

namespace tenon::contact {

namespace {

// Most are of a node and a face with four.
constexpr double nodes_of_pair = 5;

}  // namespace

int WorkingSet::parts_for(double work, int ranks, double least_work) {
  if (!(least_work > 0)) return ranks;
  int parts = ranks;
  while (parts > 1 && work < least_work * parts) parts = (parts + 1) / 2;
  return parts;
}

std::vector<double> WorkingSet::work_of_nodes() const {
  std::vector<double> work(ids_.size(), work_of_node * counted_steps());
  for (std::size_t q = 0; q < pairs_.size(); ++q) {
    const double each = work_of(q) / pairs_[q].nodes;
    for (std::int32_t k = 0; k < pairs_[q].nodes; ++k)
      work[static_cast<std::size_t>(pairs_[q].node[static_cast<std::size_t>(k)])] += each;
  }
  return work;
}

/// What the nodes cost since the last partition, at their homes.
void WorkingSet::collect_work() {
  const std::vector<double> work = work_of_nodes();
  double own = 0, all = work_of_node * counted_steps() * static_cast<double>(nodes());
  for (std::size_t q = 0; q < pairs_.size(); ++q) all += work_of(q);
  for (std::size_t n = 0; n < work.size(); ++n) own += parts_[n] == comm_.rank() ? work[n] : 0.0;
  const auto beside = static_cast<float>(own > 0 ? all / own : 1.0);
  std::vector<NodeWork> here(work.size()), of_busy(busy_.size());
  for (std::size_t n = 0; n < work.size(); ++n) here[n] = {static_cast<float>(work[n]), beside};
  if (!results_.empty()) results_.reverse<NodeWork>(here, of_busy);
  home_work_.assign(surfaces_.nodes().size(), {});
  for (std::size_t b = 0; b < busy_.size(); ++b)
    if (static_cast<std::size_t>(busy_[b]) < home_work_.size())
      home_work_[static_cast<std::size_t>(busy_[b])] = of_busy[b];
}

// Nodes that are in some pair are shared out by their work; each pair learns which ranks sum for its nodes.
void WorkingSet::partition() {
  const std::vector<SurfaceNode>& nodes = surfaces_.nodes();
  std::vector<int> owners;
  std::vector<LocalIndex> index;
  for (const PairRecord& pair : records_)
    for (std::int32_t k = 0; k < pair.nodes; ++k) {
      const ItemHandle& home = pair.node[static_cast<std::size_t>(k)].home;
      owners.push_back(home.rank), index.push_back(home.index);
    }
  ExchangePlan tell;
  std::vector<LocalIndex> told;
  if (comm_.size() > 1) {
    tell = ExchangePlan::to_ranks(comm_, owners, "contact candidates");
    told.resize(static_cast<std::size_t>(tell.received()));
    tell.forward<LocalIndex>(index, told);
  } else {
    told.swap(index);
  }
  busy_slot_.assign(nodes.size(), no_index);
  std::vector<double> uses(nodes.size());
  for (const LocalIndex n : told) uses[static_cast<std::size_t>(n)] += 1;
  busy_.clear();
  std::vector<Vec3> places;
  std::vector<double> weights;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (uses[n] == 0) continue;
    busy_slot_[n] = static_cast<LocalIndex>(busy_.size());
    busy_.push_back(static_cast<LocalIndex>(n));
    places.push_back(surfaces_.parties()[static_cast<std::size_t>(nodes[n].party)]
                         ->contact_positions()[static_cast<std::size_t>(nodes[n].node)]);
    const NodeWork& before = home_work_[n];
    const double fresh = counted_steps() * (work_of_node + work_of_pair * uses[n] / nodes_of_pair);
    weights.push_back(before.work > 0 ? static_cast<double>(before.work) * static_cast<double>(before.beside) : fresh);
  }
  const double steps = counted_steps();
  steps_ = 0;
  home_part_.assign(nodes.size(), comm_.rank());
  if (comm_.size() > 1 && decomposition_ != SearchDecomposition::owner_boxes) {
    ExactSum work;
    for (const double weight : weights) work.add(weight);
    const int parts = parts_for(comm_.sum(work) / steps, comm_.size(), least_work_);
    if (parts != parts_made_) rcb_ = Rcb(comm_, parts);
    parts_made_ = parts;
    const std::vector<int> part = rcb_.partition(places, weights);
    for (std::size_t b = 0; b < busy_.size(); ++b)
      home_part_[static_cast<std::size_t>(busy_[b])] = rank_of(part[b], parts, comm_.size());
  }
  if (comm_.size() == 1) {
    for (PairRecord& pair : records_)
      for (std::int32_t k = 0; k < pair.nodes; ++k) pair.node[static_cast<std::size_t>(k)].part = comm_.rank();
    return;
  }
  // What the homes answer returns the way that the questions came.
  std::vector<std::int32_t> answers(told.size()), parts(owners.size());
  for (std::size_t i = 0; i < told.size(); ++i) answers[i] = home_part_[static_cast<std::size_t>(told[i])];
  tell.reverse<std::int32_t>(answers, parts);
  std::size_t next = 0;
  for (PairRecord& pair : records_)
    for (std::int32_t k = 0; k < pair.nodes; ++k) pair.node[static_cast<std::size_t>(k)].part = parts[next++];
}

}  // namespace tenon::contact
