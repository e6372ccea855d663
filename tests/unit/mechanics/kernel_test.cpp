// SPDX-License-Identifier: BSD-3-Clause
// The element formulas alone, one element and four at a time.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "components/mechanics/hex8_kernel.hpp"
#include "components/mechanics/hex8_volume.hpp"
#include "framework/mesh/shape_functions.hpp"

namespace tenon {
namespace {

constexpr int signs[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                             {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};

struct Hexahedron {
  std::vector<Vec3> corners;
  std::array<LocalIndex, 8> nodes{0, 1, 2, 3, 4, 5, 6, 7};
  HexModes<double> modes() const { return hex8_modes(nodes, corners); }
};

/// A cube of edge 1 at `where` with corners moved by up to `distortion`.
Hexahedron distorted(unsigned seed, double distortion, const Vec3& where = {0, 0, 0}) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> shift(-distortion, distortion);
  Hexahedron h;
  for (const auto& s : signs)
    h.corners.push_back(where +
                        Vec3{0.5 * s[0] + shift(random), 0.5 * s[1] + shift(random), 0.5 * s[2] + shift(random)});
  return h;
}

std::vector<Vec3> linear_field(const std::vector<Vec3>& x, const std::array<double, 9>& a, const Vec3& b) {
  std::vector<Vec3> v;
  for (const Vec3& p : x)
    v.push_back({b[0] + a[0] * p[0] + a[1] * p[1] + a[2] * p[2], b[1] + a[3] * p[0] + a[4] * p[1] + a[5] * p[2],
                 b[2] + a[6] * p[0] + a[7] * p[1] + a[8] * p[2]});
  return v;
}

/// b_I for each node from the modes.
std::array<Vec3, 8> nodal_gradients(const MeanGradient<double>& b) {
  double x[8], y[8], z[8];
  from_modes(ScalarModes<double>{b.xi.x, b.eta.x, b.zeta.x, b.eta_zeta.x, b.zeta_xi.x, b.xi_eta.x, 0.0}, x);
  from_modes(ScalarModes<double>{b.xi.y, b.eta.y, b.zeta.y, b.eta_zeta.y, b.zeta_xi.y, b.xi_eta.y, 0.0}, y);
  from_modes(ScalarModes<double>{b.xi.z, b.eta.z, b.zeta.z, b.eta_zeta.z, b.zeta_xi.z, b.xi_eta.z, 0.0}, z);
  std::array<Vec3, 8> result;
  for (std::size_t i = 0; i < 8; ++i) result[i] = {x[i] / 64, y[i] / 64, z[i] / 64};
  return result;
}

TEST(HexModes, GatherAndScatterAreTransposes) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> value(-1, 1);
  double u[8], w[8], m[7];
  for (double& x : u) x = value(random);
  for (double& x : m) x = value(random);
  const ScalarModes<double> s = scalar_modes(u);
  from_modes(ScalarModes<double>{m[0], m[1], m[2], m[3], m[4], m[5], m[6]}, w);
  double left = 0, right = 0;
  for (int i = 0; i < 8; ++i) left += u[i] * w[i];
  const double modes[7] = {s.xi, s.eta, s.zeta, s.eta_zeta, s.zeta_xi, s.xi_eta, s.xi_eta_zeta};
  for (int i = 0; i < 7; ++i) right += modes[i] * m[i];
  EXPECT_NEAR(left, right, 1e-14);
}

TEST(MeanGradient, IsTheIntegralOfTheShapeGradients) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Hexahedron h = distorted(seed, 0.2);
    const MeanGradient<double> b = mean_gradient(h.modes());
    EXPECT_NEAR(b.volume_192 / 192, element_measure(ElementKind::hex8, h.corners), 1e-14);
    // 2 x 2 x 2 Gauss points integrate the cofactors times dN/dxi exactly.
    std::array<Vec3, 8> expected{};
    for (const auto& s : signs) {
      const double g = 1 / std::sqrt(3.0);
      const Vec3 xi{g * s[0], g * s[1], g * s[2]};
      std::array<Vec3, 8> dn;
      shape_gradients(ElementKind::hex8, xi, dn);
      Vec3 column[3]{};
      for (std::size_t i = 0; i < 8; ++i)
        for (std::size_t j = 0; j < 3; ++j) column[j] = column[j] + dn[i][j] * h.corners[i];
      const Vec3 cofactor[3] = {cross(column[1], column[2]), cross(column[2], column[0]), cross(column[0], column[1])};
      for (std::size_t i = 0; i < 8; ++i)
        for (std::size_t j = 0; j < 3; ++j) expected[i] = expected[i] + dn[i][j] * cofactor[j];
    }
    const std::array<Vec3, 8> found = nodal_gradients(b);
    for (std::size_t i = 0; i < 8; ++i) EXPECT_LT(norm(found[i] - expected[i]), 1e-14);
  }
}

