// SPDX-License-Identifier: BSD-3-Clause
// Solid cylinder (whole or a quarter) and hollow cylinder: a flat mesh of the section, repeated along the axis.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "framework/base/error.hpp"
#include "framework/mesh/generator_tools.hpp"
#include "framework/mesh/generators.hpp"

namespace tenon {

namespace {

/// Flat mesh of a section and which of its nodes lie on which curve.
struct Section {
  std::vector<std::array<double, 2>> points;
  std::vector<std::array<GlobalId, 4>> quads;
  std::vector<char> outer, inner;
};

/// Point (s, t) of [-1, 1]^2 in the core: between the square and the disk (mapped elliptically) around it, so that the
/// corner has about 120 degrees, as its two neighbours in the shell then have.
std::array<double, 2> core_point(double s, double t, double half_width) {
  constexpr double bulge = 1.0 / 3;
  return {half_width * s * ((1 - bulge) + bulge * std::sqrt(1 - t * t / 2)),
          half_width * t * ((1 - bulge) + bulge * std::sqrt(1 - s * s / 2))};
}

/// Positions (i, j) on the lattice of the core along its border, counterclockwise: all around, or in the quarter from
/// the x axis to the y axis. The lattice runs from -n to n in steps of 2 (whole) or from 0 (quarter).
std::vector<std::array<int, 2>> border(int n, bool quarter) {
  std::vector<std::array<int, 2>> ring;
  if (quarter) {
    for (int j = 0; j < n; j += 2) ring.push_back({n, j});
    for (int i = n; i >= 0; i -= 2) ring.push_back({i, n});
    return ring;
  }
  for (int j = -n; j < n; j += 2) ring.push_back({n, j});
  for (int i = n; i > -n; i -= 2) ring.push_back({i, n});
  for (int j = n; j > -n; j -= 2) ring.push_back({-n, j});
  for (int i = -n; i < n; i += 2) ring.push_back({i, -n});
  return ring;
}

/// Adds a ring of nodes outside the nodes `inner` (which become those of the ring), `steps` rings before the last.
void add_ring(Section& section, std::vector<GlobalId>& inner, const std::vector<std::array<double, 2>>& circle,
              int steps, bool closed) {
  const auto base = static_cast<GlobalId>(section.points.size());
  const std::size_t around = inner.size();
  for (std::size_t m = 0; m < around; ++m) {
    const std::array<double, 2> from = section.points[static_cast<std::size_t>(inner[m])], to = circle[m];
    section.points.push_back(steps == 0 ? to
                                        : std::array<double, 2>{from[0] + (to[0] - from[0]) / (steps + 1),
                                                                from[1] + (to[1] - from[1]) / (steps + 1)});
  }
  const auto outer = [&](std::size_t m) { return base + static_cast<GlobalId>(m); };
  for (std::size_t m = 0; m < (closed ? around : around - 1); ++m) {
    const std::size_t next = (m + 1) % around;
    section.quads.push_back({inner[m], outer(m), outer(next), inner[next]});
  }
  for (std::size_t m = 0; m < around; ++m) inner[m] = outer(m);
}

/// Square core and rings around it (butterfly).
Section disk(const CylinderShape& shape, bool quarter) {
  const int n = shape.core, first = quarter ? 0 : -n;
  const GlobalId row = (n - first) / 2 + 1;
  // Elements of about the same width in core and shell, as far as their shape allows.
  const double half_width = shape.radius * std::clamp(n / (n + 2.0 * shape.shell), 0.3, 0.6);
  Section section;
  for (int j = first; j <= n; j += 2)
    for (int i = first; i <= n; i += 2)
      section.points.push_back(core_point(static_cast<double>(i) / n, static_cast<double>(j) / n, half_width));
  for (GlobalId j = 0; j + 1 < row; ++j)
    for (GlobalId i = 0; i + 1 < row; ++i) {
      const GlobalId c = j * row + i;
      section.quads.push_back({c, c + 1, c + 1 + row, c + row});
    }

  std::vector<GlobalId> inner;
  for (const auto& [i, j] : border(n, quarter)) inner.push_back((j - first) / 2 * row + (i - first) / 2);
  // A side of the core covers a quarter of a turn in n equal parts; a whole ring starts at the corner at -45 degrees.
  std::vector<std::array<double, 2>> circle;
  for (int m = 0; m < static_cast<int>(inner.size()); ++m) {
    const Direction d = part_of_turn(quarter ? 2 * m : 2 * m - n, 8 * n);
    circle.push_back({shape.radius * d.cosine, shape.radius * d.sine});
  }
  for (int layer = 1; layer <= shape.shell; ++layer) add_ring(section, inner, circle, shape.shell - layer, !quarter);
  section.outer.assign(section.points.size(), 0);
  for (const GlobalId m : inner) section.outer[static_cast<std::size_t>(m)] = 1;
  return section;
}

/// Marks of a section's nodes, repeated for every layer along the axis.
std::vector<char> repeat(const std::vector<char>& marks, std::size_t layers) {
  std::vector<char> all;
  for (std::size_t k = 0; k < layers; ++k) all.insert(all.end(), marks.begin(), marks.end());
  return all;
}

/// Marks of all nodes whose coordinate `c` is exactly `value`.
std::vector<char> where(const MeshData& mesh, std::size_t c, double value) {
  std::vector<char> marks;
  for (const Vec3& x : mesh.coordinates) marks.push_back(static_cast<char>(x[c] == value));
  return marks;
}

}  // namespace

MeshData generate(const CylinderShape& shape) {
  require_positive("cylinder", "radius", shape.radius);
  require_positive("cylinder", "length", shape.length);
  require_count("cylinder", "core", shape.core, 1);
  require_count("cylinder", "shell", shape.shell, 1);
  require_count("cylinder", "axial", shape.axial, 1);
  require_positive("cylinder", "axial_grading", shape.axial_grading);
  if (shape.fraction != 1 && shape.fraction != 0.25)
    throw Error(ExitCode::usage, fmt::format("cylinder: fraction = {}, but 1 or 0.25 expected", shape.fraction));
  const bool quarter = shape.fraction == 0.25;
  if (quarter && shape.core % 2 != 0)
    throw Error(ExitCode::usage,
                fmt::format("cylinder: core = {}, but an even number expected for a quarter", shape.core));

  const Section section = disk(shape, quarter);
  const std::vector<double> z = between(0, shape.length, graded(shape.axial, shape.axial_grading));
  MeshData mesh = extrude(section.points, section.quads, z);
  mesh.source = "generated cylinder";
  mesh.blocks[0].name = "cylinder";
  mesh.blocks[0].label = 1;
  const std::vector<SideData> sides = skin(mesh);
  add_face_sets(mesh, sides, "bottom", where(mesh, 2, 0));
  add_face_sets(mesh, sides, "top", where(mesh, 2, shape.length));
  add_face_sets(mesh, sides, "outer", repeat(section.outer, z.size()));
  if (quarter) {
    add_face_sets(mesh, sides, "x_min", where(mesh, 0, 0));
    add_face_sets(mesh, sides, "y_min", where(mesh, 1, 0));
  }
  return finish(std::move(mesh), shape.tetrahedra);
}

MeshData generate(const AnnulusShape& shape) {
  require_positive("annulus", "inner_radius", shape.inner_radius);
  require_positive("annulus", "outer_radius - inner_radius", shape.outer_radius - shape.inner_radius);
  require_positive("annulus", "length", shape.length);
  require_count("annulus", "radial", shape.radial, 1);
  require_count("annulus", "circumferential", shape.circumferential, 3);
  require_count("annulus", "axial", shape.axial, 1);
  require_positive("annulus", "radial_grading", shape.radial_grading);
  require_positive("annulus", "axial_grading", shape.axial_grading);

  const std::vector<double> r =
      between(shape.inner_radius, shape.outer_radius, graded(shape.radial, shape.radial_grading));
  Section section;
  const auto row = static_cast<GlobalId>(r.size());
  for (int j = 0; j < shape.circumferential; ++j) {
    const Direction d = part_of_turn(j, shape.circumferential);
    for (const double radius : r) {
      section.points.push_back({radius * d.cosine, radius * d.sine});
      section.inner.push_back(static_cast<char>(radius == r.front()));
      section.outer.push_back(static_cast<char>(radius == r.back()));
    }
    const GlobalId base = j * row, next = (j + 1) % shape.circumferential * row;
    for (GlobalId i = 0; i + 1 < row; ++i) section.quads.push_back({base + i, base + i + 1, next + i + 1, next + i});
  }
  const std::vector<double> z = between(0, shape.length, graded(shape.axial, shape.axial_grading));
  MeshData mesh = extrude(section.points, section.quads, z);
  mesh.source = "generated annulus";
  mesh.blocks[0].name = "annulus";
  mesh.blocks[0].label = 1;
  const std::vector<SideData> sides = skin(mesh);
  add_face_sets(mesh, sides, "inner", repeat(section.inner, z.size()));
  add_face_sets(mesh, sides, "outer", repeat(section.outer, z.size()));
  add_face_sets(mesh, sides, "bottom", where(mesh, 2, 0));
  add_face_sets(mesh, sides, "top", where(mesh, 2, shape.length));
  return finish(std::move(mesh), shape.tetrahedra);
}

}  // namespace tenon
