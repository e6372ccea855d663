// SPDX-License-Identifier: BSD-3-Clause
// The schema and scene that the tests of complaints, overrides, reference and fuzzing share.
#include "rich_schema.hpp"

namespace tenon::testing {

using scene::Key;
using scene::Range;
using scene::Schema;

namespace {

Schema elastic_schema() {
  Schema elastic("Linear elasticity.");
  elastic.required_quantity("density", "kg/m^3", "mass density", Range::positive())
      .required_quantity("youngs_modulus", "Pa", "modulus of elasticity", Range::positive())
      .quantity("poissons_ratio", "1", "ratio of lateral to axial strain", "0.3", {-1, 0.5, true, true});
  return elastic;
}

Schema plastic_schema() {
  Schema plastic("Johnson-Cook | flow stress.");
  plastic.required_quantity("density", "kg/m^3", "mass density", Range::positive())
      .quantity("melting_temperature", "K", "where the strength vanishes", "1083 degC", Range::positive())
      .quantity("softening_width", "delta_K", "width of the transition", "5 K")
      .table("hardening", "plastic strain", "1", "Pa", "yield stress over plastic strain", Range::positive())
      .integer("exponent", "of the softening", "1", {1, 9, false, false});
  return plastic;
}

Schema boundary_schema() {
  Schema boundary("A boundary condition.");
  boundary.texts("nodeset", "where it acts")
      .required()
      .function("velocity", "m/s", "prescribed velocity")
      .field_function("pressure", "Pa", "pressure that may vary in space")
      .function("temperature", "K", "prescribed temperature")
      .with_range(Range::positive())
      .vector("direction", "1", "direction of the velocity", "[0, 0, 1]")
      .exactly_one({"velocity", "temperature", "pressure"});
  return boundary;
}

Schema mechanics_schema() {
  Schema mechanics("Explicit finite elements.");
  mechanics.text("mesh", "name of a mesh")
      .required()
      .vector("initial_velocity", "m/s", "velocity of all nodes at the start", "[0, 0, 0]")
      .choice("quadrature", {"reduced", "full"}, "number of points", "reduced")
      .flag("erosion", "remove failed elements", "false")
      .list("boundary", boundary_schema(), "boundary conditions")
      .variants("time_step", Key::Type::object,
                {{"fixed", Schema("A step of one size.").required_quantity("size", "s", "the step", Range::positive())},
                 {"stable", Schema("The stable step.").quantity("safety", "1", "factor", "0.9", {0, 1, true, false})}},
                "how the step is chosen");
  return mechanics;
}

}  // namespace

Schema rich_schema() {
  Schema mesh("A mesh.");
  mesh.text("file", "mesh file").text("generate", "generator").exactly_one({"file", "generate"});
  Schema checkpoint("Checkpoints.");
  checkpoint.integer("every", "steps between checkpoints", "100", {1, 1000000, false, false})
      .quantity("interval", "s", "time between checkpoints")
      .at_most_one({"every", "interval"});
  Schema output("Output.");
  output.reals("times", "s", "times of frames", Range::not_negative())
      .texts("fields", "names of fields")
      .object("checkpoint", checkpoint, "checkpoints");
  Schema root("A whole simulation.");
  root.required_quantity("end_time", "s", "when the run ends", Range::positive())
      .named("meshes", mesh, "meshes by name")
      .variants("materials", Key::Type::named, {{"elastic", elastic_schema()}, {"johnson_cook", plastic_schema()}},
                "materials by name")
      .variants("components", Key::Type::named, {{"mechanics", mechanics_schema()}, {"idle", Schema("Does nothing.")}},
                "physics components by name")
      .required()
      .object("output", output, "what is written");
  return root;
}

const char* const good_scene = R"(# A bar that hits a wall.
end_time: 80 us
meshes:
  bar: {file: bar.e}
  fine:
    generate: "cylinder"
materials:
  copper: &copper
    type: elastic
    density: 8930 kg/m^3
    youngs_modulus: 117 GPa
  soft:
    <<: *copper
    youngs_modulus: 1.5e9
  steel:
    type: johnson_cook
    density: 7.85 g/cm^3
    melting_temperature: 1500 °C
    hardening: [[0, 400 MPa], [0.1, 450 MPa]]
components:
  body:
    type: mechanics
    mesh: bar
    initial_velocity: [0, 0, -227 m/s]
    boundary:
      - nodeset: foot
        velocity:
          table: [[0 s, 0], [2 us, 4 m/s], [5 us, 1 km/h]]
      - nodeset: [left, right]
        temperature: {sine: {amplitude: 5 K, period: 1 ms, offset: 20 degC}}
      - nodeset: all
        velocity: {smooth_step: {from: 0, to: 3 m/s, end: 1 ms}}
      - nodeset: all
        velocity: {expression: 10 * sin(2*pi*t/1e-3), unit: mm/s}
      - nodeset: all
        pressure: {expression: '10 * sin(2*pi*t/1e-3) * exp(-x^2) + max(y, z)',
                  unit : MPa
}
    time_step: {type: stable, safety: 0.5}
  rest:
    type: idle
output:
  times: [0, 10 us, 20 us]
  fields: displacement
  checkpoint:
    every: 50
)";

std::vector<std::string> complaints(const std::string& text, const std::vector<scene::Override>& overrides) {
  scene::Diagnostics diagnostics;
  scene::parse_scene(text, "s", overrides, rich_schema(), diagnostics);
  std::vector<std::string> errors = diagnostics.errors();
  for (std::string& error : errors)
    if (error.compare(0, 2, "s:") == 0) error.erase(0, 2);
  return errors;
}

}  // namespace tenon::testing