TEST(MeanGradient, GivesLinearFieldsExactly) {
  const std::array<double, 9> a{0.3, -1.2, 0.7, 0.1, 2.0, -0.4, 0.9, 0.5, -1.1};
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Hexahedron h = distorted(seed, 0.2, {10, -3, 5});
    const Tensor<double> l =
        velocity_gradient(hex8_modes(h.nodes, linear_field(h.corners, a, {1, 2, 3})), mean_gradient(h.modes()));
    const double found[9] = {l.x.x, l.x.y, l.x.z, l.y.x, l.y.y, l.y.z, l.z.x, l.z.y, l.z.z};
    for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(found[i], a[i], 5e-14);
  }
}

TEST(MeanGradient, ProductsAreSumsOverTheNodes) {
  const Hexahedron h = distorted(7, 0.25);
  const MeanGradient<double> b = mean_gradient(h.modes());
  const SymmetricTensor<double> g = gradient_products(b);
  SymmetricTensor<double> expected{0, 0, 0, 0, 0, 0};
  for (const Vec3& n : nodal_gradients(b)) {
    expected.xx += n[0] * n[0], expected.yy += n[1] * n[1], expected.zz += n[2] * n[2];
    expected.xy += n[0] * n[1], expected.yz += n[1] * n[2], expected.zx += n[2] * n[0];
  }
  EXPECT_NEAR(g.xx, expected.xx, 1e-14);
  EXPECT_NEAR(g.yy, expected.yy, 1e-14);
  EXPECT_NEAR(g.zz, expected.zz, 1e-14);
  EXPECT_NEAR(g.xy, expected.xy, 1e-14);
  EXPECT_NEAR(g.yz, expected.yz, 1e-14);
  EXPECT_NEAR(g.zx, expected.zx, 1e-14);
}

// case A14 b: the gamma projection leaves no force for linear velocities on any shape (unprojected: 0.12).
TEST(Hourglass, LinearVelocitiesMeetNoResistance) {
  const std::array<double, 9> a{0.3, -1.2, 0.7, 0.1, 2.0, -0.4, 0.9, 0.5, -1.1};
  double unprojected = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Hexahedron h = distorted(seed, 0.2);
    const HexModes<double> x = h.modes(), v = hex8_modes(h.nodes, linear_field(h.corners, a, {1, 2, 3}));
    const HourglassVectors<double> q = hourglass_rates(x, v, velocity_gradient(v, mean_gradient(x)));
    EXPECT_LT(std::sqrt(product(q, q)), 1e-13);
    unprojected = std::max(unprojected, std::abs(v.xi_eta.x));
  }
  EXPECT_GT(unprojected, 0.1);
}

TEST(Kinematics, RigidRotationHasNoStrainAndTheExactAngle) {
  const Vec3 axis = (1 / std::sqrt(14.0)) * Vec3{1, 2, 3};
  for (const double degrees : {0.1, 1.0, 10.0, 90.0, 170.0}) {
    const double angle = degrees * std::numbers::pi / 180, s = std::sin(angle), c = 1 - std::cos(angle);
    const Hexahedron h = distorted(11, 0.2);
    std::vector<Vec3> moved, velocity;
    for (const Vec3& x : h.corners) {
      const Vec3 y = x + s * cross(axis, x) + c * cross(axis, cross(axis, x));
      moved.push_back(y), velocity.push_back(y - x);
    }
    const HexModes<double> x = hex8_modes(h.nodes, moved), v = hex8_modes(h.nodes, velocity);
    const StepDeformation<double> step =
        step_deformation(velocity_gradient(v, mean_gradient(mid_step(x, v, 1.0))), 1.0);
    EXPECT_LT(std::sqrt(squared_norm(step.strain_increment)), 1e-13 / std::cos(0.5 * angle));
    const Vec3 given{0.2, -0.5, 0.7}, expected = given + s * cross(axis, given) + c * cross(axis, cross(axis, given));
    const Vector<double> found = step.rotation * Vector<double>{given[0], given[1], given[2]};
    EXPECT_LT(norm(Vec3{found.x, found.y, found.z} - expected), 1e-12) << degrees;
  }
}

