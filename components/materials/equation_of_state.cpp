// SPDX-License-Identifier: BSD-3-Clause
#include "components/materials/equation_of_state.hpp"

namespace tenon {
namespace {

/// At the undeformed volume, at constant entropy: dp/dmu + p dp/de.
template <typename Law>
double isentropic_bulk_modulus(const Law& law) {
  LaneValues volume, energy;
  for (int l = 0; l < lanes; ++l) volume[l] = 1, energy[l] = law.initial_energy;
  PressureLaw p;
  if constexpr (requires { law.evaluate(volume, energy, p); })
    law.evaluate(volume, energy, p);
  else
    law.evaluate(volume, p);
  const double e = law.initial_energy;
  return p.dA_dmu[0] + p.dB_dmu[0] * e + p.B[0] * (p.A[0] + p.B[0] * e);
}

}  // namespace

void Gruneisen::evaluate(const LaneValues& volume, PressureLaw& law) const {
  constexpr double least = 0.01;
  const double stiffness = density * c * c;
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    const double mu = 1 / volume[l] - 1, share = mu / (1 + mu);
    const double N = 1 + mu * ((1 - 0.5 * gamma0) - 0.5 * a * mu), dN = (1 - 0.5 * gamma0) - a * mu;
    const double pole = 1 - (S1 - 1) * mu - mu * share * (S2 + S3 * share);
    // d/dmu of mu^2/(1 + mu) and of mu^3/(1 + mu)^2
    const double d_pole = -(S1 - 1) - S2 * share * (2 - share) - S3 * share * share * (3 - 2 * share);
    const double D = pole > least ? pole : least, dD = pole > least ? d_pole : 0.0;
    const double compressed = stiffness * mu * N / (D * D);
    const double slope = stiffness * (N + mu * dN - 2 * mu * N * dD / D) / (D * D);
    law.A[l] = mu > 0 ? compressed : stiffness * mu;
    law.dA_dmu[l] = mu > 0 ? slope : stiffness;
    law.B[l] = gamma0 + a * mu;
    law.dB_dmu[l] = a;
  }
}

void PolynomialState::evaluate(const LaneValues& volume, PressureLaw& law) const {
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    const double mu = 1 / volume[l] - 1, C2 = mu > 0 ? C[2] : 0.0, C6 = mu > 0 ? C[6] : 0.0;
    law.A[l] = C[0] + mu * (C[1] + mu * (C2 + mu * C[3]));
    law.dA_dmu[l] = C[1] + mu * (2 * C2 + 3 * mu * C[3]);
    law.B[l] = C[4] + mu * (C[5] + mu * C6);
    law.dB_dmu[l] = C[5] + 2 * mu * C6;
  }
}

void IdealGas::evaluate(const LaneValues& volume, const LaneValues& energy, PressureLaw& law) const {
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    const double slope = energy[l] > 0 ? gamma - 1 : 0.0;
    law.A[l] = law.dA_dmu[l] = 0;
    law.B[l] = slope / volume[l];
    law.dB_dmu[l] = slope;
  }
}

void TaitState::evaluate(const LaneValues& volume, PressureLaw& law) const {
  const double stiffness = density * c * c;
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    const double power = power_of(1 / volume[l], gamma);
    law.A[l] = background + stiffness / gamma * (power - 1);
    law.dA_dmu[l] = stiffness * power * volume[l];
    law.B[l] = law.dB_dmu[l] = 0;
  }
}

double JwlState::bulk_modulus() const {
  return isentropic_bulk_modulus(*this);
}

// dV/dmu = -V^2.
void JwlState::evaluate(const LaneValues& volume, PressureLaw& law) const {
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    const double V = volume[l], first = A * exp_of(-R1 * V), second = B * exp_of(-R2 * V);
    law.A[l] = first * (1 - omega / (R1 * V)) + second * (1 - omega / (R2 * V));
    law.dA_dmu[l] = first * (R1 * V * V - omega * V - omega / R1) + second * (R2 * V * V - omega * V - omega / R2);
    law.B[l] = omega / V;
    law.dB_dmu[l] = omega;
  }
}

double TillotsonState::bulk_modulus() const {
  return isentropic_bulk_modulus(*this);
}

// Pressures and slopes of both branches, then the mean of them by the share of vapour.
void TillotsonState::evaluate(const LaneValues& volume, const LaneValues& energy, PressureLaw& law) const {
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    const double V = volume[l], eta = 1 / V, mu = eta - 1, e = energy[l], x = V - 1;
    const double ratio = e * V * V / (density * E0);  // u/(E0 eta^2); kept off the pole that tension could reach
    const double scaled = ratio > -0.5 ? ratio : -0.5, w = 1 + scaled;
    // b rho u/w = b eta e/w, with dw/de = scaled/e and dw/dmu = -2 scaled V.
    const double bound = b * eta * e / w, bound_e = b * eta / (w * w), bound_mu = b * e * (1 + 2 * scaled / w) / w;
    const double p_cold = a * eta * e + bound + mu * (A + B * mu);
    const double cold_e = a * eta + bound_e, cold_mu = a * e + bound_mu + A + 2 * B * mu;
    const double fade = exp_of(-alpha * x * x), soft = A * exp_of(-beta * x);
    const double hot = bound + soft * mu;
    const double p_hot = a * eta * e + hot * fade, hot_e = a * eta + bound_e * fade;
    // dx/dmu = -V^2
    const double hot_mu = a * e + (bound_mu + soft * (1 + beta * mu * V * V) + 2 * alpha * x * V * V * hot) * fade;
    const double width = (complete - incipient) * density, raw = (e - incipient * density) / width;
    const double capped = raw < 1 ? raw : 1.0, share = mu < 0 ? (capped > 0 ? capped : 0.0) : 0.0;
    const double between = share > 0 ? (share < 1 ? 1 / width : 0.0) : 0.0;
    const double p = p_cold + share * (p_hot - p_cold);
    law.B[l] = cold_e + share * (hot_e - cold_e) + between * (p_hot - p_cold);
    law.A[l] = p - law.B[l] * e;
    law.dB_dmu[l] = 0;
    law.dA_dmu[l] = cold_mu + share * (hot_mu - cold_mu);
  }
}

}  // namespace tenon
