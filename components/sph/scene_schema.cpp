// SPDX-License-Identifier: BSD-3-Clause
// Keys of particles in a scene.
#include "components/sph/scene_block.hpp"

namespace tenon {
namespace {

using scene::Range;
using scene::Schema;

Schema components_schema(const std::string& doc, const std::string& unit, bool over_space) {
  Schema s(doc);
  for (const char* c : {"x", "y", "z"}) {
    const std::string what = std::string("Component ") + c + "; zero without it.";
    if (over_space)
      s.field_function(c, unit, what);
    else
      s.function(c, unit, what);
  }
  return s;
}

/// State at the start, of a block or of all blocks that have no entry of their own.
void add_start(Schema& s) {
  s.vector("initial_velocity", "m/s", "Velocity at the start.");
  s.object("initial_velocity_field", components_schema("Velocity at the start over x, y, z.", "m/s", true),
           "Instead of `initial_velocity`: one that depends on the place.");
  s.at_most_one({"initial_velocity", "initial_velocity_field"});
  s.field_function("initial_pressure", "Pa", "Pressure at the start; the density follows from it.");
  s.field_function("initial_density", "kg/m^3", "Density at the start; without it that of the material.");
  s.at_most_one({"initial_pressure", "initial_density"});
  s.field_function("initial_energy", "J/kg", "Internal energy at the start, of a gas.");
  s.field_function("initial_temperature", "K",
                   "Temperature at the start; without it the material's reference temperature.");
}

Schema inflow_schema() {
  Schema s("Plane behind which the particles of a moving wall are free.");
  s.vector("point", "m", "Point of the plane.").required();
  s.vector("normal", "1", "Where they go, of any length.").required();
  s.text("into", "Block that they belong to from then on.").required();
  return s;
}

Schema block_schema() {
  Schema s("Particles of one block of the mesh.");
  s.text("material", "Name of a material.").required();
  s.flag(
      "wall",
      "They make a wall: they push others and feel no force, but stand still or move as `velocity` says. A wall needs "
      "as many layers as the kernel reaches.",
      "false");
  s.object("velocity", components_schema("Velocity over time.", "m/s", false), "Of a wall that moves.");
  s.object("inflow", inflow_schema(),
           "Of a wall that moves: its particles flow in. The wall is as long as what flows in during the run.");
  s.text("from_elements",
         "Component and block of solid elements, as `plate.target`: each particle waits, and is the element from when "
         "that fails on, with its mass, momentum and energy. The mesh has them from a body of `type: elements`.");
  s.text("bond", "Of `total_lagrangian`: blocks with the same word here hold together, as at a clamp.");
  s.function("held_temperature", "K", "Temperature that its particles keep, whatever heat flows.");
  add_start(s);
  return s;
}

Schema periodic_schema() {
  Schema s("Space repeats itself along an axis: `x: [0 m, 1 m]`.");
  for (const char* c : {"x", "y", "z"})
    s.reals(c, "m", std::string("Where the period along ") + c + " begins and ends.");
  return s;
}

Schema symmetry_schema() {
  Schema s("Planes across the axes in which everything is mirrored; particles stay on one side.");
  for (const char* c : {"x", "y", "z"}) {
    s.quantity(std::string(c) + "_min", "m", std::string("Plane below the particles, at this ") + c + ".");
    s.quantity(std::string(c) + "_max", "m", std::string("Plane above the particles, at this ") + c + ".");
  }
  return s;
}

Schema viscosity_schema() {
  Schema s("Artificial viscosity of pairs that approach each other [Mon92], [Mon97].");
  s.quantity("alpha", "1", "Linear part; without it what suits the formulation.", "", {0, 10, false, false});
  s.quantity("beta", "1",
             "Quadratic part, against particles that run through each other; without it what suits the "
             "formulation.",
             "", {0, 10, false, false});
  s.choice("limiter", {"none", "balsara", "cullen_dehnen"},
           "Where it is switched off: `balsara` in shear [Bal95], `cullen_dehnen` wherever no shock is.", "none");
  return s;
}

Schema fluid_schema() {
  Schema s("Of `formulation: fluid`.");
  s.choice(
      "viscosity", {"artificial", "morris", "monaghan"},
      "`artificial` needs no constant; `morris` and `monaghan` take the `viscosity` of the material (laminar flow).",
      "artificial");
  s.quantity("density_diffusion", "1", "Coefficient of delta-SPH, which keeps the pressure smooth; 0: none.", "0.1",
             {0, 1, false, false});
  s.flag("hydrostatic_diffusion", "The density that gravity makes is left out of the diffusion.", "true");
  s.choice("shifting", {"none", "shifting", "transport_velocity"},
           "Keeps particles evenly spread where streamlines would part them; for flows without violent free surfaces.",
           "none");
  s.quantity("shifting_strength", "1", "Over what is usual.", "1", {0, 10, false, false});
  s.quantity("background_pressure", "Pa", "Added to every pressure, against voids; for flows without free surfaces.",
             "0 Pa", Range::not_negative());
  s.flag("wall_slip", "Fluid passes along walls freely; else it holds on to them (needs a `viscosity`).", "true");
  return s;
}

Schema solid_schema() {
  Schema s("Of `formulation: solid` and `total_lagrangian`.");
  s.quantity("hourglass", "1",
             "Of `total_lagrangian`: resistance to modes that no strain sees [Gan15], over Young's modulus; 0: none.",
             "10", {0, 1000, false, false});
  s.quantity("contact_stiffness", "1", "Of `total_lagrangian`: what keeps bodies apart, over their own stiffness.", "1",
             {0, 10, false, false});
  s.quantity("artificial_stress", "1",
             "Of `solid`: share of a tension that pairs do not feel when they come near, against numerical fracture "
             "[Mon00]; 0: none, 0.3 is usual.",
             "0", {0, 1, false, false});
  return s;
}

Schema gas_schema() {
  Schema s("Of `formulation: gas`.");
  s.choice("density", {"summation", "continuity"},
           "`summation` of the masses around, exact where there is matter on all sides; `continuity` by the divergence "
           "of the velocity, for condensed matter with free surfaces.",
           "summation");
  s.quantity("greatest_smoothing", "1",
             "Where a smoothing length that follows the density ends, over the greatest of the start: with more, "
             "particles in thin gas see farther and cost more.",
             "4", {1, 100, false, false});
  return s;
}

Schema time_step_schema() {
  Schema s("Time step of the component.");
  s.quantity("cfl", "1", "Share of the smoothing length that a signal may cross in a step.", "0.25",
             {0, 1, true, false});
  s.quantity("fixed", "s", "Step to take whatever the particles allow.", "", Range::positive());
  s.quantity("maximum", "s", "Greatest step.", "", Range::positive());
  s.at_most_one({"fixed", "maximum"});
  return s;
}

}  // namespace

Schema sph_schema() {
  Schema s("Smoothed particle hydrodynamics: fluids, gases and solids of particles.");
  s.text("mesh", "Name of a mesh of particles (`type: particles`).").required();
  s.choice("formulation", {"by_material", "fluid", "gas", "solid", "total_lagrangian"},
           "`fluid`: weakly compressible, pressure from density alone; `gas`: any equation of state with energy, gases "
           "and shocks; `solid`: strength, on the present neighbours; `total_lagrangian`: strength, on the neighbours "
           "of the start (no numerical fracture). `by_material`: `fluid` for `tait` and `linear`, "
           "`gas` for other equations of state, `total_lagrangian` for strength alone, `solid` for both together and "
           "for what elements become.",
           "by_material");
  s.text("material", "Material of every block that is not named under `blocks`.");
  add_start(s);
  s.named("blocks", block_schema(), "Materials, walls and states at the start block by block.");
  s.choice("kernel", {"wendland_c2", "wendland_c4", "cubic_spline", "quintic_spline"}, "Smoothing kernel.",
           "wendland_c2");
  s.quantity("smoothing", "1", "Smoothing length over the spacing of particles.", "1.3", {0.5, 5, false, false});
  s.flag("variable_smoothing", "The smoothing length follows the density.", "false");
  s.vector("gravity", "m/s^2", "Acceleration of gravity.", "[0, 0, 0]");
  s.object(
      "body_acceleration", components_schema("Acceleration over time.", "m/s^2", false),
      "Acceleration of all particles over time, as in a tank that is shaken; takes the place of `gravity` along the "
      "axes that it names.");
  s.object("periodic", periodic_schema(), "Axes along which space repeats itself.");
  s.object("symmetry_planes", symmetry_schema(), "Mirrors across the axes.");
  s.object("artificial_viscosity", viscosity_schema(), "Artificial viscosity.");
  s.quantity("artificial_conduction", "1",
             "Heat that flows across jumps of the energy of a gas: 0 none, 1 as much as [Pri08].", "0",
             {0, 10, false, false});
  s.object("fluid", fluid_schema(), "Of `formulation: fluid`.");
  s.object("gas", gas_schema(), "Of `formulation: gas`.");
  s.object("solid", solid_schema(), "Of solids.");
  s.flag("heat_conduction", "Heat flows between particles that are near each other; materials need `thermal`.",
         "false");
  s.object("time_step", time_step_schema(), "Time step of the component.");
  s.quantity("skin", "1",
             "How far lists of neighbours reach beyond the support, in supports: the longer the seldomer "
             "they are made.",
             "0.1", {0, 1, false, false});
  s.flag("always_search", "Make the lists in each step, needed or not; the answer is the same.", "false");
  return s;
}

}  // namespace tenon