TEST(StableStep, EigenvalueBoundIsAboveAndTight) {
  const auto bound = [](double a, double b, double c) {
    return greatest_eigenvalue_bound(SymmetricTensor<double>{a, b, c, 0, 0, 0});
  };
  EXPECT_NEAR(bound(2, 2, 2), 2, 1e-9);
  EXPECT_NEAR(bound(5, 2, 2), 5, 1e-9);
  EXPECT_NEAR(bound(5, 3, 1), 5, 0.01);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> value(0, 1);
  for (int i = 0; i < 1000; ++i) {
    const double a = value(random), b = value(random), c = value(random), most = std::max({a, b, c});
    EXPECT_GE(bound(a, b, c), most * (1 - 1e-8));
    EXPECT_LE(bound(a, b, c), most * 1.05);
  }
  // Invariant: the same tensor in other axes.
  const SymmetricTensor<double> rotated_tensor{3.5, 3.5, 1, 1.5, 0, 0};  // 5, 2, 1
  EXPECT_NEAR(greatest_eigenvalue_bound(rotated_tensor), bound(5, 2, 1), 1e-12);
}

TEST(StableStep, DampingShortensIt) {
  EXPECT_DOUBLE_EQ(damped_step(4.0, 0.0, 0.0), 1.0);
  // dt^2/4 omega^2 + dt/2 c = 1
  const double dt = damped_step(4.0, 1.5, 0.0);
  EXPECT_NEAR(dt * dt + 0.75 * dt, 1, 1e-14);
  EXPECT_DOUBLE_EQ(damped_step(4.0, 0.0, 10.0), 0.2);
}

// Four elements at once do what one does, wherever they stand in the batch.
TEST(Pack, MatchesOneElementAtATime) {
  std::vector<Vec3> x, v;
  HexConnectivity connectivity{};
  for (int l = 0; l < lanes; ++l) {
    const Hexahedron h = distorted(static_cast<unsigned>(20 + l), 0.15),
                     rates = distorted(static_cast<unsigned>(40 + l), 0.3);
    for (std::size_t i = 0; i < 8; ++i) {
      connectivity.node[i][l] = static_cast<std::int32_t>(x.size());
      x.push_back(h.corners[i]), v.push_back(rates.corners[i]);
    }
  }
  x.push_back({}), v.push_back({});
  const HexParameters<ViscousHourglass> parameters{{0.06, 1.5}, {0.1}};
  for (int lane = 0; lane < lanes; lane += pack_width) {
    const HexModes<Pack> xp = gather(x.data()->data(), connectivity, lane),
                         vp = gather(v.data()->data(), connectivity, lane);
    const auto all = [](double value) { return broadcast<Pack>(value); };
    const SymmetricTensor<Pack> stress{all(1), all(2), all(3), all(0.4), all(0.5), all(0.6)};
    Batch<1> none;
    const ElementForces<Pack> f =
        element_forces(xp, vp, stress, {all(0.7), all(1.0), all(1.0)}, {all(1.2), all(0.8)}, parameters, none, 0, 0.01);
    for (int l = 0; l < pack_width; ++l) {
      std::array<LocalIndex, 8> nodes;
      for (std::size_t i = 0; i < 8; ++i) nodes[i] = connectivity.node[i][lane + l];
      const HexModes<double> x1 = hex8_modes(nodes, x), v1 = hex8_modes(nodes, v);
      const ElementForces<double> g = element_forces(x1, v1, SymmetricTensor<double>{1, 2, 3, 0.4, 0.5, 0.6},
                                                     {0.7, 1.0, 1.0}, {1.2, 0.8}, parameters, none, 0, 0.01);
      EXPECT_NEAR(f.x.xi[l], g.x.xi, 1e-13);
      EXPECT_NEAR(f.y.eta_zeta[l], g.y.eta_zeta, 1e-13);
      EXPECT_NEAR(f.z.xi_eta_zeta[l], g.z.xi_eta_zeta, 1e-13);
      EXPECT_NEAR(f.volume[l], g.volume, 1e-14);
      EXPECT_NEAR(f.step[l], g.step, 1e-13);
      EXPECT_NEAR(f.hourglass_energy[l], g.hourglass_energy, 1e-14);
      EXPECT_NEAR(f.viscosity_energy[l], g.viscosity_energy, 1e-14);
    }
  }
}

