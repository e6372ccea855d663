// SPDX-License-Identifier: BSD-3-Clause
// A sparse matrix by rows, and its product with vectors of several components.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "framework/base/types.hpp"

namespace tenon::transfer {

/// Row i has the terms begin[i] .. begin[i+1]). Sums are taken in the order of the terms, in four parts (every fourth
/// term, for the latency of the additions): the same bits wherever a row is worked out. Value is double or float.
template <typename Value>
struct SparseRows {
  std::vector<std::int64_t> begin{0};
  std::vector<LocalIndex> column;
  std::vector<Value> value;

  std::size_t size() const { return begin.size() - 1; }
  std::size_t first(std::size_t row) const { return static_cast<std::size_t>(begin[row]); }
  std::size_t last(std::size_t row) const { return static_cast<std::size_t>(begin[row + 1]); }
  /// Local. `from`: columns x components, `to`: size() x components.
  void multiply(std::span<const double> from, std::span<double> to, int components) const;
  std::int64_t memory() const;
};

}  // namespace tenon::transfer
