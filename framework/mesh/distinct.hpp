// SPDX-License-Identifier: BSD-3-Clause
// The distinct values of a list, and orders by value: what assembling a mesh does most.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "framework/base/types.hpp"

namespace tenon {

struct Distinct {
  std::vector<std::int64_t> values;  ///< ascending
  std::vector<LocalIndex> places;    ///< of each entry among `values`
};

/// By a hash table, so that only the distinct values are sorted.
Distinct distinct(std::span<const std::int64_t> entries);

/// Positions in ascending order of the keys; equal keys keep their order.
std::vector<std::size_t> sorted_positions(std::span<const std::int64_t> keys);

}  // namespace tenon
