// SPDX-License-Identifier: BSD-3-Clause
// Meshes assembled from parts with sparse ids in any order, against the whole mesh that every rank makes again.
#include "framework/mesh/assemble.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "tests/support/test_communicator.hpp"
#include "tests/unit/mesh/mesh_samples.hpp"

namespace tenon::testing {
namespace {

/// Ids far apart, some negative, in the order of the numbers.
std::int64_t sparse(GlobalId n) {
  return n * n * 1'000'003 - 5'000'000'000'000 + 17 * n;
}

/// What a code would hold: a part of a mesh, in its own order.
struct OwnPart {
  struct Block {
    std::string name;
    ElementKind kind;
    std::vector<std::int64_t> connectivity, ids;
  };
  std::vector<std::int64_t> node_ids;
  std::vector<Vec3> coordinates;
  std::vector<Block> blocks;

  MeshPart view(bool with_ids = true) const {
    MeshPart part{node_ids, coordinates, {}};
    for (const Block& b : blocks)
      part.blocks.push_back({b.name, b.kind, b.connectivity,
                             with_ids ? std::span<const std::int64_t>(b.ids) : std::span<const std::int64_t>()});
    return part;
  }
  AssembledMesh assemble(const Communicator& comm, bool with_ids = true) const {
    return tenon::assemble(comm, view(with_ids), {.source = "parts"});
  }
};

/// The elements for which `mine(global element)`, last ones first, with their nodes, those twice and backwards; and
/// loose nodes for which `mine(node)`.
OwnPart part_of(const MeshData& whole, const std::function<bool(GlobalId)>& mine) {
  OwnPart part;
  std::set<GlobalId> nodes, touched;
  GlobalId first = 0;
  for (std::size_t b = 0; b < whole.blocks.size(); ++b) {
    const BlockData& block = whole.blocks[b];
    const auto width = static_cast<std::size_t>(topology(block.kind).nodes);
    OwnPart::Block own{"block " + std::string(1, static_cast<char>('a' + b)), block.kind, {}, {}};
    for (std::size_t e = block.size(); e-- > 0;)
      for (std::size_t i = 0; i < width; ++i) {
        const GlobalId n = block.connectivity[e * width + i];
        touched.insert(n);
        if (!mine(first + static_cast<GlobalId>(e))) continue;
        if (i == 0) own.ids.push_back(sparse(first + static_cast<GlobalId>(e)));
        own.connectivity.push_back(sparse(n));
        nodes.insert(n);
      }
    first += static_cast<GlobalId>(block.size());
    if (!own.ids.empty()) part.blocks.insert(part.blocks.begin(), own);
  }
  for (GlobalId n = 0; n < static_cast<GlobalId>(whole.coordinates.size()); ++n)
    if (touched.count(n) == 0 && mine(n)) nodes.insert(n);
  for (int copy = 0; copy < 2; ++copy)
    for (auto n = nodes.rbegin(); n != nodes.rend(); ++n) {
      part.node_ids.push_back(sparse(*n));
      part.coordinates.push_back(whole.coordinates[static_cast<std::size_t>(*n)]);
    }
  return part;
}

/// A brick, a pyramid, a wedge and a shell that share nodes, and nodes that nothing touches.
MeshData mixed() {
  MeshData mesh;
  mesh.coordinates = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0},   {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1},
                      {0, 1, 1}, {9, 9, 9}, {.5, .5, 2}, {2, 0, 0}, {2, 0, 1}, {8, 8, 8}};
  mesh.blocks = {{"", 1, ElementKind::hex8, {0, 1, 2, 3, 4, 5, 6, 7}, {1}},
                 {"", 2, ElementKind::pyramid5, {4, 5, 6, 7, 9}, {2}},
                 {"", 3, ElementKind::wedge6, {1, 10, 2, 5, 11, 6}, {3}},
                 {"", 4, ElementKind::tri3, {5, 11, 6}, {4}}};
  return mesh;
}

std::vector<MeshData> wholes() {
  std::vector<MeshData> all{mixed(), MeshData{}};
  for (const MeshSample& sample : mesh_samples()) all.push_back(sample.make());
  return all;
}

