// SPDX-License-Identifier: BSD-3-Clause
#include "components/materials/read_material.hpp"

#include <fmt/core.h>

#include "components/materials/read_law.hpp"
#include "components/materials/read_thermal.hpp"

namespace tenon {
namespace {

using scene::Range;
using scene::Schema;

Schema elastic_schema() {
  Schema schema("Isotropic elasticity; needed by mechanics.");
  schema.required_quantity("youngs_modulus", "Pa", "Young's modulus.", Range::positive());
  schema.required_quantity("poissons_ratio", "1", "Poisson's ratio, above -1 and below 0.5.", {-1, 0.5, true, true});
  return schema;
}

}  // namespace

Schema material_schema() {
  Schema schema("A material.");
  schema.required_quantity("density", "kg/m^3", "Density of the undeformed body.", Range::positive());
  schema.object("elastic", elastic_schema(), "Isotropic elasticity; needed by mechanics.");
  add_plasticity(schema);
  add_whole_laws(schema);
  add_equation_of_state(schema);
  add_failure(schema);
  schema.quantity("viscosity", "Pa s", "Dynamic viscosity of a fluid; for particles.", "", Range::not_negative());
  schema.object("thermal", thermal_properties_schema(),
                "Thermal properties; needed by conduction, plastic heat and expansion.");
  return schema;
}

MaterialDescription read_material(const std::string& name, const scene::Value& value, scene::Diagnostics& diagnostics) {
  MaterialDescription material;
  material.name = name;
  material.density = value.real("density");
  if (value.has("elastic")) {
    const scene::Value v = value.child("elastic");
    material.elastic = Elasticity{v.real("youngs_modulus"), v.real("poissons_ratio"), 0};
  }
  material.plasticity = read_plasticity(value, diagnostics);
  material.whole_law = read_whole_law(value, material.elastic, diagnostics);
  material.equation_of_state = read_equation_of_state(value, material.density, diagnostics);
  material.failure = read_failure(value, diagnostics);
  if (value.has("viscosity")) material.viscosity = value.real("viscosity");
  const double expansion = value.has("thermal") ? value.child("thermal").real("expansion") : 0;
  if (expansion != 0 && (value.has("equation_of_state") || value.has("soil")))
    diagnostics.error(value.child("thermal").where("expansion"),
                      fmt::format("expansion is {} 1/K, but the pressure of material '{}' is a function of its volume; "
                                  "expected none with equation_of_state or soil",
                                  expansion, name));
  if (const auto* rubber = std::get_if<MooneyRivlinParameters>(&material.whole_law))
    material.elastic = MooneyRivlin::small_strain(*rubber, 0);
  if (const auto* wood = std::get_if<OrthotropicParameters>(&material.whole_law))
    material.elastic = OrthotropicElastic(*wood, 0).elasticity;
  if (value.has("thermal")) {
    const scene::Value v = value.child("thermal");
    material.thermal = read_thermal_properties(v, diagnostics);
    if (material.elastic) material.elastic->expansion = expansion;
  }
  return material;
}

}  // namespace tenon
