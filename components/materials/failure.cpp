// SPDX-License-Identifier: BSD-3-Clause
#include "components/materials/failure.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tenon {

namespace {

/// Greatest eigenvalue of a symmetric tensor, by the trigonometric solution of its characteristic polynomial.
double greatest_principal(const Batch<6>& s, int l) {
  const double p = (s[0][l] + s[1][l] + s[2][l]) / 3;
  const double x = s[0][l] - p, y = s[1][l] - p, z = s[2][l] - p, xy = s[3][l], yz = s[4][l], zx = s[5][l];
  const double j2 = 0.5 * (x * x + y * y + z * z) + xy * xy + yz * yz + zx * zx;
  if (!(j2 > 0)) return p;
  const double j3 = x * (y * z - yz * yz) - xy * (xy * z - yz * zx) + zx * (xy * yz - y * zx);
  const double radius = 2 * std::sqrt(j2 / 3);
  const double cosine = std::clamp(4 * j3 / (radius * radius * radius), -1.0, 1.0);
  return p + radius * std::cos(std::acos(cosine) / 3);
}

}  // namespace

void FailureCriterion::accumulate(const FailureInput& input, Batch<1>& damage) const {
  for (int l = 0; l < lanes; ++l) {
    double d = damage[0][l];
    if (plastic_strain) d = std::max(d, input.eqps[0][l] / *plastic_strain);
    if (tensile_stress) d = std::max(d, greatest_principal(input.stress, l) >= *tensile_stress ? 1.0 : 0.0);
    damage[0][l] = d;
  }
}

}  // namespace tenon
