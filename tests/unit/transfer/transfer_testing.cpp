// SPDX-License-Identifier: BSD-3-Clause
#include "transfer_testing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "transfer/mesh_items.hpp"

namespace tenon::transfer::testing {

namespace {

struct Value {
  GlobalId id;
  int component;
  double value;
};

}  // namespace

MeshData box(int n, const BoxOptions& options) {
  BoxShape shape;
  shape.low = options.low, shape.high = options.high;
  shape.elements = {n, n, n};
  shape.tetrahedra = options.tetrahedra;
  shape.distortion = options.distortion;
  shape.seed = options.seed;
  return generate(shape);
}

MeshData mixed_box(int n) {
  MeshData mesh = box(n);
  const BlockData cells = mesh.blocks.front();
  mesh.node_sets.clear(), mesh.side_sets.clear(), mesh.blocks.clear();
  const std::array<ElementKind, 3> kinds{ElementKind::hex8, ElementKind::wedge6, ElementKind::pyramid5};
  for (std::size_t b = 0; b < 3; ++b) {
    BlockData block;
    block.name = std::string(topology(kinds[b]).name);
    block.label = static_cast<std::int64_t>(b) + 1;
    block.kind = kinds[b];
    mesh.blocks.push_back(block);
  }
  const auto add = [&](std::size_t b, std::initializer_list<GlobalId> nodes) {
    BlockData& block = mesh.blocks[b];
    block.connectivity.insert(block.connectivity.end(), nodes);
    block.labels.push_back(static_cast<std::int64_t>(block.labels.size()) + 1);
  };
  for (std::size_t e = 0; e < cells.size(); ++e) {
    const GlobalId* v = cells.connectivity.data() + 8 * e;
    Vec3 centre{};
    for (int a = 0; a < 8; ++a) centre = centre + 0.125 * mesh.coordinates[static_cast<std::size_t>(v[a])];
    if (centre[0] < 1.0 / 3) {
      add(0, {v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7]});
    } else if (centre[0] < 2.0 / 3) {
      add(1, {v[0], v[1], v[2], v[4], v[5], v[6]});
      add(1, {v[0], v[2], v[3], v[4], v[6], v[7]});
    } else {
      const auto apex = static_cast<GlobalId>(mesh.coordinates.size());
      mesh.coordinates.push_back(centre);
      mesh.node_labels.push_back(apex + 1);
      const Topology& hex = topology(ElementKind::hex8);
      for (const auto& side : hex.side)  // the normal of a side points out, that of a base towards the apex
        add(2, {v[side[3]], v[side[2]], v[side[1]], v[side[0]], apex});
    }
  }
  return mesh;
}

void rotate(MeshData& mesh, double degrees, const Vec3& about) {
  const double angle = degrees * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
  const double k = 1 / std::sqrt(3.0);
  const Vec3 axis{k, k, k};
  for (Vec3& x : mesh.coordinates) {
    const Vec3 d = x - about;
    x = about + (c * d + (s * cross(axis, d) + (1 - c) * dot(axis, d) * axis));
  }
}

void shift(MeshData& mesh, const Vec3& by) {
  for (Vec3& x : mesh.coordinates) x = x + by;
}

ElementSet element_set(const MeshData& mesh) {
  ElementSet set;
  set.x = mesh.coordinates;
  set.x.push_back({});
  for (const BlockData& block : mesh.blocks)
    set.stride = std::max(set.stride, static_cast<std::size_t>(topology(block.kind).nodes));
  for (const BlockData& block : mesh.blocks) {
    const auto nodes = static_cast<std::size_t>(topology(block.kind).nodes);
    for (std::size_t e = 0; e < block.size(); ++e) {
      Box box;
      for (std::size_t a = 0; a < set.stride; ++a) {
        const GlobalId n = block.connectivity[e * nodes + (a < nodes ? a : 0)];
        set.nodes.push_back(static_cast<LocalIndex>(n));
        box.add(mesh.coordinates[static_cast<std::size_t>(n)]);
      }
      box.inflate(1e-8 * box.diagonal());
      set.boxes.push_back(box);
      set.items.push_back(static_cast<LocalIndex>(set.ids.size()));
      set.ids.push_back(static_cast<GlobalId>(set.ids.size()));
      set.kinds.push_back(block.kind);
    }
  }
  if (mesh.blocks.size() == 1) set.kinds.resize(1);
  return set;
}

std::array<double, max_nodes> weights_of(const Placement& place) {
  std::array<double, max_nodes> weights{};
  if (place.found()) shape_weights(place, std::span(weights).first(place.nodes()));
  return weights;
}

MeshPointer distributed(MeshData mesh, PartitionMethod method) {
  DistributeOptions options;
  options.method = method;
  return distribute(communicator(), std::move(mesh), options);
}

std::vector<Vec3> places(const Mesh& mesh, Location location) {
  if (location == Location::node) return mesh.coordinates;
  std::vector<Vec3> result;
  for_each_element(mesh, [&](LocalIndex, const ElementBlock& block, LocalIndex e) {
    result.push_back(centre_of(block.kind, corners_of(block, e, mesh.coordinates)));
  });
  return result;
}

