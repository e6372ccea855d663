// SPDX-License-Identifier: BSD-3-Clause
#include "components/materials/read_material.hpp"

#include <fmt/core.h>

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

Schema linear_hardening_schema() {
  Schema schema("Von Mises plasticity with linear isotropic hardening.");
  schema.required_quantity("yield_stress", "Pa", "Flow stress at zero plastic strain.", Range::positive());
  schema.quantity("hardening_modulus", "Pa", "Slope of the flow stress over the plastic strain.", "0 Pa",
                  Range::not_negative());
  return schema;
}

Schema johnson_cook_schema() {
  Schema schema("Johnson-Cook flow stress (A + B eqps^n) (1 + C ln(rate / reference_strain_rate)) (1 - T*^m).");
  schema.required_quantity("A", "Pa", "Flow stress at zero plastic strain.", Range::positive());
  schema.required_quantity("B", "Pa", "Factor of strain hardening.", Range::not_negative());
  schema.required_quantity("n", "1", "Exponent of strain hardening.", {0, 10, true, false});
  schema.quantity("C", "1", "Factor of rate hardening; 0 for none.", "0", Range::not_negative());
  schema.quantity("m", "1", "Exponent of thermal softening.", "1", Range::positive());
  schema.quantity("reference_strain_rate", "1/s", "Below this rate there is no rate hardening.", "1 1/s",
                  Range::positive());
  schema.quantity("reference_temperature", "K", "Below this temperature there is no softening.", "293.15 K",
                  Range::not_negative());
  schema.required_quantity("melting_temperature", "K", "From this temperature on there is no strength.",
                           Range::positive());
  return schema;
}

LinearHardeningParameters read_linear_hardening(const scene::Value& v) {
  return {v.real("yield_stress"), v.real("hardening_modulus")};
}

JohnsonCookParameters read_johnson_cook(const scene::Value& v, scene::Diagnostics& diagnostics) {
  const JohnsonCookParameters p{v.real("A"),
                                v.real("B"),
                                v.real("n"),
                                v.real("C"),
                                v.real("m"),
                                v.real("reference_strain_rate"),
                                v.real("reference_temperature"),
                                v.real("melting_temperature")};
  if (!(p.melting_temperature > p.reference_temperature))
    diagnostics.error(v.where("melting_temperature"),
                      fmt::format("melting_temperature is {} K; expected more than the reference_temperature, {} K",
                                  p.melting_temperature, p.reference_temperature));
  return p;
}

}  // namespace

Schema material_schema() {
  Schema schema("A material.");
  schema.required_quantity("density", "kg/m^3", "Density of the undeformed body.", Range::positive());
  schema.object("elastic", elastic_schema(), "Isotropic elasticity; needed by mechanics.");
  schema.variants("plasticity", scene::Key::Type::object,
                  {{"linear_hardening", linear_hardening_schema()}, {"johnson_cook", johnson_cook_schema()}},
                  "Plastic flow; elastic without it.");
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
  if (value.has("plasticity")) {
    const scene::Value v = value.child("plasticity");
    if (v.text("type") == "linear_hardening")
      material.plasticity = read_linear_hardening(v);
    else
      material.plasticity = read_johnson_cook(v, diagnostics);
    if (!material.elastic)
      diagnostics.error(value.where("plasticity"),
                        fmt::format("material '{}' has plasticity without elasticity; add an 'elastic' block", name));
  }
  if (value.has("thermal")) {
    const scene::Value v = value.child("thermal");
    material.thermal = read_thermal_properties(v, diagnostics);
    if (material.elastic) material.elastic->expansion = v.real("expansion");
  }
  return material;
}

}  // namespace tenon
