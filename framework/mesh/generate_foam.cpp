// SPDX-License-Identifier: BSD-3-Clause
// Open-cell foam: bricks of a fine lattice that lie in a strut, rounded.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/base/error.hpp"
#include "framework/mesh/generator_tools.hpp"
#include "framework/mesh/generators.hpp"

namespace tenon {

namespace {

struct Strut {
  Vec3 from, to;
};

/// Edges of Kelvin's cells around the unit cube [0, 1]^3. The corners of a truncated octahedron about the origin are
/// the permutations of (0, +-1/4, +-1/2); the cells are centred at corners and middles of the cubes.
std::vector<Strut> kelvin_struts() {
  std::vector<Vec3> corners;
  for (const double a : {-0.25, 0.25})
    for (const double b : {-0.5, 0.5})
      for (std::size_t zero = 0; zero < 3; ++zero)
        for (std::size_t turn = 1; turn <= 2; ++turn) {
          Vec3 x{0, 0, 0};
          x[(zero + turn) % 3] = a, x[(zero + 3 - turn) % 3] = b;
          corners.push_back(x);
        }
  std::vector<Strut> struts;
  for (int k = -1; k <= 3; ++k)
    for (int j = -1; j <= 3; ++j)
      for (int i = -1; i <= 3; ++i) {
        if ((i & 1) != (j & 1) || (j & 1) != (k & 1)) continue;
        const Vec3 centre{0.5 * i, 0.5 * j, 0.5 * k};
        for (std::size_t a = 0; a < corners.size(); ++a)
          for (std::size_t b = a + 1; b < corners.size(); ++b)
            if (const Vec3 d = corners[a] - corners[b]; std::abs(dot(d, d) - 0.125) < 1e-9)
              struts.push_back({centre + corners[a], centre + corners[b]});
      }
  return struts;
}

/// From a point (in cells) to the axis of the nearest strut.
Vec3 to_nearest(const std::vector<Strut>& struts, const Vec3& x) {
  Vec3 nearest{};
  double least = std::numeric_limits<double>::infinity();
  for (const Strut& s : struts) {
    const Vec3 along = s.to - s.from;
    const double t = std::clamp(dot(x - s.from, along) / dot(along, along), 0.0, 1.0);
    const Vec3 d = s.from + t * along - x;
    if (const double square = dot(d, d); square < least) least = square, nearest = d;
  }
  return nearest;
}

/// Bricks of the fine lattice, x fastest.
struct Lattice {
  std::array<GlobalId, 3> n;
  GlobalId index(GlobalId i, GlobalId j, GlobalId k) const { return (k * n[1] + j) * n[0] + i; }
  std::array<GlobalId, 3> place(GlobalId b) const { return {b % n[0], b / n[0] % n[1], b / n[0] / n[1]}; }
};

/// Keeps the largest part that hangs together by faces (of equal ones the first).
void keep_largest(const Lattice& lattice, std::vector<char>& solid) {
  std::vector<GlobalId> part(solid.size(), -1), sizes, stack;
  for (GlobalId seed = 0; seed < static_cast<GlobalId>(solid.size()); ++seed) {
    if (!solid[static_cast<std::size_t>(seed)] || part[static_cast<std::size_t>(seed)] >= 0) continue;
    const auto number = static_cast<GlobalId>(sizes.size());
    sizes.push_back(0);
    stack.assign(1, seed);
    part[static_cast<std::size_t>(seed)] = number;
    while (!stack.empty()) {
      const std::array<GlobalId, 3> at = lattice.place(stack.back());
      stack.pop_back();
      ++sizes.back();
      for (std::size_t c = 0; c < 3; ++c)
        for (const GlobalId step : {-1, 1}) {
          std::array<GlobalId, 3> to = at;
          to[c] += step;
          if (to[c] < 0 || to[c] >= lattice.n[c]) continue;
          const auto b = static_cast<std::size_t>(lattice.index(to[0], to[1], to[2]));
          if (!solid[b] || part[b] >= 0) continue;
          part[b] = number;
          stack.push_back(static_cast<GlobalId>(b));
        }
    }
  }
  const GlobalId largest = std::max_element(sizes.begin(), sizes.end()) - sizes.begin();
  for (std::size_t b = 0; b < solid.size(); ++b) solid[b] = static_cast<char>(solid[b] && part[b] == largest);
}

/// Which bricks lie in a strut: one cubic cell, repeated.
std::vector<char> solid_bricks(const FoamShape& shape, const std::vector<Strut>& struts, const Lattice& lattice) {
  const int m = shape.elements;
  const Lattice one{{m, m, m}};
  std::vector<char> cell(static_cast<std::size_t>(m) * static_cast<std::size_t>(m) * static_cast<std::size_t>(m));
  const double radius = shape.strut_radius / shape.cell;
  for (GlobalId b = 0; b < static_cast<GlobalId>(cell.size()); ++b) {
    const auto [i, j, k] = one.place(b);
    const auto middle = [&](GlobalId a) { return (static_cast<double>(a) + 0.5) / m; };
    cell[static_cast<std::size_t>(b)] =
        static_cast<char>(norm(to_nearest(struts, {middle(i), middle(j), middle(k)})) <= radius);
  }
  std::vector<char> solid(static_cast<std::size_t>(lattice.n[0] * lattice.n[1] * lattice.n[2]));
  for (GlobalId b = 0; b < static_cast<GlobalId>(solid.size()); ++b) {
    const auto [i, j, k] = lattice.place(b);
    solid[static_cast<std::size_t>(b)] = cell[static_cast<std::size_t>(one.index(i % m, j % m, k % m))];
  }
  keep_largest(lattice, solid);
  return solid;
}

std::uint64_t mixed(std::uint64_t z) {  // splitmix64 [SLF14]
  z += 0x9E3779B97F4A7C15ULL;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

/// Shift of a point (in cells), linear between the corners of the cubic cells; none across the outer faces.
Vec3 shift(const FoamShape& shape, const Vec3& x) {
  Vec3 sum{0, 0, 0};
  std::array<int, 3> base;
  for (std::size_t c = 0; c < 3; ++c) base[c] = std::clamp(static_cast<int>(std::floor(x[c])), 0, shape.cells[c] - 1);
  for (unsigned corner = 0; corner < 8; ++corner) {
    double weight = 1;
    std::uint64_t id = 0;
    std::array<int, 3> at;
    for (std::size_t c = 0; c < 3; ++c) {
      const int up = static_cast<int>(corner >> c & 1U);
      at[c] = base[c] + up;
      weight *= up == 1 ? x[c] - base[c] : 1 - (x[c] - base[c]);
      id = id * 4096 + static_cast<std::uint64_t>(at[c]);
    }
    for (std::size_t c = 0; c < 3; ++c) {
      if (at[c] == 0 || at[c] == shape.cells[c]) continue;
      const double u = static_cast<double>(mixed(mixed(shape.seed) + 4 * id + c) >> 11) * 0x1p-53;
      sum[c] += weight * (2 * u - 1) * shape.irregularity;
    }
  }
  return sum;
}

/// Draws the nodes of the surface, but for the outer faces, towards the round strut, by at most a quarter of a brick.
void round_off(const FoamShape& shape, const std::vector<Strut>& struts, const std::vector<SideData>& sides,
               MeshData& mesh) {
  std::vector<char> on_skin(mesh.coordinates.size(), 0);
  const BlockData& block = mesh.blocks.front();
  const Topology& t = topology(block.kind);
  for (const SideData& side : sides)
    for (const std::int8_t i : t.side[static_cast<std::size_t>(side.side)])
      if (i >= 0 && i < 8)
        on_skin[static_cast<std::size_t>(block.connectivity[static_cast<std::size_t>(8 * side.element + i)])] = 1;
  const double radius = shape.strut_radius / shape.cell, most = 0.25 / shape.elements;
  for (std::size_t n = 0; n < mesh.coordinates.size(); ++n) {
    Vec3& x = mesh.coordinates[n];
    bool outside = false;
    Vec3 within{};
    for (std::size_t c = 0; c < 3; ++c) {
      outside = outside || x[c] == 0 || x[c] == shape.cells[c];
      within[c] = x[c] - std::floor(x[c]);
    }
    if (!on_skin[n] || outside) continue;
    const Vec3 d = to_nearest(struts, within);
    const double distance = norm(d);
    if (distance > 0) x = x + (std::clamp(distance - radius, -most, most) / distance) * d;
  }
}

}  // namespace

MeshData generate(const FoamShape& shape) {
  require_positive("foam", "cell", shape.cell);
  require_positive("foam", "strut_radius", shape.strut_radius);
  require_count("foam", "elements", shape.elements, 4);
  for (const int n : shape.cells) require_count("foam", "cells", n, 1);
  if (!(shape.irregularity >= 0 && shape.irregularity < 0.3))
    throw Error(ExitCode::usage,
                fmt::format("foam: irregularity = {}, but a number from 0 to below 0.3 expected", shape.irregularity));
  Lattice lattice{};
  double bricks = 1;
  for (std::size_t c = 0; c < 3; ++c) {
    lattice.n[c] = static_cast<GlobalId>(shape.cells[c]) * shape.elements;
    bricks *= static_cast<double>(lattice.n[c]);
  }
  if (bricks > 1e9) throw Error(ExitCode::usage, "foam: more than 1e9 bricks of the lattice, solid or not");
  const std::vector<Strut> struts = kelvin_struts();
  const std::vector<char> solid = solid_bricks(shape, struts, lattice);
  if (std::count(solid.begin(), solid.end(), 1) == 0)
    throw Error(ExitCode::usage, "foam: no brick lies in a strut; make `strut_radius` or `elements` greater");

  MeshData mesh;
  mesh.source = "generated foam";
  BlockData block;
  block.name = "foam";
  block.label = 1;
  const Lattice corners{{lattice.n[0] + 1, lattice.n[1] + 1, lattice.n[2] + 1}};
  std::vector<GlobalId> node(static_cast<std::size_t>(corners.n[0] * corners.n[1] * corners.n[2]), -1);
  for (GlobalId b = 0; b < static_cast<GlobalId>(solid.size()); ++b) {
    if (!solid[static_cast<std::size_t>(b)]) continue;
    const auto [i, j, k] = lattice.place(b);
    for (const auto& [di, dj, dk] :
         {std::array{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}) {
      GlobalId& n = node[static_cast<std::size_t>(corners.index(i + di, j + dj, k + dk))];
      if (n < 0) {
        n = static_cast<GlobalId>(mesh.coordinates.size());
        const auto at = [&](GlobalId a) { return static_cast<double>(a) / shape.elements; };
        mesh.coordinates.push_back({at(i + di), at(j + dj), at(k + dk)});
      }
      block.connectivity.push_back(n);
    }
  }
  mesh.blocks.push_back(std::move(block));
  number_from_one(mesh);

  const std::vector<SideData> sides = skin(mesh);
  std::vector<char> bottom, top;
  for (const Vec3& x : mesh.coordinates) {
    bottom.push_back(static_cast<char>(x[2] == 0));
    top.push_back(static_cast<char>(x[2] == shape.cells[2]));
  }
  add_face_sets(mesh, sides, "bottom", bottom);
  add_face_sets(mesh, sides, "top", top);
  round_off(shape, struts, sides, mesh);
  for (Vec3& x : mesh.coordinates) x = shape.cell * (x + shift(shape, x));
  return finish(std::move(mesh), false);
}

}  // namespace tenon
