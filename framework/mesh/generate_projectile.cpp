// SPDX-License-Identifier: BSD-3-Clause
// Projectile with an ogival nose, solid or filled: a cylinder of bricks whose layers follow the ogive.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "framework/base/error.hpp"
#include "framework/mesh/generator_tools.hpp"
#include "framework/mesh/generators.hpp"

namespace tenon {

namespace {

/// Nose and layers of a projectile; layer 0 is the tip, as in the cylinder that it is made of.
struct Ogive {
  explicit Ogive(const ProjectileShape& s) : shape(s) {
    arc = 2 * s.caliber * s.radius;
    base = std::sqrt(arc * arc - (arc - s.radius) * (arc - s.radius));
    const double blunt = arc - s.radius + s.tip * s.radius;
    reach = std::sqrt(arc * arc - blunt * blunt);
  }
  /// Radius of the nose at the distance `s` in front of its base.
  double radius(double s) const { return std::sqrt(arc * arc - s * s) - (arc - shape.radius); }

  /// Place of a node of layer `k` that is (x, y) on the section of the shaft.
  Vec3 place(double x, double y, int k) const {
    if (k >= shape.nose) {
      const double t = static_cast<double>(k - shape.nose) / shape.axial;
      return {x, y, k == shape.nose + shape.axial ? shape.length : base + (shape.length - base) * t};
    }
    const double f = static_cast<double>(shape.nose - k) / shape.nose, s = reach * f, r = radius(s) / shape.radius;
    // The end is a flat dome, towards which the layers bulge more and more: elements stay well shaped.
    constexpr double bulge = 0.3;
    const double rho = (x * x + y * y) / (shape.radius * shape.radius);
    return {r * x, r * y, base - s - bulge * r * shape.radius * f * f * (1 - rho)};
  }

