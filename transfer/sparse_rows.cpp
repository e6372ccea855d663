// SPDX-License-Identifier: BSD-3-Clause
#include "transfer/sparse_rows.hpp"

#include <array>
#include <cassert>

namespace tenon::transfer {

namespace {

constexpr std::size_t parts = 4;

template <std::size_t components, typename Value>
void multiply_fixed(const SparseRows<Value>& rows, const double* from, double* to) {
  const LocalIndex* const column = rows.column.data();
  const Value* const value = rows.value.data();
  for (std::size_t i = 0; i < rows.size(); ++i, to += components) {
    std::array<std::array<double, components>, parts> sum{};
    const std::size_t end = rows.last(i);
    const auto add = [&](std::size_t part, std::size_t k) {
      const double* const x = from + static_cast<std::size_t>(column[k]) * components;
      for (std::size_t c = 0; c < components; ++c) sum[part][c] += double{value[k]} * x[c];
    };
    std::size_t k = rows.first(i);
    for (; k + parts <= end; k += parts)
      for (std::size_t part = 0; part < parts; ++part) add(part, k + part);
    for (std::size_t part = 0; k < end; ++k, ++part) add(part, k);
    for (std::size_t c = 0; c < components; ++c) to[c] = (sum[0][c] + sum[1][c]) + (sum[2][c] + sum[3][c]);
  }
}

/// The same sums for any number of components.
template <typename Value>
void multiply_any(const SparseRows<Value>& rows, const double* from, double* to, std::size_t components) {
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t c = 0; c < components; ++c, ++to) {
      std::array<double, parts> sum{};
      for (std::size_t k = rows.first(i); k < rows.last(i); ++k)
        sum[(k - rows.first(i)) % parts] +=
            double{rows.value[k]} * from[static_cast<std::size_t>(rows.column[k]) * components + c];
      *to = (sum[0] + sum[1]) + (sum[2] + sum[3]);
    }
}

}  // namespace

template <typename Value>
void SparseRows<Value>::multiply(std::span<const double> from, std::span<double> to, int components) const {
  assert(to.size() >= size() * static_cast<std::size_t>(components));
  switch (components) {
    case 1:
      return multiply_fixed<1>(*this, from.data(), to.data());
    case 2:
      return multiply_fixed<2>(*this, from.data(), to.data());
    case 3:
      return multiply_fixed<3>(*this, from.data(), to.data());
    case 6:
      return multiply_fixed<6>(*this, from.data(), to.data());
    default:
      return multiply_any(*this, from.data(), to.data(), static_cast<std::size_t>(components));
  }
}

template <typename Value>
std::int64_t SparseRows<Value>::memory() const {
  return static_cast<std::int64_t>(begin.capacity() * sizeof(begin[0]) + column.capacity() * sizeof(column[0]) +
                                   value.capacity() * sizeof(value[0]));
}

template struct SparseRows<double>;
template struct SparseRows<float>;

}  // namespace tenon::transfer
