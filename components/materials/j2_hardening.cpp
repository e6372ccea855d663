// SPDX-License-Identifier: BSD-3-Clause
#include "components/materials/j2_hardening.hpp"

#include "components/materials/trial_stress.hpp"

namespace tenon {
namespace {

/// The return with rate hardening, solved for u = (d / (D dt))^(1/p), in which the equation is nearly straight both for
/// small u (the rate term) and for large: q - 3 G d(u) - sigma_y(eqps + d(u)) (1 + u) = 0.
template <typename Curve>
void find_rate_term(const Curve& curve, const CowperSymonds& rate, double three_g, double dt, const LaneValues& trial,
                    const LaneValues& eqps, const LaneValues& yields, LaneValues& u) {
  const double scale = dt * rate.D, p = rate.p;
  LaneValues stress, slope, searching, low, high;
  curve.evaluate(eqps, stress, slope);
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    // The root is below both guesses if the curve does not soften, and always below `high`.
    const double by_rate = trial[l] / stress[l] - 1, excess = trial[l] - stress[l];
    const double by_flow = power_of((excess > 0 ? excess : 0.0) / (three_g * scale), 1 / p);
    const double guess = by_flow > 0 && by_flow < by_rate ? by_flow : by_rate;
    searching[l] = yields[l];
    low[l] = 0;
    high[l] = 2 * power_of(trial[l] / (three_g * scale), 1 / p) + 1e-280;
    u[l] = yields[l] > 0 ? guess : 0.0;
  }
  falling_root(
      [&](const LaneValues& at, LaneValues& value, LaneValues& fall) {
        LaneValues d, e;
#pragma GCC ivdep
        for (int l = 0; l < lanes; ++l) d[l] = scale * power_of(at[l], p), e[l] = eqps[l] + d[l];
        curve.evaluate(e, value, fall);
#pragma GCC ivdep
        for (int l = 0; l < lanes; ++l) {
          const double flow = value[l];
          value[l] = trial[l] - three_g * d[l] - flow * (1 + at[l]);
          fall[l] = -flow - (three_g + fall[l] * (1 + at[l])) * p * d[l] / at[l];
        }
      },
      searching, low, high, u);
}

}  // namespace

template <typename Curve>
void J2Hardening<Curve>::update(const UpdateInput& input, Batch<6>& stress, Batch<1>& state,
                                Batch<1>& plastic_work) const {
  elastic_trial(elasticity, input, stress);
  Batch<1> trial, scale;
  von_mises(stress, trial);
  const LaneValues &q = trial.v[0], &eqps = state.v[0];
  LaneValues before, slope, yields;
  curve.evaluate(eqps, before, slope);
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    yields[l] = q[l] > before[l] ? 1.0 : 0.0;
    plastic_work.v[0][l] = 0;
  }
  if (!any_lane(yields)) return;

  const double three_g = 3 * elasticity.shear_modulus();
  LaneValues increment, rate_term{}, end, after;
  if (rate.active()) {
    find_rate_term(curve, rate, three_g, input.dt, q, eqps, yields, rate_term);
#pragma GCC ivdep
    for (int l = 0; l < lanes; ++l)
      increment[l] = yields[l] > 0 ? input.dt * rate.D * power_of(rate_term[l], rate.p) : 0.0;
  } else {
    curve.find_increment(three_g, q, eqps, yields, increment);
  }
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) end[l] = eqps[l] + increment[l];
  curve.evaluate(end, after, slope);
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    const double factor = 1 + rate_term[l], shrunk = factor * after[l] / q[l];
    scale.v[0][l] = yields[l] > 0 ? shrunk : 1.0;
    plastic_work.v[0][l] = 0.5 * factor * (before[l] + after[l]) * increment[l];
    state.v[0][l] = end[l];
  }
  scale_deviator(scale, stress);
}

template struct J2Hardening<LinearFlow>;
template struct J2Hardening<VoceFlow>;
template struct J2Hardening<TableFlow>;

}  // namespace tenon
