// SPDX-License-Identifier: BSD-3-Clause
// Shells under stress turned about a skew axis (case A02 b), and the resultant of pressure on their faces.
#include <numbers>

#include "components/mechanics/shell4_group.hpp"
#include "shell_case.hpp"

namespace tenon::testing {
namespace {

constexpr double pi = std::numbers::pi;

Vec3 warped(double r, double s) {
  return {r + 0.2 * r * s, s - 0.1 * r * r, 0.1 * r * s + 0.05 * r};
}

Vec3 rotated(const Vec3& x, double angle) {
  const Vec3 n = (1 / std::sqrt(14.0)) * Vec3{1, 2, 3};
  return x + std::sin(angle) * cross(n, x) + 2 * std::pow(std::sin(0.5 * angle), 2) * cross(n, cross(n, x));
}

/// One block of shells driven node by node, without the component.
class RotatedShell {
 public:
  RotatedShell(ShellGrid::Cells cells, const MaterialDescription& material)
      : mesh_(shell_grid({2, 2, cells}, warped)), nodes_(mesh_.coordinates) {
    block_.kind = mesh_.blocks[0].kind;
    for (const GlobalId n : mesh_.blocks[0].connectivity) block_.connectivity.push_back(static_cast<LocalIndex>(n));
    block_.ids.resize(mesh_.elements());
    nodes_.add_rotations();
    group_ = make_shell_group(0, block_, mesh_.coordinates, material, section(0.01, 5), {});
    // Uniaxial in the element's own axes.
    for (const StateArray& array : group_->state())
      for (LocalIndex e = 0; array.name == "stress" && e < group_->size(); ++e)
        for (int row = 0; row < array.rows; row += 6) array.at(e, row) = 100e6;
    group_->fill_padding();
  }
  void turn(double from, double to, int steps) {
    const double angle = (to - from) / steps, dt = 1e-3;
    const Vec3 spin = (2 * std::tan(0.5 * angle) / dt / std::sqrt(14.0)) * Vec3{1, 2, 3};
    for (int s = 1; s <= steps; ++s) {
      for (std::size_t n = 0; n < nodes_.size(); ++n) {
        const Vec3 x = rotated(mesh_.coordinates[n], from + s * angle);
        nodes_.velocity()[n] = (1 / dt) * (x - nodes_.position()[n]);
        nodes_.position()[n] = x, nodes_.spin()[n] = spin;
      }
      group_->advance(nodes_.arrays(), dt);
    }
  }
  const ElementGroup& group() const { return *group_; }

 private:
  MeshData mesh_;
  ElementBlock block_;
  NodalState nodes_;
  std::unique_ptr<ElementGroup> group_;
};

void expect_turning_stress(ShellGrid::Cells cells, const MaterialDescription& material) {
  constexpr int first[6] = {0, 1, 2, 0, 1, 2}, second[6] = {0, 1, 2, 1, 2, 0};
  RotatedShell b(cells, material);
  std::vector<Vec3> axis;  // of the stress, from 100 MPa a a
  for (LocalIndex e = 0; e < b.group().size(); ++e) {
    const double xx = b.group().stress(e, 0);
    axis.push_back((1 / std::sqrt(100e6 * xx)) * Vec3{xx, b.group().stress(e, 3), b.group().stress(e, 5)});
  }
  double angle = 0;
  for (const int steps : {90, 270, 9, 27}) {  // 360 of 1 degree, 36 of 10
    const double next = angle + (steps == 90 || steps == 9 ? 0.5 : 1.5) * pi;
    b.turn(angle, next, steps);
    angle = next;
    for (LocalIndex e = 0; e < b.group().size(); ++e) {
      const Vec3 a = rotated(axis[static_cast<std::size_t>(e)], angle);
      for (int c = 0; c < 6; ++c) {
        const double exact = 100e6 * a[static_cast<std::size_t>(first[c])] * a[static_cast<std::size_t>(second[c])];
        EXPECT_NEAR(b.group().stress(e, c), exact, 1e-10 * 100e6) << angle << " " << e << " " << c;
        EXPECT_NEAR(b.group().face_stress(e, c, true), exact, 1e-10 * 100e6) << angle << " " << e << " " << c;
      }
      EXPECT_NEAR(b.group().thickness(e), 0.01, 1e-14);
    }
  }
}

TEST(ShellObjectivity, StressTurnsWithTheShell) {
  MaterialDescription hard = steel(), curved = steel();
  hard.plasticity = LinearHardeningParameters{400e6, 1e9};
  curved.plasticity = VoceHardeningParameters{{400e6, 600e6, 10}};
  for (const ShellGrid::Cells cells : {ShellGrid::Cells::quads, ShellGrid::Cells::triangles})
    for (const MaterialDescription& material : {steel(), hard, curved}) expect_turning_stress(cells, material);
}

// The first step from rest: every node moves by dt^2/2 f/m. The area vector of any surface over straight edges is half
// the sum of x_i cross x_(i+1) around them.
TEST(ShellPressure, ResultantIsThatOfTheSurfaceOfTheNodes) {
  constexpr int n = 4;
  constexpr double pressure = 1.5;
  std::vector<Vec3> edge;
  for (int i = 0; i < n; ++i) edge.push_back(warped(double(i) / n, 0));
  for (int i = 0; i < n; ++i) edge.push_back(warped(1, double(i) / n));
  for (int i = 0; i < n; ++i) edge.push_back(warped(1 - double(i) / n, 1));
  for (int i = 0; i < n; ++i) edge.push_back(warped(0, 1 - double(i) / n));
  Vec3 area{};
  for (std::size_t i = 0; i < edge.size(); ++i) area = area + 0.5 * cross(edge[i], edge[(i + 1) % edge.size()]);

  for (const ShellGrid::Cells cells : {ShellGrid::Cells::quads, ShellGrid::Cells::mixed})
    for (const ShellSection::Reference reference :
         {ShellSection::Reference::middle, ShellSection::Reference::top, ShellSection::Reference::at}) {
      ShellSection thick = section(0.3);
      thick.reference = reference, thick.offset = 0.2;
      MechanicsOptions options;
      options.time_step.fixed = 1;
      SurfaceLoad load;
      load.side_sets = {"top"}, load.label = "pressure";
      for (auto& value : load.value) value = SpaceTimeFunction::constant(0);
      load.value[0] = SpaceTimeFunction::constant(pressure);
      options.loads.surface_loads = {load};
      const auto body = shell_body(whole_mesh(shell_grid({n, n, cells}, warped)), steel(), thick, options);
      body->initialize();
      body->advance(1);
      Vec3 force{};
      for (std::size_t i = 0; i < body->nodal_mass().size(); ++i)
        force = force + 2 * body->nodal_mass()[i] * (body->current_coordinates()[i] - body->mesh().coordinates[i]);
      EXPECT_LT(norm(force + pressure * area), 1e-10 * pressure * norm(area));
      EXPECT_GT(norm(area), 0.9);
    }
}

}  // namespace
}  // namespace tenon::testing
