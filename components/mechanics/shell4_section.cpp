// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/shell4_section.hpp"

#include <cmath>
#include <numbers>

namespace tenon {

namespace {

/// Legendre polynomial of degree n and its derivative at z, |z| < 1.
struct Legendre {
  double value, slope;
};
Legendre legendre(int n, double z) {
  double before = 1, now = n == 0 ? 1 : z;
  for (int k = 2; k <= n; ++k) {
    const double next = ((2 * k - 1) * z * now - (k - 1) * before) / k;
    before = now, now = next;
  }
  return {now, n == 0 ? 0 : n * (before - z * now) / (1 - z * z)};
}

/// Newton's iteration to round-off; the starting points are close enough for all n in use.
template <typename Correction>
double root(double z, Correction correction) {
  for (int i = 0; i < 50; ++i) z -= correction(z);
  return z;
}

}  // namespace

double ThroughThickness::second_moment() const {
  double sum = 0;
  for (std::size_t i = 0; i < place.size(); ++i) sum += 0.25 * weight[i] * place[i] * place[i];
  return sum;
}

ThroughThickness through_thickness(ShellSection::Rule rule, int n) {
  ThroughThickness result{std::vector<double>(static_cast<std::size_t>(n)),
                          std::vector<double>(static_cast<std::size_t>(n))};
  const bool lobatto = rule == ShellSection::Rule::lobatto;
  for (int i = 0; i < n; ++i) {
    double z = 0, weight = 1;
    if (lobatto && (i == 0 || i == n - 1)) {
      z = i == 0 ? -1 : 1, weight = 1.0 / (n * (n - 1));
    } else if (lobatto) {  // P'(n-1) = 0, with (1 - z^2) P'' = 2 z P' - n (n-1) P
      z = root(-std::cos(std::numbers::pi * i / (n - 1)), [n](double at) {
        const Legendre p = legendre(n - 1, at);
        return p.slope * (1 - at * at) / (2 * at * p.slope - n * (n - 1) * p.value);
      });
      const double p = legendre(n - 1, z).value;
      weight = 1 / (n * (n - 1) * p * p);
    } else if (n > 1) {
      z = root(-std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), [n](double at) {
        const Legendre p = legendre(n, at);
        return p.value / p.slope;
      });
      const double slope = legendre(n, z).slope;
      weight = 1 / ((1 - z * z) * slope * slope);
    }
    if (2 * i + 1 == n) z = 0;
    result.place[static_cast<std::size_t>(i)] = z, result.weight[static_cast<std::size_t>(i)] = weight;
  }
  // Mirror images to the last bit, and weights of sum 1.
  double sum = 0;
  for (std::size_t i = 0, k = result.place.size() - 1; i < k; ++i, --k)
    result.place[k] = -result.place[i], result.weight[k] = result.weight[i];
  for (const double w : result.weight) sum += w;
  for (double& w : result.weight) w /= sum;
  return result;
}

}  // namespace tenon
