// SPDX-License-Identifier: BSD-3-Clause
#include "apps/tenon/scene_particles.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "apps/tenon/scene_meshes.hpp"
#include "framework/base/error.hpp"
#include "framework/io/vtk_result.hpp"
#include "framework/mesh/particle_bodies.hpp"
#include "framework/mesh_files/readers.hpp"
#include "framework/scene/known_names.hpp"

namespace tenon {

namespace {

using scene::Diagnostics;
using scene::Range;
using scene::Schema;
using scene::Value;

constexpr std::array<const char*, 6> sides{"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};

Schema& add_lattice(Schema& s) {
  s.quantity("spacing", "m", "Edge of a cube of the volume of a particle; without it that of the whole mesh.", "",
             Range::positive());
  s.choice("lattice", {"cubic", "hexagonal"},
           "`hexagonal`: close packed. Particles in a box fill it exactly; in other shapes they share its volume "
           "equally.",
           "cubic");
  return s;
}

Schema& add_relaxed(Schema& s) {
  s.flag("relaxed", "Particles are pushed apart until they are evenly spread, also along the surface.", "false");
  return s;
}

Schema box_schema() {
  Schema s("A box filled with particles.");
  s.vector("low", "m", "Lower corner.", "[0, 0, 0]");
  s.vector("high", "m", "Upper corner; of two dimensions z is left out, of one y too.").required();
  return add_lattice(s);
}

Schema sphere_schema() {
  Schema s("A ball, or a hollow one; in two dimensions a circle or a ring.");
  s.vector("centre", "m", "Centre.", "[0, 0, 0]");
  s.required_quantity("radius", "m", "Radius.", Range::positive());
  s.quantity("inner_radius", "m", "Radius of the hole.", "0 m", Range::not_negative());
  return add_relaxed(add_lattice(s));
}

Schema cylinder_schema() {
  Schema s("A straight cylinder, or a tube.");
  s.vector("foot", "m", "Middle of the end where it begins.", "[0, 0, 0]");
  s.vector("axis", "1", "Direction towards the other end.", "[0, 0, 1]");
  s.required_quantity("radius", "m", "Radius.", Range::positive());
  s.quantity("inner_radius", "m", "Radius of the hole.", "0 m", Range::not_negative());
  s.required_quantity("length", "m", "Length.", Range::positive());
  return add_relaxed(add_lattice(s));
}

Schema tank_schema() {
  Schema s("Layers of particles around a box: the walls of a tank (`wall: true` in the component).");
  s.vector("low", "m", "Lower corner of the space inside.", "[0, 0, 0]");
  s.vector("high", "m", "Upper corner of the space inside.").required();
  s.integer("layers", "Layers of particles.", "3", {1, 100, false, false});
  s.texts("open", "Sides without a wall: any of x_min, x_max, y_min, y_max, z_min, z_max.");
  s.quantity("spacing", "m", "Distance of the particles; without it that of the whole mesh.", "", Range::positive());
  return s;
}

Schema mesh_schema() {
  Schema s("All that the solid elements of a mesh file, or a closed surface in it, enclose.");
  s.text("file", "Exodus II or Gmsh file, relative to the scene's folder.").required();
  s.quantity("unit", "m", "Length of one unit of the file's coordinates.", "1 m", Range::positive());
  return add_relaxed(add_lattice(s));
}

Schema points_schema() {
  Schema s(
      "Points of a file: Exodus II (spheres) or ParaView (.vtu, .pvtu, .pvd). Their volumes are those of a nodal field "
      "`volume`, the attributes of the spheres, or cubes of `spacing`.");
  s.text("file", "Path, relative to the scene's folder.").required();
  s.quantity("unit", "m", "Length of one unit of the file's coordinates.", "1 m", Range::positive());
  s.quantity("spacing", "m", "Edge of a cube of the volume of a particle, if the file has no volumes.", "",
             Range::positive());
  return s;
}

Schema elements_schema() {
  Schema s(
      "One particle for each solid element of a block, in its place: what elements become when they fail "
      "(`from_elements` in the component).");
  s.text("mesh", "Name of a mesh that stands before this one.").required();
  s.text("block", "Block of that mesh.").required();
  return s;
}

struct Common {
  int dimension;
  double spacing;  // 0: none
  std::span<const SceneMesh> earlier;
};

double spacing_of(const Value& v, const Common& common, const std::string& name, Diagnostics& diagnostics) {
  if (v.has("spacing")) return v.real("spacing");
  if (common.spacing > 0) return common.spacing;
  diagnostics.error(v.where(), "body '" + name + "': key 'spacing' is needed, here or for the whole mesh");
  return 1;
}

ParticleFill read_fill(const Value& v, const Common& common, const std::string& name, Diagnostics& diagnostics) {
  ParticleFill fill;
  fill.spacing = spacing_of(v, common, name, diagnostics);
  fill.dimension = common.dimension;
  if (v.text("lattice") == "hexagonal") fill.lattice = ParticleLattice::hexagonal;
  if (v.text("type") != "box") fill.relaxed = v.flag("relaxed");
  return fill;
}

void check_corners(const Value& v, const Common& common, Diagnostics& diagnostics) {
  const Vec3 low = v.vector("low"), high = v.vector("high");
  for (std::size_t c = 0; c < static_cast<std::size_t>(common.dimension); ++c)
    if (!(high[c] > low[c])) diagnostics.error(v.where("high"), "high: every coordinate must be above that of `low`");
}

TankShape read_tank(const Value& v, const Common& common, const std::string& name, Diagnostics& diagnostics) {
  TankShape tank;
  tank.low = v.vector("low"), tank.high = v.vector("high"), tank.dimension = common.dimension;
  tank.spacing = spacing_of(v, common, name, diagnostics);
  tank.layers = static_cast<int>(v.integer("layers"));
  const std::vector<std::string> known(sides.begin(), sides.begin() + 2 * common.dimension);
  for (const std::string& side : v.texts("open")) {
    const auto found = std::ranges::find(known, side);
    if (found == known.end())
      diagnostics.error(v.where("open"), "open: there is no side '" + side + "'" + scene::suggestion(side, known));
    else
      tank.open[static_cast<std::size_t>(found - known.begin())] = true;
  }
  return tank;
}

MeshData in_unit(MeshData mesh, double unit) {
  for (Vec3& x : mesh.coordinates) x = unit * x;
  return mesh;
}

/// Volumes of the points: a field of that name, or what the reader found; empty if there are none.
std::vector<double> volumes_of(const ResultData& result, double unit, int dimension) {
  std::vector<double> volumes = result.mesh.volumes;
  for (const FieldData& field : result.fields)
    if (field.description.name == "volume" && field.description.location == Location::node &&
        field.description.components == 1)
      volumes = field.values;
  for (double& volume : volumes) volume *= std::pow(unit, dimension);
  return volumes;
}

MeshData read_points(const std::string& path, double unit, std::optional<double> spacing, int dimension) {
  ResultData result = is_vtk_result(path) ? read_vtk_result(path, {}, "") : read_result(path, {});
  std::vector<double> volumes = volumes_of(result, unit, dimension);
  if (spacing) volumes.assign(result.mesh.coordinates.size(), std::pow(*spacing, dimension));
  if (volumes.empty())
    throw Error(ExitCode::usage, path +
                                     ": its points have no volumes (a nodal field 'volume', or attributes of "
                                     "spheres); give the body a 'spacing'");
  MeshData mesh;
  mesh.source = path, mesh.coordinates = std::move(result.mesh.coordinates), mesh.volumes = std::move(volumes);
  BlockData block;
  block.name = "points", block.kind = ElementKind::particle;
  for (std::size_t i = 0; i < mesh.coordinates.size(); ++i) {
    if (!(mesh.volumes[i] > 0))
      throw Error(ExitCode::geometry, fmt::format("{}: point {} has the volume {:g}; expected a positive one", path,
                                                  result.mesh.node_labels[i], mesh.volumes[i]));
    block.connectivity.push_back(static_cast<GlobalId>(i));
    block.labels.push_back(static_cast<std::int64_t>(i) + 1);
  }
  mesh.blocks.push_back(std::move(block));
  return in_unit(std::move(mesh), unit);
}

std::function<MeshData()> elements_recipe(const Value& v, std::span<const SceneMesh> earlier,
                                          Diagnostics& diagnostics) {
  std::vector<std::string> names;
  for (const SceneMesh& mesh : earlier) names.push_back(mesh.name);
  const auto found = std::ranges::find(names, v.text("mesh"));
  if (found == names.end()) {
    diagnostics.error(v.where("mesh"), "mesh: there is no mesh '" + v.text("mesh") + "' before this one" +
                                           scene::suggestion(v.text("mesh"), names));
    return [] { return MeshData(); };
  }
  const SceneMesh& mesh = earlier[static_cast<std::size_t>(found - names.begin())];
  scene::check_name(v, "block", v.text("block"), mesh.summary.blocks, "block", mesh.summary.source, diagnostics);
  return [&mesh, block = v.text("block")] { return particles_of_elements(mesh.data, block); };
}

std::function<MeshData()> body_recipe(const std::string& name, const Value& v, const Common& common,
                                      const std::string& folder, Diagnostics& diagnostics) {
  const std::string& type = v.text("type");
  const int dimension = common.dimension;
  const auto path = [&] { return (std::filesystem::path(folder) / v.text("file")).string(); };
  if (type == "tank") {
    check_corners(v, common, diagnostics);
    return [tank = read_tank(v, common, name, diagnostics)] { return tank_walls(tank); };
  }
  if (type == "elements") return elements_recipe(v, common.earlier, diagnostics);
  if (type == "points") {
    const auto spacing = v.has("spacing") ? std::optional(v.real("spacing")) : std::nullopt;
    return [file = path(), unit = v.real("unit"), spacing, dimension] {
      return read_points(file, unit, spacing, dimension);
    };
  }
  const ParticleFill fill = read_fill(v, common, name, diagnostics);
  if (type == "box") {
    check_corners(v, common, diagnostics);
    return [low = v.vector("low"), high = v.vector("high"), fill] { return fill_box(low, high, fill); };
  }
  if (dimension == 1 || (dimension == 2 && type == "cylinder"))
    diagnostics.error(v.where(), fmt::format("body '{}': a {} has more than {} dimensions; take a {}", name, type,
                                             dimension, dimension == 1 ? "box" : "sphere, which is a circle then"));
  if (type == "mesh")
    return [file = path(), unit = v.real("unit"), fill] {
      return fill_region(mesh_region(in_unit(read_mesh(file), unit), fill.dimension), fill);
    };
  const double radius = v.real("radius"), inner = v.real("inner_radius");
  if (!(inner < radius)) diagnostics.error(v.where("inner_radius"), "inner_radius: expected less than radius");
  if (type == "sphere")
    return [centre = v.vector("centre"), inner, radius, fill] {
      return fill_region(ball_region(centre, inner, radius, fill.dimension), fill);
    };
  if (!(norm(v.vector("axis")) > 0))
    diagnostics.error(v.where("axis"), "axis: expected a direction, found the zero vector");
  return [foot = v.vector("foot"), axis = v.vector("axis"), inner, radius, length = v.real("length"), fill] {
    return fill_region(cylinder_region(foot, axis, inner, radius, length), fill);
  };
}

}  // namespace

Schema particle_mesh_schema() {
  Schema s("Particles (for components of type `sph`): each body becomes a block of its name.");
  s.integer("dimension",
            "2: a sheet of particles in the plane z = 0, with masses per metre of thickness; 1: a row along x.", "3",
            {1, 3, false, false});
  s.quantity("spacing", "m", "Edge of a cube of the volume of a particle, of bodies that say nothing else.", "",
             Range::positive());
  s.variants("bodies", scene::Key::Type::named,
             {{"box", box_schema()},
              {"sphere", sphere_schema()},
              {"cylinder", cylinder_schema()},
              {"tank", tank_schema()},
              {"mesh", mesh_schema()},
              {"elements", elements_schema()},
              {"points", points_schema()}},
             "Bodies by name.")
      .required();
  return s;
}

std::function<MeshData()> particle_recipe(const Value& block, const std::string& folder,
                                          std::span<const SceneMesh> earlier, Diagnostics& diagnostics) {
  const Common common{static_cast<int>(block.integer("dimension")), block.has("spacing") ? block.real("spacing") : 0,
                      earlier};
  std::vector<std::pair<std::string, std::function<MeshData()>>> recipes;
  for (const auto& [name, body] : block.entries("bodies"))
    recipes.emplace_back(name, body_recipe(name, body, common, folder, diagnostics));
  if (recipes.empty()) diagnostics.error(block.where("bodies"), "bodies: expected one body or more");
  return [recipes] {
    std::vector<std::pair<std::string, MeshData>> bodies;
    for (const auto& [name, recipe] : recipes) bodies.emplace_back(name, recipe());
    return join_particles(std::move(bodies));
  };
}

}  // namespace tenon
