// SPDX-License-Identifier: BSD-3-Clause
// Distributed meshes against the whole mesh, which every rank makes again: ownership, ghosts, order, sets, sums.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>

#include "framework/mesh/dual_graph.hpp"
#include "framework/mesh/mesh.hpp"
#include "tests/support/test_communicator.hpp"
#include "tests/unit/mesh/mesh_samples.hpp"
#include "tests/unit/mesh/sample_elements.hpp"

namespace tenon::testing {
namespace {

/// A brick, a pyramid on it, a wedge beside it, a shell on the wedge, tetrahedra apart, and nodes that nothing touches.
MeshData mixed_mesh() {
  MeshData mesh;
  mesh.source = "mixed";
  mesh.coordinates = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0},   {0, 1, 0}, {0, 0, 1}, {1, 0, 1},
                      {1, 1, 1}, {0, 1, 1}, {.5, .5, 2}, {2, 0, 0}, {2, 0, 1}, {9, 9, 9},
                      {5, 0, 0}, {6, 0, 0}, {5, 1, 0},   {5, 0, 1}, {8, 8, 8}, {6, 1, 1}};
  for (std::size_t n = 0; n < mesh.coordinates.size(); ++n)
    mesh.node_labels.push_back(1000 + 7 * static_cast<std::int64_t>(n));
  mesh.blocks = {{"brick", 1, ElementKind::hex8, {0, 1, 2, 3, 4, 5, 6, 7}, {11}},
                 {"nothing", 9, ElementKind::hex8, {}, {}},
                 {"roof", 2, ElementKind::pyramid5, {4, 5, 6, 7, 8}, {12}},
                 {"ramp", 3, ElementKind::wedge6, {1, 9, 2, 5, 10, 6}, {13}},
                 {"cover", 4, ElementKind::tri3, {5, 10, 6}, {14}},
                 {"chips", 5, ElementKind::tet4, {12, 13, 14, 15, 17, 15, 14, 13}, {16, 15}}};
  mesh.node_sets = {{"loose", 1, {11, 16}}, {"empty", 2, {}}, {"some", 3, {0, 8, 12, 17}}};
  mesh.side_sets = {{"none", 1, {}}, {"both", 2, {{0, 4}, {1, 0}, {2, 1}, {2, 2}, {3, 0}, {4, 3}, {5, 0}}}};
  add_derived_sets(mesh);
  return mesh;
}

std::vector<MeshSample> all_samples() {
  std::vector<MeshSample> samples = mesh_samples();
  for (MeshSample& s : samples)
    s.make = [make = s.make] {
      MeshData mesh = make();
      add_derived_sets(mesh);
      return mesh;
    };
  samples.push_back({"mixed", mixed_mesh});
  samples.push_back({"one element", [] {
                       MeshData mesh = generate(BoxShape{});
                       add_derived_sets(mesh);
                       return mesh;
                     }});
  samples.push_back({"nothing", [] { return MeshData{}; }});
  return samples;
}

struct Case {
  std::string name;
  MeshData whole;
  std::shared_ptr<const Mesh> mesh;
};

Case make(const MeshSample& sample, PartitionMethod method) {
  const Communicator& comm = communicator();
  Case c{sample.name, sample.make(), nullptr};
  c.mesh = distribute(comm, comm.rank() == 0 ? sample.make() : MeshData{}, {.cost = {}, .method = method});
  return c;
}

/// All samples, distributed once; some by the other methods also.
class Distribute : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    int i = 0;
    for (const MeshSample& sample : all_samples()) {
      cases.push_back(make(sample, PartitionMethod::automatic));
      if (i % 4 == 1) cases.push_back(make(sample, PartitionMethod::graph));
      if (i % 4 == 3) cases.push_back(make(sample, PartitionMethod::rcb));
      ++i;
    }
  }
  static void TearDownTestSuite() { cases.clear(); }  // before MPI ends
  static std::vector<Case> cases;
};
std::vector<Case> Distribute::cases;

/// Global node ids of an element.
std::vector<GlobalId> global_nodes(const Mesh& mesh, const ElementBlock& block, LocalIndex e) {
  std::vector<GlobalId> ids;
  for (const LocalIndex n : block.nodes(e)) ids.push_back(mesh.node_ids[static_cast<std::size_t>(n)]);
  return ids;
}

std::vector<GlobalId> whole_nodes(const BlockData& block, GlobalId e) {
  const auto n = static_cast<std::size_t>(topology(block.kind).nodes);
  const auto first = block.connectivity.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(e) * n);
  return {first, first + static_cast<std::ptrdiff_t>(n)};
}

