// SPDX-License-Identifier: BSD-3-Clause
// Bodies of particles in two components: what contact does between them keeps momentum and energy, and a bar passes its
// momentum on to another as the method of characteristics has it.
#include "sph_contact_case.hpp"

namespace tenon::testing {
namespace {

/// One body of particles per component.
struct TwoBodies {
  std::array<MeshData, 2> mesh;
  std::array<SphOptions, 2> sph;
  ContactOptions contact;
  double end = 1;  ///< s
};

class TwoBodiesRun {
 public:
  explicit TwoBodiesRun(const TwoBodies& scene, const Communicator& comm = communicator(),
                        const std::string& checkpoint = "")
      : comm_(comm), simulation_(comm, log_, 0, scene.end) {
    DistributeOptions by_place;
    by_place.method = PartitionMethod::rcb;
    std::vector<Component*> parties;
    for (std::size_t b = 0; b < 2; ++b) {
      MeshData mesh = scene.mesh[b];
      const std::string name = b == 0 ? "first" : "second";
      bodies_[b] = static_cast<Sph*>(
          &simulation_.add(std::make_unique<Sph>(name, distribute(comm, std::move(mesh), by_place), scene.sph[b])));
      parties.push_back(bodies_[b]);
    }
    contact_ =
        static_cast<Contact*>(&simulation_.add(std::make_unique<Contact>("contact", comm, parties, scene.contact)));
    if (checkpoint.empty()) {
      simulation_.initialize();
    } else {
      const CheckpointReader reader(comm, checkpoint);
      simulation_.initialize(&reader);
    }
  }
  Simulation& simulation() { return simulation_; }
  Contact& contact() { return *contact_; }
  double time() const { return simulation_.time(); }
  void steps(
      int count, const std::function<void()>& look = [] {}) {
    for (int s = 0; s < count && !simulation_.done(); ++s) {
      simulation_.step();
      const auto [linear, angular] = contact_->momentum_errors();
      residual_ = std::max({residual_, linear, angular});
      look();
    }
  }
  /// Of one body, or of both with the moment about the origin.
  Vec3 momentum(std::size_t b, bool angular = false) const {
    std::array<ExactSum, 3> sums;
    const ParticleData& p = bodies_[b]->particles();
    for (std::size_t i = 0; i < p.owned(); ++i) {
      const Vec3 v = p.mass[i] * p.velocity.vec(i), of = angular ? cross(p.position.vec(i), v) : v;
      for (std::size_t c = 0; c < 3; ++c) sums[c].add(of[c]);
    }
    return {comm_.sum(sums[0]), comm_.sum(sums[1]), comm_.sum(sums[2])};
  }
  Vec3 total(bool angular = false) const { return momentum(0, angular) + momentum(1, angular); }
  double ledger_error() { return simulation_.ledger().take().error; }
  double residual() const { return residual_; }
  /// Collective. Least distance between particles of the two, m; on rank 0.
  double distance() const {
    const std::vector<double> all = state();
    double least = 1e300;
    if (comm_.rank() != 0) return least;
    const auto first = static_cast<std::size_t>(bodies_[0]->mesh().global_nodes);
    const auto second = static_cast<std::size_t>(bodies_[1]->mesh().global_nodes);
    const auto place = [&](std::size_t n) { return Vec3{all[3 * n], all[3 * n + 1], all[3 * n + 2]}; };
    for (std::size_t i = 0; i < first; ++i)
      for (std::size_t j = 0; j < second; ++j) least = std::min(least, norm(place(i) - place(2 * first + j)));
    return least;
  }
  /// Collective. Places and velocities by id, on rank 0.
  std::vector<double> state() const {
    std::vector<double> all;
    for (Sph* const body : bodies_) {
      const ParticleData& p = body->particles();
      for (const Column* column : {&p.position, &p.velocity}) {
        const std::vector<GlobalId> ids = comm_.gather(std::span<const GlobalId>(p.ids).first(p.owned()));
        const std::vector<double> values = comm_.gather(std::span<const double>(column->values).first(3 * p.owned()));
        std::vector<double> ordered(3 * static_cast<std::size_t>(body->mesh().global_nodes));
        for (std::size_t k = 0; k < ids.size(); ++k)
          std::copy_n(&values[3 * k], 3, &ordered[3 * static_cast<std::size_t>(ids[k])]);
        all.insert(all.end(), ordered.begin(), ordered.end());
      }
    }
    return all;
  }
  void save(const std::string& file) {
    CheckpointWriter writer(comm_, file);
    simulation_.save(writer);
    writer.finish();
  }

