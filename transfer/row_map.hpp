// SPDX-License-Identifier: BSD-3-Clause
// The map itself: a sparse matrix by rows of local target items, and the gather that brings its columns.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "framework/comm/exchange_plan.hpp"
#include "transfer/mesh_items.hpp"
#include "transfer/slot_table.hpp"

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

/// Rows of interpolation, all with room for `width` terms. The heaviest term comes first, the others in the order of
/// the element's nodes; the weights of a row add up to 1, so that of the first is not kept: 88 bytes for a hexahedron.
class PointRows {
 public:
  PointRows(int width, std::size_t rows)
      : width_(static_cast<std::size_t>(width)), slot_(rows * width_, no_index), weight_(rows * (width_ - 1)) {}

  std::size_t size() const { return slot_.size() / width_; }
  std::size_t width() const { return width_; }
  /// Numbers the source items: mark(i, table) for i < count marks those that will be asked for.
  template <typename Mark>
  void take_items(std::size_t count, Mark mark) {
    for (std::size_t i = 0; i < count; ++i) mark(i, table_);
    table_.number();
  }
  LocalIndex slot(int owner, LocalIndex index) { return table_.slot(owner, index); }
  /// `slot_of(a)`: the slot of the source item with weights[a]. A row that is never set has no terms.
  template <typename SlotOf>
  void set(std::size_t row, std::span<const double> weights, SlotOf slot_of) {
    std::size_t heaviest = 0;
    for (std::size_t a = 1; a < weights.size(); ++a)
      if (std::abs(weights[a]) > std::abs(weights[heaviest])) heaviest = a;
    LocalIndex* const slots = slot_.data() + row * width_;
    double* const to = weight_.data() + row * (width_ - 1);
    slots[0] = slot_of(heaviest);
    std::size_t k = 1;
    for (std::size_t a = 0; a < weights.size(); ++a)
      if (a != heaviest) slots[k] = slot_of(a), to[k - 1] = weights[a], ++k;
    for (; k < width_; ++k) slots[k] = slots[0];  // weight 0
  }

 private:
  friend class RowMap;
  std::size_t width_;
  std::vector<LocalIndex> slot_;
  std::vector<double> weight_;
  SlotTable table_;
};

/// target = sum of weights x gathered source values, in an order that does not depend on the ranks: of source ids, or,
/// for interpolation, that of PointRows: v0 + sum w (v - v0), which keeps constants, and values at a node, bit for bit.
class RowMap {
 public:
  RowMap() = default;
  /// Collective. Rows of all local target items; those without terms receive 0.
  RowMap(const Communicator& comm, const Rows& rows, const std::string& name);
  /// Collective. The same for interpolation; rows without terms receive `empty_value`.
  RowMap(const Communicator& comm, PointRows&& rows, double empty_value, const std::string& name);

  std::size_t rows() const { return width_ > 0 ? slot_.size() / width_ : begin_.size() - 1; }
  /// Items that arrive by the gather.
  std::size_t slots() const { return slots_; }
  const ExchangePlan& gather() const { return gather_; }
  /// Local. `gathered`: slots() x components, `target`: rows() x components.
  void multiply(std::span<const double> gathered, std::span<double> target, int components) const;

  /// Calls visit(slot, weight) for the terms of a row; zeros may be among them.
  template <typename Visit>
  void for_each_term(std::size_t row, Visit&& visit) const {
    if (width_ == 0) {
      for (auto k = static_cast<std::size_t>(begin_[row]); k < static_cast<std::size_t>(begin_[row + 1]); ++k)
        visit(static_cast<std::size_t>(slot_[k]), weight_[k]);
      return;
    }
    const LocalIndex* const slots = slot_.data() + row * width_;
    const double* const weights = weight_.data() + row * (width_ - 1);
    if (slots[0] == no_index) return;
    double first = 1;
    for (std::size_t k = 1; k < width_; ++k) first -= weights[k - 1];
    visit(static_cast<std::size_t>(slots[0]), first);
    for (std::size_t k = 1; k < width_; ++k) visit(static_cast<std::size_t>(slots[k]), weights[k - 1]);
  }
  std::int64_t memory() const;

 private:
  template <int components>
  void multiply_fixed(const double* gathered, double* target) const;
  template <int components, int width>
  void interpolate_fixed(const double* gathered, double* target) const;
  void multiply_any(const double* gathered, double* target, std::size_t components) const;
  void take_gather(const Communicator& comm, const SlotTable& wanted, const std::string& name);

  std::vector<std::int64_t> begin_{0};
  std::vector<LocalIndex> slot_;
  std::vector<double> weight_;
  std::size_t slots_ = 0;
  ExchangePlan gather_;
  std::size_t width_ = 0;  // of PointRows; 0: rows by begin_
  double empty_value_ = 0;
};

}  // namespace tenon::transfer
