// SPDX-License-Identifier: BSD-3-Clause
// Impulses between the halves of a step: books, momentum and bits of a body that something pushes.
#include <filesystem>
#include <set>

#include "constraints_case.hpp"

namespace tenon::testing {
namespace {

using Kind = PrescribedMotion::Kind;

MeshData bodies() {
  return joined({{"a", box({0, 0, 0}, {1, 1, 1.2}, {2, 2, 4}, 0.2), 1},
                 {"b", box({2, 0, 0}, {3, 1, 1}, {2, 2, 3}, 0.2)},
                 {"c", box({4, 0, 0}, {5, 1, 1}, {2, 2, 2}, 0.2)},
                 {"d", box({6, 0, 0}, {7, 1, 1}, {1, 2, 2})},
                 {"e", box({8, 0, 0}, {9, 1, 1}, {1, 1, 2})},
                 {"f", box({9, 0, 0}, {10, 1, 1}, {1, 3, 3})},
                 {"g", box({3, 0, 0}, {3.8, 1, 1}, {1, 3, 3})}});
}

/// Held, guided and falling nodes, free, hinged and driven rigid bodies, loads and damping; and, if asked for, parts
/// tied to a rigid body and to guided nodes.
MechanicsOptions everything(bool tied = false) {
  MechanicsOptions o;
  o.initial_velocities = {{"", "", {1, 2, -3}, {0, -3, 0, 3, 0, 0, 0, 0, 0}, {}}};
  PrescribedMotion pulled = motion(Kind::velocity, {"b_x_min"});
  pulled.components = {true, false, true};
  pulled.value = {TimeFunction::constant(3), TimeFunction::constant(0), TimeFunction::constant(-7)};
  PrescribedMotion tilted = motion(Kind::symmetry, {"b_x_max"});
  tilted.normal = {2, 1, 0.5};
  PrescribedMotion bonded = motion(Kind::wall, {"c_z_max"});
  bonded.normal = {0, 0, 1}, bonded.centre = {0, 0, 1};
  o.motions = {pulled, tilted, bonded, motion(Kind::fixed, {"c_x_max"})};
  o.walls.push_back({{0, 0, 0}, {0, 0, 1}, TimeFunction::constant(0), {"c_z_min", "b_z_min"}, "wall"});
  o.walls.push_back({{0, -1e-4, 0}, {0, 0.8, 0.6}, TimeFunction::constant(0), {"c_y_min"}, "slope"});
  LoadOptions& l = o.loads;
  l.body_forces.push_back({{}, {always(0), always(5), always(-9.81)}, "gravity"});
  l.damping = {100, 0};
  RigidBody free, hinged, driven;
  free.blocks = {"a_top"}, free.label = "free";
  hinged.blocks = {"d"}, hinged.label = "hinged";
  hinged.joint = Vec3{6.2, 0.1, 0.3}, hinged.rotation = RigidBody::Rotation::hinge, hinged.axis = {1, 2, 2};
  driven.blocks = {"e"}, driven.label = "driven";
  driven.prescribed_velocity[1] = TimeFunction::constant(4);
  l.rigid_bodies = {free, hinged, driven};
  if (tied) l.ties = {{{"f_x_min"}, {"e_x_max"}, 0.05, "tied 1"}, {{"g_x_min"}, {"b_x_max"}, 0.05, "tied 2"}};
  return o;
}

/// In (-1, 1), the same wherever it is computed.
double random_of(std::int64_t a, std::int64_t b, std::int64_t c) {
  std::uint64_t x = static_cast<std::uint64_t>(a * 1000003 + b * 10007 + c * 101 + 12345);
  x = (x ^ (x >> 31)) * 0x7fb5d329728ea185ull;
  x = (x ^ (x >> 27)) * 0x81dadef4bc2dd44dull;
  return 2 * static_cast<double>((x ^ (x >> 33)) >> 11) / 9007199254740992.0 - 1;
}

/// Pushes some nodes and all rigid bodies in every step.
class Pusher {
 public:
  explicit Pusher(Mechanics& body) : body_(body), party_(*body.contact_party()) {
    for (const LocalIndex n : body.mesh().owned_nodes)
      if (body.mesh().node_ids[static_cast<std::size_t>(n)] % 3 != 1) watched_.push_back(n);
    party_.watch(watched_);
  }
  void step(double dt, std::int64_t step) {
    body_.begin_step(dt);
    for (int round = 0; round < 2; ++round) act(2 * step + round);
    body_.end_step(dt);
  }
  /// Greatest difference of a change of velocity from w p, m/s; means nothing with ties.
  double worst() const { return worst_; }
  /// What has gone into all nodes and bodies, N s.
  Vec3 given() const { return {sum(0), sum(1), sum(2)}; }

