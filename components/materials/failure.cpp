// SPDX-License-Identifier: BSD-3-Clause
#include "components/materials/failure.hpp"

#include <algorithm>
#include <cmath>

#include "components/materials/lane_math.hpp"

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

double mean_stress(const Batch<6>& s, int l) {
  return (s[0][l] + s[1][l] + s[2][l]) / 3;
}

double von_mises_stress(const Batch<6>& s, int l) {
  const double xy = s[0][l] - s[1][l], yz = s[1][l] - s[2][l], zx = s[2][l] - s[0][l];
  const double shear = s[3][l] * s[3][l] + s[4][l] * s[4][l] + s[5][l] * s[5][l];
  return std::sqrt(0.5 * (xy * xy + yz * yz + zx * zx) + 3 * shear);
}

/// Plastic strain at fracture under the present stress, rate and temperature.
double fracture_strain(const JohnsonCookDamage& d, const FailureInput& input, double increment, int l) {
  const double q = von_mises_stress(input.stress, l), mean = mean_stress(input.stress, l);
  const double triaxiality = mean / std::max(q, 1e-12 * std::abs(mean) + 1e-300);
  const double rate = increment / input.dt / d.reference_strain_rate;
  const double range = d.melting_temperature - d.reference_temperature;
  const double hot = std::clamp((input.temperature[0][l] - d.reference_temperature) / range, 0.0, 1.0);
  const double strain =
      (d.D1 + d.D2 * exp_of(d.D3 * triaxiality)) * (1 + d.D4 * log_of(std::max(rate, 1.0))) * (1 + d.D5 * hot);
  return std::max(strain, JohnsonCookDamage::least);
}

}  // namespace

void FailureCriterion::accumulate(const FailureInput& input, Batch<1>& damage) const {
  for (int l = 0; l < lanes; ++l) {
    double d = damage[0][l];
    const double increment = input.eqps[0][l] - input.eqps_before[0][l];
    if (johnson_cook && increment > 0) {
      const double limit = fracture_strain(*johnson_cook, input, increment, l);
      d += increment / (plastic_strain ? std::min(limit, *plastic_strain) : limit);
    }
    // Not summed up, so that failure comes at the very step at which the limit is reached.
    if (plastic_strain) d = std::max(d, input.eqps[0][l] / *plastic_strain);
    if (tensile_stress) d = std::max(d, greatest_principal(input.stress, l) >= *tensile_stress ? 1.0 : 0.0);
    if (spall_pressure) d = std::max(d, mean_stress(input.stress, l) >= *spall_pressure ? 1.0 : 0.0);
    damage[0][l] = d;
  }
}

}  // namespace tenon
