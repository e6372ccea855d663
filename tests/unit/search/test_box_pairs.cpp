// SPDX-License-Identifier: BSD-3-Clause
// The distributed broad phase against brute force (VERIFICATION C11), for every decomposition and way to spread items.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>

#include "framework/decomposition/graph_partition.hpp"
#include "framework/search/box_pairs.hpp"
#include "tests/support/test_communicator.hpp"

namespace tenon {
namespace {

using IdPairs = std::vector<std::pair<std::int64_t, std::int64_t>>;
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::array decompositions{SearchDecomposition::rcb, SearchDecomposition::slices,
                                    SearchDecomposition::owner_boxes};

const Communicator& comm() {
  return testing::communicator();
}

/// What all ranks know; each takes its share.
struct Scene {
  std::string name;
  std::vector<Box> first, second;
};

enum class Spread { in_turn, in_blocks, all_on_last };
constexpr std::array spreads{Spread::in_turn, Spread::in_blocks, Spread::all_on_last};

/// The items that one rank keeps, and their numbers in the scene.
struct Share {
  std::vector<Box> boxes;
  std::vector<std::int64_t> ids;
};

std::size_t keeper(Spread spread, std::size_t i, std::size_t count) {
  const auto ranks = static_cast<std::size_t>(comm().size());
  if (spread == Spread::in_turn) return i % ranks;
  return spread == Spread::in_blocks ? i * ranks / count : ranks - 1;
}

Share share_of(int rank, const std::vector<Box>& boxes, Spread spread) {
  Share share;
  for (std::size_t i = 0; i < boxes.size(); ++i)
    if (keeper(spread, i, boxes.size()) == static_cast<std::size_t>(rank)) {
      share.boxes.push_back(boxes[i]);
      share.ids.push_back(static_cast<std::int64_t>(i));
    }
  return share;
}

bool is_there(const Box& box) {
  return box.low[0] <= box.high[0] && box.low[1] <= box.high[1] && box.low[2] <= box.high[2];
}

// On rank 0; each rank does its share.
IdPairs brute_force(const std::vector<Box>& first, const std::vector<Box>& second, bool within) {
  std::vector<std::array<std::int64_t, 2>> pairs;
  const auto ranks = static_cast<std::size_t>(comm().size());
  for (auto i = static_cast<std::size_t>(comm().rank()); i < first.size(); i += ranks) {
    if (!is_there(first[i])) continue;
    for (std::size_t k = within ? i + 1 : 0; k < second.size(); ++k)
      if (first[i].overlaps(second[k]) && is_there(second[k]))
        pairs.push_back({static_cast<std::int64_t>(i), static_cast<std::int64_t>(k)});
  }
  IdPairs all;
  for (const auto& [i, k] : comm().gather(std::span<const std::array<std::int64_t, 2>>(pairs))) all.emplace_back(i, k);
  std::sort(all.begin(), all.end());
  return all;
}

// The pairs of all ranks on rank 0, by numbers in the scene, sorted; nothing is dropped, so a pair found twice shows.
IdPairs gathered(const std::vector<BoxPair>& pairs, const std::vector<Box>& first, Spread spread_first,
                 const std::vector<Box>& second, Spread spread_second, bool within) {
  const std::vector<BoxPair> all = comm().gather(std::span(pairs));
  std::vector<Share> firsts, seconds;
  for (int r = 0; r < comm().size(); ++r) {
    firsts.push_back(share_of(r, first, spread_first));
    seconds.push_back(share_of(r, second, spread_second));
  }
  IdPairs result;
  for (const BoxPair& pair : all) {
    const std::int64_t a =
        firsts[static_cast<std::size_t>(pair.first.rank)].ids.at(static_cast<std::size_t>(pair.first.index));
    const std::int64_t b =
        seconds[static_cast<std::size_t>(pair.second.rank)].ids.at(static_cast<std::size_t>(pair.second.index));
    result.push_back(within ? std::pair(std::min(a, b), std::max(a, b)) : std::pair(a, b));
    if (within) {
      EXPECT_LT(pair.first, pair.second);
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

void expect_exact(BoxPairSearch& search, const Scene& scene, Spread spread, const IdPairs& expected) {
  const Spread other = spreads[2 - static_cast<std::size_t>(spread)];
  const Share first = share_of(comm().rank(), scene.first, spread),
              second = share_of(comm().rank(), scene.second, other);
  std::vector<BoxPair> pairs;
  search.find(first.boxes, second.boxes, pairs);
  const IdPairs found = gathered(pairs, scene.first, spread, scene.second, other, false);
  if (comm().rank() == 0) {
    EXPECT_EQ(found, expected);
  }
}

void expect_exact_within(BoxPairSearch& search, const Scene& scene, Spread spread, const IdPairs& expected) {
  const Share share = share_of(comm().rank(), scene.first, spread);
  std::vector<BoxPair> pairs;
  search.find_within(share.boxes, pairs);
  const IdPairs found = gathered(pairs, scene.first, spread, scene.first, spread, true);
  if (comm().rank() == 0) {
    EXPECT_EQ(found, expected);
  }
}

void expect_exact_everyhow(const Scene& scene) {
  const IdPairs expected = brute_force(scene.first, scene.second, false);
  const IdPairs expected_within = brute_force(scene.first, scene.first, true);
  for (const SearchDecomposition decomposition : decompositions) {
    BoxPairSearch between(comm(), decomposition, "between"), within(comm(), decomposition, "within");
    for (const Spread spread : spreads) {
      SCOPED_TRACE(scene.name + ", decomposition " + std::to_string(static_cast<int>(decomposition)) + ", spread " +
                   std::to_string(static_cast<int>(spread)));
      expect_exact(between, scene, spread, expected);
      expect_exact_within(within, scene, spread, expected_within);
    }
  }
}

Box around_corners(const std::vector<Vec3>& corners, double by) {
  Box box;
  for (const Vec3& x : corners) box.add(x);
  box.inflate(by);
  return box;
}

// Triangles and quadrilaterals with sizes over two decades, in a unit box, and nodes.
Scene random_facets(int facets, int nodes, unsigned seed) {
  Scene scene{"random facets", {}, {}};
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(0, 1);
  for (int f = 0; f < facets; ++f) {
    const Vec3 x{u(random), u(random), u(random)};
    const double size = 0.2 * std::pow(100, -u(random));
    std::vector<Vec3> corners;
    for (int k = 0; k < 3 + f % 2; ++k)
      corners.push_back(x + size * Vec3{u(random) - 0.5, u(random) - 0.5, u(random) - 0.5});
    scene.first.push_back(around_corners(corners, 1e-3));
  }
  for (int n = 0; n < nodes; ++n) {
    const Vec3 x{u(random), u(random), u(random)};
    scene.second.push_back({x, x});
  }
  return scene;
}

void move(std::vector<Box>& boxes, double by, std::mt19937& random) {
  std::uniform_real_distribution<double> u(-by, by);
  for (Box& box : boxes) {
    const Vec3 step{u(random) + 3 * by, u(random), u(random)};
    box.low = box.low + step, box.high = box.high + step;
  }
}

TEST(BoxPairSearch, RandomFacetsThatMove) {
  Scene scene = random_facets(5000, 2000, 1);
  std::mt19937 random(2);
  std::vector<BoxPairSearch> between, within;
  for (const SearchDecomposition decomposition : decompositions) {
    between.emplace_back(comm(), decomposition, "between");
    within.emplace_back(comm(), decomposition, "within");
  }
  for (int step = 0; step < 3; ++step) {
    SCOPED_TRACE("step " + std::to_string(step));
    const IdPairs expected = brute_force(scene.first, scene.second, false);
    const IdPairs expected_within = brute_force(scene.first, scene.first, true);
    if (comm().rank() == 0) {
      EXPECT_GT(expected.size(), 100u);
    }
    for (std::size_t d = 0; d < decompositions.size(); ++d) {
      expect_exact(between[d], scene, Spread::in_turn, expected);
      expect_exact_within(within[d], scene, Spread::in_blocks, expected_within);
    }
    move(scene.first, 0.03, random);
    move(scene.second, 0.03, random);
  }
}

// A strip folded like a concertina, every layer near the next.
Scene folded_strip() {
  Scene scene{"folded strip", {}, {}};
  const double h = 0.05;
  for (int layer = 0; layer < 12; ++layer)
    for (int i = 0; i < 20; ++i) {
      const double z = 0.01 * layer, x = h * i;
      scene.first.push_back(around_corners({{x, 0, z}, {x + h, 0, z}, {x + h, h, z}, {x, h, z}}, 0.006));
      scene.second.push_back(around_corners({{x, 0, z}}, 0));
    }
  return scene;
}

Scene on_one_point() {
  Scene scene{"all on one point", {}, {}};
  scene.first.assign(60, Box{{0.1, 0.2, 0.3}, {0.1, 0.2, 0.3}});
  scene.second.assign(70, Box{{0.1, 0.2, 0.3}, {0.1, 0.2, 0.3}});
  return scene;
}

// Squares that touch, with nodes on their corners: whatever the cuts, boxes and corners lie on them.
Scene coplanar() {
  Scene scene{"coplanar", {}, {}};
  for (int i = 0; i < 256; ++i) {
    const Vec3 low{0.125 * (i % 16), 0.125 * (i / 16), 0.5};
    scene.first.push_back({low, low + Vec3{0.125, 0.125, 0}});
    scene.second.push_back({low, low});
  }
  return scene;
}

Scene on_a_line() {
  Scene scene{"on a line", {}, {}};
  for (int i = 0; i < 100; ++i) {
    scene.first.push_back({{0, 0, 1.0 * (i / 3)}, {0, 0, 1.0 * (i / 3 + 1)}});
    scene.second.push_back({{0, 0, 1.0 * (i / 5)}, {0, 0, 1.0 * (i / 5)}});
  }
  return scene;
}

Scene one_box_per_rank() {
  Scene scene{"one box per rank", {}, {}};
  for (int r = 0; r < comm().size(); ++r) {
    scene.first.push_back({{0.7 * r, 0, 0}, {0.7 * r + 1, 1, 1}});
    scene.second.push_back({{0.5, 0.3 * r, 0.5}, {0.5, 0.3 * r, 0.5}});
  }
  return scene;
}

Scene larger_than_parts() {
  Scene scene = random_facets(200, 200, 3);
  scene.name = "boxes larger than parts";
  for (std::size_t i = 0; i < 200; i += 10) scene.first[i].inflate(0.3);
  scene.first[5] = {{-1, -1, -1}, {2, 2, 2}};
  scene.second[7] = {{-5, 0.5, 0.5}, {5, 0.5, 0.5}};
  return scene;
}

Scene with_bad_boxes() {
  Scene scene = random_facets(300, 300, 4);
  scene.name = "bad boxes";
  for (std::size_t i = 0; i < 300; i += 11) {
    scene.first[i].low[i % 3] = std::nan("");
    scene.second[i].high[i % 3] = std::nan("");
    if (i > 0) scene.first[i - 1] = Box();
  }
  scene.first[1] = {{-infinity, -infinity, 0.4}, {infinity, infinity, 0.6}};
  scene.second[1] = {{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}};
  scene.first[2] = {{infinity, infinity, infinity}, {infinity, infinity, infinity}};
  scene.first[3] = {{-infinity, 0, 0}, {-infinity, 1, 1}};
  scene.first[4] = {{0, 0, 0}, {1, -1, 1}};
  return scene;
}

TEST(BoxPairSearch, NothingAndOnlyOneSet) {
  expect_exact_everyhow({"nothing", {}, {}});
  expect_exact_everyhow({"only first", {Box{{0, 0, 0}, {1, 1, 1}}, Box{{1, 1, 1}, {2, 2, 2}}}, {}});
  expect_exact_everyhow({"only second", {}, {Box{{0, 0, 0}, {1, 1, 1}}}});
  expect_exact_everyhow({"only endless",
                         std::vector<Box>(3, Box{{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}}),
                         std::vector<Box>(2, Box{{0, -infinity, 0}, {0, infinity, 0}})});
}

TEST(BoxPairSearch, FoldedStrip) {
  expect_exact_everyhow(folded_strip());
}

TEST(BoxPairSearch, Degenerate) {
  for (const Scene& scene : {on_one_point(), coplanar(), on_a_line(), one_box_per_rank()}) expect_exact_everyhow(scene);
}

TEST(BoxPairSearch, LargeAndBadBoxes) {
  for (const Scene& scene : {larger_than_parts(), with_bad_boxes()}) expect_exact_everyhow(scene);
}

// The cuts of a first search stay; then everything leaves the region that they were made for.
TEST(BoxPairSearch, ItemsFarFromTheCuts) {
  Scene scene = random_facets(300, 300, 5);
  for (const SearchDecomposition decomposition : decompositions) {
    BoxPairSearch search(comm(), decomposition, "far");
    for (int step = 0; step < 3; ++step) {
      expect_exact(search, scene, Spread::in_turn, brute_force(scene.first, scene.second, false));
      for (auto* boxes : {&scene.first, &scene.second})
        for (Box& box : *boxes) box.low = -10.0 * box.low, box.high = -10.0 * box.high, std::swap(box.low, box.high);
    }
  }
}

// Two sheets of which one is far denser: after a few searches all ranks work about as much.
TEST(BoxPairSearch, WorkIsBalanced) {
  std::mt19937 random(static_cast<unsigned>(6 + comm().rank()));
  std::uniform_real_distribution<double> u(0, 1);
  std::vector<Box> boxes;
  for (int i = 0; i < 40000 / comm().size(); ++i) {
    const double crowd = u(random) < 0.5 ? 0.1 : 1;
    const Vec3 x{crowd * u(random), crowd * u(random), 0.01 * u(random)};
    boxes.push_back({x, x + Vec3{0.004, 0.004, 0.004}});
  }
  BoxPairSearch search(comm(), SearchDecomposition::rcb, "balance");
  std::vector<BoxPair> pairs;
  for (int n = 0; n < 6; ++n) search.find_within(boxes, pairs);
  EXPECT_LE(imbalance(comm(), static_cast<double>(search.work().total())), 1.1);
  // Nothing has changed: what the last cuts left is not worth new ones.
  const std::int64_t cuts = search.cuts();
  for (int n = 0; n < 3; ++n) search.find_within(boxes, pairs);
  EXPECT_LE(search.cuts(), cuts + 1);
  EXPECT_EQ(search.searches(), 9);
}

}  // namespace
}  // namespace tenon
