// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/core.h>

#include "components/materials/read_law.hpp"

namespace tenon {
namespace {

using scene::Range;
using scene::Schema;
using scene::Value;

void add_energy(Schema& schema) {
  schema.quantity("initial_energy", "J/m^3", "Internal energy per undeformed volume at the start.", "0 J/m^3");
}

void add_least_pressure(Schema& schema) {
  schema.quantity("least_pressure", "Pa",
                  "Pressure (negative: tension) below which the material parts; none if absent.", "",
                  {-std::numeric_limits<double>::infinity(), 0, false, false});
}

void add_common(Schema& schema) {
  add_energy(schema);
  add_least_pressure(schema);
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

Schema ideal_gas_schema() {
  Schema schema("Ideal gas: p = (gamma - 1) (1 + mu) e, mu = V0/V - 1.");
  schema.required_quantity("gamma", "1", "Ratio of the specific heats, above 1.",
                           {1, std::numeric_limits<double>::infinity(), true, false});
  schema.quantity("initial_energy", "J/m^3", "Internal energy per undeformed volume at the start.", "0 J/m^3",
                  Range::not_negative());
  return schema;
}

Schema tait_schema() {
  Schema schema("Liquid: p = background + density c^2/gamma ((1 + mu)^gamma - 1), mu = V0/V - 1.");
  schema.required_quantity("c", "m/s", "Speed of sound of the undeformed liquid.", Range::positive());
  schema.quantity("gamma", "1", "Exponent.", "7", Range::positive());
  schema.quantity("background", "Pa", "Pressure of the undeformed liquid.", "0 Pa");
  add_common(schema);
  return schema;
}

Schema linear_schema() {
  Schema schema("Liquid: p = background + density c^2 mu, mu = V0/V - 1.");
  schema.required_quantity("c", "m/s", "Speed of sound of the undeformed liquid.", Range::positive());
  schema.quantity("background", "Pa", "Pressure of the undeformed liquid.", "0 Pa");
  add_common(schema);
  return schema;
}

Schema jwl_schema() {
  Schema schema(
      "Detonation products (Jones, Wilkins, Lee): p = A (1 - omega/(R1 V)) exp(-R1 V) + B (1 - omega/(R2 V)) "
      "exp(-R2 V) + omega e/V; V is the volume over that of the explosive.");
  schema.required_quantity("A", "Pa", "Coefficient A.");
  schema.required_quantity("B", "Pa", "Coefficient B.");
  for (const char* const name : {"R1", "R2", "omega"})
    schema.required_quantity(name, "1", fmt::format("Coefficient {}.", name), Range::positive());
  schema.required_quantity("initial_energy", "J/m^3", "Energy of the explosive per undeformed volume.",
                           Range::not_negative());
  add_least_pressure(schema);
  return schema;
}

Schema tillotson_schema() {
  Schema schema(
      "Impacts up to vaporization (Tillotson): compressed or cold p = (a + b/(1 + u/(E0 (1 + mu)^2))) rho u + A mu + "
      "B mu^2; expanded vapour by alpha and beta.");
  for (const char* const name : {"a", "b", "alpha", "beta"})
    schema.required_quantity(name, "1", fmt::format("Coefficient {}.", name), Range::not_negative());
  schema.required_quantity("A", "Pa", "Bulk modulus of the undeformed material.", Range::positive());
  schema.required_quantity("B", "Pa", "Coefficient of mu^2.");
  schema.required_quantity("E0", "J/kg", "Energy scale of b.", Range::positive());
  schema.required_quantity("incipient_vaporization", "J/kg", "Energy at which expanded matter starts to boil.",
                           Range::positive());
  schema.required_quantity("complete_vaporization", "J/kg", "Energy at which all of it is vapour.", Range::positive());
  add_common(schema);
  return schema;
}

PolynomialState read_polynomial(const Value& v, scene::Diagnostics& diagnostics) {
  PolynomialState polynomial;
  for (int i = 0; i < 7; ++i) polynomial.C[i] = v.real(fmt::format("C{}", i));
  polynomial.initial_energy = v.real("initial_energy");
  if (!(polynomial.bulk_modulus() > 0))
    diagnostics.error(
        v.where(), fmt::format("the undeformed material has the bulk modulus {:.4g} Pa; expected a positive one from "
                               "C1 + C5 e + C4 (C0 + C4 e) with the initial energy e",
                               polynomial.bulk_modulus()));
  return polynomial;
}

TillotsonState read_tillotson(const Value& v, double density, scene::Diagnostics& diagnostics) {
  const TillotsonState t{density,
                         v.real("a"),
                         v.real("b"),
                         v.real("A"),
                         v.real("B"),
                         v.real("E0"),
                         v.real("alpha"),
                         v.real("beta"),
                         v.real("incipient_vaporization"),
                         v.real("complete_vaporization"),
                         v.real("initial_energy")};
  if (!(t.complete > t.incipient))
    diagnostics.error(v.where("complete_vaporization"),
                      fmt::format("complete_vaporization is {:.4g} J/kg; expected more than incipient_vaporization, "
                                  "{:.4g} J/kg",
                                  t.complete, t.incipient));
  return t;
}

PolynomialState linear_liquid(const Value& v, double density) {
  PolynomialState state;
  state.C[0] = v.real("background"), state.C[1] = density * v.real("c") * v.real("c");
  state.initial_energy = v.real("initial_energy");
  return state;
}

}  // namespace

void add_equation_of_state(Schema& material) {
  material.variants("equation_of_state", scene::Key::Type::object,
                    {{"gruneisen", gruneisen_schema()},
                     {"ideal_gas", ideal_gas_schema()},
                     {"jwl", jwl_schema()},
                     {"linear", linear_schema()},
                     {"polynomial", polynomial_schema()},
                     {"tait", tait_schema()},
                     {"tillotson", tillotson_schema()}},
                    "Pressure over volume and energy, in place of the elastic one. In mechanics 'elastic' gives the "
                    "shear modulus; particles of a fluid or a gas need none.");
  material.at_most_one({"equation_of_state", "hyperelastic", "orthotropic", "foam", "soil"});
}

std::optional<EquationOfState> read_equation_of_state(const Value& material, double density,
                                                      scene::Diagnostics& diagnostics) {
  if (!material.has("equation_of_state")) return std::nullopt;
  const Value v = material.child("equation_of_state");
  const std::string type = v.text("type");
  EquationOfState state;
  if (type != "ideal_gas" && v.has("least_pressure")) state.least_pressure = v.real("least_pressure");
  if (type == "gruneisen")
    state.law = Gruneisen{density,      v.real("c"),      v.real("S1"), v.real("S2"),
                          v.real("S3"), v.real("gamma0"), v.real("a"),  v.real("initial_energy")};
  else if (type == "ideal_gas")
    state.law = IdealGas{v.real("gamma"), v.real("initial_energy")};
  else if (type == "tait")
    state.law = TaitState{density, v.real("c"), v.real("gamma"), v.real("background"), v.real("initial_energy")};
  else if (type == "linear")
    state.law = linear_liquid(v, density);
  else if (type == "jwl")
    state.law =
        JwlState{v.real("A"), v.real("B"), v.real("R1"), v.real("R2"), v.real("omega"), v.real("initial_energy")};
  else if (type == "tillotson")
    state.law = read_tillotson(v, density, diagnostics);
  else
    state.law = read_polynomial(v, diagnostics);
  return state;
}

}  // namespace tenon