TEST_F(Distribute, EveryItemIsOwnedOnceAndAllRanksAgree) {
  const Communicator& comm = communicator();
  for (const auto& [name, whole, mesh] : cases) {
    // Each rank adds (rank + 1) for what it owns; a copy elsewhere must name the same owner.
    std::vector<std::int64_t> node_owner(whole.coordinates.size(), 0), node_count(node_owner), element_owner,
        element_count;
    element_owner.assign(whole.elements(), 0);
    element_count = element_owner;
    for (const LocalIndex n : mesh->owned_nodes) {
      const auto id = static_cast<std::size_t>(mesh->node_ids[static_cast<std::size_t>(n)]);
      node_owner[id] += comm.rank(), node_count[id] += 1;
    }
    for (const ElementBlock& b : mesh->blocks)
      for (const LocalIndex e : owned_elements(b, comm.rank())) {
        const auto id = static_cast<std::size_t>(b.ids[static_cast<std::size_t>(e)]);
        element_owner[id] += comm.rank(), element_count[id] += 1;
      }
    for (auto* v : {&node_owner, &node_count, &element_owner, &element_count}) comm.sum(std::span<std::int64_t>(*v));
    EXPECT_EQ(node_count, std::vector<std::int64_t>(node_count.size(), 1)) << name;
    EXPECT_EQ(element_count, std::vector<std::int64_t>(element_count.size(), 1)) << name;
    for (std::size_t n = 0; n < mesh->node_ids.size(); ++n)
      EXPECT_EQ(mesh->node_owners[n], node_owner[static_cast<std::size_t>(mesh->node_ids[n])]);
    for (const ElementBlock& b : mesh->blocks)
      for (std::size_t e = 0; e < b.ids.size(); ++e)
        EXPECT_EQ(b.owners[e], element_owner[static_cast<std::size_t>(b.ids[e])]);
  }
}

TEST_F(Distribute, HoldsOwnElementsAndAllThatTouchOwnNodesAndNoMore) {
  const Communicator& comm = communicator();
  for (const auto& [name, whole, mesh] : cases) {
    std::set<GlobalId> own;
    for (const LocalIndex n : mesh->owned_nodes) own.insert(mesh->node_ids[static_cast<std::size_t>(n)]);
    ASSERT_EQ(mesh->blocks.size(), whole.blocks.size());
    GlobalId first = 0;
    for (std::size_t b = 0; b < whole.blocks.size(); ++b) {
      const ElementBlock& part = mesh->blocks[b];
      EXPECT_EQ(part.name, whole.blocks[b].name);
      EXPECT_EQ(part.kind, whole.blocks[b].kind);
      EXPECT_EQ(part.first_id, first);
      EXPECT_EQ(part.global_count, static_cast<GlobalId>(whole.blocks[b].size()));
      for (GlobalId e = 0; e < part.global_count; ++e) {
        const std::vector<GlobalId> nodes = whole_nodes(whole.blocks[b], e);
        const bool touches = std::any_of(nodes.begin(), nodes.end(), [&](GlobalId n) { return own.count(n) == 1; });
        const auto found = std::lower_bound(part.ids.begin(), part.ids.end(), first + e);
        const bool here = found != part.ids.end() && *found == first + e;
        const auto at = found - part.ids.begin();
        const bool owned = here && part.owners[static_cast<std::size_t>(at)] == comm.rank();
        EXPECT_EQ(here, touches || owned) << name << e;
        if (!here) continue;
        EXPECT_EQ(global_nodes(*mesh, part, static_cast<LocalIndex>(at)), nodes) << name;
        EXPECT_EQ(part.labels[static_cast<std::size_t>(at)], whole.blocks[b].labels[static_cast<std::size_t>(e)]);
      }
      first += part.global_count;
    }
  }
}

TEST_F(Distribute, StoresEverythingInAscendingOrder) {
  for (const auto& [name, whole, mesh] : cases) {
    const auto ascends = [](const auto& v) {
      return std::adjacent_find(v.begin(), v.end(), std::greater_equal<>()) == v.end();
    };
    EXPECT_TRUE(ascends(mesh->node_ids));
    EXPECT_TRUE(ascends(mesh->owned_nodes));
    for (const ElementBlock& b : mesh->blocks) {
      EXPECT_TRUE(ascends(b.ids));
      EXPECT_EQ(b.connectivity.size(), b.ids.size() * static_cast<std::size_t>(topology(b.kind).nodes));
    }
    for (const NodeSet& s : mesh->node_sets) EXPECT_TRUE(ascends(s.nodes));
    std::set<LocalIndex> used;
    for (const ElementBlock& b : mesh->blocks) used.insert(b.connectivity.begin(), b.connectivity.end());
    for (LocalIndex n = 0; n < mesh->nodes(); ++n)  // nodes of local elements, and loose ones with their owner
      EXPECT_TRUE(used.count(n) == 1 || mesh->owns_node(n)) << name;
  }
}

