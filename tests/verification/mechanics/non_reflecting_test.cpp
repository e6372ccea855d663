// SPDX-License-Identifier: BSD-3-Clause
// Pulses that leave the mesh through non-reflecting boundaries.
#include "constraints_case.hpp"

namespace tenon::testing {
namespace {

/// The pulse of case A03 in a bar of n elements, longitudinal or transverse; the share of its energy that is left after
/// it has met the end.
double left_over(int n, bool shear, bool absorbing) {
  const double e = 210e9, nu = 0.3, rho = 7850;
  const double along = std::sqrt(e * (1 - nu) / ((1 + nu) * (1 - 2 * nu)) / rho),
               across = std::sqrt(e / (2 * (1 + nu)) / rho);
  const double speed = shear ? across : along;
  MechanicsOptions o;
  o.viscosity = {0, 0};
  o.hourglass.form = HourglassOptions::Form::none;
  const double h = 1.0 / n;
  // u(x, 0) and v = -c u' of a pulse to the right. The start is at rest in place: displacements come from the motion of
  // a velocity that is the same in time, so the pulse is given by its velocity and by initial stress.
  const auto slope = [](double x) { return -2 * (x - 0.5) / 0.0025 * 1e-5 * std::exp(-std::pow((x - 0.5) / 0.05, 2)); };
  o.initial_velocity_function = [=](const Vec3& x) {
    const double v = -speed * slope(x[0]);
    return shear ? Vec3{0, v, 0} : Vec3{v, 0, 0};
  };
  class Stress final : public Formula {
   public:
    explicit Stress(std::function<double(double)> f) : f_(std::move(f)) {}
    double value(double, const Vec3& x) const override { return f_(x[0]); }

   private:
    std::function<double(double)> f_;
  };
  InitialStress initial{{}, {}, "pulse"};
  const double lambda = rho * (along * along - 2 * across * across);
  const auto set = [&](std::size_t c, double modulus) {
    initial.stress[c] =
        SpaceTimeFunction::formula(std::make_shared<Stress>([=](double x) { return modulus * slope(x); }));
  };
  if (shear)
    set(3, rho * across * across);
  else
    set(0, rho * along * along), set(1, lambda), set(2, lambda);
  o.loads.initial_stresses = {initial};
  PrescribedMotion rollers = motion(PrescribedMotion::Kind::fixed, {"y_min", "y_max", "z_min", "z_max"});
  rollers.components = {shear, !shear, true};
  o.motions = {rollers};
  if (absorbing) o.loads.non_reflecting = {{{"x_max"}, "non_reflecting"}};
  const auto b = body(shared_mesh(on_root(box({0, 0, 0}, {1, h, h}, {n, 1, 1}))), elastic_material(e, nu, rho), o);
  b->initialize();
  const double start = energy_rows(*b).at("kinetic_energy");
  Ledger ledger(*b);
  run_to(*b, 0.9 / speed);
  EXPECT_LE(ledger.error(), 1e-12);
  const auto rows = energy_rows(*b);
  if (absorbing) {
    EXPECT_NEAR(rows.at("absorbed_energy") / (2 * start), 1, 0.01);
  }
  return rows.at("kinetic_energy") / start;
}

TEST(NonReflecting, PulsesLeaveAtNormalIncidence) {
  for (const bool shear : {false, true}) {
    const double left = left_over(200, shear, true);
    std::printf("%s: %.3g of the energy left\n", shear ? "shear" : "longitudinal", left);
    EXPECT_LE(left, 0.01);
    EXPECT_GE(left_over(50, shear, false), 0.5);  // without it all of it comes back
  }
}

}  // namespace
}  // namespace tenon::testing
