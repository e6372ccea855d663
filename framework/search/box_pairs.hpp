// SPDX-License-Identifier: BSD-3-Clause
// All pairs of overlapping boxes over all ranks: the broad phase of contact, in a decomposition of its own.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "framework/base/box.hpp"
#include "framework/base/types.hpp"
#include "framework/comm/communicator.hpp"
#include "framework/comm/exchange_plan.hpp"
#include "framework/search/box_join.hpp"
#include "framework/search/search_parts.hpp"

namespace tenon {

/// Where the caller keeps an item: its rank, and its place in the span that it handed over there.
struct ItemHandle {
  std::int32_t rank;
  LocalIndex index;
  auto operator<=>(const ItemHandle&) const = default;
};

/// Two items whose boxes overlap or touch, wherever they are kept.
struct BoxPair {
  ItemHandle first, second;
  auto operator<=>(const BoxPair&) const = default;
};

/// Finds pairs again and again while the boxes move. Each box goes to all parts of space that it meets; a pair is
/// reported where the low corner of the two boxes' intersection lies, hence once, whatever their sizes. The set of
/// pairs is exact (in doubles) and the same for any decomposition; their order and the ranks that report them are not.
/// Empty boxes, and those with a coordinate that is not a number, are in no pair.
///
/// The parts follow the work of earlier searches: cuts are made anew once the work lost to imbalance since the last
/// time, beyond what new cuts left then, exceeds what cutting costs [MJZK12]. All of it is counted, not timed, so all
/// ranks and all runs decide alike. On one rank nothing is sent or copied.
class BoxPairSearch {
 public:
  /// Collective.
  BoxPairSearch(const Communicator& comm, SearchDecomposition decomposition, std::string name);

  /// Collective. Every pair of one box of each set, on some rank, in place of what was in `pairs`.
  void find(std::span<const Box> first, std::span<const Box> second, std::vector<BoxPair>& pairs);
  /// Collective. Every unordered pair of two different boxes of one set, the lower handle first.
  void find_within(std::span<const Box> boxes, std::vector<BoxPair>& pairs);

  /// Of this rank, in the last search.
  struct Work {
    std::int64_t tests;           ///< comparisons of two boxes
    std::int64_t pairs;           ///< found here, those that another rank reports included
    std::int64_t boxes_received;  ///< sorted here, those of this rank included
    /// All in one, about in nanoseconds of a core, sending included.
    std::int64_t total() const { return 150 * boxes_received + tests + 16 * pairs; }
  };
  const Work& work() const { return work_; }
  /// Searches so far, and those that made new cuts.
  std::int64_t searches() const { return searches_; }
  std::int64_t cuts() const { return cuts_; }

 private:
  /// The boxes of one set that meet on this rank.
  struct Side {
    ExchangePlan plan;
    std::vector<int> rank_of_send;
    std::vector<LocalIndex> item_of_send, index;
    std::vector<Box> sent, boxes;
    std::vector<ItemHandle> handles;
    std::vector<std::int32_t> pairs;     // of each box here
    std::vector<float> work, sent_work;  // of each box here, and of what was sent
    std::vector<float> weight;           // of the caller's items, from the last search
  };

  void search(std::array<std::span<const Box>, 2> sets, std::size_t count, std::vector<BoxPair>& pairs);
  void search_by_owner_boxes(std::array<std::span<const Box>, 2> sets, std::size_t count, std::vector<BoxPair>& pairs);
  void join_here(std::array<std::span<const Box>, 2> sets, std::size_t count, std::vector<BoxPair>& pairs);
  void join_arrived(std::size_t count, std::vector<BoxPair>& pairs);
  void cut_if_worth_it(std::array<std::span<const Box>, 2> sets);
  void send(Side& side, std::span<const Box> boxes, const char* which);
  void return_work(std::array<std::span<const Box>, 2> sets, std::size_t count);
  void judge_balance();

  Communicator comm_;
  SearchDecomposition decomposition_;
  std::string name_;
  SearchParts parts_;
  BoxJoin join_;
  std::array<Side, 2> sides_;
  std::vector<int> ranks_;
  Work work_{};
  std::int64_t searches_ = 0, cuts_ = 0;
  std::int64_t items_ = 0;     // boxes received on all ranks, last search
  std::int64_t all_work_ = 0;  // on all ranks, last search
  double lost_ = 0;            // work waited for since the last cuts, beyond what they left
  double left_ = 0;            // greatest over mean work, less one, that cuts leave
  bool fresh_ = false;         // no search since the last cuts
  bool cut_by_work_ = false;   // the last cuts knew the work of the items
};

}  // namespace tenon
