// SPDX-License-Identifier: BSD-3-Clause
// The map itself: a sparse matrix by rows of local target items, and the gather that brings its columns.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "framework/base/pack.hpp"
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

/// Numbers that nobody has set yet: a big array that is to be written once is not zeroed first.
template <typename T>
class RawArray {
 public:
  void resize(std::size_t size) {
    if (size > capacity_) values_ = std::make_unique_for_overwrite<T[]>(size), capacity_ = size;
    size_ = size;
  }
  T* data() { return values_.get(); }
  const T* data() const { return values_.get(); }
  T operator[](std::size_t i) const { return values_[i]; }
  std::size_t size() const { return size_; }
  std::size_t capacity() const { return capacity_; }

 private:
  std::unique_ptr<T[]> values_;
  std::size_t size_ = 0, capacity_ = 0;
};

/// Rows of interpolation, all with room for `width` terms. The heaviest term comes first, and the first of the
/// element's nodes takes its place; the weights of a row add up to 1, so that of the first is not kept: 88 bytes for a
/// hexahedron. Every row must be set once.
class PointRows {
 public:
  PointRows() = default;
  void resize(std::size_t width, std::size_t rows) {
    width_ = width;
    slot_.resize(rows * width), weight_.resize(rows * (width - 1));
  }
  std::size_t size() const { return width_ > 0 ? slot_.size() / width_ : 0; }
  std::size_t width() const { return width_; }
  /// `slot_of(a)`: the slot of the source item with weights[a].
  template <typename SlotOf>
  void set(std::size_t row, std::span<const double> weights, SlotOf slot_of) {
    std::size_t heaviest = 0;
    for (std::size_t a = 1; a < weights.size(); ++a)
      if (std::abs(weights[a]) > std::abs(weights[heaviest])) heaviest = a;
    LocalIndex* const slots = slot_.data() + row * width_;
    double* const to = weight_.data() + row * (width_ - 1);
    for (std::size_t a = 0; a < weights.size(); ++a) slots[a] = slot_of(a);
    std::swap(slots[0], slots[heaviest]);
    for (std::size_t a = 1; a < weights.size(); ++a) to[a - 1] = weights[a];
    if (heaviest > 0) to[heaviest - 1] = weights[0];
    for (std::size_t a = weights.size(); a < width_; ++a) slots[a] = slots[0], to[a - 1] = 0;
  }
  /// The same for the eight weights of a hexahedron, none negative: low of the first four nodes, high of the others.
  TENON_KERNEL void set_hexahedron(std::size_t row, const Pack& low, const Pack& high, const LocalIndex* slots_from) {
    const Pack most = greater_of(low, high);
    const double greatest = std::max(std::max(most[0], most[1]), std::max(most[2], most[3]));
    const unsigned where = bits(low == greatest) | bits(high == greatest) << 4;
    const int heaviest = std::countr_zero(where);
    LocalIndex* const slots = slot_.data() + row * 8;
    double* const to = weight_.data() + row * 7;
    std::memcpy(slots, slots_from, 8 * sizeof(LocalIndex));
    std::swap(slots[0], slots[heaviest]);
    double all[8];
    store(all, low), store(all + 4, high);
    std::memcpy(to, all + 1, 7 * sizeof(double));
    if (heaviest > 0) to[heaviest - 1] = all[0];
  }
  /// The row has no terms.
  void set_empty(std::size_t row) {
    LocalIndex* const slots = slot_.data() + row * width_;
    double* const to = weight_.data() + row * (width_ - 1);
    std::fill_n(slots, width_, no_index), std::fill_n(to, width_ - 1, 0.0);
  }

 private:
  friend class RowMap;
  std::size_t width_ = 0;
  RawArray<LocalIndex> slot_;
  RawArray<double> weight_;
};

/// target = sum of weights x gathered source values, in an order that does not depend on the ranks: of source ids, or,
/// for interpolation, that of PointRows: v0 + sum w (v - v0), which keeps constants, and values at a node, bit for bit.
class RowMap {
 public:
  RowMap() = default;
  /// Collective. Rows of all local target items; those without terms receive `empty_value`.
  RowMap(const Communicator& comm, const Rows& rows, const std::string& name, double empty_value = 0);
  /// Collective. The same for interpolation; rows without terms receive `empty_value`. Slots are those of `wanted`, or,
  /// without it, on one rank, the places of the source items themselves, of which there are `slots`.
  RowMap(const Communicator& comm, PointRows&& rows, double empty_value, const SlotTable& wanted,
         const std::string& name);
  RowMap(PointRows&& rows, double empty_value, std::size_t slots);

  std::size_t rows() const { return width_ > 0 ? points_.size() : begin_.size() - 1; }
  /// The rows of interpolation, to be used again for another map; this one has none left.
  PointRows take_rows() { return std::exchange(points_, {}); }
  /// Items that arrive by the gather.
  std::size_t slots() const { return slots_; }
  /// Whether multiply() takes the source's own values: on one rank interpolation gathers nothing.
  bool direct() const { return direct_; }
  /// Collective. Brings source values (one message per neighbour for all of them) to `to` of each item, slots() long.
  void gather(std::span<const ExchangeItem> values) const;
  template <typename T>
  std::vector<T> gathered(std::span<const T> values) const {
    std::vector<T> result(slots_);
    const ExchangeItem item{reinterpret_cast<const std::byte*>(values.data()),
                            reinterpret_cast<std::byte*>(result.data()), sizeof(T)};
    gather(std::span(&item, 1));
    return result;
  }
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
    const LocalIndex* const slots = points_.slot_.data() + row * width_;
    const double* const weights = points_.weight_.data() + row * (width_ - 1);
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
  bool direct_ = false;
  std::size_t width_ = 0;  // of points_; 0: rows by begin_
  PointRows points_;
  double empty_value_ = 0;
};

}  // namespace tenon::transfer
