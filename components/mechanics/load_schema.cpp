// SPDX-License-Identifier: BSD-3-Clause
// Keys of loads in a scene.
#include "components/mechanics/load_scene.hpp"

namespace tenon {
namespace {

using scene::Range;
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

Schema damping_schema() {
  Schema s("Rayleigh damping: forces -(mass M + stiffness K) v.");
  s.quantity("mass", "1/s", "Mass-proportional part, on every node; implicit, so the step does not suffer.", "0",
             Range::not_negative());
  s.quantity("stiffness", "s",
             "Stiffness-proportional part; lowers the stable step by (1 + x^2)^0.5 - x, x its damping "
             "ratio in the fastest mode.",
             "0", Range::not_negative());
  return s;
}

Schema relaxation_schema() {
  Schema s(
      "Way to a static state: kinetic energy is taken at each of its peaks until forces balance; the run then ends.");
  s.quantity("tolerance", "1", "Greatest residual over loads and reactions.", "1e-6", {0, 1, true, true});
  s.quantity("after", "s", "Loads and motions are constant from this time on, and nothing has converged before.", "0",
             Range::not_negative());
  return s;
}

Schema connector_schema(bool spring) {
  Schema s(spring ? "Spring between nodes, or from nodes to the ground."
                  : "Dashpot between nodes, or from nodes to the ground.");
  s.texts("node_sets", "Nodes, each with one of these: to the ground, or to the nearest node of `other_sets`.");
  s.texts("other_sets", "Nodes at the other ends.");
  s.reals("nodes", "1", "Two nodes by their ids in the mesh file.");
  s.vector("from", "m", "Place of one end: the nearest node; with `to`.");
  s.vector("to", "m", "Place of the other end.");
  s.exactly_one({"node_sets", "nodes", "from"});
  s.vector("direction", "1",
           "Only relative displacement along it counts; without it that along the line between the "
           "nodes, and to the ground that in all directions.");
  if (spring) {
    s.quantity("stiffness", "N/m", "Force per elongation.", "", Range::positive());
    s.table("table", "elongation", "m", "N", "Force over elongation, straight on outside the points.");
    s.exactly_one({"stiffness", "table"});
  } else {
    s.quantity("coefficient", "N.s/m", "Force per rate of elongation.", "", Range::positive());
    s.table("table", "rate", "m/s", "N", "Force over rate of elongation, straight on outside the points.");
    s.exactly_one({"coefficient", "table"});
  }
  return s;
}

Schema rigid_body_schema() {
  Schema s("Blocks that move as one rigid body; mass and inertia are those of their elements.");
  s.texts("blocks", "One block of the mesh, or a list of them.").required();
  s.vector("velocity", "m/s", "Velocity of the centre at the start; without it that of the initial velocities.");
  s.vector("spin", "rad/s", "Angular velocity at the start; without it that of the initial velocities.");
  s.vector("joint", "m", "Point of the body that never moves: a ball joint, or with `rotation: hinge` a hinge.");
  s.texts("fixed", "Translations of the centre that are held: any of x, y, z.");
  for (const char* c : {"x", "y", "z"})
    s.function(std::string("velocity_") + c, "m/s", std::string("Prescribed velocity of the centre along ") + c + ".");
  s.choice(
      "rotation", {"free", "fixed", "hinge", "prescribed"},
      "`free`; `fixed`: it does not turn; `hinge`: it turns about `axis` only; `prescribed`: by `angle` about `axis`.",
      "free");
  s.vector("axis", "1", "Axis of a hinge or of the prescribed rotation, through the joint or the centre.");
  s.function("angle", "rad", "Prescribed right-handed angle over time.");
  return s;
}

Schema tied_schema() {
  Schema s("Nodes that are bound to the faces they lie on, or near to, at the start.");
  s.texts("node_sets", "Nodes that are bound.").required();
  s.texts("side_sets", "Faces that they are bound to.").required();
  s.quantity("tolerance", "m", "Greatest distance; without it 5 % of the greatest face diagonal.", "",
             Range::not_negative());
  return s;
}

Schema non_reflecting_schema() {
  Schema s(
      "Sides that let plane waves out, by dashpots rho c_p and rho c_s per area; not at nodes that are tied or rigid.");
  s.texts("side_sets", "One side set of the mesh, or a list of them.").required();
  return s;
}

Schema initial_stress_schema() {
  Schema s("Stress of blocks at the start.");
  s.texts("blocks", "One block of the mesh, or a list of them; all without it.");
  for (const char* c : {"xx", "yy", "zz", "xy", "yz", "zx"})
    s.field_function(c, "Pa", std::string("Component ") + c + " of the Cauchy stress over place; zero without it.");
  return s;
}

Schema mass_scaling_schema() {
  Schema s("Added mass in small elements; what was added stands in the log and in the history.");
  s.required_quantity("time_step", "s", "Step that every element shall allow, `time_step.scale` included.",
                      Range::positive());
  s.quantity("limit", "1", "Greatest added share of the mass of the body.", "5 %", Range::not_negative());
  return s;
}

}  // namespace

void add_load_keys(Schema& s) {
  s.vector("gravity", "m/s^2", "Acceleration of gravity, on all mass.");
  s.list("body_forces", body_force_schema(), "Acceleration fields on mass.");
  s.list("nodal_forces", nodal_force_schema(), "Forces on nodes.");
  s.list("pressures", pressure_schema(), "Pressures on sides.");
  s.list("tractions", traction_schema(), "Tractions on sides.");
  s.object("damping", damping_schema(), "Rayleigh damping.");
  s.object("dynamic_relaxation", relaxation_schema(), "Search for a static state.");
  s.list("springs", connector_schema(true), "Springs.");
  s.list("dashpots", connector_schema(false), "Dashpots.");
  s.list("rigid_bodies", rigid_body_schema(), "Rigid bodies.");
  s.list("tied", tied_schema(), "Nodes bound to faces.");
  s.list("non_reflecting", non_reflecting_schema(), "Sides that let waves out.");
  s.list("initial_stresses", initial_stress_schema(), "Stress at the start.");
  s.object("mass_scaling", mass_scaling_schema(), "Added mass for larger steps.");
}

}  // namespace tenon
