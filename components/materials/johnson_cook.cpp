// SPDX-License-Identifier: BSD-3-Clause
#include "components/materials/johnson_cook.hpp"

#include <algorithm>
#include <cmath>

#include "components/materials/trial_stress.hpp"

namespace tenon {
namespace {

/// 1 - T*^m; 1 up to the reference temperature, 0 from melting on.
double thermal_factor(const JohnsonCookParameters& flow, double temperature) {
  const double t = (temperature - flow.reference_temperature) / (flow.melting_temperature - flow.reference_temperature);
  if (!(t > 0)) return 1;
  if (t >= 1) return 0;
  return flow.m == 1 ? 1 - t : 1 - std::pow(t, flow.m);
}

/// Flow stress and its slope over the increment d of plastic strain, at fixed temperature.
struct FlowStress {
  double hardening;    ///< (A + B eqps^n) thermal factor, Pa
  double rate_factor;  ///< 1 + C ln max(1, rate / rate0)
  double slope;        ///< d(value)/dd, Pa; may be infinite at eqps = 0
  double value() const { return hardening * rate_factor; }
};

struct Point {
  const JohnsonCookParameters& flow;
  double eqps, thermal, dt;

  FlowStress at(double d) const {
    const double e = eqps + d;
    const double power = flow.B * std::pow(e, flow.n);
    const double hardening = (flow.A + power) * thermal;
    const double ratio = d / (dt * flow.reference_strain_rate);
    const bool fast = ratio > 1;
    const double rate_factor = fast ? 1 + flow.C * std::log(ratio) : 1;
    const double slope = flow.n * power / e * thermal * rate_factor + (fast ? hardening * flow.C / d : 0);
    return {hardening, rate_factor, slope};
  }
};

struct Solution {
  double increment;    ///< of eqps
  double flow_stress;  ///< Pa, at the end of the step
  double mean_stress;  ///< Pa, mean over the plastic strain of the step
};

/// A point between the bounds when Newton leaves them: downwards from the upper bound at first, then the geometric
/// mean, which reaches the smallest numbers (n near 0) in a few halvings of the exponent.
double within(double low, double high, int iteration) {
  constexpr int downward = 8;
  constexpr double least = 1e-290;
  if (low == 0 && iteration < downward) return high / 64;
  return std::sqrt(std::max(low, least * high)) * std::sqrt(high);
}

/// Root of g(d) = q - 3 G d - flow_stress(d), which falls steadily from g(0) > 0 to g(q / 3G) <= 0. g is convex but for
/// the kink of the rate term, so Newton converges from the left without overshoot; the bracket serves the rest, such as
/// the infinite slope of virgin material with n < 1.
Solution solve(const Point& point, double q, double three_g, double guess, double start_hardening) {
  constexpr int newton_budget = 40, budget = 120;
  double low = 0, high = q / three_g;
  double d = guess > low && guess < high ? guess : 0.5 * high;
  FlowStress f = point.at(d);
  double value = f.value();
  for (int i = 0; i < budget; ++i) {
    const double g = q - three_g * d - value;
    (g > 0 ? low : high) = d;
    const double step = g / (three_g + f.slope);
    if (std::abs(step) <= 3e-8 * d && std::isfinite(f.slope)) {
      d += step;  // the error of this last step is of second order: 1e-15
      value += f.slope * step;
      break;
    }
    if (!(high - low > 4e-16 * high)) break;
    const double newton = d + step;
    d = newton > low && newton < high && i < newton_budget ? newton : within(low, high, i);
    f = point.at(d);
    value = f.value();
  }
  const double end_hardening = value / f.rate_factor;
  return {d, value, 0.5 * (start_hardening + end_hardening) * f.rate_factor};
}

}  // namespace

void JohnsonCook::update(const UpdateInput& input, Batch<6>& stress, Batch<2>& state, Batch<1>& plastic_work) const {
  elastic_trial(elasticity, input, stress);
  Batch<1> q, scale;
  von_mises(stress, q);

  const double three_g = 3 * elasticity.shear_modulus();
  for (int l = 0; l < lanes; ++l) {
    scale.v[0][l] = 1;
    plastic_work.v[0][l] = 0;
    const double rate = state.v[1][l];
    state.v[1][l] = 0;
    const double trial = q.v[0][l];
    if (!(trial > 0)) continue;
    const double thermal = thermal_factor(flow, input.temperature.v[0][l]);
    if (trial <= flow.A * thermal) continue;
    if (thermal == 0) {  // molten: all of the deviator flows, at no work
      scale.v[0][l] = 0;
      state.v[0][l] += trial / three_g;
      state.v[1][l] = trial / three_g / input.dt;
      continue;
    }
    const double eqps = state.v[0][l];
    const double start_hardening = (flow.A + flow.B * std::pow(eqps, flow.n)) * thermal;
    if (trial <= start_hardening) continue;
    const Solution s = solve({flow, eqps, thermal, input.dt}, trial, three_g, rate * input.dt, start_hardening);
    scale.v[0][l] = s.flow_stress / trial;
    state.v[0][l] = eqps + s.increment;
    state.v[1][l] = s.increment / input.dt;
    plastic_work.v[0][l] = s.mean_stress * s.increment;
  }
  scale_deviator(scale, stress);
}

}  // namespace tenon
