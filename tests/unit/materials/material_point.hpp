// SPDX-License-Identifier: BSD-3-Clause
// One material point, driven by strain or by uniaxial stress.
#pragma once

#include <array>
#include <cmath>

#include "components/materials/j2_linear_hardening.hpp"
#include "components/materials/johnson_cook.hpp"
#include "components/materials/linear_elastic.hpp"

namespace tenon::testing {

using Tensor = std::array<double, 6>;  // xx yy zz xy yz zx, tensor shear

template <int N>
Batch<N> everywhere(const std::array<double, N>& values) {
  Batch<N> batch;
  for (int c = 0; c < N; ++c)
    for (int l = 0; l < lanes; ++l) batch[c][l] = values[static_cast<std::size_t>(c)];
  return batch;
}

/// The same point in all lanes; values are read from lane 0.
template <Material M>
struct MaterialPoint {
  M material;
  Batch<6> stress = everywhere<6>({});
  StateBatch<M> state{};
  double plastic_work = 0, stress_work = 0;
  double temperature = 293.15;

  void strain(const Tensor& increment, double dt = 1, double dT = 0) {
    const Batch<6> e = everywhere<6>(increment);
    temperature += dT;
    const Batch<1> t = everywhere<1>({temperature}), d = everywhere<1>({dT});
    Batch<1> work;
    const Batch<6> before = stress;
    material.update({e, t, d, dt}, stress, state, work);
    plastic_work += work[0][0];
    for (int c = 0; c < 6; ++c)
      stress_work += (c < 3 ? 1 : 2) * 0.5 * (before[c][0] + stress[c][0]) * increment[static_cast<std::size_t>(c)];
  }

  /// Uniaxial stress along x: finds the lateral strain that leaves no lateral stress, by the secant method.
  void pull(double axial, double dt = 1, double dT = 0) {
    const MaterialPoint start = *this;
    const auto lateral_stress = [&](double lateral) {
      *this = start;
      strain({axial, lateral, lateral, 0, 0, 0}, dt, dT);
      return stress[1][0];
    };
    double a = -0.5 * axial, fa = lateral_stress(a);
    double b = a - fa / (2 * material.elasticity.lame_lambda() + 2 * material.elasticity.shear_modulus());
    double fb = lateral_stress(b);
    for (int i = 0; i < 100 && fb != fa && std::abs(fb) > 1e-14 * std::abs(stress[0][0]); ++i) {
      const double c = b - fb * (b - a) / (fb - fa);
      a = b, fa = fb;
      b = c, fb = lateral_stress(b);
    }
  }

  double operator[](int c) const { return stress[c][0]; }
  double eqps() const { return state[0][0]; }
  double von_mises() const {
    const double p = (stress[0][0] + stress[1][0] + stress[2][0]) / 3;
    double sum = 0;
    for (int c = 0; c < 3; ++c)
      sum += (stress[c][0] - p) * (stress[c][0] - p) + 2 * stress[c + 3][0] * stress[c + 3][0];
    return std::sqrt(1.5 * sum);
  }
  /// Elastic energy per volume of the present stress, J/m^3.
  double elastic_energy() const {
    const double p = (stress[0][0] + stress[1][0] + stress[2][0]) / 3, q = von_mises();
    return 0.5 * p * p / material.elasticity.bulk_modulus() + q * q / (6 * material.elasticity.shear_modulus());
  }
};

inline const Elasticity steel{200e9, 0.3, 0};

}  // namespace tenon::testing
