// SPDX-License-Identifier: BSD-3-Clause
// Resultants and work of loads against closed forms.
#include "components/mechanics/element_kinds.hpp"
#include "components/mechanics/nodal_load.hpp"
#include "components/mechanics/surface_load.hpp"
#include "framework/mesh/shape_functions.hpp"
#include "mechanics_case.hpp"

namespace tenon::testing {
namespace {

const std::vector<std::string> faces{"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};

class Field final : public Formula {
 public:
  explicit Field(std::function<double(double, const Vec3&)> f) : f_(std::move(f)) {}
  double value(double t, const Vec3& x) const override { return f_(t, x); }

 private:
  std::function<double(double, const Vec3&)> f_;
};

SpaceTimeFunction in_space(std::function<double(double, const Vec3&)> f) {
  return SpaceTimeFunction::formula(std::make_shared<Field>(std::move(f)));
}
SpaceTimeFunction always(double value) {
  return SpaceTimeFunction::constant(value);
}

SurfaceLoad pressure(std::vector<std::string> sets, SpaceTimeFunction p) {
  return {SurfaceLoad::Kind::pressure, std::move(sets), {std::move(p)}, "pressure"};
}

/// A box with warped sides: its corners and all nodes moved by a smooth map.
std::shared_ptr<const Mesh> warped_box() {
  BoxShape shape;
  shape.high = {2, 1, 1};
  shape.elements = {5, 3, 4};
  shape.distortion = 0.2;
  MeshData data = on_root(shape);
  for (Vec3& x : data.coordinates)
    x = {x[0] + 0.2 * std::sin(2 * x[1]) * x[2], x[1] - 0.15 * std::cos(x[0] + x[2]), x[2] + 0.1 * x[0] * x[1] * x[2]};
  return shared_mesh(std::move(data));
}

struct Resultant {
  Vec3 force{}, moment{};
  double size = 0;  ///< sum of |f|
};

Resultant resultant(const Mesh& mesh, const NodalState& nodes, const Load& load) {
  std::vector<ForceRow> force(nodes.size() + 1);
  const ElementGroups none = [&] {
    ElementGroups groups;
    for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
      groups.push_back(
          make_element_group(b, mesh.blocks[b], mesh.coordinates, {mesh.blocks[b].name, steel(), {}, {}}, {}));
    return groups;
  }();
  NodalState copy = nodes;
  load.add_forces({copy, none, 0}, force);
  std::array<ExactSum, 7> sums;
  for (const LocalIndex node : mesh.owned_nodes) {
    const auto n = static_cast<std::size_t>(node);
    const Vec3 f{force[n].v[0], force[n].v[1], force[n].v[2]}, moment = cross(nodes.position()[n], f);
    for (std::size_t c = 0; c < 3; ++c) sums[c].add(f[c]), sums[3 + c].add(moment[c]);
    sums[6].add(norm(f));
  }
  std::array<double, 7> total{};
  mesh.comm.sum(sums, total);
  return {{total[0], total[1], total[2]}, {total[3], total[4], total[5]}, total[6]};
}

double volume(const Mesh& mesh) {
  ExactSum sum;
  for (const ElementBlock& block : mesh.blocks)
    for (LocalIndex e = 0; e < block.size(); ++e) {
      if (block.owners[static_cast<std::size_t>(e)] != mesh.comm.rank()) continue;
      std::vector<Vec3> corners;
      for (const LocalIndex n : block.nodes(e)) corners.push_back(mesh.coordinates[static_cast<std::size_t>(n)]);
      sum.add(element_measure(block.kind, corners));
    }
  return mesh.comm.sum(sum);
}

TEST(Loads, PressureOnAClosedSurfaceHasNoResultant) {
  const auto mesh = warped_box();
  const Resultant r =
      resultant(*mesh, NodalState(mesh->coordinates), SurfaceForce(*mesh, pressure(faces, always(3e5))));
  EXPECT_GT(r.size, 1e6);
  EXPECT_LE(norm(r.force), 1e-15 * r.size);
  EXPECT_LE(norm(r.moment), 1e-15 * r.size);
}

TEST(Loads, HydrostaticPressureLiftsByTheDisplacedWeight) {
  const auto mesh = warped_box();
  const double weight = 9810;
  const auto depth = in_space([&](double, const Vec3& x) { return weight * (5 - x[2]); });
  const Resultant r = resultant(*mesh, NodalState(mesh->coordinates), SurfaceForce(*mesh, pressure(faces, depth)));
  EXPECT_NEAR(r.force[2], weight * volume(*mesh), 1e-13 * r.size);
  EXPECT_LE(std::hypot(r.force[0], r.force[1]), 1e-13 * r.size);
}

TEST(Loads, PressureFollowsTheSurfaceAndTractionDoesNot) {
  BoxShape shape;
  shape.elements = {2, 2, 2};
  const auto mesh = shared_mesh(on_root(shape));
  NodalState nodes(mesh->coordinates);
  for (Vec3& x : nodes.position()) x = {-3 * x[1], 2 * x[0], x[2]};  // turned by a quarter and stretched
  const Resultant p = resultant(*mesh, nodes, SurfaceForce(*mesh, pressure({"x_max"}, always(-10))));
  EXPECT_NEAR(norm(p.force - Vec3{0, 30, 0}), 0, 1e-13);  // suction on a face of 3 m^2 that looks to +y now
  using Kind = SurfaceLoad::Kind;
  for (const auto& [kind, area] : {std::pair(Kind::reference_traction, 1.0), std::pair(Kind::current_traction, 3.0)}) {
    const Resultant t =
        resultant(*mesh, nodes, SurfaceForce(*mesh, {kind, {"x_max"}, {always(1), always(2), always(-5)}, "traction"}));
    EXPECT_NEAR(norm(t.force - area * Vec3{1, 2, -5}), 0, 1e-13);
  }
}

TEST(Loads, TrianglesCarryTheSameResultant) {
  BoxShape shape;
  shape.high = {2, 1, 1};
  shape.elements = {4, 3, 2};
  shape.tetrahedra = true;
  const auto mesh = shared_mesh(on_root(shape));
  // A set that is named twice counts once. p = x on 2 m x 1 m: 2 N at x = 4/3 m, z = 1/2 m.
  const auto p = in_space([](double, const Vec3& x) { return x[0]; });
  const Resultant r =
      resultant(*mesh, NodalState(mesh->coordinates), SurfaceForce(*mesh, pressure({"y_max", "y_max"}, p)));
  EXPECT_NEAR(norm(r.force - Vec3{0, -2, 0}), 0, 1e-14);
  EXPECT_NEAR(norm(r.moment - Vec3{1, 0, -8.0 / 3}), 0, 1e-14);
}

TEST(Loads, UnknownAndUnfitSetsAreRefused) {
  const auto mesh = shared_mesh(on_root(BoxShape{}));
  const auto refusal = [&](const auto& make) -> std::string {
    try {
      make();
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_NE(refusal([&] { SurfaceForce(*mesh, pressure({"lid"}, always(1))); }).find("no side set 'lid'"),
            std::string::npos);
  const auto plate = shared_mesh(on_root(PlateShape{}));
  EXPECT_NE(refusal([&] { SurfaceForce(*plate, pressure({"x_min"}, always(1))); }).find("is an edge"),
            std::string::npos);
  EXPECT_NE(refusal([&] {
              NodalLoad(*mesh, NodalForce{{"lid"}, {}, false, "force"});
            }).find("no node set 'lid'"),
            std::string::npos);
}

TEST(Loads, AFallingBodyFollowsTheParabola) {
  MechanicsOptions options;
  options.initial_velocities.push_back({"", "", {1, 2, 3}, {}, {}});
  options.loads.body_forces.push_back({{}, {always(0.5), always(0), always(-9.81)}, "gravity"});
  const auto b = body(warped_box(), steel(), options);
  b->initialize();
  Ledger ledger(*b);
  for (int s = 0; s < 200; ++s) b->advance(b->time_step() * (s % 2 ? 1 : 0.3));
  const double t = b->time();
  const std::vector<double> u = field(*b, "displacement");
  const Vec3 expected = t * Vec3{1, 2, 3} + 0.5 * t * t * Vec3{0.5, 0, -9.81};
  for (std::size_t n = 0; 3 * n < u.size(); ++n)
    for (std::size_t c = 0; c < 3; ++c) ASSERT_NEAR(u[3 * n + c], expected[c], 5e-14);
  EXPECT_LE(ledger.error(), 1e-13);
  const auto rows = energy_rows(*b);
  // Velocities, and so the work, are those of half a step before.
  const double mass = steel().density * volume(b->mesh());
  const Vec3 start{1, 2, 3}, last = start + (t - 0.5 * b->time_step()) * Vec3{0.5, 0, -9.81};
  EXPECT_NEAR(rows.at("body_work"), 0.5 * mass * (dot(last, last) - dot(start, start)), 1e-11 * mass);
  EXPECT_NEAR(rows.at("internal_energy"), 0, 1e-9 * rows.at("kinetic_energy"));
}

TEST(Loads, SharedForceAndItsWork) {
  MechanicsOptions options;
  const auto at_rest = [&](bool shared) {
    options.loads.nodal_forces = {{{"x_max", "x_min"}, {always(6), always(0), always(0)}, shared, "force"}};
    BoxShape shape;
    shape.elements = {1, 2, 2};
    return body(shared_mesh(on_root(shape)), elastic_material(1e7, 0, 1000), options);
  };
  for (const bool shared : {true, false}) {
    const auto b = at_rest(shared);
    b->initialize();
    Ledger ledger(*b);
    for (int s = 0; s < 50; ++s) b->advance(b->time_step());
    // All nodes are in the sets; momentum after the last half step is F (t - dt/2).
    ExactSum momentum;
    for (const LocalIndex n : b->mesh().owned_nodes)
      momentum.add(b->nodal_mass()[static_cast<std::size_t>(n)] *
                   field(*b, "velocity")[3 * static_cast<std::size_t>(n)]);
    const double force = shared ? 6.0 : 18 * 6.0, half = 0.5 * b->time() / 50;
    EXPECT_NEAR(b->mesh().comm.sum(momentum), force * (b->time() - half), 1e-12 * force * b->time());
    EXPECT_LE(ledger.error(), 1e-13);
  }
}

TEST(Loads, PrescribedAccelerationIsExactAndItsWorkBooked) {
  MechanicsOptions options;
  PrescribedMotion m = motion(PrescribedMotion::Kind::acceleration, {"x_min"});
  m.components = {true, false, true};
  m.value[0] = TimeFunction::constant(1e4);
  options.initial_velocities.push_back({"", "", {1, 0, 0}, {}, {}});
  options.motions = {m};
  BoxShape shape;
  shape.elements = {4, 2, 2};
  const auto b = body(shared_mesh(on_root(shape)), steel(), options);
  b->initialize();
  Ledger ledger(*b);
  run_to(*b, 1e-3);
  const std::vector<double> u = field(*b, "displacement");
  for (const LocalIndex n : nodes_of_sets(b->mesh(), {"x_min"}, "test")) {
    const auto i = 3 * static_cast<std::size_t>(n);
    EXPECT_NEAR(u[i], 1e-3 + 0.5 * 1e4 * 1e-6, 1e-14);
    EXPECT_EQ(u[i + 2], 0);
  }
  EXPECT_LE(ledger.error(), 1e-12);
}

}  // namespace
}  // namespace tenon::testing
