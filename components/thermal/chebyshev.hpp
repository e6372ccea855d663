// SPDX-License-Identifier: BSD-3-Clause
// Chebyshev smoothing of A x = b, and the bound of the spectrum of D^-1 A that it needs.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace tenon::thermal {

/// Chebyshev smoothing [Saa03, algorithm 12.1] on the upper part of the spectrum of D^-1 A: its coefficients.
struct Chebyshev {
  static constexpr int degree = 2;
  /// Part of the spectrum that is smoothed: from `greatest` / `range` to `greatest`.
  static constexpr double range = 5;
  explicit Chebyshev(double greatest = 1)
      : theta(0.5 * greatest * (1 + 1 / range)), delta(0.5 * greatest * (1 - 1 / range)) {}
  double theta, delta;
};

// The matrix of the functions below, A with diagonal D, is any type with
//   rows()                          number of rows
//   entry(v, k)                     value of vector v that belongs to row k
//   inverse_diagonal(k)             1 / D_k; 0 for a row that takes no part
//   multiply(v, out)                out[k] = (A v)_k
//   row_size(k)                     sum of the sizes of the entries of row k
//   Sum                             adds up terms by add(); sums(array of two of them) and greatest(double): of all
//   ranks

/// Greatest quotient of Rayleigh of D^-1 A in a power iteration from x, which is lost; near its greatest eigenvalue,
/// unless its eigenvector is a rare one.
template <typename Matrix>
double power_iteration(const Matrix& a, std::span<double> x, std::span<double> product) {
  constexpr int turns = 12;
  double greatest = 0;
  for (int turn = 0; turn < turns; ++turn) {
    a.multiply(x, product);
    std::array<typename Matrix::Sum, 2> local;
    double size = 0;
    for (std::size_t k = 0; k < a.rows(); ++k) {
      double& entry = a.entry(x, k);
      const double inverse = a.inverse_diagonal(k);
      local[0].add(entry * product[k]);
      if (inverse > 0) local[1].add(entry * entry / inverse);
      entry = inverse * product[k];
      size = std::max(size, std::abs(entry));
    }
    const std::array<double, 2> sums = a.sums(local);
    size = a.greatest(size);
    if (!(sums[1] > 0) || !(size > 0)) break;
    greatest = std::max(greatest, sums[0] / sums[1]);
    for (std::size_t k = 0; k < a.rows(); ++k) a.entry(x, k) /= size;
  }
  return greatest;
}

/// What to take for the greatest eigenvalue of D^-1 A; x is where the power iteration starts. A regular mesh has few
/// modes at the top of its spectrum, all below 2, which that may miss; a bad element has one of its own far above the
/// rest, which it finds. The polynomial bears a quarter more than the bound. No eigenvalue is above the greatest sum of
/// a row (Gershgorin).
template <typename Matrix>
double spectral_bound(const Matrix& a, std::span<double> x, std::span<double> product) {
  constexpr double margin = 1.1, regular = 2;
  const double power = power_iteration(a, x, product);
  double row = 0;
  for (std::size_t k = 0; k < a.rows(); ++k) row = std::max(row, a.inverse_diagonal(k) * a.row_size(k));
  row = a.greatest(row);
  return row > 0 ? std::min(row, std::max(margin * power, regular)) : 1.0;
}

/// Smooths x, whose residual is `rest`; from zero, if so said, whatever x is. `rest` is lost.
template <typename Matrix>
void smooth(const Chebyshev& c, const Matrix& a, bool from_zero, std::span<double> rest, std::span<double> change,
            std::span<double> product, std::span<double> x) {
  const double sigma = c.theta / c.delta, inverse_theta = 1 / c.theta;
  double rho = 1 / sigma;
  for (std::size_t k = 0; k < a.rows(); ++k) {
    const double step = inverse_theta * a.inverse_diagonal(k) * rest[k];
    a.entry(change, k) = step;
    a.entry(x, k) = from_zero ? step : a.entry(x, k) + step;
  }
  for (int turn = 1; turn < Chebyshev::degree; ++turn) {
    a.multiply(change, product);
    const double next = 1 / (2 * sigma - rho), keep = next * rho, take = 2 * next / c.delta;
    for (std::size_t k = 0; k < a.rows(); ++k) {
      rest[k] -= product[k];
      double& step = a.entry(change, k);
      step = keep * step + take * a.inverse_diagonal(k) * rest[k];
      a.entry(x, k) += step;
    }
    rho = next;
  }
}

}  // namespace tenon::thermal
