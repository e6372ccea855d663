// SPDX-License-Identifier: BSD-3-Clause
#include "components/materials/orthotropic_elastic.hpp"

#include <algorithm>
#include <cmath>

namespace tenon {
namespace {

using Matrix = double[3][3];

double determinant(const Matrix& m) {
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

double cofactor(const Matrix& m, int i, int j) {
  const int a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
  return m[a][c] * m[b][d] - m[a][d] * m[b][c];
}

void compliance(const OrthotropicParameters& p, Matrix& s) {
  s[0][0] = 1 / p.E1, s[1][1] = 1 / p.E2, s[2][2] = 1 / p.E3;
  s[0][1] = s[1][0] = -p.nu12 / p.E1;
  s[1][2] = s[2][1] = -p.nu23 / p.E2;
  s[2][0] = s[0][2] = -p.nu31 / p.E3;
}

/// Whether 2 mu I + lambda 1 1^T - C has no negative eigenvalue, but for round-off: none below -1e-6 of its size.
bool covers(const Matrix& C, double two_mu, double lambda) {
  constexpr double round_off = 1e-13;
  Matrix m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m[i][j] = lambda + (i == j ? two_mu : 0) - C[i][j];
  const double size = two_mu + std::abs(lambda) + C[0][0] + C[1][1] + C[2][2], least = -round_off * size;
  return m[0][0] >= least && m[1][1] >= least && m[2][2] >= least && cofactor(m, 0, 0) >= least * size &&
         cofactor(m, 1, 1) >= least * size && cofactor(m, 2, 2) >= least * size &&
         determinant(m) >= least * size * size;
}

/// The isotropic C = lambda 1 1^T + 2 mu I of least lambda + 2 mu that is nowhere softer. For each mu, the least lambda
/// makes the difference singular: lambda = -1 / (1 (2 mu I - C)^-1 1).
Elasticity isotropic_bound(const Matrix& C, const double (&shear)[3], double expansion) {
  constexpr int tries = 4000;  // just off the singular ends, where round-off would rule
  const double least = std::max({shear[0], shear[1], shear[2]}), most = std::max(least, C[0][0] + C[1][1] + C[2][2]);
  double best_two_mu = most, best_lambda = 0;
  for (int k = 0; k <= tries; ++k) {
    const double two_mu = least + (most - least) * k / tries + 1e-4 * most;
    Matrix m;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) m[i][j] = (i == j ? two_mu : 0) - C[i][j];
    double sum = 0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) sum += cofactor(m, i, j);
    const double lambda = std::max(-determinant(m) / sum * (1 + 1e-9), -0.3 * two_mu);
    if (!std::isfinite(lambda) || !covers(C, two_mu, lambda)) continue;
    if (lambda + two_mu < best_lambda + best_two_mu) best_two_mu = two_mu, best_lambda = lambda;
  }
  const double mu = 0.5 * best_two_mu * (1 + 2e-6);  // what `covers` may have missed
  return {mu * (3 * best_lambda + 2 * mu) / (best_lambda + mu), best_lambda / (2 * (best_lambda + mu)), expansion};
}

}  // namespace

std::optional<std::string> OrthotropicElastic::objection(const OrthotropicParameters& p) {
  // [Jon99] ch. 2.4: the leading minors of the compliance must be positive.
  Matrix s;
  compliance(p, s);
  if (!(cofactor(s, 2, 2) > 0)) return "nu12^2 must be less than E1/E2";
  if (!(cofactor(s, 0, 0) > 0)) return "nu23^2 must be less than E2/E3";
  if (!(cofactor(s, 1, 1) > 0)) return "nu31^2 must be less than E3/E1";
  if (!(determinant(s) > 0)) return "Poisson's ratios nu12, nu23 and nu31 are too great together";
  return std::nullopt;
}

OrthotropicElastic::OrthotropicElastic(const OrthotropicParameters& p, double expansion)
    : shear{2 * p.G12, 2 * p.G23, 2 * p.G31}, start{p.axis_1[0], p.axis_1[1], p.axis_1[2],
                                                    p.axis_2[0], p.axis_2[1], p.axis_2[2]} {
  Matrix s;
  compliance(p, s);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) normal[i][j] = cofactor(s, j, i) / determinant(s);
  elasticity = isotropic_bound(normal, shear, expansion);
}

void OrthotropicElastic::update(const UpdateInput& input, Batch<6>& stress, Batch<6>& state,
                                Batch<1>& plastic_work) const {
  constexpr int from[6] = {0, 1, 2, 0, 1, 2}, to[6] = {0, 1, 2, 1, 2, 0};
  const auto &e = input.strain_increment.v, &axes = state.v;
  auto& s = stress.v;
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    double n[3][3];  // rows: the axes
    for (int j = 0; j < 3; ++j) n[0][j] = axes[j][l], n[1][j] = axes[j + 3][l];
    n[2][0] = n[0][1] * n[1][2] - n[0][2] * n[1][1];
    n[2][1] = n[0][2] * n[1][0] - n[0][0] * n[1][2];
    n[2][2] = n[0][0] * n[1][1] - n[0][1] * n[1][0];
    const double thermal = elasticity.expansion * input.temperature_increment.v[0][l];
    const double x = e[0][l] - thermal, y = e[1][l] - thermal, z = e[2][l] - thermal;
    const double xy = e[3][l], yz = e[4][l], zx = e[5][l];
    double strain[6], t[6];
    for (int c = 0; c < 6; ++c) {
      const double *a = n[from[c]], *b = n[to[c]];
      strain[c] = a[0] * (x * b[0] + xy * b[1] + zx * b[2]) + a[1] * (xy * b[0] + y * b[1] + yz * b[2]) +
                  a[2] * (zx * b[0] + yz * b[1] + z * b[2]);
    }
    for (int c = 0; c < 3; ++c) {
      t[c] = normal[c][0] * strain[0] + normal[c][1] * strain[1] + normal[c][2] * strain[2];
      t[c + 3] = shear[c] * strain[c + 3];
    }
    for (int c = 0; c < 6; ++c) {
      const int i = from[c], j = to[c];
      s[c][l] += n[0][i] * (t[0] * n[0][j] + t[3] * n[1][j] + t[5] * n[2][j]) +
                 n[1][i] * (t[3] * n[0][j] + t[1] * n[1][j] + t[4] * n[2][j]) +
                 n[2][i] * (t[5] * n[0][j] + t[4] * n[1][j] + t[2] * n[2][j]);
    }
    plastic_work.v[0][l] = 0;
  }
}

}  // namespace tenon