std::vector<double> sampled(const Mesh& mesh, Location location, const Function& f) {
  return sampled(mesh, location, std::span(&f, 1));
}

std::vector<double> sampled(const Mesh& mesh, Location location, std::span<const Function> f) {
  std::vector<double> values;
  for (const Vec3& x : places(mesh, location))
    for (const Function& component : f) values.push_back(component(x));
  return values;
}

GridTransfer make_transfer(const Pair& pair, FieldKind kind, const TransferOptions& options) {
  FieldDescription field;
  field.name = "field";
  field.location = pair.from;
  field.kind = kind;
  return GridTransfer({pair.source.get(), pair.source->coordinates, pair.from},
                      {pair.target.get(), pair.target->coordinates, pair.to}, field, options, "test");
}

std::vector<double> transferred(const Pair& pair, FieldKind kind, const std::vector<double>& values,
                                const TransferOptions& options, int components) {
  const GridTransfer map = make_transfer(pair, kind, options);
  // Poisoned, so that a value that is never set shows.
  std::vector<double> result(static_cast<std::size_t>(item_count(*pair.target, pair.to) * components),
                             std::numeric_limits<double>::quiet_NaN());
  map.apply(values, result, components);
  return result;
}

double greatest_error(const Mesh& mesh, Location location, const std::vector<double>& values, const Function& f) {
  const std::vector<Vec3> x = places(mesh, location);
  EXPECT_EQ(x.size(), values.size());
  double greatest = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double error = std::abs(values[i] - f(x[i]));
    greatest = std::isnan(error) ? std::numeric_limits<double>::infinity() : std::max(greatest, error);
  }
  return mesh.comm.max(greatest);
}

double global_sum(const Mesh& mesh, Location location, const std::vector<double>& values) {
  ExactSum sum;
  for (const LocalIndex i : items_of(mesh, location).owned) sum.add(values[static_cast<std::size_t>(i)]);
  return mesh.comm.sum(sum);
}

double global_least(const Mesh& mesh, const std::vector<double>& values) {
  double least = std::numeric_limits<double>::infinity();
  for (const double v : values) least = std::min(least, v);
  return mesh.comm.min(least);
}

std::uint64_t fingerprint(const Mesh& mesh, Location location, const std::vector<double>& values, int components) {
  const Items items = items_of(mesh, location);
  std::vector<Value> mine;
  for (std::size_t i = 0; i < values.size(); ++i)
    mine.push_back({items.ids[i / static_cast<std::size_t>(components)], static_cast<int>(i) % components, values[i]});
  std::vector<Value> all = mesh.comm.gather(std::span<const Value>(mine));
  std::stable_sort(all.begin(), all.end(), [](const Value& a, const Value& b) {
    return std::tie(a.id, a.component) < std::tie(b.id, b.component);
  });
  std::uint64_t hash = 0xcbf29ce484222325;  // FNV-1a
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto bits = std::bit_cast<std::uint64_t>(all[i].value);
    if (i > 0 && all[i - 1].id == all[i].id && all[i - 1].component == all[i].component) {
      EXPECT_EQ(bits, std::bit_cast<std::uint64_t>(all[i - 1].value)) << "a ghost of item " << all[i].id << " differs";
      continue;
    }
    for (int shift = 0; shift < 64; shift += 8) hash = (hash ^ (bits >> shift & 0xff)) * 0x100000001b3;
  }
  std::vector<std::uint64_t> shared{hash};
  mesh.comm.broadcast(shared);
  return shared.front();
}

void expect_bits_of_one_rank(const std::string& file_name, const std::map<std::string, std::uint64_t>& fingerprints) {
  if (communicator().size() == 1) {
    std::ofstream file(file_name);
    for (const auto& [name, hash] : fingerprints) file << hash << ' ' << name << '\n';
    EXPECT_TRUE(file.good());
    return;
  }
  std::ifstream file(file_name);
  std::size_t compared = 0;
  for (std::string line; std::getline(file, line); ++compared) {
    std::istringstream words(line);
    std::uint64_t hash = 0;
    std::string name;
    words >> hash >> std::ws;
    std::getline(words, name);
    const auto found = fingerprints.find(name);
    ASSERT_NE(found, fingerprints.end()) << name;
    EXPECT_EQ(found->second, hash) << name;
  }
  EXPECT_EQ(compared, fingerprints.size()) << "run this test on one rank first, in the same folder";
}

double random_number(std::uint64_t seed, std::uint64_t index) {
  std::uint64_t z = seed * 0x9e3779b97f4a7c15 + index + 0x9e3779b97f4a7c15;
  for (int repeat = 0; repeat < 2; ++repeat) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    z ^= z >> 31;
  }
  return static_cast<double>(z >> 11) * 0x1p-53;
}

}  // namespace tenon::transfer::testing