/// Ways of sharing elements out; from three ranks on, the last has nothing.
std::vector<std::function<bool(GlobalId)>> decompositions(GlobalId elements) {
  const Communicator& comm = communicator();
  const GlobalId ranks = comm.size() > 2 ? comm.size() - 1 : comm.size();
  const GlobalId rank = comm.rank();
  return {[=](GlobalId e) { return e * ranks / std::max<GlobalId>(elements, e + 1) == rank; },
          [=](GlobalId e) { return (e * 7919 + 3) % ranks == rank; }, [=](GlobalId e) { return rank == ranks - 1; }};
}

bool owned_here(const Mesh& mesh, GlobalId node) {
  const auto found = std::lower_bound(mesh.node_ids.begin(), mesh.node_ids.end(), node);
  return found != mesh.node_ids.end() && *found == node &&
         mesh.owns_node(static_cast<LocalIndex>(found - mesh.node_ids.begin()));
}

std::vector<GlobalId> global_nodes(const Mesh& mesh, const ElementBlock& block, LocalIndex e) {
  std::vector<GlobalId> ids;
  for (const LocalIndex n : block.nodes(e)) ids.push_back(mesh.node_ids[static_cast<std::size_t>(n)]);
  return ids;
}

/// Every item of `part` is that of `serial`, and exactly those are here that must be.
void expect_part_of(const Mesh& serial, const Mesh& part) {
  const Communicator& comm = communicator();
  ASSERT_EQ(part.global_nodes, serial.global_nodes);
  ASSERT_EQ(part.global_elements, serial.global_elements);
  ASSERT_EQ(part.blocks.size(), serial.blocks.size());
  std::set<LocalIndex> used;
  std::int64_t owned = 0;
  for (std::size_t b = 0; b < part.blocks.size(); ++b) {
    const ElementBlock &mine = part.blocks[b], &all = serial.blocks[b];
    EXPECT_EQ(mine.name, all.name);
    EXPECT_EQ(mine.kind, all.kind);
    EXPECT_EQ(mine.first_id, all.first_id);
    EXPECT_EQ(mine.global_count, all.global_count);
    used.insert(mine.connectivity.begin(), mine.connectivity.end());
    LocalIndex at = 0;
    for (LocalIndex e = 0; e < all.size(); ++e) {
      const auto i = static_cast<std::size_t>(e), k = static_cast<std::size_t>(at);
      const bool here = at < mine.size() && mine.ids[k] == all.ids[i];
      const std::vector<GlobalId> nodes = global_nodes(serial, all, e);
      const bool touches = std::any_of(nodes.begin(), nodes.end(), [&](GlobalId n) { return owned_here(part, n); });
      EXPECT_EQ(here, touches || (here && mine.owners[k] == comm.rank()));
      if (!here) continue;
      EXPECT_EQ(global_nodes(part, mine, at), nodes);
      EXPECT_EQ(mine.labels[k], all.labels[i]);
      owned += mine.owners[k] == comm.rank();
      ++at;
    }
    EXPECT_EQ(at, mine.size());  // ascending, and no others
  }
  EXPECT_EQ(comm.sum(owned), part.global_elements);
  EXPECT_EQ(comm.sum(static_cast<std::int64_t>(part.owned_nodes.size())), part.global_nodes);
  EXPECT_TRUE(std::is_sorted(part.node_ids.begin(), part.node_ids.end(), std::less_equal<>()));
  for (LocalIndex n = 0; n < part.nodes(); ++n) {
    const auto i = static_cast<std::size_t>(n), s = static_cast<std::size_t>(part.node_ids[i]);
    EXPECT_TRUE(used.count(n) == 1 || part.owns_node(n));
    EXPECT_EQ(part.node_labels[i], serial.node_labels[s]);
    EXPECT_EQ(part.coordinates[i], serial.coordinates[s]);
  }
  std::vector<Vec3> x(part.coordinates.size(), Vec3{-7, -7, -7});
  for (const LocalIndex n : part.owned_nodes)
    x[static_cast<std::size_t>(n)] = part.coordinates[static_cast<std::size_t>(n)];
  part.node_halo.forward(std::span<const Vec3>(x), std::span<Vec3>(x));
  EXPECT_EQ(x, part.coordinates);
}