TEST_F(Distribute, CarriesCoordinatesAndLabels) {
  for (const auto& [name, whole, mesh] : cases) {
    EXPECT_EQ(mesh->source, whole.source);
    EXPECT_EQ(mesh->global_nodes, static_cast<GlobalId>(whole.coordinates.size()));
    EXPECT_EQ(mesh->global_elements, static_cast<GlobalId>(whole.elements()));
    for (std::size_t n = 0; n < mesh->node_ids.size(); ++n) {
      const auto id = static_cast<std::size_t>(mesh->node_ids[n]);
      EXPECT_EQ(mesh->coordinates[n], whole.coordinates[id]);
      EXPECT_EQ(mesh->node_labels[n], whole.node_labels[id]);
    }
  }
}

TEST_F(Distribute, SetsAreCompleteForEverythingHere) {
  for (const auto& [name, whole, mesh] : cases) {
    ASSERT_EQ(mesh->node_sets.size(), whole.node_sets.size());
    for (std::size_t s = 0; s < whole.node_sets.size(); ++s) {
      const NodeSetData& set = whole.node_sets[s];
      EXPECT_EQ(mesh->node_sets[s].name, set.name);
      EXPECT_EQ(mesh->node_sets[s].global_count, static_cast<GlobalId>(set.nodes.size()));
      std::vector<LocalIndex> expected;
      for (LocalIndex n = 0; n < mesh->nodes(); ++n)
        if (std::binary_search(set.nodes.begin(), set.nodes.end(), mesh->node_ids[static_cast<std::size_t>(n)]))
          expected.push_back(n);
      EXPECT_EQ(mesh->node_sets[s].nodes, expected) << name << set.name;
    }
    ASSERT_EQ(mesh->side_sets.size(), whole.side_sets.size());
    for (std::size_t s = 0; s < whole.side_sets.size(); ++s) {
      const SideSetData& set = whole.side_sets[s];
      EXPECT_EQ(mesh->side_sets[s].name, set.name);
      EXPECT_EQ(mesh->side_sets[s].global_count, static_cast<GlobalId>(set.sides.size()));
      std::vector<SideData> expected, found;
      for (const SideData& side : set.sides)
        for (const ElementBlock& b : mesh->blocks)
          if (std::binary_search(b.ids.begin(), b.ids.end(), side.element)) expected.push_back(side);
      for (const Side& side : mesh->side_sets[s].sides)
        found.push_back({mesh->blocks[static_cast<std::size_t>(side.block)].ids[static_cast<std::size_t>(side.element)],
                         side.side});
      EXPECT_EQ(found, expected) << name << set.name;
    }
  }
}

TEST_F(Distribute, HaloBringsTheOwnersValues) {
  for (const auto& [name, whole, mesh] : cases) {
    std::vector<Vec3> x(mesh->coordinates.size(), Vec3{-7, -7, -7});
    for (const LocalIndex n : mesh->owned_nodes)
      x[static_cast<std::size_t>(n)] = mesh->coordinates[static_cast<std::size_t>(n)];
    mesh->node_halo.forward(std::span<const Vec3>(x), std::span<Vec3>(x));
    EXPECT_EQ(x, mesh->coordinates) << name;
  }
}

