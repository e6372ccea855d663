// SPDX-License-Identifier: BSD-3-Clause
// What contact costs where nothing touches, and that no way of searching changes the answer.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>

#include "allocation_counter.hpp"
#include "components/contact/contact.hpp"
#include "components/mechanics/mechanics.hpp"
#include "framework/mesh/generators.hpp"
#include "framework/simulation/simulation.hpp"
#include "test_communicator.hpp"

namespace tenon {
namespace {

using testing::allocations;
using testing::communicator;

/// Two cubes of 4^3 elements, `gap` (m) apart in z and askew, that approach each other with 60 m/s.
MeshData cubes(double gap) {
  MeshData all;
  all.source = "two cubes";
  for (const bool upper : {false, true}) {
    BoxShape box;
    box.elements = {4, 4, 4};
    MeshData cube = generate(box);
    const auto first = static_cast<GlobalId>(all.coordinates.size());
    for (const Vec3& x : cube.coordinates)
      all.coordinates.push_back(upper ? Vec3{x[0] + 0.3, x[1] + 0.2, x[2] + 1 + gap + 0.1 * x[0]} : x);
    BlockData block = cube.blocks.front();
    block.name = upper ? "upper" : "lower", block.label = upper ? 2 : 1;
    for (GlobalId& n : block.connectivity) n += first;
    for (std::int64_t& label : block.labels) label += upper ? 64 : 0;
    all.blocks.push_back(block);
  }
  for (std::size_t n = 0; n < all.coordinates.size(); ++n) all.node_labels.push_back(static_cast<std::int64_t>(n) + 1);
  return all;
}

MechanicsOptions steel() {
  MechanicsOptions options;
  for (const char* name : {"lower", "upper"}) {
    MechanicsOptions::Block block;
    block.name = name, block.material.name = "steel", block.material.density = 7850;
    block.material.elastic = Elasticity{210e9, 0.3, 0};
    options.blocks.push_back(block);
  }
  options.initial_velocities = {{"upper", "", {5, 0, -60}, {}, {}}};
  return options;
}

class CubesRun {
 public:
  CubesRun(const Communicator& comm, double gap, const ContactOptions* options) : simulation_(comm, log_, 0, 1) {
    auto body = std::make_unique<Mechanics>("body", distribute(comm, cubes(gap), {}), steel());
    body_ = body.get();
    simulation_.add(std::move(body));
    if (options) {
      auto contact = std::make_unique<Contact>("contact", comm, std::vector<Component*>{body_}, *options);
      contact_ = contact.get();
      simulation_.add(std::move(contact));
    }
    simulation_.initialize();
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) simulation_.step();
  }
  std::int64_t allocations_in(int count) {
    const std::int64_t before = allocations();
    steps(count);
    return allocations() - before;
  }
  Contact& contact() { return *contact_; }
  Mechanics& body() { return *body_; }
  int contact_phases() {
    return static_cast<int>(std::ranges::count_if(
        simulation_.timers().phases(), [](const PhaseTimer& phase) { return phase.name.starts_with("contact"); }));
  }

 private:
  Log log_{false};
  Simulation simulation_;
  Mechanics* body_ = nullptr;
  Contact* contact_ = nullptr;
};

/// Owned nodes of a run have the bits that the same nodes have in a run on one rank.
void expect_same_bits(CubesRun& run, CubesRun& alone, const std::string& what) {
  const std::vector<LocalIndex>& owned = run.body().mesh().owned_nodes;
  int differ = 0;
  for (const LocalIndex n : owned) {
    const auto i = static_cast<std::size_t>(n), id = static_cast<std::size_t>(run.body().mesh().node_ids[i]);
    differ += run.body().current_coordinates()[i] == alone.body().current_coordinates()[id] ? 0 : 1;
  }
  EXPECT_EQ(differ, 0) << what;
}

TEST(ContactCost, NoneWithoutContact) {
  CubesRun run(communicator(), 0.5, nullptr);
  run.steps(5);
  EXPECT_EQ(run.allocations_in(20), 0);
  EXPECT_EQ(run.contact_phases(), 0);
}

TEST(ContactCost, OnlyACheckWhereNothingIsNear) {
  const ContactOptions options;
  CubesRun run(communicator(), 20, &options);
  run.steps(5);
  EXPECT_EQ(run.contact_phases(), 6);
  const std::int64_t searches = run.contact().searches();
  EXPECT_EQ(run.allocations_in(20), 0);
  EXPECT_EQ(run.contact().searches(), searches);
  EXPECT_EQ(run.contact().enforcement_work(), 0);
}

TEST(ContactCost, SameBitsHoweverItSearches) {
  constexpr int steps = 40;
  const ContactOptions usual;
  CubesRun alone(Communicator::self(), 0.002, &usual);
  alone.steps(steps);
  EXPECT_GT(alone.contact().enforcement_work(), 0);
  for (const SearchDecomposition decomposition :
       {SearchDecomposition::rcb, SearchDecomposition::slices, SearchDecomposition::owner_boxes})
    for (const bool always : {false, true}) {
      ContactOptions options;
      options.decomposition = decomposition, options.always_search = always;
      CubesRun run(communicator(), 0.002, &options);
      run.steps(steps);
      EXPECT_EQ(run.contact().searches() > steps, always);
      expect_same_bits(run, alone, "decomposition " + std::to_string(static_cast<int>(decomposition)));
    }
}

}  // namespace
}  // namespace tenon
