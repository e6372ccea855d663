// SPDX-License-Identifier: BSD-3-Clause
#include "transfer/local_linear_fit.hpp"

#include <algorithm>
#include <cmath>

namespace tenon::transfer {

namespace {

/// Symmetric: xx yy zz xy yz zx.
using Symmetric = std::array<double, 6>;
using Matrix = std::array<Vec3, 3>;

/// Directions in which the points extend less than the root of this, relative to the greatest, are taken for round-off;
/// between the two they fade in.
constexpr double nothing = 1e-12, something = 1e-10;
/// The same for eigenvalues in units of the squared radius, which rounding of the mean alone makes 1e-31.
constexpr double no_extent = 1e-26, some_extent = 1e-24;
/// det / (trace / 3)^3 above which a covariance is inverted directly.
constexpr double well_conditioned = 1e-4;
/// |C^-1/2 m| at the edge of evenly spaced points: 0.4 at a face, 0.7 at an edge, 1.0 at a corner, and 3 half a spacing
/// outside each (measured).
constexpr double at_the_edge = 1.5;
/// The root of the weighted mean square distance of evenly spaced points from their mean, times this, is about their
/// spacing.
constexpr double spacing_per_deviation = 1.5;

Vec3 multiply(const Symmetric& a, const Vec3& v) {
  return {a[0] * v[0] + a[3] * v[1] + a[5] * v[2], a[3] * v[0] + a[1] * v[1] + a[4] * v[2],
          a[5] * v[0] + a[4] * v[1] + a[2] * v[2]};
}

/// Eigenvalues and eigenvectors (columns of `vectors`, here rows of the array) by cyclic Jacobi rotations [GV13, 8.5].
void eigen(Symmetric a, Vec3& values, Matrix& vectors) {
  double m[3][3] = {{a[0], a[3], a[5]}, {a[3], a[1], a[4]}, {a[5], a[4], a[2]}};
  vectors = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  constexpr int sweeps = 12;  // convergence is quadratic: six are enough, and zeros cost nothing
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    bool done = true;
    for (int p = 0; p < 2; ++p)
      for (int q = p + 1; q < 3; ++q) {
        if (m[p][q] == 0 || std::abs(m[p][q]) < 1e-300) continue;
        done = false;
        const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
        const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::sqrt(theta * theta + 1));
        const double c = 1 / std::sqrt(t * t + 1), s = t * c;
        const double off = m[p][q];
        m[p][p] -= t * off, m[q][q] += t * off;
        m[p][q] = m[q][p] = 0;
        const int r = 3 - p - q;
        const double rp = m[r][p], rq = m[r][q];
        m[r][p] = m[p][r] = c * rp - s * rq;
        m[r][q] = m[q][r] = s * rp + c * rq;
        const Vec3 vp = vectors[static_cast<std::size_t>(p)], vq = vectors[static_cast<std::size_t>(q)];
        vectors[static_cast<std::size_t>(p)] = c * vp - s * vq;
        vectors[static_cast<std::size_t>(q)] = s * vp + c * vq;
      }
    if (done) break;
  }
  values = {m[0][0], m[1][1], m[2][2]};
}

/// The inverse where C is well conditioned, and whether it is.
bool invert(const Symmetric& c, Symmetric& inverse) {
  const double xx = c[1] * c[2] - c[4] * c[4], yy = c[0] * c[2] - c[5] * c[5], zz = c[0] * c[1] - c[3] * c[3];
  const double xy = c[4] * c[5] - c[3] * c[2], yz = c[3] * c[5] - c[0] * c[4], zx = c[3] * c[4] - c[1] * c[5];
  const double determinant = c[0] * xx + c[3] * xy + c[5] * zx;
  const double mean = (c[0] + c[1] + c[2]) / 3;
  if (!(mean > some_extent && determinant > well_conditioned * mean * mean * mean)) return false;
  const double r = 1 / determinant;
  inverse = {r * xx, r * yy, r * zz, r * xy, r * yz, r * zx};
  return true;
}

