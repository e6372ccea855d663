// SPDX-License-Identifier: BSD-3-Clause
// Any deviatoric strength under the pressure of an equation of state.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

#include "components/materials/equation_of_state.hpp"
#include "components/materials/material_concept.hpp"

namespace tenon {

/// The deviator is that of `Strength`, whose mean stress is thrown away; pressure and energy are found together: the
/// energy of the step is e* - (p_old + p) dV / 2 with p = A + B e, and so p = (A + B e*) / (1 + B dV / 2), where e*
/// holds the energy of the start, the work of the deviator (trapezium) and the heat of artificial viscosity. The
/// balance of energy is met to round-off, the entropy of smooth flow to the second order. Below the least pressure the
/// material parts at that pressure.
template <Material Strength>
struct WithEquationOfState {
  static constexpr int strength_size = Strength::state_size;
  static constexpr int energy = strength_size, volume = strength_size + 1;
  static constexpr int state_size = strength_size + 2;
  static constexpr std::array<std::string_view, static_cast<std::size_t>(state_size)> state_names = [] {
    std::array<std::string_view, static_cast<std::size_t>(state_size)> names;
    std::copy(Strength::state_names.begin(), Strength::state_names.end(), names.begin());
    names[energy] = "internal_energy";
    names[volume] = "volume_ratio";
    return names;
  }();
  static constexpr bool needs_volume_ratio = true, needs_added_heat = true;
  static constexpr auto rotating_tensors = [] {
    if constexpr (requires { Strength::rotating_tensors; })
      return Strength::rotating_tensors;
    else
      return std::array<int, 0>{};
  }();

  Strength strength;
  EquationOfState state_law;
  Elasticity elasticity;  ///< of small strains: shear of the strength, volume of the equation of state

  WithEquationOfState(const Strength& s, const EquationOfState& e) : strength(s), state_law(e) {
    const double G = s.elasticity.shear_modulus(), K = e.bulk_modulus();
    elasticity = {9 * K * G / (3 * K + G), (3 * K - 2 * G) / (2 * (3 * K + G)), 0};
  }

  double initial_state(int i) const { return i == energy ? state_law.initial_energy() : i == volume ? 1 : 0; }

  void update(const UpdateInput& input, Batch<6>& stress, Batch<state_size>& state, Batch<1>& plastic_work) const {
    const Batch<6> before = stress;
    StateBatch<Strength> own;
    for (int i = 0; i < strength_size; ++i) std::copy_n(state.v[i], lanes, own.v[i]);
    strength.update(input, stress, own, plastic_work);
    for (int i = 0; i < strength_size; ++i) std::copy_n(own.v[i], lanes, state.v[i]);
    const LaneValues& V = (*input.volume_ratio).v[0];
    const auto &e = input.strain_increment.v, &b = before.v;
    auto& s = stress.v;
    LaneValues known, pressure, found;
#pragma GCC ivdep
    for (int l = 0; l < lanes; ++l) {
      const double mean_before = (b[0][l] + b[1][l] + b[2][l]) / 3, mean = (s[0][l] + s[1][l] + s[2][l]) / 3;
      double work = 0;
      for (int c = 0; c < 3; ++c) work += 0.5 * ((b[c][l] - mean_before) + (s[c][l] - mean)) * e[c][l];
      for (int c = 3; c < 6; ++c) work += (b[c][l] + s[c][l]) * e[c][l];
      const double V_before = state.v[volume][l], dV = V[l] - V_before;
      const double heat = input.added_heat ? (*input.added_heat).v[0][l] : 0.0;
      known[l] = state.v[energy][l] + 0.5 * (V[l] + V_before) * work + heat + 0.5 * mean_before * dV;
      found[l] = known[l];
    }
    // One Newton step where the pressure is linear in the energy; else the energy has only a short way to go.
    for (int newton = state_law.linear_in_energy() ? 1 : 4; newton > 0; --newton) {
      PressureLaw law;
      state_law.evaluate(V, found, law);
#pragma GCC ivdep
      for (int l = 0; l < lanes; ++l) {
        const double dV = V[l] - state.v[volume][l];
        const double free = (law.A[l] + law.B[l] * known[l]) / (1 + 0.5 * law.B[l] * dV);
        pressure[l] = free > state_law.least_pressure ? free : state_law.least_pressure;
        found[l] = known[l] - 0.5 * pressure[l] * dV;
      }
    }
#pragma GCC ivdep
    for (int l = 0; l < lanes; ++l) {
      const double mean = (s[0][l] + s[1][l] + s[2][l]) / 3;
      for (int c = 0; c < 3; ++c) s[c][l] = (s[c][l] - mean) - pressure[l];
      state.v[energy][l] = found[l];
      state.v[volume][l] = V[l];
    }
  }

  /// Bulk modulus of smooth flow -V dp/dV = (1 + mu) (dA/dmu + dB/dmu e) + V B p, and the shear modulus.
  void stiffness(const UpdateInput&, const Batch<6>& stress, const Batch<state_size>& state, Batch<2>& moduli) const {
    PressureLaw law;
    state_law.evaluate(state.v[volume], state.v[energy], law);
    const double G = strength.elasticity.shear_modulus();
#pragma GCC ivdep
    for (int l = 0; l < lanes; ++l) {
      const double p = -(stress.v[0][l] + stress.v[1][l] + stress.v[2][l]) / 3, V = state.v[volume][l];
      const double K = (law.dA_dmu[l] + law.dB_dmu[l] * state.v[energy][l]) / V + V * law.B[l] * p;
      moduli.v[0][l] = std::max(K, 0.0) - 2.0 / 3.0 * G;
      moduli.v[1][l] = G;
    }
  }
};

}  // namespace tenon
