// SPDX-License-Identifier: BSD-3-Clause
// A rigid rotation changes nothing but directions: 360 steps of 1 degree, then 36 of 10 (case A02).
#include <numbers>

#include "components/mechanics/hex8_group.hpp"
#include "mechanics_case.hpp"

namespace tenon::testing {
namespace {

using Kind = PrescribedMotion::Kind;

BoxShape block_shape() {
  BoxShape box;
  box.elements = {2, 2, 2};
  box.distortion = 0.3;
  return box;
}

Vec3 rotated(const Vec3& x, double angle) {
  const Vec3 n = (1 / std::sqrt(14.0)) * Vec3{1, 2, 3};
  return x + std::sin(angle) * cross(n, x) + 2 * std::pow(std::sin(0.5 * angle), 2) * cross(n, cross(n, x));
}

TEST(Objectivity, TheComponentStaysFreeOfStress) {
  MechanicsOptions options;
  PrescribedMotion turn = motion(Kind::rotation, {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"});
  turn.axis = {1, 2, 3};
  turn.factor = TimeFunction::table({{0, 0}, {360, 2 * std::numbers::pi}});
  options.motions.push_back(turn);
  // The one inner node follows because nothing deforms.
  const double rate = 2 * std::numbers::pi / 360;
  options.initial_velocity_function = [rate](const Vec3& x) { return rotated(x, rate) - x; };
  options.time_step.fixed = 1;
  BoxShape box = block_shape();
  box.elements = {1, 2, 2};  // every node on the surface
  const auto m = body(shared_mesh(on_root(box)), steel(), options);
  m->initialize();
  for (int s = 0; s < 360; ++s) m->advance(1.0);
  double most = 0;
  for (const double s : field(*m, "stress")) most = std::max(most, std::abs(s));
  // Positions are round-off exact at every step, so strains never drift: 1e-16 x E x a few.
  EXPECT_LT(communicator().max(most), 1e-14 * 210e9);
}

/// One block driven node by node, without the component.
class RotatedBlock {
 public:
  explicit RotatedBlock(HourglassOptions::Form form) : mesh_(generate(block_shape())), nodes_(mesh_.coordinates) {
    for (const GlobalId n : mesh_.blocks[0].connectivity) block_.connectivity.push_back(static_cast<LocalIndex>(n));
    block_.ids.resize(mesh_.elements());
    group_ = make_hex8_group(0, block_, mesh_.coordinates, steel(), {form, 0.05}, {});
    for (const StateArray& array : group_->state()) arrays_[array.name] = array;
  }
  LocalIndex size() const { return group_->size(); }
  double& state(const std::string& name, LocalIndex element, int row) { return arrays_.at(name).at(element, row); }
  void turn(double from, double to, int steps) {
    for (int s = 1; s <= steps; ++s) {
      const double angle = from + (to - from) * s / steps, dt = 1e-3;
      for (std::size_t n = 0; n < nodes_.size(); ++n) {
        const Vec3 x = rotated(mesh_.coordinates[n], angle);
        nodes_.velocity()[n] = (1 / dt) * (x - nodes_.position()[n]);
        nodes_.position()[n] = x;
      }
      group_->advance(nodes_.arrays(), dt);
    }
  }

 private:
  MeshData mesh_;
  ElementBlock block_;
  NodalState nodes_;
  std::unique_ptr<ElementGroup> group_;
  std::map<std::string, StateArray> arrays_;
};

TEST(Objectivity, StressRotatesWithTheBody) {
  RotatedBlock b(HourglassOptions::Form::viscous);
  for (LocalIndex e = 0; e < b.size(); ++e) b.state("stress", e, 0) = 100e6;
  double angle = 0;
  for (const int steps : {90, 270, 9, 27}) {
    const double next = angle + (steps == 90 || steps == 9 ? 0.5 : 1.5) * std::numbers::pi;
    b.turn(angle, next, steps);
    angle = next;
    const Vec3 x = rotated({1, 0, 0}, angle);
    const double expected[6] = {x[0] * x[0], x[1] * x[1], x[2] * x[2], x[0] * x[1], x[1] * x[2], x[2] * x[0]};
    for (LocalIndex e = 0; e < b.size(); ++e)
      for (int c = 0; c < 6; ++c) EXPECT_NEAR(b.state("stress", e, c), 100e6 * expected[c], 1e-10 * 100e6) << angle;
  }
}

TEST(Objectivity, HourglassForcesRotateWithTheBody) {
  RotatedBlock b(HourglassOptions::Form::stiffness);
  for (LocalIndex e = 0; e < b.size(); ++e)
    for (int i = 0; i < 12; ++i) b.state("hourglass_forces", e, i) = 1e5 * (i + 1 + e);
  b.turn(0, std::numbers::pi, 18);
  const Vec3 given = 1e5 * Vec3{4, 5, 6}, expected = rotated(given, std::numbers::pi);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(b.state("hourglass_forces", 0, 3 + c), expected[static_cast<std::size_t>(c)], 1e-10 * norm(given));
    EXPECT_GT(std::abs(expected[static_cast<std::size_t>(c)] - given[static_cast<std::size_t>(c)]), 1e4);
  }
  b.turn(std::numbers::pi, 2 * std::numbers::pi, 180);
  for (LocalIndex e = 0; e < b.size(); ++e)
    for (int i = 0; i < 12; ++i) EXPECT_NEAR(b.state("hourglass_forces", e, i), 1e5 * (i + 1 + e), 1e-10 * 1e7);
}

/// Stresses of the physical form stand in axes that turn with the element: a rotation leaves them as they are.
TEST(Objectivity, PhysicalHourglassStressesStayInTheElement) {
  RotatedBlock b(HourglassOptions::Form::physical);
  for (LocalIndex e = 0; e < b.size(); ++e)
    for (int i = 0; i < 12; ++i) b.state("hourglass_forces", e, i) = 1e5 * (i + 1 + e);
  b.turn(0, 2 * std::numbers::pi, 100);
  for (LocalIndex e = 0; e < b.size(); ++e)
    for (int i = 0; i < 12; ++i) EXPECT_NEAR(b.state("hourglass_forces", e, i), 1e5 * (i + 1 + e), 1e-8 * 1e7);
}

}  // namespace
}  // namespace tenon::testing