/// 0 to 1, smoothly, as the logarithm of x goes from that of `low` to that of `high`.
double fade_in(double x, double low, double high) {
  if (!(x > low)) return 0;
  if (x >= high) return 1;
  const double s = std::log(x / low) / std::log(high / low);
  return s * s * (3 - 2 * s);
}

/// The least nu >= 0 with sum (g_a l_a / (l_a + nu))^2 <= trust^2: the point of the ellipsoid |C^-1/2 y| <= trust that
/// is nearest to C^1/2 g, by Newton's method from the left on a convex, falling function.
double multiplier(const Vec3& g, const Vec3& l, double trust) {
  double nu = 0;
  for (int repeat = 0; repeat < 60; ++repeat) {
    double sum = 0, slope = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      if (!(l[a] > 0)) continue;
      const double damped = g[a] * l[a] / (l[a] + nu);
      sum += damped * damped;
      slope += damped * damped / (l[a] + nu);
    }
    // Newton's step for 1 / sqrt(sum), which is nearly linear in nu.
    const double root = std::sqrt(sum);
    if (!(root > trust * (1 + 1e-12))) break;
    nu += sum / slope * (root / trust - 1);
  }
  return nu;
}

/// C^-1 for the directions that are there, damped by the trust region about offset d; and whether it is all of C^-1.
bool damped_inverse(const Symmetric& c, const Vec3& d, double trust, Symmetric& inverse) {
  Vec3 l{};
  Matrix e{};
  eigen(c, l, e);
  const double greatest = std::max({l[0], l[1], l[2]});
  inverse = {};
  if (!(greatest > 0)) return false;
  Vec3 g{}, here{};
  for (std::size_t a = 0; a < 3; ++a) {
    here[a] = fade_in(l[a] / greatest, nothing, something) * fade_in(l[a], no_extent, some_extent);
    if (here[a] == 0) l[a] = 0;
    g[a] = l[a] > 0 ? dot(e[a], d) / std::sqrt(l[a]) : 0;
  }
  const double nu = dot(g, g) > trust * trust ? multiplier(g, l, trust) : 0;
  bool whole = nu == 0;
  for (std::size_t a = 0; a < 3; ++a) {
    whole = whole && here[a] == 1;
    if (!(l[a] > 0)) continue;
    const double f = here[a] / (l[a] + nu);
    const Vec3& v = e[a];
    inverse[0] += f * v[0] * v[0], inverse[1] += f * v[1] * v[1], inverse[2] += f * v[2] * v[2];
    inverse[3] += f * v[0] * v[1], inverse[4] += f * v[1] * v[2], inverse[5] += f * v[2] * v[0];
  }
  return whole;
}

/// Weights before the fit: Wendland's C2 function of the distance over the radius [Wen95].
void radial_weights(std::span<const double> squared, double radius, std::span<double> omega) {
  for (std::size_t i = 0; i < squared.size(); ++i) {
    const double q = std::sqrt(squared[i]) / radius, u = std::max(0.0, 1 - q);
    omega[i] = u * u * (u * u) * (4 * q + 1);
  }
}

/// Makes the sum 1 to an ulp (of the sum of the absolute weights). Little is added after the last weight of some size,
/// so that one can be chosen such that the sum rounds to 1 where the largest cannot.
void normalise(std::span<double> weights) {
  std::size_t largest = 0, last = 0;
  for (std::size_t i = 1; i < weights.size(); ++i) {
    if (std::abs(weights[i]) > std::abs(weights[largest])) largest = i;
    if (std::abs(weights[i]) > 1e-3) last = i;
  }
  for (int attempt = 0; attempt < 4; ++attempt) {
    double sum = 0;
    for (const double w : weights) sum += w;
    if (sum == 1) break;
    weights[attempt % 2 == 0 ? largest : last] += 1 - sum;
  }
}

/// The neighbours about their weighted mean, in units of the radius.
struct Stencil {
  std::array<Vec3, max_neighbours> y;
  Vec3 mean{};             ///< relative to t
  Symmetric covariance{};  ///< of y
};