TEST(Assemble, OnOneRankIsTheWholeMeshInTheOrderOfItsIds) {
  for (const MeshData& whole : wholes()) {
    const auto mesh = part_of(whole, [](GlobalId) { return true; }).assemble(Communicator::self()).mesh;
    EXPECT_EQ(mesh->coordinates, whole.coordinates);
    ASSERT_EQ(mesh->blocks.size(), whole.blocks.size());
    GlobalId element = 0;
    for (std::size_t b = 0; b < whole.blocks.size(); ++b) {
      EXPECT_EQ(std::vector<GlobalId>(mesh->blocks[b].connectivity.begin(), mesh->blocks[b].connectivity.end()),
                whole.blocks[b].connectivity);
      for (const std::int64_t label : mesh->blocks[b].labels) EXPECT_EQ(label, sparse(element++));
    }
    for (std::size_t n = 0; n < whole.coordinates.size(); ++n)
      EXPECT_EQ(mesh->node_labels[n], sparse(static_cast<GlobalId>(n)));
  }
}

TEST(Assemble, HasTheInvariantsOfADistributedMeshHoweverItIsShared) {
  for (const bool with_ids : {true, false})
    for (const MeshData& whole : wholes()) {
      const auto serial = part_of(whole, [](GlobalId) { return true; }).assemble(Communicator::self(), with_ids).mesh;
      for (const auto& mine : decompositions(static_cast<GlobalId>(whole.elements())))
        expect_part_of(*serial, *part_of(whole, mine).assemble(communicator(), with_ids).mesh);
    }
}

TEST(Assemble, LeavesElementsAndNodesWithRanksThatGaveThem) {
  const MeshData whole = mixed();
  for (const auto& mine : decompositions(static_cast<GlobalId>(whole.elements()))) {
    const OwnPart part = part_of(whole, mine);
    const auto mesh = part.assemble(communicator()).mesh;
    std::set<std::int64_t> given, owned;
    for (const OwnPart::Block& b : part.blocks) given.insert(b.ids.begin(), b.ids.end());
    for (const ElementBlock& b : mesh->blocks)
      for (const LocalIndex e : owned_elements(b, communicator().rank()))
        owned.insert(b.labels[static_cast<std::size_t>(e)]);
    EXPECT_EQ(owned, given);
    for (const LocalIndex n : mesh->owned_nodes)
      EXPECT_NE(std::find(part.node_ids.begin(), part.node_ids.end(), mesh->node_labels[static_cast<std::size_t>(n)]),
                part.node_ids.end());
  }
}

TEST(Assemble, MovesValuesBetweenGivenAndLocalOrder) {
  for (const MeshData& whole : wholes())
    for (const auto& mine : decompositions(static_cast<GlobalId>(whole.elements()))) {
      const OwnPart part = part_of(whole, mine);
      const AssembledMesh assembled = part.assemble(communicator());
      const Mesh& mesh = *assembled.mesh;
      EXPECT_EQ(assembled.nodes_to_mesh(part.coordinates), mesh.coordinates);
      const std::vector<double> given(part.node_ids.begin(), part.node_ids.end());
      const std::vector<double> labels(mesh.node_labels.begin(), mesh.node_labels.end());
      EXPECT_EQ(assembled.nodes_to_mesh(given), labels);
      EXPECT_EQ(assembled.nodes_from_mesh(labels), given);

      std::vector<double> elements, local;
      for (const OwnPart::Block& b : part.blocks)
        for (const std::int64_t id : b.ids) elements.push_back(static_cast<double>(id)), elements.push_back(-1);
      for (const ElementBlock& b : mesh.blocks)
        for (const std::int64_t id : b.labels) local.push_back(static_cast<double>(id)), local.push_back(-1);
      EXPECT_EQ(assembled.elements_to_mesh(elements, 2), local);
      EXPECT_EQ(assembled.elements_from_mesh(local, 2), elements);
    }
}

TEST(Assemble, TakesNodesThatOnlyAnotherRankGives) {
  const MeshData whole = mixed();
  const bool first = communicator().rank() == 0, last = communicator().rank() == communicator().size() - 1;
  OwnPart part = part_of(whole, [&](GlobalId) { return last; });
  const OwnPart nodes = part_of(whole, [&](GlobalId) { return first; });
  part.node_ids = nodes.node_ids, part.coordinates = nodes.coordinates;
  const AssembledMesh assembled = part.assemble(communicator());
  expect_part_of(*part_of(whole, [](GlobalId) { return true; }).assemble(Communicator::self()).mesh, *assembled.mesh);
  EXPECT_EQ(assembled.nodes_to_mesh(part.coordinates), assembled.mesh->coordinates);
}

