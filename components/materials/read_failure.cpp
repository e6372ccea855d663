// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/core.h>

#include "components/materials/read_law.hpp"

namespace tenon {
namespace {

using scene::Range;
using scene::Schema;
using scene::Value;

Schema johnson_cook_damage_schema() {
  Schema schema(
      "Plastic strain at fracture (D1 + D2 exp(D3 m/q)) (1 + D4 ln(rate / reference_strain_rate)) (1 + D5 T*).");
  schema.quantity("D1", "1", "Plastic strain at fracture under high tension.", "0");
  schema.quantity("D2", "1", "What lower triaxiality adds.", "0");
  schema.quantity("D3", "1", "Exponent of the triaxiality (mean stress over von Mises), mostly negative.", "0");
  schema.quantity("D4", "1", "Factor of the rate.", "0");
  schema.quantity("D5", "1", "Factor of the temperature.", "0");
  schema.quantity("reference_strain_rate", "1/s", "Below this rate it does not count.", "1 1/s", Range::positive());
  schema.quantity("reference_temperature", "K", "Below this temperature it does not count.", "293.15 K",
                  Range::not_negative());
  schema.quantity("melting_temperature", "K", "Temperature at which T* is 1; needed with D5.", "", Range::positive());
  return schema;
}

JohnsonCookDamage read_damage(const Value& v, scene::Diagnostics& diagnostics) {
  JohnsonCookDamage d{v.real("D1"), v.real("D2"), v.real("D3"), v.real("D4"), v.real("D5")};
  d.reference_strain_rate = v.real("reference_strain_rate");
  d.reference_temperature = v.real("reference_temperature");
  d.melting_temperature = v.has("melting_temperature") ? v.real("melting_temperature") : d.reference_temperature + 1;
  if (!(d.D1 + d.D2 > 0))
    diagnostics.error(v.where(),
                      fmt::format("D1 + D2 is {}; expected a positive plastic strain at fracture", d.D1 + d.D2));
  if (d.D5 != 0 && !v.has("melting_temperature"))
    diagnostics.error(v.where("D5"), "D5 without melting_temperature, which T* needs; give both");
  if (!(d.melting_temperature > d.reference_temperature))
    diagnostics.error(v.where("melting_temperature"),
                      fmt::format("melting_temperature is {} K; expected more than the reference_temperature, {} K",
                                  d.melting_temperature, d.reference_temperature));
  return d;
}

}  // namespace

void add_failure(Schema& material) {
  Schema schema("When a point of the material fails; the first limit that is reached counts.");
  schema.quantity("plastic_strain", "1", "Equivalent plastic strain at failure.", "", Range::positive());
  schema.object("johnson_cook", johnson_cook_damage_schema(),
                "Damage that grows with the plastic strain over that at fracture; a point fails at 1.");
  schema.quantity("tensile_stress", "Pa", "Greatest principal stress.", "", Range::positive());
  schema.quantity("spall_pressure", "Pa", "Greatest mean tensile stress (a positive number).", "", Range::positive());
  material.object("failure", schema, "When the material fails; never without it.");
}

std::optional<FailureCriterion> read_failure(const Value& material, scene::Diagnostics& diagnostics) {
  if (!material.has("failure")) return std::nullopt;
  const Value v = material.child("failure");
  FailureCriterion failure;
  if (v.has("plastic_strain")) failure.plastic_strain = v.real("plastic_strain");
  if (v.has("tensile_stress")) failure.tensile_stress = v.real("tensile_stress");
  if (v.has("spall_pressure")) failure.spall_pressure = v.real("spall_pressure");
  if (v.has("johnson_cook")) failure.johnson_cook = read_damage(v.child("johnson_cook"), diagnostics);
  if (!failure.needs_plastic_strain() && !failure.tensile_stress && !failure.spall_pressure)
    diagnostics.error(
        material.where("failure"),
        "failure without a limit; expected plastic_strain, johnson_cook, tensile_stress or spall_pressure");
  if (failure.needs_plastic_strain() && !material.has("plasticity") && !material.has("soil"))
    diagnostics.error(
        v.where(v.has("plastic_strain") ? "plastic_strain" : "johnson_cook"),
        "a limit of the plastic strain in a material that has none; add 'plasticity' or give another limit");
  return failure;
}

}  // namespace tenon