TEST(ElementForces, AreInEquilibriumAndSpendTheirPower) {
  const Hexahedron h = distorted(3, 0.2), rates = distorted(4, 0.4);
  const HexModes<double> x = h.modes(), v = hex8_modes(h.nodes, rates.corners);
  const HexParameters<ViscousHourglass> parameters{{0.06, 1.5}, {0.1}};
  const SymmetricTensor<double> stress{1, 2, 3, 0.4, 0.5, 0.6};
  Batch<1> none;
  const double dt = 0.01;
  const ElementForces<double> f = element_forces(x, v, stress, {0.7, 1.0, 1.0}, {1.2, 0.8}, parameters, none, 0, dt);
  double fx[8], fy[8], fz[8];
  from_modes(f.x, fx), from_modes(f.y, fy), from_modes(f.z, fz);
  Vec3 sum{}, moment{};
  double power = 0;
  for (std::size_t i = 0; i < 8; ++i) {
    const Vec3 force{fx[i], fy[i], fz[i]};
    sum = sum + force, moment = moment + cross(h.corners[i], force);
    power += dot(force, rates.corners[i]);
  }
  EXPECT_LT(norm(sum), 1e-14);
  EXPECT_LT(norm(moment), 1e-14);
  const Tensor<double> l = velocity_gradient(v, mean_gradient(x));
  const double stress_power =
      f.volume * (stress.xx * l.x.x + stress.yy * l.y.y + stress.zz * l.z.z + stress.xy * (l.x.y + l.y.x) +
                  stress.yz * (l.y.z + l.z.y) + stress.zx * (l.z.x + l.x.z));
  EXPECT_NEAR(power, stress_power + (f.hourglass_energy + f.viscosity_energy) / dt, 1e-12);
  EXPECT_GT(f.hourglass_energy, 0);
  EXPECT_GT(f.viscosity_energy, 0);
}

TEST(ElementForces, BadElementsAreCoded) {
  Hexahedron h = distorted(1, 0.1);
  const HexParameters<NoHourglass> parameters{{0.06, 1.5}, {}};
  const SymmetricTensor<double> stress{0, 0, 0, 0, 0, 0};
  const HexModes<double> rest = hex8_modes(h.nodes, std::vector<Vec3>(8, Vec3{1, 1, 1}));
  Batch<1> none;
  EXPECT_GT(element_forces(h.modes(), rest, stress, {1.0, 1.0, 1.0}, {1.2, 0.8}, parameters, none, 0, 1.0).step, 0);
  std::vector<Vec3> fast;
  for (const Vec3& x : h.corners) fast.push_back(200.0 * x);
  EXPECT_EQ(element_forces(h.modes(), hex8_modes(h.nodes, fast), stress, {1.0, 1.0, 1.0}, {1.2, 0.8}, parameters, none,
                           0, 1.0)
                .step,
            exploding_element);
  std::vector<Vec3> mirrored;
  for (const Vec3& x : h.corners) mirrored.push_back({-x[0], x[1], x[2]});
  EXPECT_EQ(
      element_forces(hex8_modes(h.nodes, mirrored), rest, stress, {1.0, 1.0, 1.0}, {1.2, 0.8}, parameters, none, 0, 1.0)
          .step,
      inverted_element);
  h.corners[3][1] = std::nan("");
  EXPECT_EQ(element_forces(h.modes(), rest, stress, {1.0, 1.0, 1.0}, {1.2, 0.8}, parameters, none, 0, 1.0).step,
            exploding_element);
}

static_assert(HourglassForm<NoHourglass>);
static_assert(HourglassForm<ViscousHourglass>);
static_assert(HourglassForm<StiffnessHourglass>);

}  // namespace
}  // namespace tenon
