// SPDX-License-Identifier: BSD-3-Clause
// All pairs of overlapping boxes of two sets, or within one, on this rank: the local kernel of the search for contacts.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "framework/search/packed_boxes.hpp"

namespace tenon {

/// Two packed trees walked together [BKS93]: groups of eight boxes against groups of eight, down to leaves. Boxes may
/// differ in size by any factor, coincide, or be points. Boxes that touch overlap; those that are empty or have a
/// coordinate that is not a number overlap nothing. Floats (rounded outward) decide what is surely apart or surely
/// together, and doubles the rest, so the pairs are exact. Their order depends on the boxes only. Allocates nothing
/// once its buffers have grown.
class BoxJoin {
 public:
  struct Pair {
    LocalIndex first, second;  ///< places in the caller's sets
  };
  using Visit = std::function<void(std::span<const Pair>)>;

  /// Two sets, or one. The boxes must stay where they are as long as pairs are asked for.
  void build(std::span<const Box> first, std::span<const Box> second);
  void build(std::span<const Box> boxes);

  /// Hands over all pairs, each once, some hundred at a time. Of one set: each unordered pair once.
  void visit_pairs(const Visit& visit);
  /// Stores all pairs; what was there is lost.
  void find_pairs(std::vector<Pair>& pairs);

  /// Comparisons of two boxes in the last visit.
  std::int64_t tests() const { return tests_; }
  /// Bytes held.
  std::int64_t memory() const;

 private:
  using Group = PackedBoxes::Group;
  static constexpr int fan_out = PackedBoxes::fan_out;
  static constexpr std::size_t chunk = 1024, leaf_pairs = fan_out * fan_out;

  void meet(int level, LocalIndex a, LocalIndex b);
  void meet_leaves(LocalIndex a, LocalIndex b);
  void flush();

  PackedBoxes packed_[2];
  std::span<const Box> boxes_[2];
  const PackedBoxes* second_ = nullptr;  // the first again for one set
  CurveRoom room_;
  float margin_ = 0;  // more than the rounding of two floats
  const Visit* visit_ = nullptr;
  std::array<Pair, chunk + leaf_pairs> waiting_;
  std::size_t waiting_count_ = 0;
  std::int64_t tests_ = 0;
};

}  // namespace tenon
