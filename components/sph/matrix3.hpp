// SPDX-License-Identifier: BSD-3-Clause
// 3 x 3 matrices of single particles, nine numbers row by row, and the correction of gradients.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "components/sph/particle_data.hpp"
#include "framework/base/types.hpp"

namespace tenon {

using Matrix3 = std::array<double, 9>;

inline constexpr Matrix3 identity3{1, 0, 0, 0, 1, 0, 0, 0, 1};

inline Matrix3 matrix_of(const Column& column, std::size_t i) {
  Matrix3 m;
  for (std::size_t k = 0; k < 9; ++k) m[k] = column[9 * i + k];
  return m;
}
inline void set_matrix(Column& column, std::size_t i, const Matrix3& m) {
  for (std::size_t k = 0; k < 9; ++k) column[9 * i + k] = m[k];
}
/// From xx yy zz xy yz zx.
inline Matrix3 matrix_of_tensor(const Column& column, std::size_t i) {
  const double* const t = column.data() + 6 * i;
  return {t[0], t[3], t[5], t[3], t[1], t[4], t[5], t[4], t[2]};
}

inline Matrix3 operator+(const Matrix3& a, const Matrix3& b) {
  Matrix3 c;
  for (std::size_t k = 0; k < 9; ++k) c[k] = a[k] + b[k];
  return c;
}
inline Matrix3 operator-(const Matrix3& a, const Matrix3& b) {
  Matrix3 c;
  for (std::size_t k = 0; k < 9; ++k) c[k] = a[k] - b[k];
  return c;
}
inline Matrix3 operator*(double s, const Matrix3& a) {
  Matrix3 c;
  for (std::size_t k = 0; k < 9; ++k) c[k] = s * a[k];
  return c;
}
inline Matrix3 product(const Matrix3& a, const Matrix3& b) {
  Matrix3 c;
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t k = 0; k < 3; ++k)
      c[3 * r + k] = a[3 * r] * b[k] + a[3 * r + 1] * b[3 + k] + a[3 * r + 2] * b[6 + k];
  return c;
}
inline Matrix3 transposed(const Matrix3& a) {
  return {a[0], a[3], a[6], a[1], a[4], a[7], a[2], a[5], a[8]};
}
inline double determinant(const Matrix3& a) {
  return a[0] * (a[4] * a[8] - a[5] * a[7]) - a[1] * (a[3] * a[8] - a[5] * a[6]) + a[2] * (a[3] * a[7] - a[4] * a[6]);
}
/// Of a matrix whose determinant is known not to vanish.
inline Matrix3 inverse(const Matrix3& a, double det) {
  const double s = 1 / det;
  return {s * (a[4] * a[8] - a[5] * a[7]), s * (a[2] * a[7] - a[1] * a[8]), s * (a[1] * a[5] - a[2] * a[4]),
          s * (a[5] * a[6] - a[3] * a[8]), s * (a[0] * a[8] - a[2] * a[6]), s * (a[2] * a[3] - a[0] * a[5]),
          s * (a[3] * a[7] - a[4] * a[6]), s * (a[1] * a[6] - a[0] * a[7]), s * (a[0] * a[4] - a[1] * a[3])};
}
/// Square root of the greatest eigenvalue of a a^T, from above: tr/3 + sqrt(2/3) |deviator|.
inline double greatest_stretch_bound(const Matrix3& a) {
  const Matrix3 c = product(a, transposed(a));
  const double mean = (c[0] + c[4] + c[8]) / 3;
  double squared = 0;
  for (std::size_t k = 0; k < 9; ++k) {
    const double v = c[k] - (k % 4 == 0 ? mean : 0);
    squared += v * v;
  }
  return std::sqrt(mean + std::sqrt(2.0 / 3 * squared));
}

/// [RL96]: sum over j of V_j (f_j - f_i) (M^-1 grad W) is the gradient of a linear field exactly, wherever the
/// neighbours are, with M = sum over j of V_j (x_j - x_i) grad W. `moment` is M, with the identity in the dimensions
/// that are left out. Particles whose neighbours do not span space (one alone, a row of them) are left without
/// correction.
inline Matrix3 gradient_correction(const Matrix3& moment, int dimension) {
  double mean = 0;
  for (int c = 0; c < dimension; ++c) mean += moment[static_cast<std::size_t>(4 * c)] / dimension;
  const double det = determinant(moment);
  constexpr double least = 1e-3;  // of the determinant of as many neighbours all round
  return det > least * std::pow(mean, dimension) && det < 1e3 && mean > least ? inverse(moment, det) : identity3;
}

}  // namespace tenon
