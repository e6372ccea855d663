// SPDX-License-Identifier: BSD-3-Clause
#include "bench_cases.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

#include "framework/mesh/assemble.hpp"

namespace tenon::bench {

namespace {

/// splitmix64 [SLF14], the finaliser as a hash.
std::uint64_t mix(std::uint64_t z) {
  z += 0x9E3779B97F4A7C15ULL;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

double uniform(std::uint64_t seed, std::uint64_t id, std::uint64_t component) {
  return static_cast<double>(mix(mix(seed) + 4 * id + component) >> 11) * 0x1p-53;
}

/// Makes hex20 of hex8.
void add_middle_nodes(MeshData& mesh) {
  constexpr std::size_t edges[12][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                                        {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
  BlockData& block = mesh.blocks.front();
  const std::vector<GlobalId> corners = std::exchange(block.connectivity, {});
  block.kind = ElementKind::hex20;
  std::map<std::pair<GlobalId, GlobalId>, GlobalId> middle;
  for (std::size_t e = 0; e < block.size(); ++e) {
    const GlobalId* const from = corners.data() + 8 * e;
    block.connectivity.insert(block.connectivity.end(), from, from + 8);
    for (const auto& [a, b] : edges) {
      const auto next = static_cast<GlobalId>(mesh.coordinates.size());
      const auto [place, added] = middle.try_emplace(std::minmax(from[a], from[b]), next);
      if (added)
        mesh.coordinates.push_back(0.5 * (mesh.coordinates[static_cast<std::size_t>(from[a])] +
                                          mesh.coordinates[static_cast<std::size_t>(from[b])]));
      block.connectivity.push_back(place->second);
    }
  }
}

/// Collective. The elements of this rank's slab of a cube that every rank has whole.
std::shared_ptr<const Mesh> slab_of(const MeshData& whole, int n, std::size_t axis) {
  const Communicator world = Communicator::world();
  const BlockData& all = whole.blocks.front();
  const auto nodes = static_cast<std::size_t>(topology(all.kind).nodes), side = static_cast<std::size_t>(n);
  const std::size_t in_cell = all.size() / (side * side * side), stride = axis == 0 ? 1 : side;
  std::vector<std::int64_t> connectivity, ids, used;
  for (std::size_t e = 0; e < all.size(); ++e) {
    const std::size_t layer = e / in_cell / stride % side;
    if (static_cast<int>(layer * static_cast<std::size_t>(world.size()) / side) != world.rank()) continue;
    const auto* const first = all.connectivity.data() + e * nodes;
    connectivity.insert(connectivity.end(), first, first + nodes);
    ids.push_back(static_cast<std::int64_t>(e));
  }
  used = connectivity;
  std::ranges::sort(used);
  used.erase(std::ranges::unique(used).begin(), used.end());
  std::vector<Vec3> coordinates;
  for (const std::int64_t id : used) coordinates.push_back(whole.coordinates[static_cast<std::size_t>(id)]);
  MeshPart part{used, coordinates, {{"cube", all.kind, connectivity, ids}}};
  return assemble(world, part, {.source = "cube"}).mesh;
}

}  // namespace

std::shared_ptr<const Mesh> cube(int n, std::uint64_t seed, const CubeShape& shape) {
  BoxShape box;
  box.elements = {n, n, n};
  box.grading = {shape.grading, shape.grading, shape.grading};
  box.distortion = 0.2;
  box.seed = seed;
  box.tetrahedra = shape.kind == ElementKind::tet4;
  MeshData mesh = generate(box);
  if (shape.kind == ElementKind::hex20) add_middle_nodes(mesh);
  return slab_of(mesh, n, shape.slabs == Slabs::x ? 0 : 1);
}

std::shared_ptr<const Mesh> sphere_surface(int n) {
  SphereShape shape;
  shape.core = n;
  shape.shell = 1;
  const MeshData ball = generate(shape);
  const BlockData& solids = ball.blocks.front();
  const Topology& hex = topology(solids.kind);
  MeshData surface;
  surface.source = "sphere";
  surface.blocks.push_back({"sphere", 1, ElementKind::quad4, {}, {}});
  BlockData& quads = surface.blocks.front();
  std::vector<GlobalId> number(ball.coordinates.size(), no_id);
  for (const SideData& side : skin(ball)) {
    quads.labels.push_back(static_cast<std::int64_t>(quads.labels.size()) + 1);
    for (const std::int8_t corner : hex.side[static_cast<std::size_t>(side.side)]) {
      const auto node =
          static_cast<std::size_t>(solids.connectivity[static_cast<std::size_t>(side.element * hex.nodes + corner)]);
      if (number[node] == no_id) {
        number[node] = static_cast<GlobalId>(surface.coordinates.size());
        surface.coordinates.push_back(ball.coordinates[node]);
        surface.node_labels.push_back(number[node] + 1);
      }
      quads.connectivity.push_back(number[node]);
    }
  }
  return distribute(Communicator::world(), std::move(surface), {});
}

Targets nodes_of(std::string name, std::shared_ptr<const Mesh> mesh) {
  return {std::move(name), mesh->coordinates, mesh->owned_nodes, mesh->global_nodes, mesh, nullptr};
}

Targets random_points(GlobalId count, std::uint64_t seed) {
  const Communicator world = Communicator::world();
  transfer::PointCloud cloud{world, {}, "random points"};
  Targets targets{"random points", {}, {}, count, nullptr, nullptr};
  for (std::uint64_t q = 0; q < static_cast<std::uint64_t>(count); ++q) {
    const Vec3 x{uniform(seed, q, 0), uniform(seed, q, 1), uniform(seed, q, 2)};
    if (static_cast<int>(x[1] * world.size()) != world.rank()) continue;
    cloud.ids.push_back(static_cast<GlobalId>(q));
    targets.points.push_back(x);
  }
  targets.owned.resize(cloud.ids.size());
  std::iota(targets.owned.begin(), targets.owned.end(), 0);
  targets.cloud = std::make_shared<const transfer::PointCloud>(std::move(cloud));
  return targets;
}

std::unique_ptr<transfer::GridTransfer> interpolation(const Mesh& source, std::span<const Vec3> coordinates,
                                                      const Targets& targets,
                                                      const transfer::TransferOptions& options) {
  FieldDescription field;
  field.name = "field";
  return std::make_unique<transfer::GridTransfer>(transfer::Grid{&source, coordinates, Location::node}, targets.grid(),
                                                  field, options, "bench");
}

double smooth_field(const Vec3& x) {
  using std::numbers::pi;
  return std::sin(2 * pi * x[0]) * std::cos(3 * pi * x[1]) * std::exp(x[2]);
}

double linear_field(const Vec3& x) {
  return 1 + 2 * x[0] - 3 * x[1] + 0.5 * x[2];
}

std::vector<double> sampled(std::span<const Vec3> points, Function f) {
  std::vector<double> values;
  values.reserve(points.size());
  for (const Vec3& x : points) values.push_back(f(x));
  return values;
}

Errors errors_of(const Targets& targets, std::span<const double> values, Function f) {
  Errors errors;
  ExactSum squares;
  for (const LocalIndex n : targets.owned) {
    const double error = std::abs(values[static_cast<std::size_t>(n)] - f(targets.points[static_cast<std::size_t>(n)]));
    errors.greatest = std::max(errors.greatest, std::isnan(error) ? HUGE_VAL : error);
    squares.add(error * error);
  }
  const Communicator& comm = targets.comm();
  errors.greatest = comm.max(errors.greatest);
  errors.rms = std::sqrt(comm.sum(squares) / static_cast<double>(targets.count));
  return errors;
}

}  // namespace tenon::bench
