// SPDX-License-Identifier: BSD-3-Clause
// The order of nodes and elements in memory does not change the physics: a coupled run in the file's order, along the
// curve and shuffled, compared by label; and a restart in the same order, and in another.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "apps/tenon/build_simulation.hpp"
#include "apps/tenon/commands.hpp"
#include "tests/support/test_communicator.hpp"

namespace tenon {
namespace {

const char* const scene_file = TENON_SOURCE_DIR "/tests/scenes/fuzz/small.yaml";

std::vector<std::string> settings(const std::string& numbering) {
  return {"meshes.solid.numbering=" + numbering, "meshes.heat.numbering=" + numbering, "meshes.solid.axial=8",
          "meshes.solid.core=4", "end_time=3 us"};
}

/// Values of a node field by the label of the node, of the nodes owned here.
std::map<std::int64_t, Vec3> by_label(Component& component, const std::string& field) {
  const Mesh& mesh = component.mesh();
  std::map<std::int64_t, Vec3> values;
  for (const ExportPort& port : component.exports()) {
    if (port.field.name != field) continue;
    const auto stride = static_cast<std::size_t>(port.field.components);
    std::vector<double> all(static_cast<std::size_t>(mesh.nodes()) * stride);
    port.read(all);
    for (const LocalIndex n : mesh.owned_nodes)
      for (std::size_t c = 0; c < stride; ++c)
        values[mesh.node_labels[static_cast<std::size_t>(n)]][c] = all[static_cast<std::size_t>(n) * stride + c];
  }
  return values;
}

/// The whole field on every rank: label -> value, gathered node by node of the ascending labels.
std::vector<double> whole_field(const Communicator& comm, Component& component, const std::string& field) {
  const std::map<std::int64_t, Vec3> mine = by_label(component, field);
  std::vector<double> whole;
  for (std::int64_t label = 1; label <= component.mesh().global_nodes; ++label) {
    const auto found = mine.find(label);
    for (std::size_t c = 0; c < 3; ++c) whole.push_back(comm.max(found == mine.end() ? -HUGE_VAL : found->second[c]));
  }
  return whole;
}

struct Result {
  std::vector<double> displacement, temperature;
};

Result run(const std::string& numbering) {
  const Communicator& comm = testing::communicator();
  Log log(false);
  const BuiltScene built =
      build_simulation(comm, log, load_scene(comm, scene_file, parse_overrides(settings(numbering))));
  Simulation& simulation = *built.simulation;
  simulation.initialize();
  simulation.run();
  return {whole_field(comm, *simulation.find("mechanics"), "displacement"),
          whole_field(comm, *simulation.find("conduction"), "temperature")};
}

void expect_near(const std::vector<double>& a, const std::vector<double>& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  double greatest = 0, worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_TRUE(std::isfinite(a[i]) && std::isfinite(b[i])) << i;
    greatest = std::max(greatest, std::abs(a[i]));
    worst = std::max(worst, std::abs(a[i] - b[i]));
  }
  EXPECT_GT(greatest, 0);
  EXPECT_LT(worst, tolerance * greatest);
}

TEST(Numbering, ThePhysicsIsThatOfTheFilesOrderToRoundOff) {
  const Result file = run("file");
  for (const char* const numbering : {"hilbert", "shuffled"}) {
    const Result other = run(numbering);
    expect_near(file.displacement, other.displacement, 1e-9);
    expect_near(file.temperature, other.temperature, 1e-9);
  }
}

/// Runs to 2 us in a folder, from the start or from a checkpoint there, one of which is written every 20 steps.
ExitCode part(const std::string& numbering, const std::string& folder, const std::string& restart, Result& result) {
  RunArguments arguments{scene_file, folder, settings(numbering), restart};
  arguments.settings.insert(arguments.settings.end(), {"end_time=2 us", "output.checkpoint.every=20 steps"});
  RunHooks hooks;
  hooks.to_terminal = hooks.frames = false;
  hooks.finished = [&](Simulation& simulation, double, double) {
    const Communicator& comm = simulation.comm();
    result = {whole_field(comm, *simulation.find("mechanics"), "displacement"),
              whole_field(comm, *simulation.find("conduction"), "temperature")};
  };
  try {
    return run_scene(testing::communicator(), arguments, hooks);
  } catch (const Error& error) {
    return error.code();
  }
}

/// The first of the checkpoints of a folder.
std::string first_checkpoint(const std::string& folder) {
  std::string first;
  testing::communicator().vote_on_root([&] {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      const std::string path = entry.path().string();
      if (entry.path().filename().string().starts_with("checkpoint-") && (first.empty() || path < first)) first = path;
    }
  });
  testing::communicator().broadcast(first);
  return first;
}

TEST(Numbering, ARestartFindsTheSameOrderAndRefusesAnother) {
  const std::string folder = "numbering-" + std::to_string(testing::communicator().size());
  Result whole, again, other;
  ASSERT_EQ(part("hilbert", folder, "", whole), ExitCode::done);
  const std::string checkpoint = first_checkpoint(folder);
  ASSERT_FALSE(checkpoint.empty());
  EXPECT_EQ(part("hilbert", folder + "-again", checkpoint, again), ExitCode::done);
  EXPECT_FALSE(whole.displacement.empty());
  EXPECT_EQ(whole.displacement, again.displacement);
  EXPECT_EQ(whole.temperature, again.temperature);
  EXPECT_EQ(part("file", folder + "-other", checkpoint, other), ExitCode::file);
}

}  // namespace
}  // namespace tenon
