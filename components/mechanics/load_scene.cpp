// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/load_scene.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace tenon {
namespace {

using scene::Value;

std::array<SpaceTimeFunction, 3> components(const Value& item, const SceneReader& reader) {
  std::array<SpaceTimeFunction, 3> result;
  const char* const names[] = {"x", "y", "z"};
  bool any = false;
  for (std::size_t c = 0; c < 3; ++c) {
    if (!item.has(names[c])) continue;
    result[c] = item.field_function(names[c]);
    any = true;
  }
  if (!any) reader.diagnostics.error(item.where(), "has no load; expected at least one of x, y, z");
  return result;
}

void read_body_forces(const Value& value, const SceneReader& reader, LoadOptions& loads) {
  if (value.has("gravity")) {
    const Vec3 g = value.vector("gravity");
    BodyForce force{{}, {}, "gravity"};
    for (std::size_t c = 0; c < 3; ++c) force.acceleration[c] = SpaceTimeFunction::constant(g[c]);
    loads.body_forces.push_back(std::move(force));
  }
  for (const Value& item : reader.items(value, "body_forces")) {
    BodyForce force{reader.blocks(item), components(item, reader), ""};
    force.label = SceneReader::label("body force", force.blocks);
    loads.body_forces.push_back(std::move(force));
  }
}

void read_surface_loads(const Value& value, const SceneReader& reader, LoadOptions& loads) {
  using Kind = SurfaceLoad::Kind;
  for (const Value& item : reader.items(value, "pressures")) {
    SurfaceLoad load{Kind::pressure, reader.side_sets(item), {item.field_function("pressure")}, ""};
    load.label = SceneReader::label("pressure", load.side_sets);
    loads.surface_loads.push_back(std::move(load));
  }
  for (const Value& item : reader.items(value, "tractions")) {
    const bool current = item.text("per") == "current";
    SurfaceLoad load{current ? Kind::current_traction : Kind::reference_traction, reader.side_sets(item),
                     components(item, reader), ""};
    load.label = SceneReader::label("traction", load.side_sets);
    loads.surface_loads.push_back(std::move(load));
  }
}

std::vector<std::pair<double, double>> law(const Value& item, const char* linear, const SceneReader& reader) {
  if (!item.has("table")) return {{0, 0}, {1, item.real(linear)}};
  std::vector<std::pair<double, double>> points = item.table("table");
  if (points.size() < 2) {
    reader.diagnostics.error(item.where("table"), "table: has one point; expected at least two");
    return {{0, 0}, {1, 0}};
  }
  return points;
}

Connector connector(const Value& item, Connector::Kind kind, const SceneReader& reader) {
  using Ends = Connector::Ends;
  const bool spring = kind == Connector::Kind::spring;
  Connector c;
  c.kind = kind;
  c.node_sets = reader.node_sets(item);
  c.other_sets = reader.names(item, "other_sets", reader.mesh.node_sets, "node set");
  c.label = SceneReader::label(spring ? "spring" : "dashpot", c.node_sets);
  c.law = law(item, spring ? "stiffness" : "coefficient", reader);
  if (item.has("direction")) {
    const Vec3 d = reader.direction(item, "direction");
    c.direction = (1 / norm(d)) * d;
  }
  c.ends = item.has("nodes")      ? Ends::labels
           : item.has("from")     ? Ends::places
           : c.other_sets.empty() ? Ends::ground
                                  : Ends::sets;
  if (item.has("nodes")) {
    const std::vector<double> nodes = item.reals("nodes");
    if (nodes.size() != 2) reader.diagnostics.error(item.where("nodes"), "nodes: expected two ids of nodes");
    for (std::size_t i = 0; i < 2 && i < nodes.size(); ++i) {
      constexpr double most = 9007199254740992;  // 2^53: doubles beyond are all whole
      if (nodes[i] != std::floor(nodes[i]) || std::abs(nodes[i]) >= most)
        reader.diagnostics.error(item.where("nodes"),
                                 fmt::format("nodes: {} is not the id of a node; expected whole numbers", nodes[i]));
      else
        c.node_labels[i] = static_cast<std::int64_t>(nodes[i]);
    }
  }
  if (item.has("from") != item.has("to"))
    reader.diagnostics.error(item.where(), "from and to belong together; expected both or none");
  else if (item.has("from"))
    c.place = {item.vector("from"), item.vector("to")};
  if (c.ends == Ends::ground && !c.direction && item.has("table"))
    reader.diagnostics.error(item.where("table"), "table: a law to the ground needs a direction");
  return c;
}

RigidBody rigid_body(const Value& item, const SceneReader& reader) {
  using Rotation = RigidBody::Rotation;
  RigidBody body;
  body.blocks = reader.blocks(item);
  body.label = SceneReader::label("rigid body", body.blocks);
  for (auto [key, to] : {std::pair("velocity", &body.velocity), {"spin", &body.spin}, {"joint", &body.joint}})
    if (item.has(key)) *to = item.vector(key);
  const char* const names[] = {"x", "y", "z"};
  const std::vector<std::string> fixed = item.has("fixed") ? item.texts("fixed") : std::vector<std::string>{};
  for (const std::string& name : fixed)
    if (name != "x" && name != "y" && name != "z")
      reader.diagnostics.error(item.where("fixed"), "fixed: '" + name + "' is not one of x, y, z");
  for (std::size_t c = 0; c < 3; ++c) {
    const std::string key = std::string("velocity_") + names[c];
    if (std::ranges::find(fixed, names[c]) != fixed.end()) body.prescribed_velocity[c] = TimeFunction::constant(0);
    if (!item.has(key)) continue;
    body.prescribed_velocity[c] = item.function(key);
    if (body.joint) reader.diagnostics.error(item.where(key), key + ": the joint holds the body; give one of the two");
  }
  const std::string& rotation = item.text("rotation");
  body.rotation = rotation == "fixed"        ? Rotation::fixed
                  : rotation == "hinge"      ? Rotation::hinge
                  : rotation == "prescribed" ? Rotation::prescribed
                                             : Rotation::free;
  const bool turns = body.rotation == Rotation::hinge || body.rotation == Rotation::prescribed;
  if (turns && !item.has("axis")) reader.diagnostics.error(item.where(), "rotation: " + rotation + " needs an axis");
  if (turns && item.has("axis")) body.axis = reader.direction(item, "axis");
  if (body.rotation == Rotation::prescribed) {
    if (item.has("angle"))
      body.angle = item.function("angle");
    else
      reader.diagnostics.error(item.where(), "rotation: prescribed needs an angle over time");
  }
  return body;
}

void read_constraints(const Value& value, const SceneReader& reader, LoadOptions& loads) {
  for (const Value& item : reader.items(value, "springs"))
    loads.connectors.push_back(connector(item, Connector::Kind::spring, reader));
  for (const Value& item : reader.items(value, "dashpots"))
    loads.connectors.push_back(connector(item, Connector::Kind::dashpot, reader));
  for (const Value& item : reader.items(value, "rigid_bodies")) loads.rigid_bodies.push_back(rigid_body(item, reader));
  for (const Value& item : reader.items(value, "tied")) {
    TiedSet set{reader.node_sets(item), reader.side_sets(item), {}, ""};
    set.label = SceneReader::label("tied", set.node_sets);
    if (item.has("tolerance")) set.tolerance = item.real("tolerance");
    loads.ties.push_back(std::move(set));
  }
}

void read_damping(const Value& value, const SceneReader& reader, LoadOptions& loads) {
  if (value.has("damping")) {
    const Value damping = value.child("damping");
    loads.damping = {damping.real("mass"), damping.real("stiffness")};
  }
  if (value.has("dynamic_relaxation")) {
    const Value relaxation = value.child("dynamic_relaxation");
    loads.relaxation = RelaxationOptions{relaxation.real("tolerance"), relaxation.real("after")};
  }
  for (const Value& item : reader.items(value, "non_reflecting")) {
    NonReflecting boundary{reader.side_sets(item), ""};
    boundary.label = SceneReader::label("non_reflecting", boundary.side_sets);
    loads.non_reflecting.push_back(std::move(boundary));
  }
}

void read_start(const Value& value, const SceneReader& reader, LoadOptions& loads) {
  for (const Value& item : reader.items(value, "initial_stresses")) {
    InitialStress initial{reader.blocks(item), {}, ""};
    initial.label = SceneReader::label("initial stress", initial.blocks);
    const char* const names[] = {"xx", "yy", "zz", "xy", "yz", "zx"};
    for (std::size_t c = 0; c < 6; ++c)
      if (item.has(names[c])) initial.stress[c] = item.field_function(names[c]);
    loads.initial_stresses.push_back(std::move(initial));
  }
  if (value.has("mass_scaling")) {
    const Value scaling = value.child("mass_scaling");
    loads.mass_scaling = MassScaling{scaling.real("time_step"), scaling.real("limit")};
  }
}

}  // namespace

void read_loads(const Value& value, const SceneReader& reader, LoadOptions& loads) {
  read_body_forces(value, reader, loads);
  read_surface_loads(value, reader, loads);
  read_constraints(value, reader, loads);
  read_damping(value, reader, loads);
  read_start(value, reader, loads);
  for (const Value& item : reader.items(value, "nodal_forces")) {
    NodalForce force{reader.node_sets(item), components(item, reader), item.flag("shared"), ""};
    force.label = SceneReader::label("nodal force", force.node_sets);
    loads.nodal_forces.push_back(std::move(force));
  }
}

}  // namespace tenon
