// SPDX-License-Identifier: BSD-3-Clause
// Keys of explicit mechanics in a scene.
#include "components/mechanics/load_scene.hpp"
#include "components/mechanics/scene_block.hpp"

namespace tenon {
namespace {

using scene::Range;
using scene::Schema;

void add_formulation(Schema& s) {
  s.choice("formulation", {"automatic", "full"},
           "`automatic`: one point and hourglass control (hex8), nodal averages of the volume strain (tet4, wedge6); "
           "`full`: all quadrature points with the mean volume strain of the element (tet4 and wedge6 then lock).",
           "automatic");
}

Schema shell_schema() {
  Schema s("Section of a block of shells (quad4, tri3).");
  s.field_function("thickness", "m", "Thickness; an expression in x, y, z is taken at the centre of each element.")
      .required();
  s.integer("points", "Integration points through the thickness; without it 3 for elastic materials, else 5.", "",
            {1, 10});
  s.choice("rule", {"gauss", "lobatto"}, "Where they lie: `lobatto` (3 points or more) has points on both faces.",
           "gauss");
  s.choice("reference", {"middle", "top", "bottom"},
           "Where the nodes lie in the section; the top is where the right-hand normal points.", "middle");
  s.quantity("offset", "m", "Instead of `reference`: distance of the middle surface from the nodes along the normal.");
  return s;
}

Schema block_schema() {
  Schema s("Material of a block of the mesh.");
  s.text("material", "Name of a material.").required();
  add_formulation(s);
  s.object("shell", shell_schema(), "Section, if the block consists of shells.");
  return s;
}

Schema hourglass_schema() {
  Schema s("Resistance to the zero-energy modes of the one-point hexahedron.");
  s.choice(
      "form", {"viscous", "stiffness", "physical", "none"},
      "`viscous` is right for plastic flow; `stiffness` for elastic bodies; `physical` bends as the material does, "
      "elastic or plastic, at some cost; `none` for tests.",
      "viscous");
  s.quantity("coefficient", "1", "Its strength; without it 0.03 (viscous) or 0.05 (stiffness).", "",
             {0, 1, false, false});
  return s;
}

Schema viscosity_schema() {
  Schema s("Artificial pressure that spreads shocks over a few elements.");
  s.quantity("linear", "1", "Coefficient of the linear part, in compression and expansion.", "0.06",
             {0, 10, false, false});
  s.quantity("quadratic", "1", "Coefficient of the quadratic part, in compression.", "1.5", {0, 100, false, false});
  return s;
}

Schema time_step_schema() {
  Schema s("Time step of the component.");
  s.choice("estimate", {"automatic", "element"},
           "`automatic`: the stable step of the assembled mesh, from its greatest eigenvalue, followed as it deforms; "
           "`element`: the least step that an element alone allows, up to a third shorter.",
           "automatic");
  s.quantity("scale", "1", "Share of the stable step that is taken.", "0.9", {0, 2, true, false});
  s.integer("subcycling",
            "Greatest ratio of the longest to the shortest step of elements: 1, 2, 4, ... Each element then moves with "
            "the longest step, in powers of two of the shortest, that it allows.",
            "1", {1, 1024, false, false});
  s.at_most_one({"fixed", "subcycling"});
  s.quantity("fixed", "s", "Step to take whatever the elements allow.", "", Range::positive());
  s.quantity("maximum", "s", "Greatest step.", "", Range::positive());
  s.at_most_one({"fixed", "maximum"});
  return s;
}

Schema erosion_schema() {
  Schema s(
      "When elements are taken out other than by the `failure` of their material, and what becomes of their nodes.");
  s.quantity("minimum_step", "s", "An element whose own stable step falls below this is taken out.", "",
             Range::positive());
  s.choice("inverted", {"stop", "remove"},
           "What an element does that turns inside out: `stop` the run, or be taken out (`remove`).", "stop");
  s.choice(
      "loose_nodes", {"keep", "remove"},
      "Nodes that no element holds any more: `keep` them as point masses, which touch others as balls; or `remove` "
      "them: their kinetic energy goes to eroded_energy, and the history has their mass and momentum.",
      "keep");
  return s;
}

Schema initial_velocity_schema() {
  Schema s("Velocity at the start of a block, of a node set, or everywhere; later entries win.");
  s.text("block", "Block of the mesh.");
  s.text("node_set", "Node set of the mesh.");
  s.vector("velocity", "m/s", "Velocity (at `centre`, if there is a gradient).", "[0, 0, 0]");
  s.reals("gradient", "1/s", "Nine numbers, row by row: the velocity grows by gradient . (X - centre).");
  s.vector("centre", "m", "Point to which the gradient refers.", "[0, 0, 0]");
  s.at_most_one({"block", "node_set"});
  return s;
}

Schema& add_sets(Schema& s) {
  s.texts("node_sets", "One node set of the mesh, or a list of them.").required();
  return s;
}

Schema fixed_schema() {
  Schema s("Nodes that stand still in some components.");
  add_sets(s).texts("components",
                    "Any of x, y, z and, for the rotations of nodes of shells, rx, ry, rz; all six without it, so that "
                    "shells are clamped.");
  return s;
}

Schema components_schema(const std::string& doc, const std::string& unit) {
  Schema s(doc);
  add_sets(s);
  for (const char* c : {"x", "y", "z"})
    s.function(c, unit, std::string("Component ") + c + " over time; free without it.");
  return s;
}

Schema gradient_schema() {
  Schema s("Displacement that is linear in space: factor(t) gradient . (X - centre).");
  add_sets(s).texts("components", "Any of x, y, z; all three without it.");
  s.reals("gradient", "1", "Nine numbers, row by row.").required();
  s.vector("centre", "m", "Point that stands still.", "[0, 0, 0]");
  s.function("factor", "1", "Factor over time.").required();
  return s;
}

Schema rotation_schema() {
  Schema s("Rigid rotation about an axis.");
  add_sets(s).vector("axis", "1", "Direction of the axis.").required();
  s.vector("centre", "m", "Point on the axis.", "[0, 0, 0]");
  s.function("angle", "rad", "Right-handed angle over time.").required();
  return s;
}

Schema symmetry_schema() {
  Schema s("Nodes that do not move along a normal.");
  add_sets(s).vector("normal", "1", "Normal of the plane, of any length.").required();
  return s;
}

Schema wall_schema() {
  Schema s("Frictionless rigid plane that nodes may not pass.");
  s.vector("point", "m", "Point of the plane.").required();
  s.vector("normal", "1", "Normal towards the body, of any length.").required();
  s.texts("node_sets", "Nodes that meet the wall; all without it. Needed if bilateral.");
  s.flag("bilateral", "The nodes, which start on the plane, also never leave it.", "false");
  s.function("motion", "m", "Displacement of the wall along its normal over time; at rest without it.");
  return s;
}

}  // namespace

Schema mechanics_schema() {
  Schema s("A deformable body, by explicit central differences.");
  s.text("mesh", "Name of a mesh.").required();
  s.text("material", "Material of every block that is not named under `blocks`.");
  add_formulation(s);
  s.object("shell", shell_schema(), "Section of the blocks of shells that have none of their own.");
  s.named("blocks", block_schema(), "Materials block by block.");
  s.object("hourglass", hourglass_schema(), "Resistance to the zero-energy modes of the elements.");
  s.object("bulk_viscosity", viscosity_schema(), "Artificial pressure in shocks.");
  s.object("time_step", time_step_schema(), "Time step of the component.");
  s.object("erosion", erosion_schema(), "Elements that are taken out, and the nodes that they leave.");
  s.choice("heat", {"none", "adiabatic", "exported"},
           "Where the heat of plastic work goes: `none` nowhere; `adiabatic` stays in the element; `exported` waits in "
           "the field plastic_heat for a transfer.",
           "none");
  s.quantity("initial_temperature", "K",
             "Temperature at the start, at which there is no stress; without it the first temperature that a transfer "
             "brings, or the material's reference temperature.");
  s.vector("initial_velocity", "m/s", "Velocity of all nodes at the start.");
  s.list("initial_velocities", initial_velocity_schema(), "Velocities at the start, after `initial_velocity`.");
  s.list("fixed", fixed_schema(), "Nodes that stand still.");
  s.list("prescribed_displacements", components_schema("Displacement that nodes have over time.", "m"),
         "Displacements of nodes over time.");
  s.list("prescribed_velocities", components_schema("Velocity that nodes have over time.", "m/s"),
         "Velocities of nodes over time.");
  s.list("prescribed_accelerations", components_schema("Acceleration that nodes have over time.", "m/s^2"),
         "Accelerations of nodes over time, from their velocity at the start.");
  s.list("prescribed_gradients", gradient_schema(), "Displacements linear in space.");
  s.list("prescribed_rotations", rotation_schema(), "Rigid rotations of nodes.");
  s.list("symmetry_planes", symmetry_schema(), "Planes of symmetry.");
  s.list("rigid_walls", wall_schema(), "Rigid walls.");
  add_load_keys(s);
  return s;
}

}  // namespace tenon
