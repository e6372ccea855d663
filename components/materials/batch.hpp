// SPDX-License-Identifier: BSD-3-Clause
// Eight points side by side: the unit of work of every material and element kernel.
#pragma once

namespace tenon {

/// Points per batch: two AVX2 registers. Short batches are padded, so that every point meets the same arithmetic
/// wherever it stands.
inline constexpr int lanes = 8;

/// N values at each of `lanes` points, value by value (struct of arrays).
template <int N>
struct alignas(64) Batch {
  double v[N][lanes];
  double* operator[](int i) { return v[i]; }
  const double* operator[](int i) const { return v[i]; }
};

}  // namespace tenon
