// SPDX-License-Identifier: BSD-3-Clause
#include "components/materials/equation_of_state.hpp"

namespace tenon {

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

}  // namespace tenon
