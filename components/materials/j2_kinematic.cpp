// SPDX-License-Identifier: BSD-3-Clause
#include "components/materials/j2_kinematic.hpp"

#include <cmath>

#include "components/materials/lane_root.hpp"
#include "components/materials/trial_stress.hpp"

namespace tenon {
namespace {

/// 3/2 of the products of the trial deviator and the back stress, Pa^2: q(theta)^2 = ss - 2 theta sa + theta^2 aa is
/// the trial stress about the back stress shrunk by theta.
struct Products {
  LaneValues ss, sa, aa;
};

Products products(const Batch<6>& stress, const Batch<7>& state) {
  Products p;
  const auto& s = stress.v;
  const auto& a = state.v;
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    const double mean = (s[0][l] + s[1][l] + s[2][l]) / 3;
    const double x = s[0][l] - mean, y = s[1][l] - mean, z = s[2][l] - mean;
    const double shear_ss = s[3][l] * s[3][l] + s[4][l] * s[4][l] + s[5][l] * s[5][l];
    const double shear_sa = s[3][l] * a[4][l] + s[4][l] * a[5][l] + s[5][l] * a[6][l];
    const double shear_aa = a[4][l] * a[4][l] + a[5][l] * a[5][l] + a[6][l] * a[6][l];
    p.ss[l] = 1.5 * (x * x + y * y + z * z + 2 * shear_ss);
    p.sa[l] = 1.5 * (x * a[1][l] + y * a[2][l] + z * a[3][l] + 2 * shear_sa);
    p.aa[l] = 1.5 * (a[1][l] * a[1][l] + a[2][l] * a[2][l] + a[3][l] * a[3][l] + 2 * shear_aa);
  }
  return p;
}

double about_back_stress(const Products& p, double theta, int l) {
  const double square = p.ss[l] - 2 * theta * p.sa[l] + theta * theta * p.aa[l];
  return std::sqrt(square > 0 ? square : 0.0);
}

/// q(theta) - R0 - (3 G + H) d - C d theta = 0 with theta = 1 / (1 + gamma d).
void find_increment(const KinematicHardeningParameters& flow, double three_g, const Products& p,
                    const LaneValues& radius, const LaneValues& yields, LaneValues& d) {
  const double stiffness = three_g + flow.isotropic_modulus;
  LaneValues searching, low, high;
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    const double excess = about_back_stress(p, 1, l) - radius[l];
    searching[l] = yields[l], low[l] = 0;
    high[l] = yields[l] > 0 ? 2 * (std::sqrt(p.ss[l]) + std::sqrt(p.aa[l])) / stiffness : 0.0;
    d[l] = yields[l] > 0 ? excess / (stiffness + flow.kinematic_modulus) : 0.0;
  }
  if (flow.recovery == 0) return;
  falling_root(
      [&](const LaneValues& at, LaneValues& value, LaneValues& slope) {
#pragma GCC ivdep
        for (int l = 0; l < lanes; ++l) {
          const double theta = 1 / (1 + flow.recovery * at[l]), q = about_back_stress(p, theta, l);
          const double turn = q > 0 ? (theta * p.aa[l] - p.sa[l]) / q : 0.0;  // dq / dtheta
          value[l] = q - radius[l] - stiffness * at[l] - flow.kinematic_modulus * at[l] * theta;
          slope[l] = -flow.recovery * theta * theta * turn - stiffness - flow.kinematic_modulus * theta * theta;
        }
      },
      searching, low, high, d);
}

}  // namespace

void J2Kinematic::update(const UpdateInput& input, Batch<6>& stress, Batch<7>& state, Batch<1>& plastic_work) const {
  elastic_trial(elasticity, input, stress);
  const double three_g = 3 * elasticity.shear_modulus(), C = flow.kinematic_modulus;
  const Products p = products(stress, state);
  LaneValues radius, yields, increment;
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    radius[l] = flow.yield_stress + flow.isotropic_modulus * state.v[0][l];
    yields[l] = about_back_stress(p, 1, l) > radius[l] ? 1.0 : 0.0;
    plastic_work.v[0][l] = 0;
  }
  if (!any_lane(yields)) return;
  find_increment(flow, three_g, p, radius, yields, increment);

  auto& s = stress.v;
  auto& a = state.v;
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    const double d = increment[l], theta = 1 / (1 + flow.recovery * d), q = about_back_stress(p, theta, l);
    // Where nothing flows d is 0, theta 1 and share 0, which leaves stress and back stress as they are, bit for bit.
    // Three halves of the flow direction over q: plastic strain = share (s - theta a), s the trial deviator.
    const double direction = 1.5 * d / q, share = yields[l] > 0 ? direction : 0.0;
    const double to_stress = 2.0 / 3.0 * three_g * share, to_back = 2.0 / 3.0 * C * theta * share;
    const double mean = (s[0][l] + s[1][l] + s[2][l]) / 3;
    double before = 0, after = 0;  // products of the back stress and the plastic strain
#pragma GCC unroll 6
    for (int c = 0; c < 6; ++c) {
      const double deviator = s[c][l] - (c < 3 ? mean : 0.0), weight = c < 3 ? 1.0 : 2.0, back = a[c + 1][l];
      const double relative = deviator - theta * back, end = theta * back + to_back * relative;
      before += weight * share * back * relative;
      after += weight * share * end * relative;
      a[c + 1][l] = end;
      s[c][l] -= to_stress * relative;
    }
    const double size = radius[l] + 0.5 * flow.isotropic_modulus * d;
    const double work = size * d + 0.5 * (before + after);
    plastic_work.v[0][l] = work > 0 ? work : 0.0;
    a[0][l] += d;
  }
}

}  // namespace tenon
