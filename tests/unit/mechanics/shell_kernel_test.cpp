// SPDX-License-Identifier: BSD-3-Clause
// The shell element by itself: quadrature, rigid motions, transposes, and its stable step against dense eigenvalues.
#include <random>

#include "components/mechanics/shell4_section.hpp"
#include "components/mechanics/shell4_step.hpp"
#include "mechanics_case.hpp"

namespace tenon::testing {
namespace {

using V = Vector<double>;

TEST(ThroughThickness, IntegratesPolynomialsExactly) {
  for (const bool lobatto : {false, true})
    for (int n = lobatto ? 3 : 1; n <= 10; ++n) {
      const ThroughThickness rule =
          through_thickness(lobatto ? ShellSection::Rule::lobatto : ShellSection::Rule::gauss, n);
      for (int degree = 0; degree <= (lobatto ? 2 * n - 3 : 2 * n - 1); ++degree) {
        double sum = 0;
        for (std::size_t i = 0; i < rule.place.size(); ++i) sum += rule.weight[i] * std::pow(rule.place[i], degree);
        EXPECT_NEAR(sum, degree % 2 ? 0.0 : 1.0 / (degree + 1), 1e-14) << n << " points, degree " << degree;
      }
      EXPECT_NEAR(rule.second_moment(), n == 1 ? 0.0 : 1.0 / 12, 1e-15);
    }
}

template <typename S>
ShellModes<double> modes(const V (&a)[4]) {
  return S::template modes<double>(a[0], a[1] - a[0], a[2] - a[0], S::nodes == 4 ? a[3] - a[0] : V{});
}

template <typename S>
ShellGeometry<double> geometry(const V (&x)[4]) {
  const ShellModes<double> m = modes<S>(x);
  const Tensor<double> axes = provisional_axes(m);
  return shell_geometry<S>(m, {dot(axes.x, m.xi), dot(axes.y, m.xi), dot(axes.x, m.eta), dot(axes.y, m.eta)});
}

template <typename S>
ShellRates<double> rates(const ShellGeometry<double>& g, const V (&v)[4], const V (&w)[4]) {
  const auto local = [&](const ShellModes<double>& m) {
    return ShellModes<double>{g.axes * m.mean, g.axes * m.xi, g.axes * m.eta, g.axes * m.hourglass};
  };
  return shell_rates<S>(g, local(modes<S>(v)), local(modes<S>(w)));
}

double size(const ShellRates<double>& r) {
  double sum = 0;
  for (const double x : r.membrane) sum += x * x;
  for (const double x : r.curvature) sum += x * x;
  for (const double x : r.shear) sum += x * x;
  return std::sqrt(sum);
}

/// A unit square, moved about by up to `plane` and `warp`, its x stretched.
void shape(std::mt19937& random, double plane, double warp, double stretch, V (&x)[4]) {
  std::uniform_real_distribution<double> u(-1, 1);
  const V corners[4] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  for (int i = 0; i < 4; ++i)
    x[i] = {stretch * (corners[i].x + plane * u(random)), corners[i].y + plane * u(random), warp * u(random)};
}

template <typename S>
void expect_no_strain() {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int trial = 0; trial < 200; ++trial) {
    V x[4], v[4]{}, w[4]{};
    shape(random, 0.2, 0.3, 1, x);
    const V shift{u(random), u(random), u(random)}, turn{u(random), u(random), u(random)};
    for (int i = 0; i < S::nodes; ++i) v[i] = shift + cross(turn, x[i]), w[i] = turn;
    const ShellRates<double> r = rates<S>(geometry<S>(x), v, w);
    EXPECT_LT(size(r), 1e-14);
    for (int i = 0; i < S::hourglasses; ++i) EXPECT_LT(std::abs(r.hourglass[i]), 1e-14);
    for (int i = 0; i < S::drills; ++i) EXPECT_LT(std::abs(r.drill[i]), 1e-14);
  }
}

TEST(ShellKernel, RigidMotionsOfWarpedElementsStrainNothing) {
  expect_no_strain<QuadShell>();
  expect_no_strain<TriShell>();
}

struct Stiffness {
  double bound, greatest;
  int zero_modes;
};

/// Eigenvalues of the matrix by Jacobi rotations.
std::vector<double> eigenvalues(std::vector<std::vector<double>> k) {
  const std::size_t n = k.size();
  for (int sweep = 0; sweep < 40; ++sweep)
    for (std::size_t p = 0; p < n; ++p)
      for (std::size_t q = p + 1; q < n; ++q) {
        if (std::abs(k[p][q]) < 1e-15 * (std::abs(k[p][p]) + std::abs(k[q][q]))) continue;
        const double t = 0.5 * std::atan2(2 * k[p][q], k[p][p] - k[q][q]), c = std::cos(t), s = std::sin(t);
        for (std::size_t i = 0; i < n; ++i) {
          const double a = k[i][p], b = k[i][q];
          k[i][p] = c * a + s * b, k[i][q] = c * b - s * a;
        }
        for (std::size_t i = 0; i < n; ++i) {
          const double a = k[p][i], b = k[q][i];
          k[p][i] = c * a + s * b, k[q][i] = c * b - s * a;
        }
      }
  std::vector<double> values;
  for (std::size_t i = 0; i < n; ++i) values.push_back(k[i][i]);
  return values;
}

/// Resultants of an elastic element of Young's modulus 1, as ShellGroup forms them.
template <typename S>
ShellResultants<double> elastic(const ShellGeometry<double>& g, const ShellStiffness<double>& k, ShellRates<double> r) {
  ShellResultants<double> q{};
  const double at = g.area * k.thickness, lambda = k.moduli.lambda, mu = k.moduli.shear;
  const auto plane = [&](const double(&e)[3], double f, double(&to)[3]) {
    to[0] = f * ((lambda + 2 * mu) * e[0] + lambda * e[1]), to[1] = f * ((lambda + 2 * mu) * e[1] + lambda * e[0]);
    to[2] = f * mu * e[2];
  };
  for (int i = 0; i < 3; ++i) r.membrane[i] += k.offset * r.curvature[i];
  plane(r.membrane, at, q.membrane);
  plane(r.curvature, at * k.second_moment, q.curvature);
  for (int i = 0; i < 3; ++i) q.curvature[i] += k.offset * q.membrane[i];
  for (int i = 0; i < 2; ++i) q.shear[i] = at * k.shear_modulus * r.shear[i];
  const double g11 = dot(g.g1, g.g1), g22 = dot(g.g2, g.g2);
  if (S::nodes == 4) {
    for (int i = 0; i < 2; ++i) r.hourglass[i] += k.offset * r.hourglass[i + 2];
    for (int i = 0; i < 6; ++i) {
      const double m = i % 2 ? g22 : g11, young = k.moduli.young * m;
      const double f = i < 2 ? young : (i < 4 ? young * k.second_moment : k.shear_modulus);
      q.hourglass[i] = at / 3 * m * f * r.hourglass[i];
    }
    for (int i = 0; i < 2; ++i) q.hourglass[i + 2] += k.offset * q.hourglass[i];
  } else {
    q.hourglass[0] = 0.01 * at / 18 * k.shear_modulus * (g11 + dot(g.g1, g.g2) + g22) * r.hourglass[0];
  }
  for (int i = 0; i < S::drills; ++i) q.drill[i] = k.drilling * r.drill[i];
  return q;
}

template <typename S>
Stiffness examine(const V (&x)[4], double nu, double t, double offset) {
  constexpr int n = S::nodes;
  const ShellGeometry<double> g = geometry<S>(x);
  const double mu = 1 / (2 * (1 + nu)), lambda = nu / ((1 + nu) * (1 - 2 * nu));
  const double share = n == 4 ? 1 : 1 / (1 + 0.2 * g.area / (t * t));
  const ShellStiffness<double> k{plane_moduli(lambda, mu), t, t * t / 12, offset, 5.0 / 6 * share * mu,
                                 1e-3 * t * t * t / 12};
  const double mass = g.area * t, inertia = rotary_inertia(g.area, t * t / 12, offset, nu);
  std::vector<std::vector<double>> matrix(6 * n, std::vector<double>(6 * n));
  for (int column = 0; column < 6 * n; ++column) {
    V v[4]{}, w[4]{};
    V& unit = column % 6 < 3 ? v[column / 6] : w[column / 6];
    const double scale = column % 6 < 3 ? 1 : 1 / std::sqrt(inertia);
    (column % 3 == 0 ? unit.x : column % 3 == 1 ? unit.y : unit.z) = scale;
    const ShellForces<double> f = shell_forces<S>(g, elastic<S>(g, k, rates<S>(g, v, w)));
    V forces[4], moments[4];
    S::share(f.force, forces), S::share(f.moment, moments);
    for (int i = 0; i < n; ++i) {
      const auto global = [&](const V& a) { return a.x * g.axes.x + a.y * g.axes.y + a.z * g.axes.z; };
      const V force = global(forces[i]), moment = (1 / std::sqrt(inertia)) * global(moments[i]);
      const double rows[6] = {force.x, force.y, force.z, moment.x, moment.y, moment.z};
      for (int c = 0; c < 6; ++c)
        matrix[static_cast<std::size_t>(6 * i + c)][static_cast<std::size_t>(column)] = n / mass * rows[c];
    }
  }
  Stiffness result{shell_frequency_squared<S>(g, k, mass, 1 / inertia), 0, 0};
  double asymmetry = 0, greatest = 0;
  for (std::size_t i = 0; i < matrix.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      asymmetry = std::max(asymmetry, std::abs(matrix[i][j] - matrix[j][i]));
      greatest = std::max(greatest, std::abs(matrix[i][j]));
    }
  EXPECT_LT(asymmetry, 1e-12 * greatest) << "forces are the transpose of rates";
  const std::vector<double> values = eigenvalues(matrix);
  result.greatest = *std::max_element(values.begin(), values.end());
  for (const double value : values) result.zero_modes += std::abs(value) < 1e-12 * result.greatest ? 1 : 0;
  return result;
}

/// Ratios of the estimated to the true step over random shapes: least and greatest.
template <typename S>
std::pair<double, double> step_ratios(double nu, double t, double offset, double plane, double warp, double stretch) {
  std::mt19937 random(7);
  double least = 2, greatest = 0;
  for (int trial = 0; trial < 40; ++trial) {
    V x[4];
    shape(random, plane, warp, stretch, x);
    const Stiffness s = examine<S>(x, nu, t, offset);
    if (t > 0.01) {
      EXPECT_EQ(s.zero_modes, 6) << "only rigid motions are free";
    }
    const double ratio = std::sqrt(s.greatest / s.bound);
    least = std::min(least, ratio), greatest = std::max(greatest, ratio);
  }
  return {least, greatest};
}

TEST(ShellStep, IsNeverAboveTheTrueLimit) {
  for (const double nu : {0.0, 0.3, 0.49})
    for (const double t : {0.001, 0.1, 0.5, 2.0})
      for (const double offset : {0.0, 0.5})
        for (const double stretch : {1.0, 4.0})
          for (const double warp : {0.0, 0.05, 0.3}) {
            const double quad = step_ratios<QuadShell>(nu, t, offset * t, 0.2, warp, stretch).second;
            const double triangle = step_ratios<TriShell>(nu, t, offset * t, 0.2, warp, stretch).second;
            EXPECT_LE(quad, 1 + 1e-9) << nu << " " << t << " " << offset << " " << stretch << " " << warp;
            EXPECT_LE(triangle, 1 + 1e-9) << nu << " " << t << " " << offset << " " << stretch << " " << warp;
          }
}

TEST(ShellStep, IsCloseToTheTrueLimit) {
  for (const double t : {0.001, 0.1, 0.5}) {
    EXPECT_GT(step_ratios<QuadShell>(0.3, t, 0, 0, 0, 1).first, 0.999) << "square, t = " << t;
    EXPECT_GT(step_ratios<QuadShell>(0.3, t, 0, 0, 0, 3).first, 0.97) << "rectangle, t = " << t;
    EXPECT_GT(step_ratios<QuadShell>(0.3, t, 0, 0.2, 0, 1).first, 0.85) << "distorted, t = " << t;
  }
  EXPECT_GT(step_ratios<TriShell>(0.3, 0.1, 0, 0.2, 0, 1).first, 0.85);
}

}  // namespace
}  // namespace tenon::testing
