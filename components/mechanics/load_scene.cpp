// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/load_scene.hpp"

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

}  // namespace

void read_loads(const Value& value, const SceneReader& reader, LoadOptions& loads) {
  read_body_forces(value, reader, loads);
  read_surface_loads(value, reader, loads);
  for (const Value& item : reader.items(value, "nodal_forces")) {
    NodalForce force{reader.node_sets(item), components(item, reader), item.flag("shared"), ""};
    force.label = SceneReader::label("nodal force", force.node_sets);
    loads.nodal_forces.push_back(std::move(force));
  }
}

}  // namespace tenon
