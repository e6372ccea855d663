// SPDX-License-Identifier: BSD-3-Clause
#include "components/materials/johnson_cook.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "components/materials/lane_math.hpp"
#include "components/materials/trial_stress.hpp"

namespace tenon {
namespace {

constexpr double tiny = 1e-290;  // still normal after division by anything that occurs here

/// x^y for x >= 0, y > 0.
[[gnu::always_inline]] inline double power(double x, double y) {
  const double value = exp_of(y * log_of(x > tiny ? x : tiny));
  return x > tiny ? value : 0.0;
}

/// A truth per lane is 0 or 1 in a double, so that g++ can vectorise what follows from it.
using Flags = double[lanes];

bool any(const Flags& flags) {
  double sum = 0;
  for (int l = 0; l < lanes; ++l) sum += flags[l];
  return sum > 0;
}

/// 1 - T*^m: 1 up to the reference temperature, 0 from melting on.
void thermal_factors(const JohnsonCookParameters& flow, const double (&temperature)[lanes], double (&thermal)[lanes]) {
  const double range = flow.melting_temperature - flow.reference_temperature;
  double t[lanes];
  for (int l = 0; l < lanes; ++l) {
    const double relative = (temperature[l] - flow.reference_temperature) / range;
    t[l] = relative > 0 ? (relative < 1 ? relative : 1.0) : 0.0;
    thermal[l] = 1;
  }
  if (!any(t)) return;
  for (int l = 0; l < lanes; ++l) {
    const double softening = power(t[l], flow.m);
    thermal[l] = t[l] < 1 ? 1 - softening : 0.0;
  }
}

/// Radial return of eight points: what is given, and the search for the increment d of plastic strain.
struct Return {
  double trial[lanes];    ///< von Mises trial stress, Pa
  double thermal[lanes];  ///< thermal factor
  double eqps[lanes];     ///< plastic strain at the start
  double d[lanes];        ///< increment: first a guess, then the solution
  double flow_stress[lanes] = {};
  Flags searching;
};

/// Flow stress and its slope over d, at fixed temperature; the slope may be infinite for d near 0.
void evaluate(const JohnsonCookParameters& flow, double dt, const Return& r, double (&value)[lanes],
              double (&slope)[lanes]) {
  const double inverse_rate = 1 / (dt * flow.reference_strain_rate);
  const double A = flow.A, B = flow.B, n = flow.n, C = flow.C;
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    const double x = r.d[l], e = r.eqps[l] + x, thermal = r.thermal[l];
    const double hardening_power = B * power(e, n);
    const double hardening = (A + hardening_power) * thermal;
    const double ratio = x * inverse_rate;
    const double rate_factor = 1 + C * log_of(ratio > 1 ? ratio : 1.0);
    const double rate_slope = hardening * (ratio > 1 ? C : 0.0) / x;
    value[l] = hardening * rate_factor;
    slope[l] = n * hardening_power / e * thermal * rate_factor + rate_slope;
  }
}

/// A place between the bounds, for when Newton leaves them: downwards by a factor at first, then the geometric mean.
void between(int iteration, const double (&low)[lanes], const double (&high)[lanes], double (&place)[lanes]) {
  constexpr int downward = 8;
  double least[lanes];
  for (int l = 0; l < lanes; ++l) least[l] = std::max(low[l], tiny * high[l]);
  for (int l = 0; l < lanes; ++l) place[l] = std::sqrt(least[l]) * std::sqrt(high[l]);
  if (iteration >= downward) return;
  for (int l = 0; l < lanes; ++l) place[l] = low[l] == 0 ? high[l] / 64 : place[l];
}

/// Bounds of the root in each lane.
struct Bracket {
  double low[lanes] = {};
  double high[lanes];
};

/// One safeguarded Newton step of the lanes that search.
void iterate(const JohnsonCookParameters& flow, double three_g, double dt, int iteration, Return& r, Bracket& bracket) {
  constexpr int newton_budget = 40;
  const double newton_allowed = iteration < newton_budget ? 1 : 0;
  double value[lanes], slope[lanes], step[lanes], next[lanes], close[lanes], leaves[lanes];
  evaluate(flow, dt, r, value, slope);
  double g[lanes];
  for (int l = 0; l < lanes; ++l) {
    g[l] = r.trial[l] - three_g * r.d[l] - value[l];
    step[l] = g[l] / (three_g + slope[l]);
    next[l] = r.d[l] + step[l];
  }
  for (int l = 0; l < lanes; ++l) {
    const double x = r.d[l], go = r.searching[l], low = bracket.low[l], high = bracket.high[l];
    bracket.low[l] = go * g[l] > 0 ? x : low;
    bracket.high[l] = go * (g[l] > 0 ? 0.0 : 1.0) > 0 ? x : high;
  }
  for (int l = 0; l < lanes; ++l) {
    const double known = slope[l] < std::numeric_limits<double>::max() ? 1.0 : 0.0;
    close[l] = std::abs(step[l]) <= 3e-8 * r.d[l] ? known : 0.0;
    const double above = next[l] > bracket.low[l] ? newton_allowed : 0.0;
    const double inside = next[l] < bracket.high[l] ? above : 0.0;
    leaves[l] = r.searching[l] * (1 - close[l]) * (1 - inside);
  }
  for (int l = 0; l < lanes; ++l) {
    // The last step is linear in what is left: its error is of second order, 1e-15.
    const double rest = slope[l] * step[l], before = r.flow_stress[l];
    const double end = close[l] > 0 ? value[l] + rest : value[l];
    r.flow_stress[l] = r.searching[l] > 0 ? end : before;
  }
  if (any(leaves)) {
    double place[lanes];
    between(iteration, bracket.low, bracket.high, place);
    for (int l = 0; l < lanes; ++l) next[l] = leaves[l] > 0 ? place[l] : next[l];
  }
  for (int l = 0; l < lanes; ++l) {
    const double x = r.d[l], width = bracket.high[l] - bracket.low[l];
    const double open = width > 4e-16 * bracket.high[l] ? r.searching[l] : 0.0;
    r.d[l] = open > 0 ? next[l] : x;
    r.searching[l] = open * (1 - close[l]);
  }
}

/// Root of g(d) = q - 3 G d - flow_stress(d), which falls steadily from g(0) > 0 to g(q / 3G) <= 0. g is convex but for
/// the kink of the rate term, so Newton converges from the left without overshoot; the bracket serves the rest, such as
/// the infinite slope of virgin material with n < 1: there the start is sought downwards, at first by a factor, then by
/// the geometric mean, which reaches the smallest numbers in a few halvings of the exponent. Lanes that are done stand
/// still.
void solve(const JohnsonCookParameters& flow, double three_g, double dt, Return& r) {
  constexpr int budget = 120;
  Bracket bracket;
  for (int l = 0; l < lanes; ++l) bracket.high[l] = r.trial[l] / three_g;
  for (int i = 0; i < budget && any(r.searching); ++i) iterate(flow, three_g, dt, i, r, bracket);
}

}  // namespace