TEST_F(Distribute, SumsAroundOwnNodesAreTheSerialOnesToTheBit) {
  // Terms of very different size, so that another order of addition gives other bits.
  const auto term = [](GlobalId element, std::size_t corner) {
    Random random(static_cast<std::uint64_t>(element) * 8 + corner);
    const double u = random.between(-1, 1);
    return u * std::ldexp(1.0, static_cast<int>(40 * random()));
  };
  for (const auto& [name, whole, mesh] : cases) {
    std::vector<double> serial(whole.coordinates.size(), 0), sum(mesh->node_ids.size(), 0);
    GlobalId element = 0;
    for (const BlockData& b : whole.blocks)
      for (GlobalId e = 0; e < static_cast<GlobalId>(b.size()); ++e, ++element) {
        const std::vector<GlobalId> nodes = whole_nodes(b, e);
        for (std::size_t i = 0; i < nodes.size(); ++i) serial[static_cast<std::size_t>(nodes[i])] += term(element, i);
      }
    for (const ElementBlock& b : mesh->blocks)
      for (LocalIndex e = 0; e < b.size(); ++e)
        for (std::size_t i = 0; i < b.nodes(e).size(); ++i)
          sum[static_cast<std::size_t>(b.nodes(e)[i])] += term(b.ids[static_cast<std::size_t>(e)], i);
    for (const LocalIndex n : mesh->owned_nodes) {
      const auto i = static_cast<std::size_t>(n);
      EXPECT_EQ(std::memcmp(&sum[i], &serial[static_cast<std::size_t>(mesh->node_ids[i])], sizeof(double)), 0) << name;
    }
  }
}

TEST_F(Distribute, BalancesElementsAndNodes) {
  const Communicator& comm = communicator();
  BoxShape shape;
  shape.elements = {20, 20, 20};
  for (const PartitionMethod method : {PartitionMethod::graph, PartitionMethod::rcb}) {
    const auto mesh = distribute(comm, comm.rank() == 0 ? generate(shape) : MeshData{}, {.cost = {}, .method = method});
    const auto elements = owned_elements(mesh->blocks[0], comm.rank()).size();
    EXPECT_LT(imbalance(comm, static_cast<double>(elements)), 1.05);
    EXPECT_LT(imbalance(comm, static_cast<double>(mesh->owned_nodes.size())), 1.10);
  }
}

TEST_F(Distribute, WeighsBlocksByTheirCost) {
  // Two boxes in one mesh, elements of the second ten times as dear.
  const Communicator& comm = communicator();
  MeshData mesh;
  if (comm.rank() == 0) {
    BoxShape shape;
    shape.elements = {12, 12, 12};
    mesh = generate(shape);
    shape.low = {2, 0, 0}, shape.high = {3, 1, 1};
    MeshData other = generate(shape);
    for (GlobalId& n : other.blocks[0].connectivity) n += static_cast<GlobalId>(mesh.coordinates.size());
    other.blocks[0].name = "dear";
    mesh.blocks.push_back(other.blocks[0]);
    mesh.coordinates.insert(mesh.coordinates.end(), other.coordinates.begin(), other.coordinates.end());
    mesh.node_labels.insert(mesh.node_labels.end(), other.node_labels.begin(), other.node_labels.end());
    mesh.node_sets.clear(), mesh.side_sets.clear();
  }
  const auto cost = [](const std::string& block, ElementKind) { return block == "dear" ? 10.0 : 1.0; };
  const auto part = distribute(comm, std::move(mesh), {.cost = cost, .method = PartitionMethod::automatic});
  const double work = static_cast<double>(owned_elements(part->blocks[0], comm.rank()).size()) +
                      10 * static_cast<double>(owned_elements(part->blocks[1], comm.rank()).size());
  EXPECT_LT(imbalance(comm, work), 1.06);
}

TEST_F(Distribute, RefusesOnAllRanksTogether) {
  const Communicator& comm = communicator();
  const auto attempt = [&](MeshData mesh, const ElementCost& cost) {
    try {
      distribute(comm, comm.rank() == 0 ? std::move(mesh) : MeshData{}, {.cost = cost, .method = {}});
    } catch (const Error& e) {
      return e.code();
    }
    return ExitCode::done;
  };
  MeshData mesh = generate(BoxShape{});
  mesh.blocks[0].connectivity[0] = 8;
  EXPECT_EQ(attempt(mesh, {}), ExitCode::file);
  if (comm.size() > 1) {
    EXPECT_EQ(attempt(generate(BoxShape{}), [](const std::string&, ElementKind) { return 0.0; }), ExitCode::usage);
  }
}

