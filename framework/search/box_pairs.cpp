// SPDX-License-Identifier: BSD-3-Clause
#include "framework/search/box_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tenon {

namespace {

// Cuts are made by a sample: so many items per rank leave about two percent of imbalance.
constexpr std::int64_t sample_of_rank = 1500;
// Counted work of making cuts, per item of the sample.
constexpr double cut_work = 300;

bool is_there(const Box& box) {
  return box.low[0] <= box.high[0] && box.low[1] <= box.high[1] && box.low[2] <= box.high[2];
}

Vec3 low_corner(const Box& a, const Box& b) {
  return {std::max(a.low[0], b.low[0]), std::max(a.low[1], b.low[1]), std::max(a.low[2], b.low[2])};
}

BoxPair ordered(const ItemHandle& a, const ItemHandle& b) {
  return a < b ? BoxPair{a, b} : BoxPair{b, a};
}

}  // namespace

BoxPairSearch::BoxPairSearch(const Communicator& comm, SearchDecomposition decomposition, std::string name)
    : comm_(comm), decomposition_(decomposition), name_(std::move(name)), parts_(comm) {}

void BoxPairSearch::find(std::span<const Box> first, std::span<const Box> second, std::vector<BoxPair>& pairs) {
  search({first, second}, 2, pairs);
}

void BoxPairSearch::find_within(std::span<const Box> boxes, std::vector<BoxPair>& pairs) {
  search({boxes, {}}, 1, pairs);
}

// `count` is the number of sets.
void BoxPairSearch::search(std::array<std::span<const Box>, 2> sets, std::size_t count, std::vector<BoxPair>& pairs) {
  pairs.clear();
  work_ = {};
  ++searches_;
  if (comm_.size() == 1) return join_here(sets, count, pairs);
  if (decomposition_ == SearchDecomposition::owner_boxes) return search_by_owner_boxes(sets, count, pairs);
  cut_if_worth_it(sets);
  for (std::size_t s = 0; s < count; ++s) {
    Side& side = sides_[s];
    side.rank_of_send.clear(), side.item_of_send.clear();
    for (std::size_t i = 0; i < sets[s].size(); ++i) {
      if (!is_there(sets[s][i])) continue;
      parts_.ranks_meeting(sets[s][i], ranks_);
      for (const int rank : ranks_) {
        side.rank_of_send.push_back(rank);
        side.item_of_send.push_back(static_cast<LocalIndex>(i));
      }
    }
    send(side, sets[s], s == 0 ? " first" : " second");
  }
  join_arrived(count, pairs);
  return_work(sets, count);
  judge_balance();
}

// Boxes of this rank with each other.
void BoxPairSearch::join_here(std::array<std::span<const Box>, 2> sets, std::size_t count,
                              std::vector<BoxPair>& pairs) {
  const int rank = comm_.rank();
  if (count == 2)
    join_.build(sets[0], sets[1]);
  else
    join_.build(sets[0]);
  join_.visit_pairs([&](std::span<const BoxJoin::Pair> found) {
    for (const auto& [i, k] : found) {
      const BoxPair pair{{rank, i}, {rank, k}};
      pairs.push_back(count == 2 ? pair : ordered(pair.first, pair.second));
    }
  });
  work_.tests += join_.tests();
  work_.pairs += static_cast<std::int64_t>(pairs.size());
  work_.boxes_received += static_cast<std::int64_t>(sets[0].size() + sets[1].size());
}

void BoxPairSearch::send(Side& side, std::span<const Box> boxes, const char* which) {
  side.sent.clear();
  for (const LocalIndex i : side.item_of_send) side.sent.push_back(boxes[static_cast<std::size_t>(i)]);
  side.plan = ExchangePlan::to_ranks(comm_, side.rank_of_send, name_ + which);
  const auto arriving = static_cast<std::size_t>(side.plan.received());
  side.boxes.resize(arriving), side.index.resize(arriving), side.handles.resize(arriving);
  const auto item = [](auto& from, auto& to) {
    return ExchangeItem{reinterpret_cast<const std::byte*>(from.data()), reinterpret_cast<std::byte*>(to.data()),
                        sizeof(from[0])};
  };
  const std::array items{item(side.sent, side.boxes), item(side.item_of_send, side.index)};
  side.plan.forward(std::span<const ExchangeItem>(items));
  const std::vector<int> from = side.plan.received_from();
  for (std::size_t i = 0; i < arriving; ++i) side.handles[i] = {from[i], side.index[i]};
  work_.boxes_received += static_cast<std::int64_t>(arriving);
}

void BoxPairSearch::join_arrived(std::size_t count, std::vector<BoxPair>& pairs) {
  Side &first = sides_[0], &second = sides_[count - 1];
  first.pairs.assign(first.boxes.size(), 0);
  second.pairs.assign(second.boxes.size(), 0);
  if (count == 2)
    join_.build(first.boxes, second.boxes);
  else
    join_.build(first.boxes);
  join_.visit_pairs([&](std::span<const BoxJoin::Pair> found) {
    work_.pairs += static_cast<std::int64_t>(found.size());
    for (const BoxJoin::Pair& pair : found) {
      const auto i = static_cast<std::size_t>(pair.first), k = static_cast<std::size_t>(pair.second);
      ++first.pairs[i], ++second.pairs[k];
      if (!parts_.owns(low_corner(first.boxes[i], second.boxes[k]))) continue;
      const ItemHandle &a = first.handles[i], &b = second.handles[k];
      pairs.push_back(count == 2 ? BoxPair{a, b} : ordered(a, b));
    }
  });
  work_.tests += join_.tests();
}

