// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/core.h>

#include "components/materials/read_law.hpp"

namespace tenon {
namespace {

using scene::Range;
using scene::Schema;
using scene::Value;

void add_rate(Schema& schema) {
  Schema rate("Rate hardening: the flow stress times 1 + (plastic strain rate / D)^(1/p).");
  rate.required_quantity("D", "1/s", "Rate at which the flow stress has doubled.", Range::positive());
  rate.required_quantity("p", "1", "Exponent, at least 1.", {1, 100, false, false});
  schema.object("cowper_symonds", rate, "Rate hardening after Cowper and Symonds; none without it.");
}

Schema linear_hardening_schema() {
  Schema schema("Von Mises plasticity with linear isotropic hardening.");
  schema.required_quantity("yield_stress", "Pa", "Flow stress at zero plastic strain.", Range::positive());
  schema.quantity("hardening_modulus", "Pa", "Slope of the flow stress over the plastic strain.", "0 Pa",
                  Range::not_negative());
  add_rate(schema);
  return schema;
}

Schema voce_schema() {
  Schema schema(
      "Von Mises plasticity, flow stress yield_stress + saturation (1 - exp(-rate eqps)) + hardening_modulus eqps.");
  schema.required_quantity("yield_stress", "Pa", "Flow stress at zero plastic strain.", Range::positive());
  schema.required_quantity("saturation", "Pa", "What hardening adds in the end.", Range::not_negative());
  schema.required_quantity("rate", "1", "How fast the flow stress saturates over the plastic strain.",
                           Range::positive());
  schema.quantity("hardening_modulus", "Pa", "Slope that stays when the flow stress has saturated.", "0 Pa",
                  Range::not_negative());
  add_rate(schema);
  return schema;
}

Schema table_schema() {
  Schema schema("Von Mises plasticity with a tabulated flow stress.");
  schema
      .table("flow_stress", "plastic strain", "1", "Pa",
             "Flow stress over the equivalent plastic strain, from 0; held beyond the last point.", Range::positive())
      .required();
  add_rate(schema);
  return schema;
}

Schema kinematic_schema() {
  Schema schema("Von Mises plasticity whose yield surface moves with the plastic strain, grows with it, or both.");
  schema.required_quantity("yield_stress", "Pa", "Radius of the yield surface at zero plastic strain.",
                           Range::positive());
  schema.required_quantity("hardening_modulus", "Pa", "Slope of the stress over the plastic strain in tension.",
                           Range::not_negative());
  schema.quantity("kinematic_share", "1", "Share of the hardening that moves the yield surface; the rest widens it.",
                  "1", {0, 1, false, false});
  schema.quantity(
      "recovery", "1",
      "Armstrong-Frederick constant: the back stress saturates at kinematic modulus / recovery; 0 for none.", "0",
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

CowperSymonds read_rate(const Value& v) {
  if (!v.has("cowper_symonds")) return {};
  const Value rate = v.child("cowper_symonds");
  return {rate.real("D"), rate.real("p")};
}

JohnsonCookParameters read_johnson_cook(const Value& v, scene::Diagnostics& diagnostics) {
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

TableHardeningParameters read_table(const Value& v, double three_g, scene::Diagnostics& diagnostics) {
  const TableHardeningParameters p{v.table("flow_stress"), read_rate(v)};
  const auto& points = p.flow_stress;
  if (points.front().first != 0)
    diagnostics.error(v.where("flow_stress"),
                      fmt::format("flow_stress starts at plastic strain {}; expected 0", points.front().first));
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double slope = (points[i].second - points[i - 1].second) / (points[i].first - points[i - 1].first);
    if (three_g > 0 && slope <= -0.9 * three_g)
      diagnostics.error(v.where("flow_stress"),
                        fmt::format("flow_stress falls by {:.4g} Pa per plastic strain from {} on; expected less than "
                                    "0.9 times three shear moduli, {:.4g} Pa, as no solution exists beyond that",
                                    -slope, points[i - 1].first, 0.9 * three_g));
  }
  return p;
}

}  // namespace

void add_plasticity(Schema& material) {
  material.variants("plasticity", scene::Key::Type::object,
                    {{"linear_hardening", linear_hardening_schema()},
                     {"johnson_cook", johnson_cook_schema()},
                     {"voce", voce_schema()},
                     {"table", table_schema()},
                     {"kinematic", kinematic_schema()}},
                    "Plastic flow; elastic without it.");
}

PlasticityParameters read_plasticity(const Value& material, scene::Diagnostics& diagnostics) {
  if (!material.has("plasticity")) return {};
  const Value v = material.child("plasticity");
  const std::string& type = v.text("type");
  if (!material.has("elastic"))
    diagnostics.error(material.where("plasticity"), "plasticity without elasticity; add an 'elastic' block");
  if (type == "linear_hardening")
    return LinearHardeningParameters{v.real("yield_stress"), v.real("hardening_modulus"), read_rate(v)};
  if (type == "voce")
    return VoceHardeningParameters{
        {v.real("yield_stress"), v.real("saturation"), v.real("rate"), v.real("hardening_modulus")}, read_rate(v)};
  if (type == "table") {
    double three_g = 0;
    if (material.has("elastic")) {
      const Value e = material.child("elastic");
      three_g = 3 * Elasticity{e.real("youngs_modulus"), e.real("poissons_ratio"), 0}.shear_modulus();
    }
    return read_table(v, three_g, diagnostics);
  }
  if (type == "kinematic") {
    const double modulus = v.real("hardening_modulus"), share = v.real("kinematic_share");
    return KinematicHardeningParameters{v.real("yield_stress"), (1 - share) * modulus, share * modulus,
                                        v.real("recovery")};
  }
  return read_johnson_cook(v, diagnostics);
}

}  // namespace tenon