 private:
  double sum(std::size_t c) const { return body_.mesh().comm.sum(given_[c]); }
  void act(std::int64_t step) {
    std::vector<Mobility> mobility(watched_.size());
    party_.mobilities(watched_, mobility);
    std::vector<LocalIndex> nodes;
    std::vector<Vec3> impulses, before;
    for (std::size_t i = 0; i < watched_.size(); ++i) {
      const auto n = static_cast<std::size_t>(watched_[i]);
      const std::int64_t id = body_.mesh().node_ids[n];
      if (mobility[i].body >= 0 || (id + step) % 4 == 0) continue;
      const double size = 0.2 * body_.nodal_mass()[n];
      nodes.push_back(watched_[i]);
      impulses.push_back(size * Vec3{random_of(id, step, 0), random_of(id, step, 1), random_of(id, step, 2)});
      before.push_back(party_.contact_velocities()[n]);
    }
    const std::vector<ContactRigidBody> rigid = party_.contact_rigid_bodies();
    std::vector<BodyImpulse> bodies(rigid.size());
    for (std::size_t b = 0; b < rigid.size(); ++b)
      for (std::size_t c = 0; c < 3; ++c) {
        bodies[b].linear[c] = 30 * random_of(std::int64_t(b), step, std::int64_t(c) + 3);
        bodies[b].angular[c] = 30 * random_of(std::int64_t(b), step, std::int64_t(c) + 6);
      }
    party_.push(nodes, impulses, bodies);
    for (std::size_t c = 0; c < 3; ++c) {
      for (const Vec3& p : impulses) given_[c].add(p[c]);
      for (const BodyImpulse& p : bodies)
        if (body_.mesh().comm.rank() == 0) given_[c].add(p.linear[c]);
    }
    check_nodes(nodes, impulses, before);
    check_bodies(rigid, bodies);
  }
  void check_nodes(const std::vector<LocalIndex>& nodes, const std::vector<Vec3>& p, const std::vector<Vec3>& before) {
    std::vector<Mobility> mobility(nodes.size());
    party_.mobilities(nodes, mobility);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const auto n = static_cast<std::size_t>(nodes[i]);
      const std::array<double, 6>& w = mobility[i].w;
      const Vec3 expected{w[0] * p[i][0] + w[3] * p[i][1] + w[5] * p[i][2],
                          w[3] * p[i][0] + w[1] * p[i][1] + w[4] * p[i][2],
                          w[5] * p[i][0] + w[4] * p[i][1] + w[2] * p[i][2]};
      const Vec3 dv = party_.contact_velocities()[n] - before[i];
      worst_ = std::max(worst_, norm(dv - expected));
    }
  }
  void check_bodies(const std::vector<ContactRigidBody>& before, const std::vector<BodyImpulse>& p) {
    const std::vector<ContactRigidBody> after = party_.contact_rigid_bodies();
    for (std::size_t b = 0; b < before.size(); ++b)
      for (std::size_t i = 0; i < 3; ++i) {
        const double dv = after[b].velocity[i] - before[b].velocity[i];
        double dw = after[b].spin[i] - before[b].spin[i];
        for (std::size_t j = 0; j < 3; ++j) dw -= before[b].inverse_inertia[3 * i + j] * p[b].angular[j];
        worst_ = std::max({worst_, std::abs(dv - before[b].inverse_mass[i] * p[b].linear[i]), std::abs(dw)});
      }
  }

