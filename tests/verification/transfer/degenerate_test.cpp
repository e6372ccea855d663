// SPDX-License-Identifier: BSD-3-Clause
// Input that no transfer can make good use of: a clear error on every rank, or the value of the policy, on any number
// of ranks; never a hang, a crash or a number that is none.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "framework/base/error.hpp"
#include "transfer/moving_least_squares.hpp"
#include "transfer_testing.hpp"

namespace tenon::transfer {
namespace {

using testing::box;
using testing::communicator;
using testing::distributed;
using testing::MeshPointer;
using testing::Pair;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double linear(const Vec3& x) {
  return 1 + 2 * x[0] - 3 * x[1] + 0.5 * x[2];
}

/// A method with the kind of field that it is for.
struct Case {
  const char* name;
  Method method;
  FieldKind kind;
  Location from = Location::node;
};
constexpr Case cases[] = {
    {"interpolate", Method::interpolate, FieldKind::point_value},
    {"nearest projection", Method::nearest_projection, FieldKind::point_value},
    {"conserve totals", Method::conserve, FieldKind::total},
    {"conserve totals of elements", Method::conserve, FieldKind::total, Location::element},
    {"conserve densities", Method::conserve, FieldKind::density},
    {"project", Method::project, FieldKind::point_value},
    {"moving least squares", Method::moving_least_squares, FieldKind::point_value},
    {"automatic", Method::automatic, FieldKind::point_value},
};

/// What a run gave: the message of its error, the same on all ranks, or values.
struct Outcome {
  std::string error;
  ExitCode code = ExitCode::done;
  std::vector<double> values;
  TransferReport report;
};

/// Every rank must have the same error, or none.
void agree(const Outcome& outcome, const char* what) {
  const Communicator& comm = communicator();
  EXPECT_EQ(comm.min(static_cast<std::int64_t>(outcome.error.empty())),
            comm.max(static_cast<std::int64_t>(outcome.error.empty())))
      << what << ": " << outcome.error;
  EXPECT_EQ(comm.min(static_cast<std::int64_t>(outcome.code)), comm.max(static_cast<std::int64_t>(outcome.code)));
}

Outcome run(const Case& c, const Pair& pair, TransferOptions options = {}) {
  Outcome outcome;
  options.method = c.method;
  try {
    const std::vector<double> values = testing::sampled(*pair.source, pair.from, linear);
    const GridTransfer map = testing::make_transfer(pair, c.kind, options);
    outcome.values.assign(static_cast<std::size_t>(item_count(*pair.target, pair.to)), nan);
    map.apply(values, outcome.values, 1);
    outcome.report = map.report(values, outcome.values, 1);
  } catch (const Error& error) {
    outcome.error = error.what();
    outcome.code = error.code();
  }
  agree(outcome, c.name);
  return outcome;
}

void expect_numbers(const Outcome& outcome, const char* what) {
  EXPECT_EQ(outcome.error, "") << what;
  for (const double v : outcome.values) ASSERT_TRUE(std::isfinite(v)) << what;
}

/// The error says which transfer and mentions the words.
void expect_error(const Outcome& outcome, ExitCode code, std::initializer_list<const char*> words, const char* what) {
  EXPECT_EQ(outcome.code, code) << what << ": " << outcome.error;
  for (const char* word : words)
    EXPECT_NE(outcome.error.find(word), std::string::npos) << what << ": no '" << word << "' in: " << outcome.error;
}

Pair pair_of(MeshData source, MeshData target, const Case& c) {
  for (MeshData* mesh : {&source, &target})
    if (communicator().rank() == 0) add_derived_sets(*mesh);
  return {distributed(std::move(source)), distributed(std::move(target)), c.from, Location::node};
}

/// Elements of the first block, in place; on the rank that has the mesh.
template <typename Change>
MeshData changed(MeshData mesh, const Change& change) {
  if (communicator().rank() == 0) change(mesh);
  return mesh;
}

GlobalId* corners_of_element(MeshData& mesh, std::size_t e) {
  return mesh.blocks[0].connectivity.data() + 8 * e;
}

// On several ranks all but one own no element of it.
TEST(Degenerate, OneElement) {
  for (const Case& c : cases)
    for (const int n : {1, 4}) {
      expect_numbers(run(c, pair_of(box(1), box(n), c)), c.name);
      expect_numbers(run(c, pair_of(box(n), box(1), c)), c.name);
    }
}

TEST(Degenerate, ElementsWithoutVolumeAreSkipped) {
  for (const Case& c : cases) {
    // Element 0 has collapsed into a corner of its own; its neighbours stay.
    const auto flat = [](MeshData& mesh) {
      GlobalId* n = corners_of_element(mesh, 0);
      const auto extra = static_cast<GlobalId>(mesh.coordinates.size());
      for (int a = 0; a < 8; ++a) {
        mesh.coordinates.push_back({0.25, 0.25, 0.25});
        mesh.node_labels.push_back(1000 + a);
        n[a] = extra + a;
      }
    };
    const Outcome source = run(c, pair_of(changed(box(3), flat), box(4), c));
    expect_numbers(source, c.name);
    const Outcome target = run(c, pair_of(box(4), changed(box(3), flat), c));
    expect_numbers(target, c.name);
    if (c.method == Method::interpolate) {
      EXPECT_EQ(source.report.skipped, 1);
    }
  }
}

TEST(Degenerate, InvertedElementsAreRefusedByNameWherePointsAreSought) {
  for (const Case& c : cases) {
    const auto inverted = [](MeshData& mesh) {
      GlobalId* n = corners_of_element(mesh, 5);
      for (int a = 0; a < 4; ++a) std::swap(n[a], n[a + 4]);
    };
    const bool seeks_in_target = c.method == Method::conserve;
    const Pair pair =
        seeks_in_target ? pair_of(box(4), changed(box(3), inverted), c) : pair_of(changed(box(3), inverted), box(4), c);
    const Outcome outcome = run(c, pair);
    if (c.method == Method::nearest_projection || c.method == Method::moving_least_squares)
      expect_numbers(outcome, c.name);  // looks at faces, or at points only
    else
      expect_error(outcome, ExitCode::geometry, {"test", "element 6", "inverted", "repair"}, c.name);
  }
}

TEST(Degenerate, DuplicatedElementsGiveTheValuesOfTheFirst) {
  for (const Case& c : cases) {
    const auto doubled = [](MeshData& mesh) {
      BlockData& block = mesh.blocks[0];
      const std::size_t count = block.size();
      block.connectivity.insert(block.connectivity.end(), block.connectivity.begin(),
                                block.connectivity.begin() + static_cast<std::ptrdiff_t>(8 * count));
      for (std::size_t e = 0; e < count; ++e) block.labels.push_back(static_cast<std::int64_t>(count + e) + 1);
    };
    // Sides that two elements share are inner sides, so a doubled mesh has no skin to project to.
    if (c.method == Method::nearest_projection) continue;
    const Pair pair = pair_of(changed(box(3), doubled), box(4), c);
    const Outcome outcome = run(c, pair);
    expect_numbers(outcome, c.name);
    // Projection keeps the integral, which a doubled mesh has twice.
    if (c.kind == FieldKind::point_value && c.method != Method::project) {
      EXPECT_LT(testing::greatest_error(*pair.target, Location::node, outcome.values, linear), 1e-12) << c.name;
    }
    if (c.method != Method::conserve) continue;
    expect_numbers(run(c, pair_of(box(4), changed(box(3), doubled), c)), c.name);
  }
}

TEST(Degenerate, CoordinatesThatAreNoNumbersAreRefused) {
  const Pair pair = pair_of(box(3), box(4), cases[0]);
  for (const Case& c : cases)
    for (const bool in_source : {true, false})
      for (const double wrong : {nan, std::numeric_limits<double>::infinity()}) {
        std::vector<Vec3> source = pair.source->coordinates, target = pair.target->coordinates;
        std::vector<Vec3>& bad = in_source ? source : target;
        const Mesh& mesh = in_source ? *pair.source : *pair.target;
        for (std::size_t n = 0; n < bad.size(); ++n)
          if (mesh.node_ids[n] == 7) bad[n][1] = wrong;
        Outcome outcome;
        FieldDescription field;
        field.name = "field", field.location = c.from, field.kind = c.kind;
        try {
          const GridTransfer map({pair.source.get(), source, c.from}, {pair.target.get(), target, Location::node},
                                 field, {.method = c.method}, "test");
        } catch (const Error& error) {
          outcome.error = error.what(), outcome.code = error.code();
        }
        agree(outcome, c.name);
        expect_error(outcome, ExitCode::geometry, {"test", "node 8", in_source ? "source" : "target", "not a place"},
                     c.name);
      }
}

TEST(Degenerate, AnEmptySourceIsRefusedAndAnEmptyTargetIsNot) {
  MeshData nothing;
  nothing.source = "nothing";
  for (const Case& c : cases) {
    const Outcome from_nothing = run(c, {distributed(nothing), pair_of(box(3), box(2), c).target, c.from});
    if (c.method == Method::conserve) {
      expect_numbers(from_nothing, c.name);  // nothing is spread over the target
      for (const double v : from_nothing.values) EXPECT_EQ(v, 0) << c.name;
    } else {
      EXPECT_NE(from_nothing.error, "") << c.name;
    }
    const Outcome to_nothing = run(c, {pair_of(box(3), box(2), c).source, distributed(nothing), c.from});
    if (c.method == Method::conserve)
      expect_error(to_nothing, ExitCode::geometry, {"test"}, c.name);  // amounts have nowhere to go
    else
      expect_numbers(to_nothing, c.name);
  }
}

TEST(Degenerate, AllTargetsOutsideFollowThePolicy) {
  Pair pair = pair_of(box(3), box(2, {.low = {5, 5, 5}, .high = {6, 6, 6}}), cases[0]);
  for (const Case& c : cases) {
    pair.from = c.from;
    expect_numbers(run(c, pair, {.outside = OutsidePolicy::nearest}), c.name);
    const bool onto_surface = c.method == Method::nearest_projection;
    const Outcome extended = run(c, pair, {.outside = OutsidePolicy::extrapolate});
    if (onto_surface)
      expect_error(extended, ExitCode::usage, {"test", "nearest or error"}, c.name);
    else
      expect_numbers(extended, c.name);
    if (c.method == Method::interpolate) {
      EXPECT_LT(testing::greatest_error(*pair.target, Location::node, extended.values, linear), 1e-10) << c.name;
      EXPECT_EQ(extended.report.outside, 27);
      EXPECT_NEAR(extended.report.greatest_distance, 5 * std::sqrt(3.0), 1e-12);
    }
    const Outcome refused = run(c, pair, {.outside = OutsidePolicy::error});
    expect_error(refused, ExitCode::geometry, {"test", "outside the mesh", "m away"}, c.name);
    const Outcome given = run(c, pair, {.outside = OutsidePolicy::value, .outside_value = -7});
    if (c.method == Method::conserve || c.method == Method::project)
      expect_error(given, ExitCode::usage, {"test", "value"}, c.name);
    else if (onto_surface)
      expect_error(given, ExitCode::usage, {"test", "nearest or error"}, c.name);
    else
      for (const double v : given.values) EXPECT_EQ(v, -7) << c.name;
    const Outcome too_far = run(c, pair, {.greatest_distance = 1});
    expect_error(too_far, ExitCode::geometry, {"test", "at most 1 m"}, c.name);
  }
}

TEST(Degenerate, CoincidentPointsGetTheSameValue) {
  // Every node of the target twice, in elements of their own.
  for (const Case& c : cases) {
    const auto doubled = [](MeshData& mesh) {
      const auto count = static_cast<GlobalId>(mesh.coordinates.size());
      const std::vector<Vec3> places = mesh.coordinates;
      mesh.coordinates.insert(mesh.coordinates.end(), places.begin(), places.end());
      BlockData& block = mesh.blocks[0];
      const std::vector<GlobalId> nodes = block.connectivity;
      const std::size_t elements = block.size();
      for (const GlobalId n : nodes) block.connectivity.push_back(n + count);
      for (std::size_t e = 0; e < elements; ++e) block.labels.push_back(static_cast<std::int64_t>(elements + e) + 1);
      for (GlobalId n = 0; n < count; ++n) mesh.node_labels.push_back(count + n + 1);
    };
    const Pair pair = pair_of(box(3, {.distortion = 0.2}), changed(box(4), doubled), c);
    const Outcome outcome = run(c, pair);
    expect_numbers(outcome, c.name);
    if (c.kind != FieldKind::point_value || c.method == Method::project) continue;
    // Both copies side by side on every rank: by ids, over all ranks.
    const auto half = static_cast<std::size_t>(pair.target->global_nodes / 2);
    std::vector<double> first(half, -1e300), second(half, -1e300);
    for (std::size_t n = 0; n < outcome.values.size(); ++n) {
      const auto id = static_cast<std::size_t>(pair.target->node_ids[n]);
      (id < half ? first[id] : second[id - half]) = outcome.values[n];
    }
    communicator().max(std::span<double>(first));
    communicator().max(std::span<double>(second));
    EXPECT_EQ(first, second) << c.name;
  }
}

TEST(Degenerate, PointsOnSharedFacesEdgesAndVerticesAreInside) {
  // Targets on all faces, edges and vertices of a source of warped elements (its own nodes, middles of edges and of
  // faces), each found once: none outside, the linear field exact.
  const auto refined = [](int n) { return box(2 * n); };
  for (const Case& c : cases) {
    if (c.method != Method::interpolate && c.method != Method::automatic) continue;
    const Pair pair = pair_of(box(3), refined(3), c);
    const Outcome outcome = run(c, pair, {.outside = OutsidePolicy::error, .tolerance = 1e-12});
    expect_numbers(outcome, c.name);
    EXPECT_EQ(outcome.report.outside, 0);
    EXPECT_LT(testing::greatest_error(*pair.target, Location::node, outcome.values, linear), 1e-14);
  }
}

/// Points 0 to count - 1 on a lattice, dealt out to the ranks in turn.
struct Cloud {
  Cloud(int count, double spread) {
    for (int i = communicator().rank(); i < count; i += communicator().size()) {
      points.ids.push_back(i);
      x.push_back({spread * (i % 4), spread * (i / 4 % 4), spread * (i / 16)});
    }
  }
  PointCloud points{communicator(), {}, "cloud"};
  std::vector<Vec3> x;
};

/// Greatest |sum of weights - 1| of the rows that moving least squares makes.
Outcome fit(const Cloud& from, const Cloud& to, double& greatest) {
  Outcome outcome;
  greatest = 0;
  try {
    std::vector<FittedPoint> fitted;
    const Rows rows =
        moving_least_squares_rows(communicator(), items_of(from.points), from.x, to.x, {}, "test", fitted);
    EXPECT_EQ(rows.size(), to.x.size());
    for (std::size_t r = 0; r < rows.size(); ++r) {
      double sum = 0;
      for (const Term& term : rows.row(r)) sum += term.weight;
      if (const double off = std::abs(sum - 1); !(off <= greatest)) greatest = off;
    }
  } catch (const Error& error) {
    outcome.error = error.what(), outcome.code = error.code();
  }
  agree(outcome, "moving least squares");
  return outcome;
}

TEST(Degenerate, CloudsWithoutPointsOrInOnePlace) {
  double greatest = 0;
  expect_error(fit(Cloud(0, 1), Cloud(64, 1), greatest), ExitCode::geometry, {"test", "no points"}, "empty cloud");
  EXPECT_EQ(fit(Cloud(64, 1), Cloud(0, 1), greatest).error, "");
  // One point; few in one place; few in a plane; many in one place.
  for (const auto& [count, spread] : {std::pair(1, 1.0), std::pair(5, 0.0), std::pair(8, 0.5), std::pair(64, 0.0)}) {
    EXPECT_EQ(fit(Cloud(count, spread), Cloud(64, 0.3), greatest).error, "");
    EXPECT_LT(greatest, 1e-13) << count << " points, " << spread << " m apart";
  }
  Cloud broken(8, 1);
  if (!broken.x.empty()) broken.x.front()[0] = nan;
  EXPECT_NE(fit(broken, Cloud(8, 1), greatest).error, "");
}

TEST(Degenerate, PointsWithoutAMeshAreNotInterpolated) {
  const Cloud points(8, 1);
  const Case c = cases[0];
  const Pair pair = pair_of(box(2), box(2), c);
  Outcome outcome;
  FieldDescription field;
  field.name = "field", field.location = Location::particle, field.kind = FieldKind::point_value;
  try {
    Grid source{.coordinates = points.x, .location = Location::particle, .cloud = &points.points};
    Grid target{.mesh = pair.target.get(), .coordinates = pair.target->coordinates};
    const GridTransfer map(source, target, field, {.method = Method::interpolate}, "test");
  } catch (const Error& error) {
    outcome.error = error.what(), outcome.code = error.code();
  }
  agree(outcome, "cloud");
  expect_error(outcome, ExitCode::usage, {"test", "cloud", "moving_least_squares"}, "cloud");
}

}  // namespace
}  // namespace tenon::transfer
