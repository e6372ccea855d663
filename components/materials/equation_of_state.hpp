// SPDX-License-Identifier: BSD-3-Clause
// Pressure as a function of volume and energy: condensed matter, gases, liquids, detonation products.
#pragma once

#include <limits>
#include <variant>

#include "components/materials/lane_root.hpp"

namespace tenon {

/// p = A(V) + B(V) e: what a step needs. V = V/V0; e is the energy per undeformed volume, J/m^3; p in Pa. Of a law that
/// is not linear in the energy: the tangent at one energy, which gives the exact pressure there.
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

/// p = (gamma - 1) (1 + mu) e, and none where the energy has become negative by errors of a scheme.
struct IdealGas {
  double gamma = 1.4;
  double initial_energy = 0;  ///< J/m^3

  double bulk_modulus() const { return gamma * (gamma - 1) * initial_energy; }
  void evaluate(const LaneValues& volume, const LaneValues& energy, PressureLaw& law) const;
};

/// Water and its like: p = background + rho0 c^2/gamma ((rho/rho0)^gamma - 1).
struct TaitState {
  double density = 0;  ///< rho0, kg/m^3
  double c = 0;        ///< speed of sound at rho0, m/s
  double gamma = 7;
  double background = 0;      ///< pressure at rho0, Pa
  double initial_energy = 0;  ///< J/m^3; no pressure depends on it

  double bulk_modulus() const { return density * c * c; }
  void evaluate(const LaneValues& volume, PressureLaw& law) const;
};

/// Detonation products [LHK68]: p = A (1 - w/(R1 V)) e^(-R1 V) + B (1 - w/(R2 V)) e^(-R2 V) + w e/V.
struct JwlState {
  double A = 0, B = 0;  ///< Pa
  double R1 = 0, R2 = 0, omega = 0;
  double initial_energy = 0;  ///< of the explosive, J/m^3

  double bulk_modulus() const;
  void evaluate(const LaneValues& volume, PressureLaw& law) const;
};

/// [Til62], for impacts up to vaporization. With eta = 1 + mu, u = e/rho0 and w = 1 + u/(E0 eta^2):
///   compressed, or cold (u < incipient):    p = (a + b/w) rho u + A mu + B mu^2
///   expanded and hot (u > complete):        p = a rho u + (b rho u/w + A mu e^(-beta (1/eta - 1)))
///                                                         e^(-alpha (1/eta - 1)^2)
/// and between the two a mean weighted by the energy. Not linear in the energy.
struct TillotsonState {
  double density = 0;  ///< rho0, kg/m^3
  double a = 0, b = 0;
  double A = 0, B = 0;  ///< Pa
  double E0 = 0;        ///< J/kg
  double alpha = 0, beta = 0;
  double incipient = 0, complete = 0;  ///< energies of vaporization, J/kg
  double initial_energy = 0;           ///< J/m^3

  double bulk_modulus() const;
  void evaluate(const LaneValues& volume, const LaneValues& energy, PressureLaw& law) const;
};

struct EquationOfState {
  std::variant<Gruneisen, PolynomialState, IdealGas, TaitState, JwlState, TillotsonState> law;
  double least_pressure = -std::numeric_limits<double>::infinity();  ///< Pa: what tension can pull it to

  double initial_energy() const {
    return std::visit([](const auto& l) { return l.initial_energy; }, law);
  }
  double bulk_modulus() const {
    return std::visit([](const auto& l) { return l.bulk_modulus(); }, law);
  }
  bool linear_in_energy() const { return !std::holds_alternative<TillotsonState>(law); }
  /// The tangent at these energies, J/m^3.
  void evaluate(const LaneValues& volume, const LaneValues& energy, PressureLaw& p) const {
    std::visit(
        [&](const auto& l) {
          if constexpr (requires { l.evaluate(volume, energy, p); })
            l.evaluate(volume, energy, p);
          else
            l.evaluate(volume, p);
        },
        law);
  }
  /// The tangent at the initial energy.
  void evaluate(const LaneValues& volume, PressureLaw& p) const {
    LaneValues energy;
    for (double& e : energy) e = initial_energy();
    evaluate(volume, energy, p);
  }
};

}  // namespace tenon