/// Makes the sum of `omega` 1.
void take_stencil(std::span<const Vec3> neighbours, double radius, std::span<double> omega, Stencil& stencil) {
  const double scale = 1 / radius;
  double total = 0;
  Vec3 mean{};
  for (std::size_t i = 0; i < neighbours.size(); ++i)
    total += omega[i], mean = mean + (omega[i] * scale) * neighbours[i];
  stencil.mean = mean = (1 / total) * mean;
  Symmetric c{};
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    omega[i] /= total;
    const Vec3 y = scale * neighbours[i] - mean, wy = omega[i] * y;
    c[0] += wy[0] * y[0], c[1] += wy[1] * y[1], c[2] += wy[2] * y[2];
    c[3] += wy[0] * y[1], c[4] += wy[1] * y[2], c[5] += wy[2] * y[0];
    stencil.y[i] = y;
  }
  stencil.covariance = c;
}

/// b of the weights omega (1 + b . y), -C^-1 m as far as points and trust allow.
Vec3 fitted_slope(const Stencil& stencil, std::span<const double> omega, double trust, FitOutcome& outcome) {
  const Vec3& mean = stencil.mean;
  Symmetric inverse{};
  outcome.exact = invert(stencil.covariance, inverse);
  Vec3 slope = multiply(inverse, -1.0 * mean);
  if (!outcome.exact || -dot(slope, mean) > trust * trust) {
    outcome.exact = damped_inverse(stencil.covariance, -1.0 * mean, trust, inverse);
    slope = multiply(inverse, -1.0 * mean);
  }
  outcome.deficient = !outcome.exact;
  outcome.among = outcome.exact && -dot(slope, mean) < at_the_edge * at_the_edge;
  if (!outcome.exact) return slope;
  Vec3 left = mean;  // once more for what rounding left
  for (std::size_t i = 0; i < omega.size(); ++i) left = left + (omega[i] * dot(slope, stencil.y[i])) * stencil.y[i];
  return slope - multiply(inverse, left);
}

}  // namespace

FitOutcome linear_fit(std::span<const Vec3> neighbours, bool all, const FitRules& rules, std::span<double> weights) {
  const std::size_t n = neighbours.size();
  std::array<double, max_neighbours> squared;
  double nearest = dot(neighbours[0], neighbours[0]), farthest = 0;
  for (std::size_t i = 0; i < n; ++i) {
    squared[i] = dot(neighbours[i], neighbours[i]);
    nearest = std::min(nearest, squared[i]), farthest = std::max(farthest, squared[i]);
  }
  FitOutcome outcome;
  outcome.distance = std::sqrt(nearest);
  const double radius = std::sqrt(farthest);
  const std::span<double> omega = weights.first(n);
  if (!(radius > 0)) {  // all coincide with t
    std::fill(omega.begin(), omega.end(), 1.0 / static_cast<double>(n));
    normalise(omega);
    outcome.deficient = true;
    return outcome;
  }
  // Few points all count; of many, the farthest just begins to.
  if (farthest > nearest * (1 + 1e-10))
    radial_weights(std::span(squared).first(n), all ? 1.5 * radius : radius, omega);
  else
    std::fill(omega.begin(), omega.end(), 1.0);

  Stencil stencil;
  take_stencil(neighbours, radius, omega, stencil);
  const double variance = stencil.covariance[0] + stencil.covariance[1] + stencil.covariance[2];
  outcome.spacing = spacing_per_deviation * radius * std::sqrt(variance);
  Vec3 slope = fitted_slope(stencil, omega, rules.trust, outcome);
  double least = 0;
  for (std::size_t i = 0; i < n; ++i)
    if (omega[i] > 0) least = std::min(least, dot(slope, stencil.y[i]));
  if (rules.non_negative && least < -1) {
    slope = (-1 / least) * slope;
    outcome.exact = false;
  }
  for (std::size_t i = 0; i < n; ++i) {
    weights[i] = omega[i] * (1 + dot(slope, stencil.y[i]));
    if (rules.non_negative) weights[i] = std::max(0.0, weights[i]);
  }
  normalise(omega);
  return outcome;
}

}  // namespace tenon::transfer