void JohnsonCook::update(const UpdateInput& input, Batch<6>& stress, Batch<2>& state, Batch<1>& plastic_work) const {
  elastic_trial(elasticity, input, stress);
  const double three_g = 3 * elasticity.shear_modulus(), dt = input.dt;
  Batch<1> trial, scale;
  von_mises(stress, trial);
  Return r;
  thermal_factors(flow, input.temperature.v[0], r.thermal);

  Flags may_yield, yields, molten;
  for (int l = 0; l < lanes; ++l) may_yield[l] = trial.v[0][l] > flow.A * r.thermal[l] ? 1.0 : 0.0;
  if (!any(may_yield)) {
    for (int l = 0; l < lanes; ++l) state.v[1][l] = plastic_work.v[0][l] = 0;
    return;
  }
  double start_hardening[lanes];
  for (int l = 0; l < lanes; ++l) {
    const double eqps = state.v[0][l], q = trial.v[0][l];
    start_hardening[l] = (flow.A + flow.B * power(eqps, flow.n)) * r.thermal[l];
    molten[l] = r.thermal[l] == 0 ? may_yield[l] : 0.0;
    yields[l] = q > start_hardening[l] ? 1 - molten[l] : 0.0;
    r.trial[l] = q, r.eqps[l] = eqps, r.searching[l] = yields[l];
    // First guess: the strain rate goes on as in the last step.
    const double guess = state.v[1][l] * dt, high = q / three_g;
    r.d[l] = (guess > 0) & (guess < high) ? guess : 0.5 * high;
  }
  solve(flow, three_g, dt, r);

  const double inverse_rate = 1 / (dt * flow.reference_strain_rate);
  for (int l = 0; l < lanes; ++l) {
    const double q = r.trial[l], end = r.flow_stress[l];
    // Molten: all of the deviator flows, at no work.
    const double increment = yields[l] > 0 ? r.d[l] : molten[l] * (q / three_g);
    const double ratio = increment * inverse_rate;
    const double rate_factor = 1 + flow.C * log_of(ratio > 1 ? ratio : 1.0);
    const double mean = 0.5 * (start_hardening[l] * rate_factor + end);
    const double shrunk = end / q;
    scale.v[0][l] = yields[l] > 0 ? shrunk : 1 - molten[l];
    state.v[0][l] += increment;
    state.v[1][l] = increment / dt;
    plastic_work.v[0][l] = yields[l] * mean * increment;
  }
  scale_deviator(scale, stress);
}

}  // namespace tenon
