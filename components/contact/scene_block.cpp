// SPDX-License-Identifier: BSD-3-Clause
#include "components/contact/scene_block.hpp"

#include <cmath>

namespace tenon {

namespace {

using scene::Diagnostics;
using scene::Range;
using scene::Schema;
using scene::Value;

void add_friction(Schema& s, const char* default_value) {
  s.quantity("friction", "1", "Coulomb's coefficient while slipping.", default_value, Range{0, 100, false, false});
  s.quantity("static_friction", "1", "Coefficient while sticking; without it that of slipping. Not less than that.", "",
             Range{0, 100, false, false});
}

Schema pair_schema() {
  Schema s("What holds between two surfaces instead of the general rule.");
  s.text("first", "A block, or a rigid surface.").required();
  s.text("second", "Another one, or the same: contact of a block with itself.").required();
  s.flag("ignore", "They pass through each other.", "false");
  s.flag(
      "tied",
      "What touches holds on for good, as if glued: particles tied to a mesh, or two meshes. What is to be tied from "
      "the start on touches or overlaps in the undeformed bodies (`initial_overlaps: keep`).",
      "false");
  s.at_most_one({"friction", "tied"});
  add_friction(s, "");
  return s;
}

Schema displacement_schema() {
  Schema s("Way from the place at the start, of time.");
  for (const char* axis : {"x", "y", "z"}) s.function(axis, "m", "Along this axis: a length, a table, or a formula.");
  return s;
}

Schema rigid_surface_schema() {
  Schema s(
      "A surface of simple shape that does not deform: it stands, moves as told (`displacement`), or flies freely "
      "(`mass`, without turning).");
  s.choice("shape", {"plane", "sphere", "cylinder"}, "Of endless extent, but for the sphere.", "plane");
  s.vector("point", "m", "Of the plane; the centre of a sphere; on the axis of a cylinder.", "[0, 0, 0]");
  s.vector("normal", "1", "Of a plane: towards the side where bodies may be.", "[0, 0, 1]");
  s.vector("axis", "1", "Of a cylinder.", "[0, 0, 1]");
  s.quantity("radius", "m", "Of a sphere or a cylinder.", "", Range::positive());
  s.flag("hollow", "Bodies are inside of the sphere or cylinder.", "false");
  s.object("displacement", displacement_schema(), "How it moves.");
  s.quantity("mass", "kg", "It moves freely, by what pushes it.", "", Range::positive());
  s.vector("velocity", "m/s", "At the start, with `mass`.", "[0, 0, 0]");
  s.at_most_one({"displacement", "mass"});
  return s;
}

CoulombFriction read_friction(const Value& block, CoulombFriction otherwise, Diagnostics& diagnostics) {
  CoulombFriction friction = otherwise;
  if (block.has("friction")) friction.static_coefficient = friction.kinetic_coefficient = block.real("friction");
  if (block.has("static_friction")) friction.static_coefficient = block.real("static_friction");
  if (friction.static_coefficient < friction.kinetic_coefficient)
    diagnostics.error(block.where("static_friction"),
                      "static_friction: expected not less than friction, which holds while slipping");
  return friction;
}

Vec3 unit_vector(const Value& block, const std::string& key, Diagnostics& diagnostics) {
  const Vec3 v = block.vector(key);
  const double length = norm(v);
  if (length > 0) return (1 / length) * v;
  diagnostics.error(block.where(key), key + ": expected a direction, found the zero vector");
  return {0, 0, 1};
}

RigidSurface read_surface(const std::string& name, const Value& block, Diagnostics& diagnostics) {
  RigidSurface surface;
  surface.name = name;
  const std::string& shape = block.text("shape");
  surface.shape = shape == "sphere"     ? RigidSurface::Shape::sphere
                  : shape == "cylinder" ? RigidSurface::Shape::cylinder
                                        : RigidSurface::Shape::plane;
  surface.point = block.vector("point");
  surface.direction = unit_vector(block, shape == "cylinder" ? "axis" : "normal", diagnostics);
  if (surface.shape != RigidSurface::Shape::plane) {
    if (!block.has("radius"))
      diagnostics.error(block.where(), "rigid surface '" + name + "': key 'radius' is needed for a " + shape);
    else
      surface.radius = block.real("radius");
  }
  surface.hollow = block.flag("hollow");
  if (block.has("displacement")) {
    const Value way = block.child("displacement");
    const char* axes[] = {"x", "y", "z"};
    for (std::size_t c = 0; c < 3; ++c)
      if (way.has(axes[c])) surface.displacement[c] = way.function(axes[c]);
  }
  if (block.has("mass")) surface.mass = block.real("mass");
  if (block.given("velocity") && !surface.mass)
    diagnostics.error(
        block.where("velocity"),
        "velocity: only a rigid surface with a mass has one; use displacement for one that moves as told");
  surface.velocity = block.vector("velocity");
  return surface;
}

}  // namespace

Schema contact_schema() {
  Schema s(
      "Contact of everything with everything: skins of solids, both sides of shells at half their thickness, and each "
      "with itself. `contact: {}` is enough. No stiffness is chosen; a scene without this block has no contact.");
  add_friction(s, "0");
  s.texts("components", "Components that touch; all that can without it.");
  s.choice(
      "initial_overlaps", {"remove", "keep", "refuse"},
      "Overlaps of the undeformed bodies are listed before the first step. `remove`: nodes are moved apart without "
      "stress; `keep`: what overlaps counts as touching; `refuse`: the run does not start (exit code 5).",
      "remove");
  s.list("pairs", pair_schema(), "Rules for single pairs of surfaces. Their forces become columns of history.csv.");
  s.named("rigid_surfaces", rigid_surface_schema(), "Planes, spheres and cylinders by name.");
  s.choice(
      "decomposition", {"auto", "own", "static", "slices"},
      "For comparison only, the answer is the same. `own`: recursive bisection of what touches, for all ranks; `auto`: "
      "likewise, but for fewer ranks where each would have too little to pay for its messages; `static`: every rank "
      "keeps its own surfaces; `slices`: one-dimensional cuts.",
      "auto");
  s.flag("always_search", "Search and share out in each step, needed or not; the answer is the same.", "false");
  return s;
}

ContactOptions read_contact(const Value& block, Diagnostics& diagnostics) {
  ContactOptions options;
  options.friction = read_friction(block, {}, diagnostics);
  const std::string& overlaps = block.text("initial_overlaps");
  using Overlaps = ContactOptions::InitialOverlaps;
  options.initial_overlaps = overlaps == "keep"     ? Overlaps::keep
                             : overlaps == "refuse" ? Overlaps::refuse
                                                    : Overlaps::remove;
  for (const auto& [name, surface] : block.entries("rigid_surfaces"))
    options.rigid_surfaces.push_back(read_surface(name, surface, diagnostics));
  for (const Value& item : block.items("pairs")) {
    ContactPair pair;
    pair.first = item.text("first"), pair.second = item.text("second"), pair.ignore = item.flag("ignore");
    pair.tied = item.flag("tied");
    if (item.has("friction") || item.has("static_friction"))
      pair.friction = read_friction(item, options.friction, diagnostics);
    options.pairs.push_back(pair);
  }
  const std::string& decomposition = block.text("decomposition");
  options.decomposition = decomposition == "static"   ? SearchDecomposition::owner_boxes
                          : decomposition == "slices" ? SearchDecomposition::slices
                                                      : SearchDecomposition::rcb;
  if (decomposition == "auto") options.least_work = sensible_least_work;
  options.always_search = block.flag("always_search");
  return options;
}

}  // namespace tenon
