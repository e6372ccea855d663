// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/core.h>

#include "components/materials/read_law.hpp"

namespace tenon {
namespace {

using scene::Range;
using scene::Schema;
using scene::Value;

void add_common(Schema& schema) {
  schema.quantity("initial_energy", "J/m^3", "Internal energy per undeformed volume at the start.", "0 J/m^3");
  schema.quantity("least_pressure", "Pa",
                  "Pressure (negative: tension) below which the material parts; none if absent.", "",
                  {-std::numeric_limits<double>::infinity(), 0, false, false});
}

Schema gruneisen_schema() {
  Schema schema("Mie-Gruneisen pressure about the shock Hugoniot U = c + S1 u + S2 (u/U) u + S3 (u/U)^2 u.");
  schema.required_quantity("c", "m/s", "Shock speed of weak shocks.", Range::positive());
  schema.required_quantity("S1", "1", "Slope of the shock speed over the particle speed.", Range::not_negative());
  schema.quantity("S2", "1", "Second coefficient of the shock speed.", "0");
  schema.quantity("S3", "1", "Third coefficient of the shock speed.", "0");
  schema.required_quantity("gamma0", "1", "Gruneisen's gamma of the undeformed material.", Range::not_negative());
  schema.quantity("a", "1", "First-order volume correction of gamma.", "0");
  add_common(schema);
  return schema;
}

Schema polynomial_schema() {
  Schema schema(
      "Pressure C0 + C1 mu + C2 mu^2 + C3 mu^3 + (C4 + C5 mu + C6 mu^2) e, mu = V0/V - 1; C2 and C6 count "
      "in compression only.");
  for (int i = 0; i < 7; ++i)
    schema.quantity(fmt::format("C{}", i), i < 4 ? "Pa" : "1", fmt::format("Coefficient C{}.", i),
                    i < 4 ? "0 Pa" : "0");
  add_common(schema);
  return schema;
}

}  // namespace

void add_equation_of_state(Schema& material) {
  material.variants("equation_of_state", scene::Key::Type::object,
                    {{"gruneisen", gruneisen_schema()}, {"polynomial", polynomial_schema()}},
                    "Pressure over volume and energy, in place of the elastic one; 'elastic' gives the shear modulus.");
  material.at_most_one({"equation_of_state", "hyperelastic", "orthotropic", "foam", "soil"});
}

std::optional<EquationOfState> read_equation_of_state(const Value& material, double density,
                                                      scene::Diagnostics& diagnostics) {
  if (!material.has("equation_of_state")) return std::nullopt;
  const Value v = material.child("equation_of_state");
  if (!material.has("elastic"))
    diagnostics.error(material.where("equation_of_state"),
                      "equation_of_state without elasticity, whose shear modulus it needs; add an 'elastic' block");
  EquationOfState state;
  if (v.has("least_pressure")) state.least_pressure = v.real("least_pressure");
  if (v.text("type") == "gruneisen") {
    state.law = Gruneisen{density,      v.real("c"),      v.real("S1"), v.real("S2"),
                          v.real("S3"), v.real("gamma0"), v.real("a"),  v.real("initial_energy")};
    return state;
  }
  PolynomialState polynomial;
  for (int i = 0; i < 7; ++i) polynomial.C[i] = v.real(fmt::format("C{}", i));
  polynomial.initial_energy = v.real("initial_energy");
  if (!(polynomial.bulk_modulus() > 0))
    diagnostics.error(
        v.where(), fmt::format("the undeformed material has the bulk modulus {:.4g} Pa; expected a positive one from "
                               "C1 + C5 e + C4 (C0 + C4 e) with the initial energy e",
                               polynomial.bulk_modulus()));
  state.law = polynomial;
  return state;
}

}  // namespace tenon
