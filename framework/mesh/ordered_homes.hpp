// SPDX-License-Identifier: BSD-3-Clause
// Every rank answers for a range of keys, in ascending order of the ranks: a distributed sort by samples.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "framework/base/types.hpp"
#include "framework/comm/communicator.hpp"

namespace tenon {

/// Unlike a Directory, whose ids are dense, this shares any 64-bit keys about equally (regular samples [SS92]). A key
/// that stands often has one home all the same.
class OrderedHomes {
 public:
  /// Collective.
  OrderedHomes(const Communicator& comm, std::span<const std::int64_t> keys);
  int home(std::int64_t key) const {
    return static_cast<int>(std::upper_bound(splitters_.begin(), splitters_.end(), key) - splitters_.begin());
  }
  std::vector<int> homes(std::span<const std::int64_t> keys) const;

 private:
  std::vector<std::int64_t> splitters_;  // rank r has keys from splitters_[r - 1] to below splitters_[r]
};

/// Numbers of rows in lexicographic order over all ranks.
struct RowNumbers {
  std::vector<GlobalId> numbers;             ///< of this rank's rows, from 0
  GlobalId count = 0;                        ///< over all ranks
  GlobalId repeated = 0;                     ///< rows that stood before, over all ranks; they have numbers of their own
  std::vector<std::int64_t> first_repeated;  ///< the least of them, on all ranks
};

/// Collective. `rows`: of `width` values each.
RowNumbers number_rows(const Communicator& comm, std::span<const std::int64_t> rows, std::size_t width,
                       const std::string& name);

}  // namespace tenon