 private:
  Log log_{false};
  Communicator comm_;
  Simulation simulation_;
  std::array<Sph*, 2> bodies_{};
  Contact* contact_ = nullptr;
  double residual_ = 0;
};

constexpr double length = 0.1, side = 0.008, spacing = 0.002, density = 1000, wave = 1500, speed = 10;
constexpr double together = 2 * length / wave, plateau = 0.5 * density * wave * speed * side * side;

/// A bar of fluid that hits one of a solid with the same impedance: strain along x only.
TwoBodies bars() {
  TwoBodies s;
  ParticleFill fill;
  fill.spacing = spacing;
  const MaterialDescription elastic = elastic_material(density * wave * wave, 0, density);
  for (std::size_t b = 0; b < 2; ++b) {
    const double low = b == 0 ? -length : 0;
    const std::string name = b == 0 ? "fluid" : "solid";
    s.mesh[b] = join_particles({{name, fill_box({low, 0, 0}, {low + length, side, side}, fill)}});
    s.sph[b].formulation = b == 0 ? SphFormulation::fluid : SphFormulation::total_lagrangian;
    s.sph[b].bodies = {body_of(name, b == 0 ? liquid(density, wave) : elastic)};
    for (std::size_t c = 1; c < 3; ++c) {
      s.sph[b].domain.axes[c].periodic = true;
      s.sph[b].domain.axes[c].low = 0, s.sph[b].domain.axes[c].high = side;
    }
  }
  s.sph[0].bodies[0].initial_velocity[0] = SpaceTimeFunction::constant(speed);
  s.end = 1.2 * together;
  return s;
}

TEST(TwoComponents, BarGivesItsMomentumToAnother) {
  TwoBodiesRun run(bars());
  const double start = run.total()[0], mass = density * length * side * side;
  double before = 0, carried = 0, from = 0, to = 0, impulse = 0, rise = -1, fall = -1;
  run.steps(100000, [&] {
    const double now = run.momentum(1)[0], force = (now - carried) / (run.time() - before);
    if (force > 0.5 * plateau) {
      if (rise < 0) rise = before;
      fall = run.time();
    }
    if (before > 0.1 * together && run.time() < 0.9 * together) {
      if (from == 0) from = before;
      to = run.time(), impulse += now - carried;
    }
    before = run.time(), carried = now;
  });
  const double right = carried / mass, left = run.momentum(0)[0] / mass;
  std::printf(
      "bars of two components: plateau %.4f of the exact one, time %.4f of 2 L/c, velocities %.4f and %.4f m/s, "
      "momentum lost %.1e, ledger %.1e, %lld steps\n",
      impulse / (to - from) / plateau, (fall - rise) / together, left, right, std::abs(run.total()[0] - start) / start,
      run.ledger_error(), static_cast<long long>(run.simulation().steps()));
  EXPECT_NEAR(impulse / (to - from), plateau, 0.02 * plateau);
  EXPECT_NEAR(fall - rise, together, 0.04 * together);
  EXPECT_GE((right - left) / speed, 0.93);
  EXPECT_LE(std::abs(left), 0.04 * speed);
  EXPECT_LE(std::abs(run.total()[0] - start), 1e-12 * start);
  EXPECT_LE(run.ledger_error(), 1e-11);
}

/// A ball of water that flies askew onto a block of rubber.
TwoBodies ball_on_block(double fast) {
  TwoBodies s;
  ParticleFill fill;
  fill.spacing = spacing;
  const double radius = 0.006;
  const Vec3 edge{0.02, 0.02, 0.008};
  s.mesh[0] = join_particles({{"block", fill_box({0, 0, 0}, edge, fill)}});
  const Vec3 centre{0.012, 0.009, edge[2] + radius + 0.5 * spacing};
  s.mesh[1] = join_particles({{"ball", fill_region(ball_region(centre, 0, radius, 3), fill)}});
  s.sph[0].formulation = SphFormulation::total_lagrangian;
  s.sph[0].bodies = {body_of("block", elastic_material(1e8, 0.3, 1100))};
  s.sph[1].bodies = {body_of("ball", liquid(1000, 300))};
  s.sph[1].bodies[0].initial_velocity[0] = SpaceTimeFunction::constant(0.3 * fast);
  s.sph[1].bodies[0].initial_velocity[2] = SpaceTimeFunction::constant(-fast);
  s.end = 1.2e-3;
  return s;
}

TEST(TwoComponents, BallOnBlockKeepsMomentumAndEnergy) {
  TwoBodiesRun run(ball_on_block(20));
  const Vec3 start = run.total(), before = run.momentum(1);
  int steps = 0;
  double least = 1e300;
  run.steps(100000, [&] {
    if (++steps % 50 == 0) least = std::min(least, run.distance());
  });
  const Vec3 after = run.momentum(1);
  std::printf(
      "ball on block of two components: %lld steps, momentum of the ball %.5f -> %.5f, lost %.1e, residual %.1e, "
      "ledger %.1e, least distance %.4f spacings\n",
      static_cast<long long>(run.simulation().steps()), before[2], after[2], norm(run.total() - start) / norm(start),
      run.residual(), run.ledger_error(), least / spacing);
  EXPECT_GT(after[2] - before[2], 0.5 * std::abs(before[2]));
  EXPECT_LE(norm(run.total() - start), 1e-12 * norm(start));
  EXPECT_LE(run.residual(), 1e-12);
  EXPECT_LE(run.ledger_error(), 1e-11);
  if (communicator().rank() == 0) {
    EXPECT_GT(least, 0.95 * spacing);
  }
}

// A light sheet flies ten spacings a step, and the block is four thick.
TEST(TwoComponents, FastSheetDoesNotPass) {
  TwoBodies s = ball_on_block(2000);
  ParticleFill fill;
  fill.spacing = spacing;
  const Vec3 low{0.007, 0.006, 0.009};
  s.mesh[1] = join_particles({{"ball", fill_box(low, low + Vec3{0.006, 0.006, spacing}, fill)}});
  s.sph[1].bodies[0].material = liquid(1, 300);
  s.sph[0].time_step.fixed = s.sph[1].time_step.fixed = 1e-5;
  TwoBodiesRun run(s);
  const double before = run.momentum(1)[2];
  run.steps(1);
  const double after = run.momentum(1)[2], distance = run.distance();
  std::printf("a step of ten spacings: momentum of the sheet %.4e -> %.4e, least distance %.3f spacings\n", before,
              after, distance / spacing);
  EXPECT_GT(after, 0.2 * before);
  EXPECT_LE(run.residual(), 1e-12);
  if (communicator().rank() == 0) {
    EXPECT_GT(distance, 0.95 * spacing);
  }
}

TEST(TwoComponents, SameBits) {
  TwoBodiesRun run(ball_on_block(20));
  run.steps(150);
  const std::vector<double> all = run.state();
  if (communicator().rank() != 0) return;
  TwoBodiesRun alone(ball_on_block(20), Communicator::self());
  alone.steps(150);
  EXPECT_EQ(all, alone.state());
}

TEST(TwoComponents, SameBitsThroughARestart) {
  const TwoBodies s = ball_on_block(20);
  const std::string file = "sph-two-components-" + std::to_string(communicator().size()) + ".h5";
  TwoBodiesRun through(s);
  through.steps(60);
  through.save(file);
  through.steps(40);
  TwoBodiesRun again(s, communicator(), file);
  again.steps(40);
  EXPECT_EQ(through.state(), again.state());
}

TEST(TwoComponents, TiesAndFrictionOfBallsAreRefused) {
  for (const bool tied : {true, false}) {
    TwoBodies s = ball_on_block(20);
    s.contact.pairs = {{"ball", "block", false, {}, tied}};
    if (!tied) s.contact.pairs[0].friction = CoulombFriction{0.2, 0.2};
    try {
      TwoBodiesRun run(s);
      FAIL() << "not refused";
    } catch (const Error& error) {
      EXPECT_NE(
          std::string(error.what())
              .find(tied ? "leave `tied` out, or make both bodies of one `sph` component" : "leave `friction` out"),
          std::string::npos)
          << error.what();
    }
  }
}

}  // namespace
}  // namespace tenon::testing
