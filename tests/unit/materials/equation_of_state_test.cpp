// SPDX-License-Identifier: BSD-3-Clause
// Equations of state: the Hugoniot, isentropes, the balance of energy, parting, the bulk modulus.
#include <gtest/gtest.h>

#include <cmath>

#include "components/materials/j2_kinematic.hpp"
#include "components/materials/j2_linear_hardening.hpp"
#include "components/materials/with_equation_of_state.hpp"
#include "deforming_point.hpp"

namespace tenon::testing {
namespace {

using Solid = WithEquationOfState<J2LinearHardening>;
static_assert(Material<Solid> && Solid::state_names[0] == "eqps" && Solid::state_names[2] == "volume_ratio");
static_assert(WithEquationOfState<J2Kinematic>::rotating_tensors[0] == 1 && Solid::rotating_tensors.empty());

const Gruneisen copper{8930, 3940, 1.489, 0, 0, 2.02, 0.47, 0};
const Gruneisen curved{7850, 4600, 1.3, 0.4, -0.2, 1.7, 0, 0};
const PolynomialState gas{{0, 0, 0, 0, 0.4, 0.4, 0}, 2.5e5};

Solid solid(const EquationOfState& state) {
  return {J2LinearHardening{Elasticity{117e9, 0.35, 0}, 90e6, 300e6}, state};
}

const TaitState water{1000, 1500, 7, 1e5, 0};
const JwlState tnt{371.2e9, 3.231e9, 4.15, 0.95, 0.30, 7e9};  // products of TNT, rho0 = 1630 kg/m^3
const TillotsonState aluminium{2700, 0.5, 1.63, 75.2e9, 65e9, 5e6, 5, 5, 3e6, 13.9e6, 0};

double pressure(const EquationOfState& state, double V, double e) {
  LaneValues volume, energy;
  for (int l = 0; l < lanes; ++l) volume[l] = V, energy[l] = e;
  PressureLaw law;
  state.evaluate(volume, energy, law);
  return law.A[0] + law.B[0] * e;
}

TEST(Gruneisen, IsOnTheHugoniotExactly) {
  for (const Gruneisen& g : {copper, curved})
    for (const double u : {1.0, 100.0, 800.0, 2000.0}) {
      double U = g.c;  // shock speed: u/U depends on itself
      for (int i = 0; i < 200; ++i) U = g.c + u * (g.S1 + u / U * (g.S2 + u / U * g.S3));
      const double exact = g.density * U * u;
      EXPECT_NEAR(pressure({g}, 1 - u / U, 0.5 * g.density * u * u), exact, 1e-11 * exact) << u;
    }
}

/// A point that a steady shock passes: stress and viscous stress together follow the Rayleigh line rho0 U^2 (1 - V),
/// what the viscous stress does is heat. Behind the shock the pressure is rho0 U u.
TEST(Gruneisen, PointBehindASteepRampIsOnTheHugoniot) {
  const double u = 800, U = copper.c + copper.S1 * u, exact = copper.density * U * u, end = 1 - u / U;
  const auto error = [&](int steps) {
    WithEquationOfState<LinearElastic> m{LinearElastic{Elasticity{1e3, 0.49, 0}}, {copper}};  // hardly any strength
    DeformingPoint<WithEquationOfState<LinearElastic>> p(m);
    for (int i = 1; i <= steps; ++i) {
      const double before = p.F[0][0], V = 1 + (end - 1) * i / steps;
      const double viscous = copper.density * U * U * (1 - 0.5 * (V + before)) - p.pressure();
      p.deform(stretch(V, 1, 1), 1e-9, viscous * (before - V));
    }
    EXPECT_NEAR(p.state[0][0], 0.5 * copper.density * u * u, 0.2 * copper.density * u * u);
    return std::abs(p.pressure() - exact) / exact;
  };
  EXPECT_LT(error(2000), 1e-3);
  EXPECT_NEAR(std::log2(error(1000) / error(2000)), 1, 0.1);
}

TEST(PolynomialState, GasExpandsAlongItsIsentrope) {
  const auto error = [](int steps) {
    WithEquationOfState<LinearElastic> m{LinearElastic{Elasticity{1e-3, 0.3, 0}}, {gas}};
    DeformingPoint<WithEquationOfState<LinearElastic>> p(m);
    p.deform(identity());  // the first update gives the pressure
    EXPECT_NEAR(p.pressure(), 1e5, 1e-6);
    for (int i = 1; i <= steps; ++i) p.deform(stretch(1 + 1.0 * i / steps, 1, 1));
    const double exact = 1e5 * std::pow(2.0, -1.4);
    return std::abs(p.pressure() - exact) / exact;
  };
  EXPECT_LT(error(100), 1e-5);
  EXPECT_NEAR(std::log2(error(50) / error(100)), 2, 0.05);
}

TEST(EquationOfState, EnergyIsBalancedToRoundOff) {
  DeformingPoint<Solid> p(solid({copper, -200e6}));
  double work = 0, parted = 0;
  for (int i = 0; i < 400; ++i) {
    const double t = 0.02 * i, before = p.pressure(), volume_before = determinant(p.F);
    const Matrix F{{{1 - 0.1 * std::sin(t), 0.05 * t * 0.1, 0}, {0, 1 + 0.02 * t * 0.1, 0}, {0, 0, 1}}};
    const Matrix L = combine(1, F, -1, p.F) * inverse(combine(0.5, F, 0.5, p.F));
    const Matrix half = combine(0.25, L, -0.25, transposed(L));
    DeformingPoint<Solid> turned = p;
    turned.rotate(inverse(combine(1, identity(), -1, half)) * combine(1, identity(), 1, half));
    p.deform(F, 1e-6, 100);
    const double volume = determinant(F), middle = 0.5 * (volume + volume_before);
    for (int c = 0; c < 6; ++c) {
      const std::size_t a = c < 3 ? static_cast<std::size_t>(c) : static_cast<std::size_t>(c - 3),
                        b = c < 3 ? a : (a + 1) % 3;
      const double rate = 0.5 * (L[a][b] + L[b][a]);
      const double s0 = turned.stress[c][0] + (c < 3 ? before : 0), s1 = p[c] + (c < 3 ? p.pressure() : 0);
      work += middle * (c < 3 ? 0.5 : 1.0) * (s0 + s1) * rate;
    }
    work += 100 - 0.5 * (before + p.pressure()) * (volume - volume_before);
    parted += p.pressure() == -200e6;
    ASSERT_GE(p.pressure(), -200e6 * (1 + 1e-12));
    ASSERT_LE(p.von_mises(), (90e6 + 300e6 * p.state[0][0]) * (1 + 1e-12));
  }
  EXPECT_GT(p.state[0][0], 0.05);
  EXPECT_NEAR(p.state[1][0], work, 1e-12 * 1e9);
}

TEST(EquationOfState, TensionIsHeldAtTheLeastPressure) {
  DeformingPoint<Solid> p(solid({copper, -100e6}));
  for (int i = 1; i <= 50; ++i) p.deform(stretch(1 + 1e-3 * i, 1, 1), 1e-6);
  EXPECT_NEAR(p.pressure(), -100e6, 1e-4);
}

/// The bulk modulus handed to the stable step is the slope of smooth compression.
TEST(EquationOfState, StiffnessIsThatOfSmoothFlow) {
  for (const EquationOfState& state :
       {EquationOfState{copper}, EquationOfState{curved},
        EquationOfState{PolynomialState{{0, 80e9, 60e9, 9e9, 1.8, 1.2, 0.3}}}, EquationOfState{IdealGas{1.4, 2.5e9}},
        EquationOfState{water}, EquationOfState{tnt}, EquationOfState{aluminium}})
    for (const double V : {0.75, 0.95, 1.03}) {
      DeformingPoint<Solid> p(solid(state));
      const double l = std::cbrt(V), d = 1e-5;
      for (int i = 1; i <= 100; ++i) {
        const double s = 1 + (l - 1) * i / 100;
        p.deform(stretch(s, s, s), 1e-6, i == 50 ? 1e9 : 0);
      }
      const double K = p.moduli[0][0] + 2.0 / 3.0 * p.moduli[1][0], up = l * std::cbrt(1 + d),
                   down = l * std::cbrt(1 - d);
      DeformingPoint<Solid> other = p;
      p.deform(stretch(up, up, up)), other.deform(stretch(down, down, down));
      EXPECT_NEAR(K, (other.pressure() - p.pressure()) / (2 * d), 1e-4 * K) << V;
    }
}

TEST(IdealGas, FollowsItsLawAndBearsNoNegativeEnergy) {
  EXPECT_NEAR(pressure({IdealGas{1.4, 0}}, 0.5, 2.5e5), 2e5, 1e-9);
  EXPECT_EQ(pressure({IdealGas{1.4, 0}}, 0.5, -1), 0);
  EXPECT_NEAR((EquationOfState{IdealGas{1.4, 2.5e5}}.bulk_modulus()), 1.4e5, 1e-9);
}

TEST(TaitState, FollowsItsLaw) {
  EXPECT_NEAR(pressure({water}, 1, 0), 1e5, 1e-6);
  EXPECT_NEAR(pressure({water}, 1 / 1.02, 0), 1e5 + 1000 * 1500.0 * 1500.0 / 7 * (std::pow(1.02, 7) - 1), 1e-3);
  EXPECT_EQ(pressure({water}, 0.9, 1e9), pressure({water}, 0.9, 0));
}

/// A detonation at 6,930 m/s leaves the products of TNT at 21 GPa: on the line from the explosive, with the energy of
/// the explosive and the work of the front, and with the speed of sound of a Chapman-Jouguet state, D - u.
TEST(JwlState, IsAtTheChapmanJouguetPointOfTnt) {
  const double rho = 1630, D = 6930, p = 21e9, V = 1 - p / (rho * D * D), e = tnt.initial_energy + 0.5 * p * (1 - V);
  EXPECT_NEAR(pressure({tnt}, V, e), p, 0.005 * p);
  const double dV = 1e-5,
               K = -V * (pressure({tnt}, V + dV, e - p * dV) - pressure({tnt}, V - dV, e + p * dV)) / (2 * dV);
  EXPECT_NEAR(std::sqrt(K * V / rho), D * V, 0.01 * D * V);
}

TEST(TillotsonState, FollowsItsBranches) {
  const double rho = 2700, E0 = 5e6;
  const auto bound = [&](double eta, double u) { return 1.63 / (1 + u / (E0 * eta * eta)) * rho * eta * u; };
  const auto cold = [&](double eta, double u) {
    return 0.5 * rho * eta * u + bound(eta, u) + 75.2e9 * (eta - 1) + 65e9 * (eta - 1) * (eta - 1);
  };
  const auto hot = [&](double eta, double u) {
    const double x = 1 / eta - 1;
    return 0.5 * rho * eta * u + (bound(eta, u) + 75.2e9 * (eta - 1) * std::exp(-5 * x)) * std::exp(-5 * x * x);
  };
  const auto close = [&](double eta, double u, double p) {
    EXPECT_NEAR(pressure({aluminium}, 1 / eta, rho * u), p, 1e-9 * std::abs(p) + 1e-3) << eta << " " << u;
  };
  for (const double eta : {1.0, 1.3, 2.0})
    for (const double u : {0.0, 1e6, 20e6}) close(eta, u, cold(eta, u));
  for (const double eta : {0.3, 0.9}) {
    close(eta, 2.9e6, cold(eta, 2.9e6)), close(eta, 14e6, hot(eta, 14e6));
    close(eta, 3e6, cold(eta, 3e6)), close(eta, 13.9e6, hot(eta, 13.9e6));
    const double u = 8e6, share = (u - 3e6) / 10.9e6;
    close(eta, u, (1 - share) * cold(eta, u) + share * hot(eta, u));
  }
}

/// What a nonlinear law adds to the step's energy is what its own pressure did.
TEST(TillotsonState, IsMetAtTheEndOfTheStep) {
  WithEquationOfState<LinearElastic> m{LinearElastic{Elasticity{1e3, 0.49, 0}}, {aluminium}};
  DeformingPoint<WithEquationOfState<LinearElastic>> p(m);
  for (int i = 1; i <= 40; ++i) {
    p.deform(stretch(1 + 0.01 * i, 1, 1), 1e-9, 1.5e9);
    const double V = 1 + 0.01 * i, exact = pressure({aluminium}, V, p.state[0][0]);
    EXPECT_NEAR(p.pressure(), exact, 1e-9 * std::abs(exact) + 1) << i;
  }
  EXPECT_GT(p.state[0][0], 13.9e6 * 2700);
}

TEST(EquationOfState, SmallStrainsHaveBothModuli) {
  const Solid m = solid({copper});
  EXPECT_NEAR(m.elasticity.bulk_modulus(), copper.bulk_modulus(), 1e-6 * copper.bulk_modulus());
  EXPECT_NEAR(m.elasticity.shear_modulus(), 117e9 / 2.7, 1e-3);
}

}  // namespace
}  // namespace tenon::testing
