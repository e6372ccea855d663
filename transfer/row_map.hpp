// SPDX-License-Identifier: BSD-3-Clause
// The map itself: a sparse matrix by rows of local target items, and the gather that brings its columns.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "framework/comm/exchange_plan.hpp"
#include "transfer/mesh_items.hpp"

namespace tenon::transfer {

/// One term of a row: a source item, where its owner keeps it, and its weight.
struct Term {
  GlobalId source = no_id;
  double weight = 0;
  int owner = -1;
  LocalIndex at_owner = no_index;
};

/// Rows of terms, one after the other; terms ascend by source id, each source once.
struct Rows {
  std::vector<std::int64_t> begin{0};
  std::vector<Term> terms;
  std::size_t size() const { return begin.size() - 1; }
  std::span<const Term> row(std::size_t i) const {
    return {terms.data() + begin[i], static_cast<std::size_t>(begin[i + 1] - begin[i])};
  }
};

/// Puts the terms of a row in order.
void sort_by_source(std::span<Term> terms);

/// Collective. From the rows of the owned items (in order of `items.owned`) those of all local items: ghosts get the
/// row that their owner has.
Rows share_rows(const Communicator& comm, const Items& items, Rows&& owned, const std::string& name);

/// target = sum of weights x gathered source values, in ascending order of source id.
class RowMap {
 public:
  RowMap() = default;
  /// Collective. Rows of all local target items. `empty_value` is what an item without terms receives. `interpolating`:
  /// the weights of every row add up to 1, and v0 + sum w (v - v0) is evaluated, which keeps constants bit for bit.
  RowMap(const Communicator& comm, const Rows& rows, bool interpolating, double empty_value, const std::string& name);

  std::size_t rows() const { return begin_.size() - 1; }
  /// Items that arrive by the gather.
  std::size_t slots() const { return slots_; }
  const ExchangePlan& gather() const { return gather_; }
  /// Local. `gathered`: slots() x components, `target`: rows() x components.
  void multiply(std::span<const double> gathered, std::span<double> target, int components) const;

  /// Calls visit(slot, weight) for the terms of a row.
  template <typename Visit>
  void for_each_term(std::size_t row, Visit&& visit) const {
    for (auto k = static_cast<std::size_t>(begin_[row]); k < static_cast<std::size_t>(begin_[row + 1]); ++k)
      visit(static_cast<std::size_t>(slot_[k]), weight_[k]);
  }
  std::int64_t memory() const;

 private:
  template <int components>
  void multiply_fixed(const double* gathered, double* target) const;
  template <int components>
  void interpolate_fixed(const double* gathered, double* target) const;

  std::vector<std::int64_t> begin_{0};
  std::vector<LocalIndex> slot_;
  std::vector<double> weight_;
  std::size_t slots_ = 0;
  ExchangePlan gather_;
  bool interpolating_ = false;
  double empty_value_ = 0;
};

}  // namespace tenon::transfer
