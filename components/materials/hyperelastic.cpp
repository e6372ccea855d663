// SPDX-License-Identifier: BSD-3-Clause
#include "components/materials/hyperelastic.hpp"

#include <algorithm>
#include <cmath>

#include "components/materials/lane_math.hpp"

namespace tenon {
namespace {

struct Symmetric {
  double xx, yy, zz, xy, yz, zx;
  double trace() const { return xx + yy + zz; }
  Symmetric squared() const {
    return {xx * xx + xy * xy + zx * zx, xy * xy + yy * yy + yz * yz, zx * zx + yz * yz + zz * zz,
            xx * xy + xy * yy + zx * yz, xy * zx + yy * yz + yz * zz, xx * zx + xy * yz + zx * zz};
  }
};

double determinant(const double (&F)[9]) {
  return F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) + F[2] * (F[3] * F[7] - F[4] * F[6]);
}

/// Volume-free left Cauchy-Green tensor and the volume ratio.
struct Strain {
  double J;
  Symmetric B;
  explicit Strain(const double (&F)[9]) : J(determinant(F)) {
    const double f = exp_of(-2.0 / 3.0 * log_of(J));
    B = {f * (F[0] * F[0] + F[1] * F[1] + F[2] * F[2]), f * (F[3] * F[3] + F[4] * F[4] + F[5] * F[5]),
         f * (F[6] * F[6] + F[7] * F[7] + F[8] * F[8]), f * (F[0] * F[3] + F[1] * F[4] + F[2] * F[5]),
         f * (F[3] * F[6] + F[4] * F[7] + F[5] * F[8]), f * (F[6] * F[0] + F[7] * F[1] + F[8] * F[2])};
  }
  double I1() const { return B.trace(); }
  double I2() const { return 0.5 * (B.trace() * B.trace() - B.squared().trace()); }
};

void gradient_of(const UpdateInput& input, int l, double (&F)[9]) {
  for (int i = 0; i < 9; ++i) F[i] = (*input.deformation_gradient).v[i][l];
}

}  // namespace

Elasticity MooneyRivlin::small_strain(const MooneyRivlinParameters& rubber, double expansion) {
  const double G = 2 * (rubber.C10 + rubber.C01), K = rubber.bulk_modulus;
  return {9 * K * G / (3 * K + G), (3 * K - 2 * G) / (2 * (3 * K + G)), expansion};
}

double MooneyRivlin::energy(const double (&F)[9], double thermal_strain) const {
  const Strain e(F);
  const double J = e.J * exp_of(-3 * thermal_strain);
  return rubber.C10 * (e.I1() - 3) + rubber.C01 * (e.I2() - 3) +
         0.5 * rubber.bulk_modulus * (0.5 * (J * J - 1) - log_of(J));
}

void MooneyRivlin::update(const UpdateInput& input, Batch<6>& stress, Batch<1>& state, Batch<1>& plastic_work) const {
  auto& s = stress.v;
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    double F[9];
    gradient_of(input, l, F);
    const Strain e(F);
    const double I1 = e.I1();
    state.v[0][l] += elasticity.expansion * input.temperature_increment.v[0][l];
    const double shrink = exp_of(-3 * state.v[0][l]), Je = e.J * shrink;
    // dU/dJ = K/2 (Je - 1/Je) dJe/dJ
    const double mean = 0.5 * rubber.bulk_modulus * (Je - 1 / Je) * shrink;
    // 2/J dev((C10 + I1 C01) B - C01 B^2), [Hol00] eq. 6.117
    const Symmetric& B = e.B;
    const Symmetric B2 = B.squared();
    const double f = 2 / e.J * (rubber.C10 + I1 * rubber.C01), g = 2 / e.J * rubber.C01;
    const double third = (f * I1 - g * B2.trace()) / 3;
    s[0][l] = mean + (f * B.xx - g * B2.xx - third);
    s[1][l] = mean + (f * B.yy - g * B2.yy - third);
    s[2][l] = mean + (f * B.zz - g * B2.zz - third);
    s[3][l] = f * B.xy - g * B2.xy;
    s[4][l] = f * B.yz - g * B2.yz;
    s[5][l] = f * B.zx - g * B2.zx;
    plastic_work.v[0][l] = 0;
  }
}

/// rho c^2 = 1/J d^2 W(F + x m (F^T n)^T)/dx^2 of a wave along n that moves along m. With c = m.n:
///   C10: 2 n.Bn - 8/3 c m.Bn + 10/9 c^2 I1, C01 (with D = B^-1): 2 m.Dm + 4/3 c n.Dm - 2/9 c^2 I2, volume: c^2 J^2
///   U''.
/// Both are bounded through the ends of the eigenvalues of B and D, of which det B = 1 gives one from the other.
void MooneyRivlin::stiffness(const UpdateInput& input, const Batch<6>&, const Batch<1>& state, Batch<2>& moduli) const {
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    double F[9];
    gradient_of(input, l, F);
    const Strain e(F);
    const double I1 = e.I1(), I2 = e.I2(), J = e.J, shrink = exp_of(-3 * state.v[0][l]), Je = J * shrink;
    // No eigenvalue is further from the mean than 2/3 sqrt(I1^2 - 3 I2).
    const double spread = 2.0 / 3.0 * std::sqrt(std::max(I1 * I1 - 3 * I2, 0.0));
    const double high = I1 / 3 + spread, d_high = std::min(high * high, I2);
    const double low = std::max(1 / d_high, I1 / 3 - spread), d_low = 1 / high;
    const double first =
        rubber.C10 * (std::max(2 * high, 10.0 / 9.0 * I1 - 2.0 / 3.0 * low) + 2.0 / 3.0 * (high - low));
    const double second =
        rubber.C01 * (std::max(2 * d_high, 10.0 / 3.0 * d_high - 2.0 / 9.0 * I2) + (d_high - d_low) / 3);
    const double volume = 0.5 * rubber.bulk_modulus * (1 + 1 / (Je * Je)) * Je * shrink;
    const double shear = 2 / J * (rubber.C10 * high + rubber.C01 * d_high);
    const double longest = (first + second) / J + volume;
    moduli.v[0][l] = std::max(longest - 2 * shear, 0.0);
    moduli.v[1][l] = shear;
  }
}

}  // namespace tenon
