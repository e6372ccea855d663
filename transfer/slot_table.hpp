// SPDX-License-Identifier: BSD-3-Clause
// Numbers the distinct items (owner, place there) that a rank wants from others.
#pragma once

#include <algorithm>
#include <map>
#include <vector>

#include "framework/base/types.hpp"

namespace tenon::transfer {

/// First mark all items that are wanted, then number them, then look slots up: no sorting, no hashing.
class SlotTable {
 public:
  void mark(int owner, LocalIndex index) {
    std::vector<LocalIndex>& slots = of(owner);
    const auto i = static_cast<std::size_t>(index);
    if (i >= slots.size()) slots.resize(std::max(i + 1, slots.size() + slots.size() / 2), no_index);
    slots[i] = 0;
  }
  /// Slots ascend by owner, then index.
  void number() {
    for (auto& [owner, slots] : slots_)
      for (std::size_t i = 0; i < slots.size(); ++i)
        if (slots[i] != no_index) {
          slots[i] = static_cast<LocalIndex>(owners_.size());
          owners_.push_back(owner);
          indices_.push_back(static_cast<LocalIndex>(i));
        }
  }
  LocalIndex slot(int owner, LocalIndex index) { return of(owner)[static_cast<std::size_t>(index)]; }

  const std::vector<int>& owners() const { return owners_; }
  const std::vector<LocalIndex>& indices() const { return indices_; }

 private:
  std::vector<LocalIndex>& of(int owner) {
    if (!last_ || owner != last_owner_) last_ = &slots_[owner], last_owner_ = owner;
    return *last_;
  }
  std::map<int, std::vector<LocalIndex>> slots_;  // few owners; std::map keeps the addresses of its values
  std::vector<LocalIndex>* last_ = nullptr;
  int last_owner_ = -1;
  std::vector<int> owners_;
  std::vector<LocalIndex> indices_;
};

}  // namespace tenon::transfer