TEST(DualGraph, JoinsElementsThatShareAFaceOrSurfacesThatShareAnEdge) {
  const PartitionGraph graph = dual_graph(mixed_mesh(), {}, true);
  std::set<std::pair<GlobalId, GlobalId>> edges;
  for (std::size_t e = 0; e < graph.ids.size(); ++e)
    for (LocalIndex k = graph.offsets[e]; k < graph.offsets[e + 1]; ++k)
      edges.insert({graph.ids[e], graph.adjacency[static_cast<std::size_t>(k)]});
  // 0 brick, 1 roof, 2 ramp, 3 cover on the ramp, 4 and 5 chips with a common face.
  const std::set<std::pair<GlobalId, GlobalId>> expected{{0, 1}, {1, 0}, {0, 2}, {2, 0},
                                                         {2, 3}, {3, 2}, {4, 5}, {5, 4}};
  EXPECT_EQ(edges, expected);

  PlateShape shape;
  shape.elements_x = 3, shape.elements_y = 2;
  const PartitionGraph plate = dual_graph(generate(shape), {}, true);
  EXPECT_EQ(plate.adjacency.size(), 2u * (2 * 2 + 3));
  BoxShape box;
  box.elements = {3, 4, 5};
  EXPECT_EQ(dual_graph(generate(box), {}, true).adjacency.size(), 2u * (2 * 4 * 5 + 3 * 3 * 5 + 3 * 4 * 4));
  EXPECT_TRUE(dual_graph(generate(box), {}, false).adjacency.empty());
}

TEST(DualGraph, JoinsAllWhereManySurfacesMeetAtAnEdge) {
  MeshData fan;  // five triangles around one edge
  fan.coordinates = {{0, 0, 0}, {0, 0, 1}};
  fan.blocks = {{"fan", 1, ElementKind::tri3, {}, {}}};
  for (int i = 0; i < 5; ++i) {
    fan.coordinates.push_back({std::cos(i), std::sin(i), 0});
    for (const GlobalId n : {0, 1, 2 + i}) fan.blocks[0].connectivity.push_back(n);
    fan.blocks[0].labels.push_back(i);
  }
  const PartitionGraph graph = dual_graph(fan, {}, true);
  EXPECT_EQ(graph.adjacency, (std::vector<GlobalId>{1, 0, 2, 1, 3, 2, 4, 3}));
}

TEST(NodeOwners, AreAmongTheOwnersAroundAndEvenlyChosen) {
  BoxShape shape;
  shape.elements = {2, 60, 60};
  const MeshData mesh = generate(shape);
  std::vector<int> owner(mesh.elements());
  for (std::size_t e = 0; e < owner.size(); ++e) owner[e] = static_cast<int>(e % 2);  // cut along the plane x = 0.5
  const std::vector<int> nodes = node_owners(mesh, owner);
  std::int64_t first = 0, cut = 0;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const double x = mesh.coordinates[n][0];
    if (x == 0.5) {
      ++cut;
      first += nodes[n] == 0 ? 1 : 0;
    } else {
      EXPECT_EQ(nodes[n], x < 0.5 ? 0 : 1);
    }
  }
  EXPECT_EQ(cut, 61 * 61);
  EXPECT_NEAR(static_cast<double>(first) / static_cast<double>(cut), 0.5, 0.03);
}

TEST(MeshSummary, IsTheSameOnAllRanks) {
  const Communicator& comm = communicator();
  const MeshSummary expected = summarise(mixed_mesh());
  const MeshSummary found = broadcast_summary(comm, comm.rank() == 0 ? expected : MeshSummary{});
  EXPECT_EQ(found.source, expected.source);
  EXPECT_EQ(found.nodes, expected.nodes);
  EXPECT_EQ(found.elements, expected.elements);
  EXPECT_EQ(found.low, expected.low);
  EXPECT_EQ(found.high, expected.high);
  const auto same = [](const std::vector<MeshSummary::Entry>& a, const std::vector<MeshSummary::Entry>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
      return x.name == y.name && x.label == y.label && x.count == y.count && x.kind == y.kind;
    });
  };
  EXPECT_TRUE(same(found.blocks, expected.blocks));
  EXPECT_TRUE(same(found.node_sets, expected.node_sets));
  EXPECT_TRUE(same(found.side_sets, expected.side_sets));
}

TEST(Mesh, FindsByName) {
  const auto mesh = make({"mixed", mixed_mesh}, PartitionMethod::automatic).mesh;
  ASSERT_NE(mesh->find_block("roof"), nullptr);
  EXPECT_EQ(mesh->find_block("roof")->kind, ElementKind::pyramid5);
  EXPECT_EQ(mesh->find_block("Roof"), nullptr);
  ASSERT_NE(mesh->find_node_set("some"), nullptr);
  EXPECT_EQ(mesh->find_node_set("some")->global_count, 4);
  ASSERT_NE(mesh->find_side_set("skin"), nullptr);
  EXPECT_EQ(mesh->find_side_set(""), nullptr);
}

}  // namespace
}  // namespace tenon::testing