TEST(Assemble, AllowsForRoundOffInCopiesIfAsked) {
  const MeshData whole = mixed();
  OwnPart part = part_of(whole, [](GlobalId) { return communicator().rank() == 0; });
  for (std::size_t n = 0; n < part.coordinates.size() / 2; ++n) part.coordinates[n][1] += 1e-12;
  const auto mesh = assemble(communicator(), part.view(), {.source = "parts", .coordinate_tolerance = 1e-11}).mesh;
  for (std::size_t n = 0; n < mesh->coordinates.size(); ++n)
    EXPECT_EQ(mesh->coordinates[n], whole.coordinates[static_cast<std::size_t>(mesh->node_ids[n])]);
  EXPECT_THROW(assemble(communicator(), part.view(), {}), Error);
}

/// What `assemble` says, the same on all ranks.
std::string refusal(const MeshPart& part) {
  std::string said = "nothing";
  try {
    assemble(communicator(), part, {.source = "parts"});
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::file);
    said = error.what();
  }
  std::string same = said;
  communicator().broadcast(same);
  EXPECT_EQ(said, same);
  return said;
}

void expect_mentions(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words) EXPECT_NE(text.find(word), std::string::npos) << text << "\nlacks: " << word;
}

/// The mixed mesh, its elements shared out one by one.
OwnPart own_part() {
  return part_of(mixed(), [](GlobalId e) { return e % communicator().size() == communicator().rank(); });
}

TEST(Assemble, RefusesWhatOneRankGivesWrong) {
  const auto spoiled = [](const std::function<void(OwnPart&)>& spoil) {
    OwnPart part = own_part();
    if (communicator().rank() == 0) spoil(part);
    return refusal(part.view());
  };
  expect_mentions(spoiled([](OwnPart& p) { p.blocks.back().connectivity[2] = 12345; }),
                  {"parts: ", "no rank gives", "node 12345", "element -5000000000000 of block \"block a\" on rank 0"});
  expect_mentions(spoiled([](OwnPart& p) { p.coordinates[0][2] += 1e-9; }),
                  {"same node at different places", "and at ("});
  expect_mentions(spoiled([](OwnPart& p) { p.coordinates[0][1] = std::nan(""); }), {"finite", "nan"});
  expect_mentions(spoiled([](OwnPart& p) { p.node_ids.push_back(3); }), {"rank 0 gives", "node ids but"});
  expect_mentions(spoiled([](OwnPart& p) { p.blocks.back().connectivity.pop_back(); }),
                  {"7 entries", "8 nodes of a hex8"});
  expect_mentions(spoiled([](OwnPart& p) { p.blocks.back().ids.push_back(3); }), {"1 elements but 2 element ids"});
  expect_mentions(spoiled([](OwnPart& p) { p.blocks.push_back(p.blocks.back()); }), {"\"block a\" twice"});
}

TEST(Assemble, RefusesElementsThatAreGivenTwice) {
  OwnPart part = part_of(mixed(), [](GlobalId) { return true; });
  if (communicator().size() == 1)
    for (OwnPart::Block& b : part.blocks) {
      b.ids.push_back(b.ids[0]);
      b.connectivity.insert(b.connectivity.end(), b.connectivity.begin(), b.connectivity.end());
    }
  expect_mentions(refusal(part.view()), {"block \"block a\"", "more than once", "with id -5000000000000"});
  expect_mentions(refusal(part.view(false)), {"block \"block a\"", "more than once", "with nodes -5000000000000, -4"});
}

TEST(Assemble, RefusesBlocksOnWhichRanksDoNotAgree) {
  if (communicator().size() == 1) return;  // one rank cannot disagree with itself
  OwnPart part = part_of(mixed(), [](GlobalId) { return communicator().rank() == 0; });
  const bool last = communicator().rank() == communicator().size() - 1;
  if (last) part.blocks = {{"block b", ElementKind::tet4, {}, {}}};
  expect_mentions(refusal(part.view()), {"block \"block b\"", "as pyramid5 and as tet4"});
  if (last)
    part.blocks = {{"block b", ElementKind::pyramid5, {sparse(0), sparse(1), sparse(2), sparse(3), sparse(4)}, {}}};
  expect_mentions(refusal(part.view()), {"some ranks give element ids for block \"block b\""});
}

}  // namespace
}  // namespace tenon::testing