  const ProjectileShape& shape;
  double arc = 0, base = 0, reach = 0;  ///< m: radius of the ogive, length of the whole nose and of the blunted one
};

void require_sense(const ProjectileShape& s) {
  require_positive("projectile", "radius", s.radius);
  require_positive("projectile", "length", s.length);
  require_count("projectile", "core", s.core, 1);
  require_count("projectile", "shell", s.shell, 1);
  require_count("projectile", "axial", s.axial, 1);
  require_count("projectile", "nose", s.nose, 1);
  if (!(s.caliber >= 0.5) || !std::isfinite(s.caliber))
    throw Error(ExitCode::usage, fmt::format("projectile: caliber = {}, but at least 0.5 expected", s.caliber));
  if (!(s.tip > 0 && s.tip < 1))
    throw Error(ExitCode::usage, fmt::format("projectile: tip = {}, but a number between 0 and 1 expected", s.tip));
  require_positive("projectile", "length - length of the nose", s.length - Ogive(s).base);
  if (s.wall == 0) return;
  require_positive("projectile", "wall", s.wall);
  require_positive("projectile", "radius - wall", s.radius - s.wall);
  require_count("projectile", "wall_elements", s.wall_elements, 1);
  require_count("projectile", "shell - wall_elements", s.shell - s.wall_elements, 1);
  require_count("projectile", "base_layers", s.base_layers, 1);
  require_count("projectile", "axial - base_layers", s.axial - s.base_layers, 1);
  require_count("projectile", "filled_nose", s.filled_nose, 0);
  require_count("projectile", "nose - filled_nose", s.nose - s.filled_nose, 1);
}

/// Section of the shaft, in the numbering of the cylinder: the core, then the rings from inside out. The rings of the
/// case are concentric.
std::vector<std::array<double, 2>> section(const ProjectileShape& s, const MeshData& cylinder) {
  const int filled = s.wall > 0 ? s.shell - s.wall_elements : s.shell;
  const double inner = s.wall > 0 ? s.radius - s.wall : s.radius;
  const auto core = static_cast<std::size_t>(s.core + 1) * static_cast<std::size_t>(s.core + 1);
  const auto around = static_cast<std::size_t>(4 * s.core);
  std::vector<std::array<double, 2>> points(core + around * static_cast<std::size_t>(s.shell));
  for (std::size_t n = 0; n < points.size(); ++n) {
    const Vec3& x = cylinder.coordinates[n];
    double scale = inner / s.radius;
    if (n >= core) {
      const int ring = static_cast<int>((n - core) / around) + 1;
      if (ring >= filled && s.wall > 0) {
        const double radius = inner + (s.radius - inner) * (ring - filled) / s.wall_elements;
        // Along the ray of the outermost ring's node, so that lines through the case are radial.
        const Vec3& rim = cylinder.coordinates[points.size() - around + (n - core) % around];
        points[n] = {rim[0] * (radius / s.radius), rim[1] * (radius / s.radius)};
        continue;
      }
    }
    points[n] = {x[0] * scale, x[1] * scale};
  }
  return points;
}

/// Takes the filling out of the first block into one of its own, with nodes of its own.
void part(MeshData& mesh, const std::vector<char>& filled, std::vector<SideSetData>& sides) {
  BlockData& whole = mesh.blocks.front();
  BlockData rest = whole, filling = whole;
  rest.connectivity.clear(), filling.connectivity.clear();
  std::vector<GlobalId> own(mesh.coordinates.size(), -1), place(filled.size());
  std::vector<char> of_case(mesh.coordinates.size(), 0);
  for (std::size_t e = 0; e < filled.size(); ++e)
    for (std::size_t i = 8 * e; i < 8 * e + 8; ++i)
      if (!filled[e]) of_case[static_cast<std::size_t>(whole.connectivity[i])] = 1;
  const auto cases = static_cast<GlobalId>(std::count(filled.begin(), filled.end(), 0));
  GlobalId next[2] = {0, cases};
  for (std::size_t e = 0; e < filled.size(); ++e) {
    place[e] = next[filled[e] ? 1 : 0]++;
    for (std::size_t i = 8 * e; i < 8 * e + 8; ++i) {
      GlobalId n = whole.connectivity[i];
      if (filled[e] && of_case[static_cast<std::size_t>(n)]) {
        GlobalId& twin = own[static_cast<std::size_t>(n)];
        if (twin < 0) {
          twin = static_cast<GlobalId>(mesh.coordinates.size());
          mesh.coordinates.push_back(mesh.coordinates[static_cast<std::size_t>(n)]);
        }
        n = twin;
      }
      (filled[e] ? filling : rest).connectivity.push_back(n);
    }
  }
  rest.name = "case", filling.name = "filling", filling.label = 2;
  mesh.blocks = {std::move(rest), std::move(filling)};
  for (SideSetData& set : sides) {
    for (SideData& side : set.sides) side.element = place[static_cast<std::size_t>(side.element)];
    std::sort(set.sides.begin(), set.sides.end());
  }
}

}  // namespace

MeshData generate(const ProjectileShape& shape) {
  require_sense(shape);
  CylinderShape round;
  round.radius = shape.radius, round.core = shape.core, round.shell = shape.shell;
  round.axial = shape.axial + shape.nose;
  MeshData mesh = generate(round);
  mesh.source = "generated projectile";
  const Ogive ogive(shape);
  const std::vector<std::array<double, 2>> points = section(shape, mesh);
  for (std::size_t n = 0; n < mesh.coordinates.size(); ++n) {
    const auto& [x, y] = points[n % points.size()];
    mesh.coordinates[n] = ogive.place(x, y, static_cast<int>(n / points.size()));
  }
  mesh.blocks[0].name = "projectile";
  const auto rename = [](auto& sets) {
    for (auto& set : sets) set.name = set.name == "bottom" ? "tip" : set.name == "top" ? "tail" : set.name;
  };
  rename(mesh.node_sets), rename(mesh.side_sets);
  if (shape.wall > 0) {
    const int core = shape.core * shape.core, inner = core + 4 * shape.core * (shape.shell - shape.wall_elements);
    const int layer = core + 4 * shape.core * shape.shell;
    std::vector<char> filled(mesh.elements(), 0);
    for (std::size_t e = 0; e < filled.size(); ++e) {
      const int k = static_cast<int>(e) / layer, within = static_cast<int>(e) % layer;
      filled[e] = static_cast<char>(within < inner && k >= shape.nose - shape.filled_nose &&
                                    k < shape.nose + shape.axial - shape.base_layers);
    }
    part(mesh, filled, mesh.side_sets);
  }
  number_from_one(mesh);
  return finish(std::move(mesh), false);
}

}  // namespace tenon
