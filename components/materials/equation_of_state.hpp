// SPDX-License-Identifier: BSD-3-Clause
// Pressure as a function of volume and energy: Mie-Gruneisen and polynomial.
#pragma once

#include <limits>
#include <variant>

#include "components/materials/lane_root.hpp"

namespace tenon {

/// p = A(V) + B(V) e: what a step needs. V = V/V0; e is the energy per undeformed volume, J/m^3; p in Pa.
struct PressureLaw {
  LaneValues A, B;            ///< Pa, 1
  LaneValues dA_dmu, dB_dmu;  ///< over mu = 1/V - 1
};

/// [Ste96]: on the Hugoniot, shock speed = c + S1 u + S2 (u/U) u + S3 (u/U)^2 u, u the particle speed and U the shock
/// speed. With mu = V0/V - 1, compressed:
///   p = rho0 c^2 mu (1 + (1 - gamma0/2) mu - a/2 mu^2) / D^2 + (gamma0 + a mu) e,
///   D = 1 - (S1 - 1) mu - S2 mu^2/(mu + 1) - S3 mu^3/(mu + 1)^2,
/// which is on the Hugoniot exactly; expanded, p = rho0 c^2 mu + (gamma0 + a mu) e. D is kept above 0.01, the pole of
/// infinite compression.
struct Gruneisen {
  double density = 0;  ///< rho0, kg/m^3
  double c = 0;        ///< m/s
  double S1 = 0, S2 = 0, S3 = 0, gamma0 = 0, a = 0;
  double initial_energy = 0;  ///< J/m^3

  double bulk_modulus() const { return density * c * c; }
  void evaluate(const LaneValues& volume, PressureLaw& law) const;
};

/// p = C0 + C1 mu + C2 mu^2 + C3 mu^3 + (C4 + C5 mu + C6 mu^2) e; C2 and C6 count in compression only.
struct PolynomialState {
  double C[7] = {};           ///< Pa; 4 to 6: 1
  double initial_energy = 0;  ///< J/m^3

  /// At the undeformed volume, at constant entropy.
  double bulk_modulus() const { return C[1] + C[5] * initial_energy + C[4] * (C[0] + C[4] * initial_energy); }
  void evaluate(const LaneValues& volume, PressureLaw& law) const;
};

struct EquationOfState {
  std::variant<Gruneisen, PolynomialState> law;
  double least_pressure = -std::numeric_limits<double>::infinity();  ///< Pa: what tension can pull it to

  double initial_energy() const {
    return std::visit([](const auto& l) { return l.initial_energy; }, law);
  }
  double bulk_modulus() const {
    return std::visit([](const auto& l) { return l.bulk_modulus(); }, law);
  }
  void evaluate(const LaneValues& volume, PressureLaw& p) const {
    std::visit([&](const auto& l) { l.evaluate(volume, p); }, law);
  }
};

}  // namespace tenon
