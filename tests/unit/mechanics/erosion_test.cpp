// SPDX-License-Identifier: BSD-3-Clause
// Elements that are taken out by their step or their shape, what they expose, and the nodes that they leave.
#include <filesystem>
#include <set>

#include "constraints_case.hpp"
#include "shell_case.hpp"
#include "solid_meshes.hpp"

namespace tenon::testing {
namespace {

using Kind = PrescribedMotion::Kind;
using Loose = ErosionOptions::LooseNodes;

MaterialDescription soft_metal() {
  MaterialDescription m = elastic_material(10e9, 0.3, 7850);
  m.plasticity = LinearHardeningParameters{20e6, 10e6};
  return m;
}

/// A body that hits a wall, so that the elements at its foot get flat and are taken out.
struct Case {
  MeshData data;
  bool shells = false;

  static Case solid(ElementKind kind) { return {solid_box(box({0, 0, 0}, {2, 2, 6}, {2, 2, 5}, 0.1), kind)}; }
  static Case shell() {
    return {shell_grid({3, 6, ShellGrid::Cells::mixed},
                       [](double r, double t) {
                         return Vec3{2 * r, 0, 6 * t};
                       }),
            true};
  }
  std::shared_ptr<const Mesh> shared() const {
    MeshData copy = data;
    return shared_mesh(std::move(copy));
  }
  /// `least`: the step below which elements go, s.
  std::unique_ptr<Mechanics> make(std::shared_ptr<const Mesh> mesh, double least, Loose loose) const {
    MechanicsOptions o;
    o.erosion.loose_nodes = loose;
    o.erosion.minimum_step = least;
    o.viscosity = {0.06, 1.2};
    o.initial_velocities = {{"", "", {30, 0, -250}, {}, {}}};
    o.walls.push_back({{0, 0, 0}, {0, 0, 1}, TimeFunction::constant(0), {}, "wall"});
    auto b =
        shells ? shell_body(std::move(mesh), soft_metal(), section(0.2), o) : body(std::move(mesh), soft_metal(), o);
    b->contact_party();
    return b;
  }
  double least() const {
    const auto b = make(shared(), 1e-12, Loose::keep);
    b->initialize();
    return 0.5 * b->time_step();
  }
};

struct Face {
  GlobalId id;
  double depth, thickness;
  auto operator<=>(const Face&) const = default;
};
struct Ball {
  GlobalId node;
  double radius;
  auto operator<=>(const Ball&) const = default;
};
struct Skin {
  std::vector<Face> faces;
  std::vector<Ball> balls;
  bool operator==(const Skin&) const = default;
};

/// What contact sees, of all ranks, on rank 0.
Skin skin_of(Mechanics& b) {
  const Mesh& mesh = b.mesh();
  std::vector<ContactFace> faces;
  std::vector<ContactParticle> balls;
  b.contact_party()->contact_faces(faces);
  b.contact_party()->contact_particles(balls);
  std::vector<Face> mine;
  std::vector<Ball> mine_too;
  for (const ContactFace& f : faces) mine.push_back({f.id, f.depth, f.thickness});
  for (const ContactParticle& p : balls)
    mine_too.push_back({mesh.node_ids[static_cast<std::size_t>(p.node)], p.radius});
  Skin all{mesh.comm.gather<Face>(mine), mesh.comm.gather<Ball>(mine_too)};
  std::ranges::sort(all.faces), std::ranges::sort(all.balls);
  return all;
}

/// Ids of faces and nodes that should show, by a search through all living elements of a body that one rank holds.
std::pair<std::set<GlobalId>, std::set<GlobalId>> brute_force(Mechanics& b) {
  const std::vector<double> alive = field(b, "element_status");
  std::map<std::set<LocalIndex>, std::set<GlobalId>> covers;
  std::set<GlobalId> ids, nodes;
  std::size_t at = 0;
  for (const LocalIndex n : b.mesh().owned_nodes) nodes.insert(n);
  for (const ElementBlock& block : b.mesh().blocks)
    for (LocalIndex e = 0; e < block.size(); ++e, ++at) {
      const Topology& kind = topology(block.kind);
      if (alive[at] == 0) continue;
      for (const LocalIndex n : block.nodes(e)) nodes.erase(n);
      for (std::size_t s = 0; s < static_cast<std::size_t>(kind.dimension == 2 ? 1 : kind.sides); ++s) {
        std::set<LocalIndex> key;
        for (std::size_t a = 0; a < static_cast<std::size_t>(kind.side_nodes[s]); ++a)
          key.insert(block.nodes(e)[static_cast<std::size_t>(kind.side[s][a])]);
        covers[key].insert(8 * block.ids[static_cast<std::size_t>(e)] + static_cast<GlobalId>(s));
      }
    }
  for (const auto& [key, all] : covers)
    if (all.size() == 1) ids.insert(*all.begin());
  return {ids, nodes};
}

void expect_skin(Mechanics& whole, const Skin& seen, bool balls) {
  if (communicator().rank() != 0) return;
  const auto [ids, nodes] = brute_force(whole);
  std::set<GlobalId> faces, particles;
  for (const Face& f : seen.faces) faces.insert(f.id);
  for (const Ball& p : seen.balls) particles.insert(p.node);
  EXPECT_EQ(faces, ids);
  if (balls) {
    EXPECT_EQ(particles, nodes);
  }
  for (const Ball& p : seen.balls) EXPECT_TRUE(p.radius > 0 && p.radius < 0.6) << p.radius;
}

double failed(Mechanics& b) {
  double sum = 0;
  for (const HistoryValue& value : b.history_values())
    if (value.column == "failed_elements") sum = value.local;
  return static_cast<double>(b.mesh().comm.sum(static_cast<std::int64_t>(sum)));
}

void check_collapse(const char* name, const Case& c, Loose loose) {
  const double least = c.least();
  const auto shared = c.make(c.shared(), least, loose);
  const auto whole = c.make(whole_mesh(c.data), least, loose);
  shared->initialize(), whole->initialize();
  Ledger ledger(*shared);
  double worst = 0, dead = 0;
  int waves = 0;
  for (int s = 0; s < 120; ++s) {
    ASSERT_EQ(shared->time_step(), whole->time_step()) << "step " << s;
    const std::int64_t version = shared->contact_party()->surface_version();
    const double dt = std::min(shared->time_step(), 2 * least);
    shared->advance(dt), whole->advance(dt);
    const double error = ledger.error();
    ASSERT_TRUE(std::isfinite(error));
    worst = std::max(worst, error);
    const double now = failed(*shared);
    if (now != dead) {
      EXPECT_NE(version, shared->contact_party()->surface_version()) << "step " << s;
      const Skin seen = skin_of(*shared);
      EXPECT_TRUE(seen == skin_of(*whole)) << "step " << s;
      if (++waves < 5) expect_skin(*whole, seen, loose == Loose::keep);
    }
    dead = now;
  }
  std::printf("%s: %g elements gone in %d steps, ledger %.2g\n", name, dead, waves, worst);
  EXPECT_GT(dead, 2);
  EXPECT_LT(worst, 1e-12);
  for (const char* field : {"displacement", "velocity", "stress", "element_status"})
    expect_same_bits(in_global_order(*shared, field), in_global_order(*whole, field), field);
  EXPECT_EQ(energy_rows(*shared), energy_rows(*whole));
}

TEST(Erosion, HexahedraWhoseStepCollapses) {
  check_collapse("hex8", Case::solid(ElementKind::hex8), Loose::keep);
  check_collapse("hex8", Case::solid(ElementKind::hex8), Loose::remove);
}

TEST(Erosion, TetrahedraWhoseStepCollapses) {
  check_collapse("tet4", Case::solid(ElementKind::tet4), Loose::keep);
  check_collapse("tet4", Case::solid(ElementKind::tet4), Loose::remove);
}

TEST(Erosion, WedgesWhoseStepCollapses) {
  check_collapse("wedge6", Case::solid(ElementKind::wedge6), Loose::remove);
}

TEST(Erosion, ShellsWhoseStepCollapses) {
  check_collapse("shells", Case::shell(), Loose::keep);
  check_collapse("shells", Case::shell(), Loose::remove);
}

void check_restart(const Case& c, Loose loose) {
  const std::string file = "mechanics_erosion_" + std::to_string(communicator().size()) + ".h5";
  const double least = c.least();
  const auto whole = c.make(c.shared(), least, loose);
  whole->initialize();
  // Right after a step in which an element was doomed: that is what a restart has to find again.
  int s = 0;
  for (double dead = 0; s < 200 && (s < 20 || failed(*whole) == dead); ++s) {
    dead = failed(*whole);
    whole->advance(std::min(whole->time_step(), 2 * least));
  }
  ASSERT_LT(s, 200);
  {
    CheckpointWriter writer(communicator(), file);
    whole->save(writer);
    writer.finish();
  }
  const auto continued = c.make(c.shared(), least, loose);
  {
    const CheckpointReader reader(communicator(), file);
    continued->set_clock(whole->time());
    continued->load(reader);
  }
  continued->initialize();
  EXPECT_EQ(failed(*continued), failed(*whole));
  for (int k = 0; k < 40; ++k) {
    ASSERT_EQ(whole->time_step(), continued->time_step()) << k;
    whole->advance(std::min(whole->time_step(), 2 * least)),
        continued->advance(std::min(continued->time_step(), 2 * least));
  }
  for (const char* name : {"displacement", "velocity", "stress", "element_status"})
    expect_same_bits(in_global_order(*continued, name), in_global_order(*whole, name), name);
  EXPECT_EQ(energy_rows(*continued), energy_rows(*whole));
  EXPECT_TRUE(skin_of(*continued) == skin_of(*whole));
  communicator().barrier();
  if (communicator().rank() == 0) std::filesystem::remove(file);
}

TEST(Erosion, ContinuesBitwiseFromACheckpoint) {
  check_restart(Case::solid(ElementKind::hex8), Loose::keep);
  check_restart(Case::solid(ElementKind::tet4), Loose::remove);
  check_restart(Case::shell(), Loose::remove);
}

TEST(Erosion, AMinimumAboveTheFirstStepIsRefused) {
  const Case c = Case::solid(ElementKind::hex8);
  const auto b = c.make(c.shared(), 10 * c.least(), Loose::keep);
  EXPECT_THROW(b->initialize(), Error);
}

// A cube that is pressed through itself.
TEST(Erosion, ElementsInsideOutStopTheRunOrAreTakenOut) {
  MechanicsOptions o;
  PrescribedMotion flat = motion(Kind::gradient, {"z_max"});
  flat.gradient = {0, 0, 0, 0, 0, 0, 0, 0, -1};
  flat.factor = TimeFunction::table({{0, 0}, {2e-3, 2}});
  o.motions = {motion(Kind::fixed, {"z_min"}), flat};
  o.time_step.collapse = 0;
  const auto run = [&] {
    const auto b = body(shared_mesh(on_root(box({0, 0, 0}, {1, 1, 1}, {1, 1, 1}))), steel(), o);
    b->initialize();
    while (b->time() < 1.1e-3) b->advance(std::min(b->time_step(), 2e-5));
    return energy_rows(*b);
  };
  o.time_step.fixed = 2e-5;
  EXPECT_THROW(run(), Error);
  o.erosion.inverted = true;
  const std::map<std::string, double> rows = run();
  for (const auto& [row, value] : rows) EXPECT_TRUE(std::isfinite(value)) << row;
  EXPECT_GT(rows.at("eroded_energy"), 0);
}

// Case A13c with removal: everything leaves with what it had.
TEST(Erosion, RemovedNodesLeaveMassMomentumAndEnergyBehind) {
  MaterialDescription metal = steel();
  metal.failure.emplace().tensile_stress = 1e3;
  MechanicsOptions o;
  o.erosion.loose_nodes = Loose::remove;
  o.initial_velocity_function = [](const Vec3& x) { return Vec3{7 + 100 * x[0], 50 * x[1] - 3, 20 * x[2] * x[0]}; };
  const auto b = body(shared_mesh(on_root(box({0, 0, 0}, {1, 1, 1}, {2, 1, 1}))), metal, o);
  b->initialize();
  std::array<ExactSum, 4> before;
  for (const LocalIndex n : b->mesh().owned_nodes) {
    const auto i = static_cast<std::size_t>(n);
    const std::vector<double> v = field(*b, "velocity");
    before[0].add(b->nodal_mass()[i]);
    for (std::size_t c = 0; c < 3; ++c) before[1 + c].add(b->nodal_mass()[i] * v[3 * i + c]);
  }
  std::array<double, 4> start{};
  b->mesh().comm.sum(before, start);
  const double energy = energy_rows(*b).at("kinetic_energy");
  Ledger ledger(*b);
  for (int s = 0; s < 10; ++s) b->advance(std::min(b->time_step(), 1e-5));
  const std::map<std::string, double> rows = energy_rows(*b);
  EXPECT_EQ(rows.at("kinetic_energy"), 0);
  EXPECT_NEAR(rows.at("eroded_energy") / energy, 1, 2e-2);  // the first kick is within
  EXPECT_LT(ledger.error(), 1e-13);
  const std::array<std::string, 4> columns{"removed_mass", "removed_momentum_x", "removed_momentum_y",
                                           "removed_momentum_z"};
  for (const HistoryValue& value : b->history_values()) {
    const auto found = std::ranges::find(columns, value.column);
    if (found == columns.end()) continue;
    const double expected = start[static_cast<std::size_t>(found - columns.begin())];
    EXPECT_NEAR(value.local, expected, 1e-12 * std::abs(start[0] * 100)) << value.column;
  }
  for (const LocalIndex n : b->mesh().owned_nodes) EXPECT_EQ(b->nodal_mass()[static_cast<std::size_t>(n)], 0);
}

}  // namespace
}  // namespace tenon::testing
