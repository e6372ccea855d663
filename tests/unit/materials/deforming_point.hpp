// SPDX-License-Identifier: BSD-3-Clause
// One material point under a path of deformation gradients, as an element would drive it.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "components/materials/material_concept.hpp"
#include "material_point.hpp"

namespace tenon::testing {

using Matrix = std::array<std::array<double, 3>, 3>;

inline Matrix identity() {
  return {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
}
inline Matrix operator*(const Matrix& a, const Matrix& b) {
  Matrix c{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k) c[i][j] += a[i][k] * b[k][j];
  return c;
}
inline Matrix combine(double x, const Matrix& a, double y, const Matrix& b) {
  Matrix c;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) c[i][j] = x * a[i][j] + y * b[i][j];
  return c;
}
inline Matrix transposed(const Matrix& a) {
  Matrix c;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) c[i][j] = a[j][i];
  return c;
}
inline double determinant(const Matrix& m) {
  double sum = 0;
  for (std::size_t j = 0; j < 3; ++j) {
    const std::size_t a = (j + 1) % 3, b = (j + 2) % 3;
    sum += m[0][j] * (m[1][a] * m[2][b] - m[1][b] * m[2][a]);
  }
  return sum;
}
inline Matrix inverse(const Matrix& m) {
  Matrix c;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t a = (j + 1) % 3, b = (j + 2) % 3, d = (i + 1) % 3, e = (i + 2) % 3;
      c[i][j] = (m[a][d] * m[b][e] - m[a][e] * m[b][d]) / determinant(m);
    }
  return c;
}
/// Turn by `angle` about the axis (1, 2, 3).
inline Matrix turn(double angle) {
  const double s = 1 / std::sqrt(14.0), n[3] = {s, 2 * s, 3 * s}, c = std::cos(angle), w = std::sin(angle);
  Matrix r{{{c, -w * n[2], w * n[1]}, {w * n[2], c, -w * n[0]}, {-w * n[1], w * n[0], c}}};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) r[i][j] += (1 - c) * n[i] * n[j];
  return r;
}

/// Midpoint rate of deformation, and the rotation of Hughes and Winget for all that turns ([HW80]).
template <Material M>
struct DeformingPoint {
  M material;
  Matrix F = identity();
  Batch<6> stress = everywhere<6>({});
  StateBatch<M> state{};
  Batch<2> moduli{};
  double plastic_work = 0, work = 0;  ///< per undeformed volume; `work` by the trapezium

  explicit DeformingPoint(const M& m) : material(m) {
    if constexpr (requires { m.initial_state(0); })
      for (int i = 0; i < M::state_size; ++i)
        for (int l = 0; l < lanes; ++l) state[i][l] = m.initial_state(i);
  }

  Matrix tensor(int first = -1) const {
    const auto at = [&](int c) {
      if constexpr (M::state_size > 0)
        if (first >= 0) return state[first + c][0];
      return stress[c][0];
    };
    return {{{at(0), at(3), at(5)}, {at(3), at(1), at(4)}, {at(5), at(4), at(2)}}};
  }

  void rotate(const Matrix& R) {
    constexpr std::size_t row[6] = {0, 1, 2, 0, 1, 2}, column[6] = {0, 1, 2, 1, 2, 0};
    const auto turned = [&](const Matrix& t, auto& to, int first) {
      const Matrix r = R * t * transposed(R);
      for (int c = 0; c < 6; ++c)
        for (int l = 0; l < lanes; ++l) to[first + c][l] = r[row[c]][column[c]];
    };
    turned(tensor(), stress, 0);
    if constexpr (requires { M::rotating_tensors; })
      for (const int first : M::rotating_tensors) turned(tensor(first), state, first);
    if constexpr (requires { M::rotating_vectors; })
      for (const int first : M::rotating_vectors) {
        double v[3] = {};
        for (std::size_t i = 0; i < 3; ++i)
          for (std::size_t j = 0; j < 3; ++j) v[i] += R[i][j] * state[first + static_cast<int>(j)][0];
        for (int i = 0; i < 3; ++i)
          for (int l = 0; l < lanes; ++l) state[first + i][l] = v[i];
      }
  }

  void deform(const Matrix& to, double dt = 1, double heat = 0, double dT = 0) {
    const Matrix L = combine(1, to, -1, F) * inverse(combine(0.5, F, 0.5, to));
    const Matrix half = combine(0.25, L, -0.25, transposed(L));
    rotate(inverse(combine(1, identity(), -1, half)) * combine(1, identity(), 1, half));
    const double volume_before = determinant(F), volume = determinant(to);
    F = to;
    const Tensor e{
        L[0][0], L[1][1], L[2][2], 0.5 * (L[0][1] + L[1][0]), 0.5 * (L[1][2] + L[2][1]), 0.5 * (L[2][0] + L[0][2])};
    Batch<9> gradient;
    for (std::size_t i = 0; i < 9; ++i)
      for (int l = 0; l < lanes; ++l) gradient[static_cast<int>(i)][l] = F[i / 3][i % 3];
    const Batch<6> strain = everywhere<6>(e), before = stress;
    const Batch<1> T = everywhere<1>({293.15}), rise = everywhere<1>({dT}), ratio = everywhere<1>({volume}),
                   added = everywhere<1>({heat});
    const UpdateInput input{strain, T, rise, dt, &gradient, &ratio, &added};
    Batch<1> plastic;
    material.update(input, stress, state, plastic);
    if constexpr (requires { material.stiffness(input, stress, state, moduli); })
      material.stiffness(input, stress, state, moduli);
    const double middle = 0.5 * (volume + volume_before);
    plastic_work += middle * plastic[0][0];
    for (int c = 0; c < 6; ++c)
      work += middle * (c < 3 ? 0.5 : 1.0) * (before[c][0] + stress[c][0]) * e[static_cast<std::size_t>(c)];
  }

  double operator[](int c) const { return stress[c][0]; }
  double pressure() const { return -(stress[0][0] + stress[1][0] + stress[2][0]) / 3; }
  double von_mises() const {
    double sum = 0;
    for (int c = 0; c < 3; ++c) sum += std::pow(stress[c][0] + pressure(), 2) + 2 * stress[c + 3][0] * stress[c + 3][0];
    return std::sqrt(1.5 * sum);
  }
};

inline Matrix stretch(double x, double y, double z) {
  return {{{x, 0, 0}, {0, y, 0}, {0, 0, z}}};
}

}  // namespace tenon::testing
