// SPDX-License-Identifier: BSD-3-Clause
#include "apps/tenon/scene_meshes.hpp"

#include <fmt/core.h>

#include <cmath>
#include <filesystem>
#include <optional>

#include "apps/tenon/scene_particles.hpp"
#include "apps/tenon/scene_shapes.hpp"
#include "framework/mesh/generators.hpp"
#include "framework/mesh/mesh.hpp"
#include "framework/mesh/renumber.hpp"
#include "framework/mesh_files/readers.hpp"

namespace tenon {

namespace {

using scene::Range;
using scene::Schema;
using scene::Value;

constexpr Range count{1, 100000, false, false};
constexpr Range ratio{1e-6, 1e6, false, false};

Schema file_schema() {
  Schema s("A mesh file: Exodus II (.e .g .exo) or Gmsh 2.2 and 4.1 (.msh). Blocks and sets keep their names.");
  s.text("file", "Path, relative to the scene's folder.").required();
  s.quantity("unit", "m", "Length of one unit of the file's coordinates.", "1 m", Range::positive());
  return s;
}

Schema box_schema() {
  Schema s("A box; block `box`, sets `x_min` ... `z_max`.");
  s.vector("low", "m", "Lower corner.", "[0, 0, 0]");
  s.vector("high", "m", "Upper corner.").required();
  s.vector("elements", "1", "Elements along x, y, z.").required();
  s.vector("grading", "1", "Ratio of the last to the first element along x, y, z.", "[1, 1, 1]");
  s.choice("element", {"hex8", "tet4"}, "Kind of element.", "hex8");
  s.quantity("distortion", "1", "Random shift of the inner nodes, in element sizes.", "0", {0, 0.45, false, false});
  return s;
}

Schema cylinder_schema() {
  Schema s(
      "A solid cylinder about z from z = 0; block `cylinder`, sets `bottom`, `top`, `outer`, and `x_min`, `y_min` if "
      "not full.");
  s.required_quantity("radius", "m", "Radius.", Range::positive());
  s.required_quantity("length", "m", "Length.", Range::positive());
  s.integer("core", "Elements across the square core of the full cross-section (even).", "4", count);
  s.integer("shell", "Elements from the core to the surface.", "4", count);
  s.integer("axial", "Elements along the axis.", "8", count);
  s.quantity("axial_grading", "1", "Ratio of the last to the first element along the axis.", "1", ratio);
  s.choice("part", {"full", "quarter"}, "Full section, or the quarter x, y >= 0.", "full");
  s.choice("element", {"hex8", "tet4"}, "Kind of element.", "hex8");
  return s;
}

Schema sphere_schema() {
  Schema s("A solid ball about the origin; block `sphere`, set `outer`.");
  s.required_quantity("radius", "m", "Radius.", Range::positive());
  s.integer("core", "Elements across the core cube.", "4", count);
  s.integer("shell", "Elements from the core to the surface.", "4", count);
  s.choice("element", {"hex8", "tet4"}, "Kind of element.", "hex8");
  return s;
}

Schema annulus_schema() {
  Schema s("A hollow cylinder about z; block `annulus`, sets `inner`, `outer`, `bottom`, `top`.");
  s.required_quantity("inner_radius", "m", "Inner radius.", Range::positive());
  s.required_quantity("outer_radius", "m", "Outer radius.", Range::positive());
  s.required_quantity("length", "m", "Length.", Range::positive());
  s.integer("radial", "Elements across the wall.", "4", count);
  s.integer("circumferential", "Elements around.", "32", {3, 100000, false, false});
  s.integer("axial", "Elements along the axis.", "8", count);
  s.quantity("radial_grading", "1", "Ratio of the last to the first element across the wall.", "1", ratio);
  s.quantity("axial_grading", "1", "Ratio of the last to the first element along the axis.", "1", ratio);
  s.choice("element", {"hex8", "tet4"}, "Kind of element.", "hex8");
  return s;
}

Schema plate_schema() {
  Schema s("A flat rectangle in z = 0; block `plate`, sets `x_min`, `x_max`, `y_min`, `y_max`.");
  s.required_quantity("length_x", "m", "Length along x.", Range::positive());
  s.required_quantity("length_y", "m", "Length along y.", Range::positive());
  s.integer("elements_x", "Elements along x.", "8", count);
  s.integer("elements_y", "Elements along y.", "8", count);
  s.quantity("grading_x", "1", "Ratio of the last to the first element along x.", "1", ratio);
  s.quantity("grading_y", "1", "Ratio of the last to the first element along y.", "1", ratio);
  s.choice("element", {"quad4", "tri3"}, "Kind of element.", "quad4");
  return s;
}

BoxShape box(const Value& v, scene::Diagnostics& diagnostics) {
  BoxShape shape;
  shape.low = v.vector("low"), shape.high = v.vector("high"), shape.grading = v.vector("grading");
  shape.distortion = v.real("distortion"), shape.tetrahedra = v.text("element") == "tet4";
  const Vec3 elements = v.vector("elements");
  double cells = 1;
  for (std::size_t c = 0; c < 3; ++c) {
    if (!(shape.high[c] > shape.low[c]))
      diagnostics.error(v.where("high"), "high: every coordinate must be above that of `low`");
    if (elements[c] != std::floor(elements[c]) || elements[c] < 1 || elements[c] > 100000)
      diagnostics.error(v.where("elements"),
                        fmt::format("elements: {} is not a whole number from 1 to 100000", elements[c]));
    if (!(shape.grading[c] >= ratio.low && shape.grading[c] <= ratio.high))
      diagnostics.error(v.where("grading"),
                        fmt::format("grading: {} is not between {} and {}", shape.grading[c], ratio.low, ratio.high));
    shape.elements[c] = static_cast<int>(std::min(std::max(elements[c], 1.0), 1e5));
    cells *= shape.elements[c];
  }
  if (cells > 1e9) diagnostics.error(v.where("elements"), "elements: more than 1e9 in all");
  return shape;
}

int number(const Value& v, const char* key) {
  return static_cast<int>(v.integer(key));
}

CylinderShape cylinder(const Value& v) {
  CylinderShape shape;
  shape.radius = v.real("radius"), shape.length = v.real("length");
  shape.core = number(v, "core"), shape.shell = number(v, "shell"), shape.axial = number(v, "axial");
  shape.axial_grading = v.real("axial_grading");
  shape.fraction = v.text("part") == "quarter" ? 0.25 : 1.0;
  shape.tetrahedra = v.text("element") == "tet4";
  return shape;
}

AnnulusShape annulus(const Value& v, scene::Diagnostics& diagnostics) {
  AnnulusShape shape;
  shape.inner_radius = v.real("inner_radius"), shape.outer_radius = v.real("outer_radius"),
  shape.length = v.real("length");
  shape.radial = number(v, "radial"), shape.circumferential = number(v, "circumferential"),
  shape.axial = number(v, "axial");
  shape.radial_grading = v.real("radial_grading"), shape.axial_grading = v.real("axial_grading");
  shape.tetrahedra = v.text("element") == "tet4";
  if (!(shape.outer_radius > shape.inner_radius))
    diagnostics.error(v.where("outer_radius"), "outer_radius: expected more than inner_radius");
  return shape;
}

MeshData read_file(const Value& v, const std::string& folder) {
  const std::filesystem::path path = std::filesystem::path(folder) / v.text("file");
  MeshData mesh = read_mesh(path.string());
  const double unit = v.real("unit");
  if (unit != 1)
    for (Vec3& x : mesh.coordinates) x = unit * x;
  return mesh;
}

/// What is to be done on rank 0, decided on every rank alike so that complaints are the same everywhere.
std::function<MeshData()> recipe(const Value& v, const std::string& folder, std::span<const SceneMesh> earlier,
                                 scene::Diagnostics& diagnostics) {
  const std::string& type = v.text("type");
  if (type == "file") return [v, folder] { return read_file(v, folder); };
  if (type == "box") return [s = box(v, diagnostics)] { return generate(s); };
  if (type == "cylinder") {
    const CylinderShape s = cylinder(v);
    if (s.core % 2 != 0) diagnostics.error(v.where("core"), "core: expected an even number");
    return [s] { return generate(s); };
  }
  if (type == "sphere") {
    SphereShape s;
    s.radius = v.real("radius"), s.core = number(v, "core"), s.shell = number(v, "shell");
    s.tetrahedra = v.text("element") == "tet4";
    return [s] { return generate(s); };
  }
  if (type == "particles") return particle_recipe(v, folder, earlier, diagnostics);
  if (type == "can" || type == "projectile" || type == "foam") return shape_recipe(v, diagnostics);
  if (type == "annulus") return [s = annulus(v, diagnostics)] { return generate(s); };
  PlateShape s;
  s.length_x = v.real("length_x"), s.length_y = v.real("length_y");
  s.elements_x = number(v, "elements_x"), s.elements_y = number(v, "elements_y");
  s.grading_x = v.real("grading_x"), s.grading_y = v.real("grading_y");
  s.triangles = v.text("element") == "tri3";
  return [s] { return generate(s); };
}

Numbering numbering_of(const Value& v) {
  const std::string& word = v.text("numbering");
  return word == "file"       ? Numbering::file
         : word == "hilbert"  ? Numbering::hilbert
         : word == "shuffled" ? Numbering::shuffled
                              : Numbering::automatic;
}

}  // namespace

std::vector<std::pair<std::string, scene::Schema>> mesh_variants() {
  std::vector<std::pair<std::string, scene::Schema>> variants{
      {"file", file_schema()},         {"box", box_schema()},
      {"cylinder", cylinder_schema()}, {"sphere", sphere_schema()},
      {"annulus", annulus_schema()},   {"plate", plate_schema()},
      {"can", can_schema()},           {"projectile", projectile_schema()},
      {"foam", foam_schema()},         {"particles", particle_mesh_schema()}};
  for (auto& [name, schema] : variants) {
    if (name == "particles") continue;
    add_placement(schema);
    schema.choice(
        "numbering", {"automatic", "file", "hilbert", "shuffled"},
        "Order of nodes and elements in memory: `automatic` puts them along a Hilbert curve where the file's order "
        "would "
        "slow the run down, `hilbert` always, `file` never; `shuffled` makes a poor order, to try what that costs. "
        "Messages and output keep the file's numbers.",
        "automatic");
  }
  return variants;
}

SceneMesh make_mesh(const Communicator& comm, const std::string& name, const scene::Value& block,
                    const std::string& folder, std::span<const SceneMesh> earlier, scene::Diagnostics& diagnostics) {
  SceneMesh mesh;
  mesh.name = name;
  if (block.text("type") == "particles") mesh.dimension = static_cast<int>(block.integer("dimension"));
  const std::size_t before = diagnostics.errors().size();
  const std::function<MeshData()> make = recipe(block, folder, earlier, diagnostics);
  const bool particles = block.text("type") == "particles";
  const std::function<void(MeshData&)> place = particles ? [](MeshData&) {} : placement(block, diagnostics);
  if (diagnostics.errors().size() > before) return mesh;
  comm.vote_on_root([&] {
    mesh.data = make();
    place(mesh.data);
    check(mesh.data);
    add_derived_sets(mesh.data);
    // Particles are put in order as they move; those of elements stand in the order of these.
    if (!particles) mesh.numbering = described(renumber(mesh.data, numbering_of(block)));
    mesh.summary = summarise(mesh.data);
  });
  mesh.summary = broadcast_summary(comm, mesh.summary);
  return mesh;
}

}  // namespace tenon
