// SPDX-License-Identifier: BSD-3-Clause
// Linear hardening J2 under plane stress: the return projected onto the plane, [ST86], [SH98] ch. 3.4.
#include <cmath>

#include "components/materials/j2_linear_hardening.hpp"
#include "components/materials/lane_root.hpp"
#include "components/materials/plane_stress_elastic.hpp"

namespace tenon {
namespace {

/// With sum = xx + yy, difference = xx - yy: q^2 = sum^2/4 + 3/4 difference^2 + 3 (xy^2 + yz^2 + zx^2). If the plastic
/// strain of the step is m times the deviator of its end, the return divides the sum by u = 1 + A m and everything else
/// by v = 1 + 2 G m, A = E / (3 (1 - nu)), and eqps grows by 2/3 m q. With x = A m and w = 1 - h x what is left is
///   f(x) = s0 / q(x) - w = 0,   q(x) = sqrt(a / u^2 + b / v^2) = n / (u v),   u = 1 + x,   v = 1 + r x,
/// which is concave and almost straight (straight if a or b is 0):
///   (1/q)' = (a v^3 + r b u^3) / n^3,   (1/q)'' = -3 a b (r - 1)^2 u v / n^5,   n^2 = a v^2 + b u^2.
/// One Halley step from x = 0 leaves next to nothing; Newton steps finish. Multiplied out, each is one division.
/// Stresses are relative to the initial yield stress.
struct Return {
  double r, h;                   ///< 2 G / A, 2/3 H / A
  alignas(64) double a[lanes];   ///< sum^2 / 4 of the trial stress
  alignas(64) double b[lanes];   ///< the rest of its q^2
  alignas(64) double s0[lanes];  ///< flow stress at the start of the step
  alignas(64) double x[lanes];
};

/// Halley's step from x = 0, no longer than two of Newton's. Elastic points stay at 0 and are not `open` afterwards.
[[gnu::always_inline]] inline void first_step(Return& p, double (&open)[lanes]) {
  const double bend = 1.5 * (p.r - 1) * (p.r - 1);
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    const double a = p.a[l], b = p.b[l], s0 = p.s0[l], n2 = a + b, n = std::sqrt(n2);
    const double excess = n - s0, slope = s0 * (a + p.r * b) + p.h * (n2 * n);
    const double newton = slope * slope, halley = newton - bend * s0 * (a * b) * excess;
    const double divisor = halley > 0.5 * newton ? halley : 0.5 * newton;
    const double step = excess * n2 * slope / divisor;
    p.x[l] = excess > 0 ? step : 0.0;
    open[l] = excess > 0 ? 1.0 : 0.0;
  }
}

/// Newton's step. Closes the lanes whose step is too small for another to matter: what is left is of the order of its
/// square. f is concave, so that a step never ends to the right of the root, wherever it starts.
[[gnu::always_inline]] inline void next_step(Return& p, double (&open)[lanes]) {
  constexpr double last_step = 1e-7;
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    const double x = p.x[l], s0 = p.s0[l], u = 1 + x, v = 1 + p.r * x;
    const double av2 = p.a[l] * (v * v), bu2 = p.b[l] * (u * u), n2 = av2 + bu2, n3 = n2 * std::sqrt(n2);
    const double residual = (1 - p.h * x) * n3 - s0 * (u * v) * n2;
    const double slope = s0 * (av2 * v + p.r * (bu2 * u)) + p.h * n3;
    const double next = x + (open[l] > 0 ? residual / slope : 0.0);
    open[l] = std::abs(next - x) > last_step * u ? 1.0 : 0.0;
    p.x[l] = next > 0 ? next : 0.0;
  }
}

}  // namespace

void J2LinearHardening::update_plane_stress(const UpdateInput& input, Batch<6>& stress, Batch<1>& state,
                                            Batch<1>& plastic_work, Batch<1>& thickness_increment) const {
  constexpr int budget = 60;
  elastic_trial_plane_stress(elasticity, input, stress, thickness_increment);
  const double A = elasticity.youngs_modulus / (3 * (1 - elasticity.poissons_ratio));
  const double unit = 1 / yield_stress, slope = hardening_modulus * unit;
  auto& s = stress.v;
  Return p;
  p.r = 2 * elasticity.shear_modulus() / A, p.h = 2 * hardening_modulus / (3 * A);
  alignas(64) double yields[lanes], open[lanes];
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    const double xx = s[0][l] * unit, yy = s[1][l] * unit, xy = s[3][l] * unit, yz = s[4][l] * unit,
                 zx = s[5][l] * unit;
    const double sum = xx + yy, difference = xx - yy;
    p.a[l] = 0.25 * (sum * sum);
    p.b[l] = 0.75 * (difference * difference) + 3 * (xy * xy + yz * yz + zx * zx);
    p.s0[l] = 1 + slope * state.v[0][l];
    yields[l] = p.a[l] + p.b[l] > p.s0[l] * p.s0[l] ? 1.0 : 0.0;
    plastic_work.v[0][l] = 0;
  }
  if (!any_lane(yields)) return;
  first_step(p, open);
  for (int i = 0; i < budget && any_lane(open); ++i) next_step(p, open);

  const double per_A = 1 / A, plastic = (1 - elasticity.lame_lambda() / elasticity.p_wave_modulus()) / 3;
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    const double x = p.x[l], u = 1 + x, v = 1 + p.r * x, w = 1 - p.h * x;
    const double inverse = 1 / (u * v * w);
    const double of_sum = v * w * inverse, of_rest = u * w * inverse;
    const double half_sum = 0.5 * (of_sum + of_rest), half_difference = 0.5 * (of_sum - of_rest);
    const double xx = s[0][l], yy = s[1][l], multiplier = x * per_A;
    const bool flows = x > 0;
    s[0][l] = flows ? half_sum * xx + half_difference * yy : xx;
    s[1][l] = flows ? half_sum * yy + half_difference * xx : yy;
    s[3][l] = flows ? of_rest * s[3][l] : s[3][l];
    s[4][l] = flows ? of_rest * s[4][l] : s[4][l];
    s[5][l] = flows ? of_rest * s[5][l] : s[5][l];
    const double before = p.s0[l] * yield_stress, after = before * (u * v * inverse);
    const double increment = 2.0 / 3.0 * multiplier * after;
    state.v[0][l] += increment;
    plastic_work.v[0][l] = 0.5 * (before + after) * increment;
    // What flows in the plane does not contract elastically.
    thickness_increment.v[0][l] -= plastic * multiplier * (of_sum * (xx + yy));
  }
}

}  // namespace tenon
