// SPDX-License-Identifier: BSD-3-Clause
#include "apps/tenon/scene_shapes.hpp"

#include <fmt/core.h>

#include <cmath>

#include "framework/mesh/generators.hpp"

namespace tenon {

namespace {

using scene::Range;
using scene::Schema;
using scene::Value;

constexpr Range count{1, 100000, false, false};

int number(const Value& v, const char* key) {
  return static_cast<int>(v.integer(key));
}

CanShape can(const Value& v, scene::Diagnostics& diagnostics) {
  CanShape s;
  s.radius = v.real("radius"), s.length = v.real("length"), s.thickness = v.real("thickness"), s.hole = v.real("hole");
  s.circumferential = number(v, "circumferential"), s.axial = number(v, "axial"), s.lid = number(v, "lid"),
  s.through = number(v, "through");
  if (!(s.radius > s.thickness + s.hole))
    diagnostics.error(v.where("radius"), "radius: expected more than thickness and hole together");
  if (!(s.length > 2 * s.thickness)) diagnostics.error(v.where("length"), "length: expected more than two thicknesses");
  return s;
}

ProjectileShape projectile(const Value& v, scene::Diagnostics& diagnostics) {
  ProjectileShape s;
  s.radius = v.real("radius"), s.length = v.real("length"), s.caliber = v.real("caliber"), s.tip = v.real("tip");
  s.core = number(v, "core"), s.shell = number(v, "shell"), s.axial = number(v, "axial"), s.nose = number(v, "nose");
  s.wall = v.real("wall"), s.wall_elements = number(v, "wall_elements"), s.base_layers = number(v, "base_layers"),
  s.filled_nose = number(v, "filled_nose");
  const auto expect = [&](bool holds, const char* key, const std::string& what) {
    if (!holds) diagnostics.error(v.where(key), fmt::format("{}: expected {}", key, what));
  };
  const double nose = s.radius * std::sqrt(4 * s.caliber - 1);
  expect(s.length > nose, "length", fmt::format("more than {:.6g} m, the length of the nose", nose));
  if (s.wall == 0) return s;
  expect(s.wall < s.radius, "wall", "less than the radius");
  expect(s.wall_elements < s.shell, "wall_elements", "less than `shell`, as the filling has the rest");
  expect(s.base_layers < s.axial, "base_layers", "less than `axial`");
  expect(s.filled_nose < s.nose, "filled_nose", "less than `nose`");
  return s;
}

FoamShape foam(const Value& v, scene::Diagnostics& diagnostics) {
  FoamShape s;
  s.cell = v.real("cell"), s.strut_radius = v.real("strut_radius"), s.elements = number(v, "elements");
  s.irregularity = v.real("irregularity");
  const Vec3 cells = v.vector("cells");
  for (std::size_t c = 0; c < 3; ++c) {
    if (cells[c] != std::floor(cells[c]) || cells[c] < 1 || cells[c] > 1000)
      diagnostics.error(v.where("cells"), fmt::format("cells: {} is not a whole number from 1 to 1000", cells[c]));
    s.cells[c] = static_cast<int>(std::min(std::max(cells[c], 1.0), 1e3));
  }
  return s;
}

/// Turns v about the unit vector n (Rodrigues).
Vec3 turned(const Vec3& v, const Vec3& n, double cosine, double sine) {
  return cosine * v + sine * cross(n, v) + ((1 - cosine) * dot(n, v)) * n;
}

}  // namespace

Schema can_schema() {
  Schema s(
      "Half of a closed can (y >= 0) that stands on z = 0, with a hole in the middle of each lid; block `can`, sets "
      "`bottom`, `top`, `outer`, `symmetry`. Elements: (axial + 2 lid) circumferential through.");
  s.required_quantity("radius", "m", "Outer radius.", Range::positive());
  s.required_quantity("length", "m", "Length outside.", Range::positive());
  s.required_quantity("thickness", "m", "Thickness of tube and lids.", Range::positive());
  s.required_quantity("hole", "m", "Radius of the holes in the lids.", Range::positive());
  s.integer("circumferential", "Elements around the half turn.", "20", {2, 100000, false, false});
  s.integer("axial", "Elements along the tube.", "20", count);
  s.integer("lid", "Elements from a hole to the rim.", "5", count);
  s.integer("through", "Elements through the thickness.", "3", count);
  return s;
}

Schema projectile_schema() {
  Schema s(
      "A projectile with an ogival nose that flies along -z, the tip at z = 0; block `projectile`, or with a `wall` "
      "blocks `case` and `filling`, which have nodes of their own and touch; sets `tip`, `tail`, `outer`.");
  s.required_quantity("radius", "m", "Radius of the shaft.", Range::positive());
  s.required_quantity("length", "m", "From the tail to where the ogive ends in a point.", Range::positive());
  s.quantity("caliber", "1", "Radius of the ogive over the diameter (CRH); 0.5 is a half ball.", "3",
             {0.5, 1000, false, false});
  s.quantity("tip", "1", "The nose is blunted where it is this share of the radius wide.", "0.35", {0, 1, true, true});
  s.integer("core", "Elements across the square core of the section.", "4", count);
  s.integer("shell", "Elements from the core to the surface.", "2", count);
  s.integer("axial", "Elements along the shaft.", "16", count);
  s.integer("nose", "Elements along the nose.", "8", count);
  s.quantity("wall", "m", "Thickness of the case; 0: solid.", "0 m", Range::not_negative());
  s.integer("wall_elements", "Elements through the case, of those of `shell`.", "1", count);
  s.integer("base_layers", "Layers of elements of the shaft that close the case behind.", "2", count);
  s.integer("filled_nose", "Layers of elements of the nose that are filled.", "0", {0, 100000, false, false});
  return s;
}

Schema foam_schema() {
  Schema s(
      "Open-cell foam: struts of bricks along the edges of Kelvin's cells (truncated octahedra), from the origin; "
      "block "
      "`foam`, sets `bottom`, `top`.");
  s.required_quantity("cell", "m", "Edge of the cubic cell of the lattice, which holds two of Kelvin's cells.",
                      Range::positive());
  s.required_quantity("strut_radius", "m", "Radius of the struts.", Range::positive());
  s.vector("cells", "1", "Cubic cells along x, y, z.").required();
  s.integer("elements", "Bricks along the edge of a cubic cell.", "12", {4, 1000, false, false});
  s.quantity("irregularity", "1", "Random shift of the lattice, in cells; none across the outer faces.", "0",
             {0, 0.3, false, true});
  return s;
}

std::function<MeshData()> shape_recipe(const Value& v, scene::Diagnostics& diagnostics) {
  const std::string& type = v.text("type");
  if (type == "can") return [s = can(v, diagnostics)] { return generate(s); };
  if (type == "projectile") return [s = projectile(v, diagnostics)] { return generate(s); };
  return [s = foam(v, diagnostics)] { return generate(s); };
}

void add_placement(Schema& schema) {
  Schema turn("A rotation.");
  turn.vector("axis", "1", "Direction of the axis, of any length.").required();
  turn.vector("point", "m", "A point of the axis.", "[0, 0, 0]");
  turn.required_quantity("angle", "rad", "Angle, right-handed.");
  schema.object("turn", std::move(turn), "The mesh is turned.");
  schema.vector("shift", "m", "The mesh is moved, after it was turned.", "[0, 0, 0]");
}

std::function<void(MeshData&)> placement(const Value& v, scene::Diagnostics& diagnostics) {
  const Vec3 shift = v.vector("shift");
  Vec3 axis{0, 0, 1}, point{0, 0, 0};
  double angle = 0;
  if (v.has("turn")) {
    const Value turn = v.child("turn");
    axis = turn.vector("axis"), point = turn.vector("point"), angle = turn.real("angle");
    if (!(norm(axis) > 0)) diagnostics.error(turn.where("axis"), "axis: expected a direction, not zero");
  }
  if (angle == 0 && norm(shift) == 0) return [](MeshData&) {};
  return [=](MeshData& mesh) {
    const Vec3 n = (1 / norm(axis)) * axis;
    const double cosine = std::cos(angle), sine = std::sin(angle);
    for (Vec3& x : mesh.coordinates) x = point + turned(x - point, n, cosine, sine) + shift;
  };
}

}  // namespace tenon
