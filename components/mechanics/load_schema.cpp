// SPDX-License-Identifier: BSD-3-Clause
// Keys of loads in a scene.
#include "components/mechanics/load_scene.hpp"

namespace tenon {
namespace {

using scene::Schema;

void add_components(Schema& s, const std::string& unit, const std::string& what) {
  for (const char* c : {"x", "y", "z"})
    s.field_function(c, unit, what + " " + c + " over time and place; zero without it.");
}

Schema body_force_schema() {
  Schema s("Acceleration field on the mass of blocks.");
  s.texts("blocks", "One block of the mesh, or a list of them; all without it.");
  add_components(s, "m/s^2", "Component");
  return s;
}

Schema nodal_force_schema() {
  Schema s("Force on each node of sets; places in expressions are those of the undeformed body.");
  s.texts("node_sets", "One node set of the mesh, or a list of them.").required();
  add_components(s, "N", "Component");
  s.flag("shared", "The force is that on all these nodes together, in equal shares.", "false");
  return s;
}

Schema pressure_schema() {
  Schema s("Pressure that follows the surface: along the present normal, on the present area.");
  s.texts("side_sets", "One side set of the mesh, or a list of them; of shells, side 1 or 2.").required();
  s.field_function("pressure", "Pa", "Pressure over time and (present) place; negative: suction.").required();
  return s;
}

Schema traction_schema() {
  Schema s("Force per area in a fixed direction.");
  s.texts("side_sets", "One side set of the mesh, or a list of them.").required();
  add_components(s, "Pa", "Component");
  s.choice("per", {"reference", "current"},
           "Area that it refers to, and place that expressions see: `reference` of the undeformed body (a dead load), "
           "`current` of the present one.",
           "reference");
  return s;
}

}  // namespace

void add_load_keys(Schema& s) {
  s.vector("gravity", "m/s^2", "Acceleration of gravity, on all mass.");
  s.list("body_forces", body_force_schema(), "Acceleration fields on mass.");
  s.list("nodal_forces", nodal_force_schema(), "Forces on nodes.");
  s.list("pressures", pressure_schema(), "Pressures on sides.");
  s.list("tractions", traction_schema(), "Tractions on sides.");
}

}  // namespace tenon