// The items of the first set stay; those of the second go where they may meet one. Within one set: of two ranks one
// gets the other's boxes, either in turn, so that all get about as many.
void BoxPairSearch::search_by_owner_boxes(std::array<std::span<const Box>, 2> sets, std::size_t count,
                                          std::vector<BoxPair>& pairs) {
  Box own;
  for (const Box& box : sets[0])
    if (is_there(box)) own.add(box);
  const std::vector<Box> bounds = comm_.all_gather(own);
  const BoxTree tree(bounds);
  const int me = comm_.rank();
  const auto takes_from_me = [&](int rank) {
    return count == 2 || (rank != me && (rank < me) == ((rank + me) % 2 == 0));
  };
  Side& side = sides_[1];
  side.rank_of_send.clear(), side.item_of_send.clear();
  const std::span<const Box> moving = sets[count - 1];
  for (std::size_t i = 0; i < moving.size(); ++i) {
    if (!is_there(moving[i])) continue;
    ranks_.clear();
    tree.overlapping(moving[i], ranks_);
    std::sort(ranks_.begin(), ranks_.end());
    for (const int rank : ranks_)
      if (takes_from_me(rank)) {
        side.rank_of_send.push_back(rank);
        side.item_of_send.push_back(static_cast<LocalIndex>(i));
      }
  }
  send(side, moving, " second");
  if (count == 1) join_here({sets[0], {}}, 1, pairs);
  if (count == 2) work_.boxes_received += static_cast<std::int64_t>(sets[0].size());
  join_.build(sets[0], side.boxes);
  join_.visit_pairs([&](std::span<const BoxJoin::Pair> found) {
    work_.pairs += static_cast<std::int64_t>(found.size());
    for (const BoxJoin::Pair& pair : found) {
      const ItemHandle a{me, pair.first}, &b = side.handles[static_cast<std::size_t>(pair.second)];
      pairs.push_back(count == 2 ? BoxPair{a, b} : ordered(a, b));
    }
  });
  work_.tests += join_.tests();
}

void BoxPairSearch::cut_if_worth_it(std::array<std::span<const Box>, 2> sets) {
  const double sample = std::min(static_cast<double>(sample_of_rank), static_cast<double>(items_) / comm_.size());
  if (!parts_.empty() && lost_ <= cut_work * sample) return;
  const bool work_known = items_ > 0;
  const double mean = work_known ? static_cast<double>(all_work_) / static_cast<double>(items_) : 1.0;
  const std::int64_t all = comm_.sum(static_cast<std::int64_t>(sets[0].size() + sets[1].size()));
  const std::int64_t stride = std::max<std::int64_t>(1, all / (sample_of_rank * comm_.size()));
  std::vector<Vec3> centres;
  std::vector<double> weights;
  for (std::size_t s = 0; s < 2; ++s) {
    const std::vector<float>& known = sides_[s].weight;
    const bool fits = work_known && known.size() == sets[s].size();
    std::int64_t until_next = 0;
    for (std::size_t i = 0; i < sets[s].size(); ++i) {
      if (!is_there(sets[s][i])) continue;
      const Vec3 x = PackedBoxes::centre(sets[s][i]);
      if (!std::isfinite(x[0] + x[1] + x[2])) continue;
      if (until_next-- > 0) continue;
      until_next = stride - 1;
      centres.push_back(x);
      weights.push_back(fits && known[i] > 0 ? static_cast<double>(known[i]) : mean);
    }
  }
  parts_.cut(decomposition_, centres, weights);
  ++cuts_;
  lost_ = 0;
  fresh_ = true;
  cut_by_work_ = work_known;
}

// Each box here has its share of the work; an item has that of all its clones.
void BoxPairSearch::return_work(std::array<std::span<const Box>, 2> sets, std::size_t count) {
  const Work fixed{work_.tests, 0, work_.boxes_received};
  const double each =
      static_cast<double>(fixed.total()) / static_cast<double>(std::max<std::int64_t>(1, work_.boxes_received));
  const double per_pair = 0.5 * static_cast<double>(Work{0, 1, 0}.total());
  for (std::size_t s = 0; s < count; ++s) {
    Side& side = sides_[s];
    side.work.resize(side.boxes.size()), side.sent_work.resize(side.sent.size());
    for (std::size_t i = 0; i < side.boxes.size(); ++i)
      side.work[i] = static_cast<float>(each + per_pair * side.pairs[i]);
    side.plan.reverse(std::span<const float>(side.work), std::span(side.sent_work));
    side.weight.assign(sets[s].size(), 0);
    for (std::size_t k = 0; k < side.sent_work.size(); ++k)
      side.weight[static_cast<std::size_t>(side.item_of_send[k])] += side.sent_work[k];
  }
}

void BoxPairSearch::judge_balance() {
  const std::int64_t mine = work_.total(), greatest = comm_.max(mine);
  std::array<std::int64_t, 2> sums{mine, work_.boxes_received};
  comm_.sum(std::span(sums));
  all_work_ = sums[0], items_ = sums[1];
  if (all_work_ == 0) return;
  const double mean = static_cast<double>(all_work_) / comm_.size();
  const double beyond = static_cast<double>(greatest) / mean - 1;
  // What cuts leave: falls at once, rises slowly, so that an unlucky one is not taken for the best there is.
  if (fresh_ && cut_by_work_) left_ = left_ > 0 && beyond > left_ ? left_ + 0.25 * (beyond - left_) : beyond;
  fresh_ = false;
  lost_ += std::max(0.0, beyond - left_) * mean;
}

}  // namespace tenon
