// SPDX-License-Identifier: BSD-3-Clause
// Sparse matrices of one rank in compressed rows, and their products.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "framework/base/types.hpp"

namespace tenon::thermal {

/// Entries of row r: offsets[r] .. offsets[r + 1].
template <typename T>
struct SparseMatrix {
  LocalIndex columns = 0;
  std::vector<LocalIndex> offsets{0}, column;
  std::vector<T> value;

  LocalIndex rows() const { return static_cast<LocalIndex>(offsets.size()) - 1; }
  std::size_t begin(LocalIndex row) const { return static_cast<std::size_t>(offsets[static_cast<std::size_t>(row)]); }
  std::size_t end(LocalIndex row) const { return begin(row + 1); }
  void add(LocalIndex col, T v) {
    column.push_back(col);
    value.push_back(v);
  }
  /// No rows; keeps its memory.
  void clear(LocalIndex number_of_columns) {
    columns = number_of_columns;
    offsets.assign(1, 0);
    column.clear();
    value.clear();
  }
  void end_row() { offsets.push_back(static_cast<LocalIndex>(column.size())); }
  std::int64_t memory() const {
    return static_cast<std::int64_t>(offsets.capacity() + column.capacity()) * 4 +
           static_cast<std::int64_t>(value.capacity() * sizeof(T));
  }
};

/// The transpose; the columns of each of its rows ascend.
template <typename T>
SparseMatrix<T> transposed(const SparseMatrix<T>& m) {
  SparseMatrix<T> t;
  t.columns = m.rows();
  t.offsets.assign(static_cast<std::size_t>(m.columns) + 1, 0);
  t.column.resize(m.column.size());
  t.value.resize(m.value.size());
  for (const LocalIndex c : m.column) ++t.offsets[static_cast<std::size_t>(c) + 1];
  for (std::size_t r = 1; r < t.offsets.size(); ++r) t.offsets[r] += t.offsets[r - 1];
  std::vector<LocalIndex> next(t.offsets.begin(), t.offsets.end() - 1);
  for (LocalIndex r = 0; r < m.rows(); ++r)
    for (std::size_t p = m.begin(r); p < m.end(r); ++p) {
      const auto place = static_cast<std::size_t>(next[static_cast<std::size_t>(m.column[p])]++);
      t.column[place] = r;
      t.value[place] = m.value[p];
    }
  return t;
}

/// Adds terms (column, value) up to one row of a product at a time. `place` is its memory.
template <typename T>
class RowSum {
 public:
  RowSum(SparseMatrix<T>& out, std::vector<LocalIndex>& place) : out_(out), place_(place) {
    place_.assign(static_cast<std::size_t>(out.columns), no_index);
  }
  void add(LocalIndex col, T v) {
    LocalIndex& place = place_[static_cast<std::size_t>(col)];
    if (place < out_.offsets.back()) {  // not in this row yet
      place = static_cast<LocalIndex>(out_.column.size());
      out_.add(col, v);
    } else {
      out_.value[static_cast<std::size_t>(place)] += v;
    }
  }

 private:
  SparseMatrix<T>& out_;
  std::vector<LocalIndex>& place_;
};

/// c = a b, terms in ascending order of a's entries. Allocates only what c and `place` do not have.
template <typename A, typename B>
void product(const SparseMatrix<A>& a, const SparseMatrix<B>& b, SparseMatrix<double>& c,
             std::vector<LocalIndex>& place) {
  c.clear(b.columns);
  RowSum<double> row(c, place);
  for (LocalIndex r = 0; r < a.rows(); ++r) {
    for (std::size_t p = a.begin(r); p < a.end(r); ++p)
      for (std::size_t q = b.begin(a.column[p]); q < b.end(a.column[p]); ++q)
        row.add(b.column[q], static_cast<double>(a.value[p]) * static_cast<double>(b.value[q]));
    c.end_row();
  }
}

/// The same with values of half the size; sums stay in double precision.
void make_single(const SparseMatrix<double>& m, SparseMatrix<float>& single);

/// out = b - m x.
void residual(const SparseMatrix<float>& m, std::span<const double> x, std::span<const double> b,
              std::span<double> out);
/// out = m x.
void multiply(const SparseMatrix<float>& m, std::span<const double> x, std::span<double> out);

}  // namespace tenon::thermal
