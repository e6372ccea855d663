// SPDX-License-Identifier: BSD-3-Clause
#include "framework/mesh/distinct.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace tenon {

namespace {

/// Numbers values as they come: open addressing, at most half full.
class Numbering {
 public:
  explicit Numbering(std::vector<std::int64_t>& values) : values_(values) { resize(1024); }

  LocalIndex number(std::int64_t value) {
    std::size_t slot = start(value);
    for (; slots_[slot] != no_index; slot = (slot + 1) & (slots_.size() - 1))
      if (values_[static_cast<std::size_t>(slots_[slot])] == value) return slots_[slot];
    const auto fresh = static_cast<LocalIndex>(values_.size());
    slots_[slot] = fresh;
    values_.push_back(value);
    if (2 * values_.size() > slots_.size()) resize(2 * slots_.size());
    return fresh;
  }

 private:
  std::size_t start(std::int64_t value) const {
    return static_cast<std::size_t>((static_cast<std::uint64_t>(value) * 0x9E3779B97F4A7C15ULL) >> shift_);
  }
  void resize(std::size_t size) {
    slots_.assign(size, no_index);
    shift_ = 64 - std::countr_zero(size);
    for (std::size_t i = 0; i < values_.size(); ++i) {
      std::size_t slot = start(values_[i]);
      while (slots_[slot] != no_index) slot = (slot + 1) & (size - 1);
      slots_[slot] = static_cast<LocalIndex>(i);
    }
  }

  std::vector<std::int64_t>& values_;
  std::vector<LocalIndex> slots_;
  int shift_ = 0;
};

}  // namespace

Distinct distinct(std::span<const std::int64_t> entries) {
  Distinct result;
  std::vector<std::int64_t> as_they_come;
  Numbering numbering(as_they_come);
  result.places.reserve(entries.size());
  for (const std::int64_t value : entries) result.places.push_back(numbering.number(value));

  std::vector<LocalIndex> place(as_they_come.size());
  result.values.reserve(as_they_come.size());
  for (const std::size_t i : sorted_positions(as_they_come)) {
    place[i] = static_cast<LocalIndex>(result.values.size());
    result.values.push_back(as_they_come[i]);
  }
  for (LocalIndex& p : result.places) p = place[static_cast<std::size_t>(p)];
  return result;
}

std::vector<std::size_t> sorted_positions(std::span<const std::int64_t> keys) {
  std::vector<std::size_t> order(keys.size());
  // Many codes give their ids in order.
  if (std::is_sorted(keys.begin(), keys.end())) {
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    return order;
  }
  std::vector<std::pair<std::int64_t, std::size_t>> pairs(keys.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i] = {keys[i], i};
  std::sort(pairs.begin(), pairs.end());
  for (std::size_t i = 0; i < pairs.size(); ++i) order[i] = pairs[i].second;
  return order;
}

}  // namespace tenon
