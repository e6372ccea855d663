// SPDX-License-Identifier: BSD-3-Clause
// What contact costs bodies of particles where nothing is near: no search, no message of theirs, no allocation.
#include <gtest/gtest.h>

#include "allocation_counter.hpp"
#include "components/contact/contact.hpp"
#include "components/mechanics/mechanics.hpp"
#include "framework/mesh/particle_bodies.hpp"
#include "sph_case.hpp"

namespace tenon {
namespace {

using testing::allocations;
using testing::communicator;

constexpr double spacing = 0.01;

/// A cube of water at rest, `height` (m) above a cube of steel that rises with 60 m/s.
class CubesRun {
 public:
  explicit CubesRun(double height, bool always = false, const Communicator& comm = communicator())
      : comm_(comm), simulation_(comm, log_, 0, 1) {
    BoxShape box;
    box.high = {0.06, 0.06, 0.06}, box.elements = {4, 4, 4};
    MeshData steel = generate(box);
    MechanicsOptions mechanics;
    MechanicsOptions::Block block;
    block.name = steel.blocks.front().name, block.material.name = "steel", block.material.density = 7850;
    block.material.elastic = Elasticity{210e9, 0.3, 0};
    mechanics.blocks = {block};
    mechanics.initial_velocities = {{block.name, "", {0, 0, 60}, {}, {}}};
    auto body = std::make_unique<Mechanics>("body", distribute(comm, std::move(steel), {}), mechanics);
    ParticleFill fill;
    fill.spacing = spacing;
    const double foot = 0.06 + height;
    SphOptions options;
    options.bodies = {testing::body_of("water", testing::liquid(1000, 1500))};
    DistributeOptions by_place;
    by_place.method = PartitionMethod::rcb;
    auto water = std::make_unique<Sph>(
        "water",
        distribute(comm, join_particles({{"water", fill_box({0, 0, foot}, {0.06, 0.06, foot + 0.06}, fill)}}),
                   by_place),
        options);
    body_ = body.get(), water_ = water.get();
    simulation_.add(std::move(body));
    simulation_.add(std::move(water));
    ContactOptions contact;
    contact.always_search = always;
    contact_ = static_cast<Contact*>(
        &simulation_.add(std::make_unique<Contact>("contact", comm, std::vector<Component*>{body_, water_}, contact)));
    simulation_.initialize();
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) simulation_.step();
  }
  std::int64_t exchanges() const {
    std::int64_t calls = 0;
    for (const ExchangeCount& count : comm_.counts())
      if (count.name == "water home") calls += count.calls;
    return calls;
  }
  Contact& contact() { return *contact_; }
  Sph& water() { return *water_; }
  /// Sums over all particles, exact: of places and velocities.
  std::array<double, 2> sums() const {
    std::array<ExactSum, 2> local;
    const ParticleData& p = water_->particles();
    for (std::size_t i = 0; i < p.owned(); ++i)
      for (std::size_t c = 0; c < 3; ++c)
        local[0].add(static_cast<double>(1 + p.ids[i]) * p.position[3 * i + c]),
            local[1].add(static_cast<double>(1 + p.ids[i]) * p.velocity[3 * i + c]);
    return {comm_.sum(local[0]), comm_.sum(local[1])};
  }

 private:
  Log log_{false};
  Communicator comm_;
  Simulation simulation_;
  Mechanics* body_ = nullptr;
  Sph* water_ = nullptr;
  Contact* contact_ = nullptr;
};

TEST(ParticlesCost, NothingWhereNothingIsNear) {
  CubesRun run(20);
  run.steps(5);
  const std::int64_t searches = run.contact().searches(), home = run.water().times_home(), calls = run.exchanges();
  const std::int64_t before = allocations();
  run.steps(20);
  EXPECT_EQ(allocations(), before);
  EXPECT_EQ(run.contact().searches(), searches);
  EXPECT_EQ(run.water().times_home(), home);
  EXPECT_EQ(run.exchanges(), calls);
}

TEST(ParticlesCost, OneWayHomePerStepWhereSomethingIsNear) {
  CubesRun run(0.002);
  run.steps(5);
  const std::int64_t home = run.water().times_home(), calls = run.exchanges();
  run.steps(10);
  EXPECT_EQ(run.water().times_home(), home + 10);
  EXPECT_LE(run.exchanges(), calls + 20);  // and at most one way back
}

// From far away until they touch, on any number of ranks, whether it searches in each step or not.
TEST(ParticlesCost, RestChangesNoBit) {
  constexpr int steps = 220;
  CubesRun alone(0.02, true, Communicator::self()), run(0.02);
  alone.steps(steps), run.steps(steps);
  EXPECT_GT(run.contact().enforcement_work() + run.contact().iterations(), 0);
  EXPECT_LT(run.water().times_home(), steps - 20);
  EXPECT_EQ(run.sums(), alone.sums());
}

}  // namespace
}  // namespace tenon