  Mechanics& body_;
  ContactParty& party_;
  std::vector<LocalIndex> watched_;
  double worst_ = 0;
  std::array<ExactSum, 3> given_;
};

void compare(Mechanics& a, Mechanics& b) {
  for (const char* name : {"displacement", "velocity", "stress"})
    expect_same_bits(in_global_order(a, name), in_global_order(b, name), name);
  EXPECT_EQ(energy_rows(a), energy_rows(b));
}

std::unique_ptr<Mechanics> shared_body(bool tied = false) {
  return body(shared_mesh(bodies()), steel(), everything(tied));
}

/// How far the nodes of a set are below z = 0, m.
double below(const Mechanics& b, const std::string& set) {
  double most = 0;
  for (const LocalIndex n : b.mesh().find_node_set(set)->nodes)
    if (b.mesh().owns_node(n)) most = std::max(most, -b.current_coordinates()[static_cast<std::size_t>(n)][2]);
  return most;
}

TEST(ContactSide, BooksOfARandomlyPushedBodyClose) {
  const auto b = shared_body();
  Pusher pusher(*b);
  b->initialize();
  Ledger ledger(*b);
  double worst = 0;
  for (int s = 0; s < 60; ++s) {
    pusher.step(b->time_step(), s);
    worst = std::max(worst, ledger.error());
  }
  std::printf("ledger %.2g, response %.2g\n", worst, pusher.worst());
  EXPECT_LT(worst, 1e-13);
  EXPECT_LT(pusher.worst(), 1e-13);
  EXPECT_LT(below(*b, "c_z_min"), 1e-14);  // the wall holds whatever pushes
  EXPECT_GT(std::abs(energy_rows(*b).at("contact_work")), 1);
}

TEST(ContactSide, BooksOfTiedPartsClose) {
  const auto b = shared_body(true);
  Pusher pusher(*b);
  b->initialize();
  Ledger ledger(*b);
  for (int s = 0; s < 60; ++s) {
    pusher.step(b->time_step(), s);
    EXPECT_LT(ledger.error(), 1e-13);
  }
}

// A free part tied to another, and one tied to a free rigid body: what is pushed in is what they have.
TEST(ContactSide, ImpulsesOnTiedNodesKeepMomentum) {
  MechanicsOptions o;
  RigidBody rigid;
  rigid.blocks = {"e"}, rigid.label = "free";
  o.loads.rigid_bodies = {rigid};
  o.loads.ties = everything(true).loads.ties;
  const auto b = body(shared_mesh(bodies()), steel(), o);
  Pusher pusher(*b);
  b->initialize();
  for (int s = 0; s < 20; ++s) pusher.step(b->time_step(), s);
  const Vec3 given = pusher.given();
  for (std::size_t c = 0; c < 3; ++c) {
    ExactSum momentum;
    if (communicator().rank() == 0)
      momentum.add(b->rigid_bodies().inertia(0).mass * b->rigid_bodies().state(0).velocity[c]);
    for (const LocalIndex n : b->mesh().owned_nodes) {
      const auto i = static_cast<std::size_t>(n);
      momentum.add(b->nodal_mass()[i] * b->contact_party()->contact_velocities()[i][c]);
    }
    EXPECT_NEAR(communicator().sum(momentum), given[c], 1e-11 * norm(given)) << c;
  }
}

TEST(ContactSide, SameBitsOnAnyNumberOfRanks) {
  const auto shared = shared_body(true);
  const auto whole = body(whole_mesh(bodies()), steel(), everything(true));
  Pusher a(*shared), b(*whole);
  shared->initialize(), whole->initialize();
  for (int s = 0; s < 40; ++s) {
    ASSERT_EQ(shared->time_step(), whole->time_step()) << "step " << s;
    a.step(shared->time_step(), s), b.step(whole->time_step(), s);
  }
  compare(*shared, *whole);
}

TEST(ContactSide, ContinuesBitwiseFromACheckpoint) {
  const std::string file = "mechanics_contact_side_" + std::to_string(communicator().size()) + ".h5";
  const auto whole = shared_body(), continued = shared_body();
  Pusher first(*whole);
  whole->contact_party()->contact_fields();
  whole->initialize();
  for (int s = 0; s < 20; ++s) first.step(whole->time_step(), s);
  for (const LocalIndex n : whole->mesh().owned_nodes) {
    const auto id = static_cast<double>(whole->mesh().node_ids[static_cast<std::size_t>(n)]);
    whole->contact_party()->contact_fields().slip[static_cast<std::size_t>(n)] = {id, 2, 3};
    whole->contact_party()->contact_fields().friction_heat[static_cast<std::size_t>(n)] = 0.5 * id;
  }
  {
    CheckpointWriter writer(communicator(), file);
    whole->save(writer);
    writer.finish();
  }
  {
    const CheckpointReader reader(communicator(), file);
    continued->set_clock(whole->time());
    continued->load(reader);
  }
  Pusher second(*continued);
  continued->initialize();
  for (int s = 20; s < 40; ++s) first.step(whole->time_step(), s), second.step(continued->time_step(), s);
  compare(*continued, *whole);
  for (const char* name : {"contact_slip", "friction_heat"})
    expect_same_bits(in_global_order(*continued, name), in_global_order(*whole, name), name);
  for (const double heat : field(*whole, "friction_heat")) EXPECT_EQ(heat, 0);  // was taken
  communicator().barrier();
  if (communicator().rank() == 0) std::filesystem::remove(file);
}

TEST(ContactSide, ABodyThatNothingPushesMovesAsWithoutContact) {
  const auto with = shared_body(), without = shared_body();
  std::vector<LocalIndex> watched(with->mesh().owned_nodes);
  with->contact_party()->watch(watched);
  with->initialize(), without->initialize();
  for (int s = 0; s < 20; ++s) with->advance(with->time_step()), without->advance(without->time_step());
  for (const char* name : {"displacement", "velocity", "stress"})
    expect_same_bits(in_global_order(*with, name), in_global_order(*without, name), name);
  auto rows = energy_rows(*with);
  EXPECT_EQ(rows.at("contact_work"), 0);
  rows.erase("contact_work");
  EXPECT_EQ(rows, energy_rows(*without));
}

TEST(ContactSide, SubcyclingIsRefused) {
  MechanicsOptions o;
  o.time_step.subcycling = 4;
  const auto b = body(shared_mesh(bodies()), steel(), o);
  EXPECT_THROW(b->contact_party(), Error);
}

/// Faces of all ranks, ascending by id, with the global ids of their nodes.
using GlobalFace = std::array<GlobalId, 5>;
std::vector<GlobalFace> all_faces(Mechanics& b) {
  std::vector<ContactFace> faces;
  b.contact_party()->contact_faces(faces);
  std::vector<GlobalFace> mine;
  for (const ContactFace& f : faces) {
    GlobalFace g{f.id, -1, -1, -1, -1};
    for (std::size_t a = 0; a < 4 && f.nodes[a] != no_index; ++a)
      g[a + 1] = b.mesh().node_ids[static_cast<std::size_t>(f.nodes[a])];
    mine.push_back(g);
  }
  std::vector<GlobalFace> all = b.mesh().comm.gather<GlobalFace>(mine);
  std::ranges::sort(all);
  return all;
}

TEST(ContactSide, FacesAreTheSkinOnAnyNumberOfRanks) {
  const auto shared = shared_body();
  const auto whole = body(whole_mesh(bodies()), steel(), everything());
  const std::vector<GlobalFace> a = all_faces(*shared), b = all_faces(*whole);
  EXPECT_EQ(a, b);
  if (communicator().rank() != 0) return;
  EXPECT_EQ(a.size(), std::size_t(2 * (2 * 2 + 2 * 8) + 2 * (4 + 12) + 2 * 12 + 2 * (4 + 4) + 10 + 30 + 30));
  std::set<GlobalId> ids;
  for (const GlobalFace& f : a) ids.insert(f[0]);
  EXPECT_EQ(ids.size(), a.size());
}

}  // namespace
}  // namespace tenon::testing
