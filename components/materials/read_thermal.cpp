// SPDX-License-Identifier: BSD-3-Clause
#include "components/materials/read_thermal.hpp"

#include <fmt/core.h>

namespace tenon {
namespace {

using scene::Range;
using scene::Schema;

/// sum of k_i a_i a_i over three orthogonal unit axes, of which two are given (the second is made orthogonal).
std::array<Vec3, 3> orthotropic_tensor(const Vec3& k, const Vec3& first, const Vec3& second) {
  const Vec3 a = (1 / norm(first)) * first;
  Vec3 b = second - dot(second, a) * a;
  b = (1 / norm(b)) * b;
  const Vec3 c = cross(a, b);
  std::array<Vec3, 3> tensor{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) tensor[i][j] = k[0] * a[i] * a[j] + k[1] * b[i] * b[j] + k[2] * c[i] * c[j];
  return tensor;
}

void read_directions(const scene::Value& v, ThermalProperties& thermal, scene::Diagnostics& diagnostics) {
  const Vec3 k = v.vector("orthotropic_conductivity"), first = v.vector("first_axis"), second = v.vector("second_axis");
  if (!(k[0] > 0 && k[1] > 0 && k[2] > 0)) {
    diagnostics.error(v.where("orthotropic_conductivity"),
                      "orthotropic_conductivity: all three must be greater than 0 W/(m K)");
    return;
  }
  constexpr double parallel = 1e-6;
  if (!(norm(cross(first, second)) > parallel * norm(first) * norm(second))) {
    diagnostics.error(v.where("second_axis"), "second_axis: expected a direction other than first_axis, neither zero");
    return;
  }
  thermal.conductivity = k[0];
  thermal.conductivity_tensor = orthotropic_tensor(k, first, second);
}

void read_melting(const scene::Value& v, ThermalProperties& thermal, scene::Diagnostics& diagnostics) {
  thermal.latent_heat = v.real("latent_heat");
  if (thermal.latent_heat == 0) return;
  if (!v.has("solidus") || !v.has("liquidus")) {
    diagnostics.error(v.where("latent_heat"), "latent_heat: needs solidus and liquidus, between which it is taken up");
    return;
  }
  thermal.solidus = v.real("solidus");
  thermal.liquidus = v.real("liquidus");
  if (!(thermal.liquidus > thermal.solidus))
    diagnostics.error(
        v.where("liquidus"),
        fmt::format("liquidus is {} K; expected more than the solidus, {} K (for a pure substance give an "
                    "interval that is narrow beside the temperature differences)",
                    thermal.liquidus, thermal.solidus));
}

}  // namespace

Schema thermal_properties_schema() {
  Schema schema("Thermal properties; needed by conduction, plastic heat and thermal expansion.");
  schema.table("conductivity", "temperature", "K", "W/(m K)",
               "Heat conductivity: a number, or points over the temperature (implicit steppers).", Range::positive());
  schema.vector("orthotropic_conductivity", "W/(m K)",
                "Conductivities along first_axis, second_axis and across both, in place of `conductivity`; the axes do "
                "not turn with the body.");
  schema.exactly_one({"conductivity", "orthotropic_conductivity"});
  schema.vector("first_axis", "1", "Direction of the first orthotropic conductivity.", "[1, 0, 0]");
  schema.vector("second_axis", "1", "Direction of the second one; made orthogonal to the first.", "[0, 1, 0]");
  schema
      .table("specific_heat", "temperature", "K", "J/(kg K)",
             "Specific heat: a number, or points over the temperature (implicit steppers; plastic heat takes the value "
             "at the reference temperature).",
             Range::positive())
      .required();
  schema.quantity("latent_heat", "J/kg", "Heat of melting, taken up evenly between solidus and liquidus.", "0 J/kg",
                  Range::not_negative());
  schema.quantity("solidus", "K", "Temperature at which melting begins.", "", Range::positive());
  schema.quantity("liquidus", "K", "Temperature at which melting is complete.", "", Range::positive());
  schema.quantity("expansion", "1/K", "Linear coefficient of thermal expansion.", "0 1/K");
  schema.quantity("reference_temperature", "K", "Start temperature where no other is given; also in degC.", "293.15 K",
                  Range::not_negative());
  schema.quantity("taylor_quinney", "1", "Share of the plastic work that becomes heat.", "0.9", {0, 1, false, false});
  return schema;
}

ThermalProperties read_thermal_properties(const scene::Value& v, scene::Diagnostics& diagnostics) {
  ThermalProperties thermal;
  thermal.reference_temperature = v.real("reference_temperature");
  thermal.taylor_quinney = v.real("taylor_quinney");
  const TemperatureTable heat(v.table("specific_heat"));
  thermal.specific_heat = heat(thermal.reference_temperature);
  if (!heat.is_constant()) thermal.specific_heat_over_temperature = heat;
  if (v.has("conductivity")) {
    const TemperatureTable k(v.table("conductivity"));
    thermal.conductivity = k(thermal.reference_temperature);
    if (!k.is_constant()) thermal.conductivity_over_temperature = k;
  } else {
    read_directions(v, thermal, diagnostics);
  }
  read_melting(v, thermal, diagnostics);
  return thermal;
}

}  // namespace tenon
