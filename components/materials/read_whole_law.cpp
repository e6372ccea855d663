// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/core.h>

#include <cmath>

#include "components/materials/read_law.hpp"

namespace tenon {
namespace {

using scene::Range;
using scene::Schema;
using scene::Value;

void add_bulk_modulus(Schema& schema) {
  schema.required_quantity("bulk_modulus", "Pa", "Bulk modulus of small strains.", Range::positive());
}

Schema neo_hookean_schema() {
  Schema schema("Rubber with the energy G/2 (I1 - 3) and a volume part.");
  schema.required_quantity("shear_modulus", "Pa", "Shear modulus of small strains.", Range::positive());
  add_bulk_modulus(schema);
  return schema;
}

Schema mooney_rivlin_schema() {
  Schema schema("Rubber with the energy C10 (I1 - 3) + C01 (I2 - 3) and a volume part.");
  schema.required_quantity("C10", "Pa", "Factor of the first invariant.", Range::positive());
  schema.required_quantity("C01", "Pa", "Factor of the second invariant.", Range::not_negative());
  add_bulk_modulus(schema);
  return schema;
}

Schema orthotropic_schema() {
  Schema schema("Elasticity with three planes of symmetry, which turn with the material; in place of 'elastic'.");
  for (const char* name : {"E1", "E2", "E3"})
    schema.required_quantity(name, "Pa", fmt::format("Young's modulus along axis {}.", name[1]), Range::positive());
  for (const char* name : {"nu12", "nu23", "nu31"})
    schema.required_quantity(name, "1",
                             fmt::format("Contraction along axis {} under a tension along axis {}.", name[3], name[2]));
  for (const char* name : {"G12", "G23", "G31"})
    schema.required_quantity(name, "Pa", fmt::format("Shear modulus between axes {} and {}.", name[1], name[2]),
                             Range::positive());
  schema.vector("axis_1", "1", "Direction of axis 1 in the undeformed body.", "[1, 0, 0]");
  schema.vector("axis_2", "1", "Direction of axis 2; what it has along axis 1 is taken off.", "[0, 1, 0]");
  return schema;
}

Schema foam_schema() {
  Schema schema("Foam that is crushed without spreading sideways, until it locks; elastic below.");
  schema
      .table("yield_stress", "compaction 1 - V/V0", "1", "Pa",
             "Compressive strength over the compaction, from 0; beyond the last point with the last slope.",
             Range::positive())
      .required();
  schema.quantity("tension_cutoff", "Pa", "Tensile strength; the first yield stress unless given.", "",
                  Range::not_negative());
  return schema;
}

Schema soil_schema() {
  Schema schema("Soil that is compacted for good and whose shear strength depends on the pressure.");
  schema
      .table("pressure", "compaction -ln(V/V0)", "1", "Pa",
             "Pressure of first loading over the compaction, from 0 at 0; beyond the last point with the last slope.",
             Range::not_negative())
      .required();
  schema.quantity("a0", "Pa^2", "Constant of the strength q^2 = 3 (a0 + a1 p + a2 p^2).", "0", Range::not_negative());
  schema.quantity("a1", "Pa", "Factor of the pressure in the strength.", "0 Pa", Range::not_negative());
  schema.quantity("a2", "1", "Factor of the squared pressure in the strength.", "0", Range::not_negative());
  schema.quantity("tension_cutoff", "Pa", "Greatest mean tension.", "0 Pa", Range::not_negative());
  return schema;
}

MooneyRivlinParameters read_hyperelastic(const Value& v, scene::Diagnostics& diagnostics) {
  const bool neo_hookean = v.text("type") == "neo_hookean";
  const MooneyRivlinParameters p{neo_hookean ? 0.5 * v.real("shear_modulus") : v.real("C10"),
                                 neo_hookean ? 0.0 : v.real("C01"), v.real("bulk_modulus")};
  const double G = 2 * (p.C10 + p.C01);
  if (!(3 * p.bulk_modulus > 2 * G))
    diagnostics.error(v.where("bulk_modulus"),
                      fmt::format("bulk_modulus is {:.4g} Pa; expected more than 2/3 of the shear modulus {:.4g} Pa, "
                                  "below which Poisson's ratio is negative",
                                  p.bulk_modulus, G));
  return p;
}

OrthotropicParameters read_orthotropic(const Value& v, scene::Diagnostics& diagnostics) {
  OrthotropicParameters p{v.real("E1"),   v.real("E2"),  v.real("E3"),  v.real("nu12"), v.real("nu23"),
                          v.real("nu31"), v.real("G12"), v.real("G23"), v.real("G31")};
  const Vec3 a = v.vector("axis_1"), b = v.vector("axis_2");
  const double length = std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
  double along = 0, left = 0;
  for (int i = 0; i < 3; ++i) p.axis_1[i] = a[i] / length, along += b[i] * p.axis_1[i];
  for (int i = 0; i < 3; ++i) p.axis_2[i] = b[i] - along * p.axis_1[i], left += p.axis_2[i] * p.axis_2[i];
  const double size = std::sqrt(b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
  if (!(length > 0))
    diagnostics.error(v.where("axis_1"), "axis_1 has no length; expected a direction");
  else if (!(std::sqrt(left) > 1e-6 * size))
    diagnostics.error(v.where("axis_2"), "axis_2 is zero or parallel to axis_1; expected another direction");
  for (double& x : p.axis_2) x /= std::sqrt(left);
  if (const auto objection = OrthotropicElastic::objection(p))
    diagnostics.error(v.where(), "no material has these orthotropic constants: " + *objection);
  return p;
}

FoamParameters read_foam(const Value& v, scene::Diagnostics& diagnostics) {
  FoamParameters p{v.table("yield_stress"), 0};
  const auto& points = p.yield_stress;
  p.tension_cutoff = v.has("tension_cutoff") ? v.real("tension_cutoff") : points.front().second;
  if (points.front().first != 0 || points.back().first >= 1)
    diagnostics.error(v.where("yield_stress"),
                      fmt::format("yield_stress is given over the compactions {} to {}; expected 0 to less than 1",
                                  points.front().first, points.back().first));
  for (std::size_t i = 1; i < points.size(); ++i)
    if (points[i].second < points[i - 1].second)
      diagnostics.error(v.where("yield_stress"),
                        fmt::format("yield_stress falls from {:.4g} Pa to {:.4g} Pa; expected it not to fall",
                                    points[i - 1].second, points[i].second));
  return p;
}

SoilParameters read_soil(const Value& v, const std::optional<Elasticity>& elastic, scene::Diagnostics& diagnostics) {
  const SoilParameters p{v.table("pressure"), v.real("a0"), v.real("a1"), v.real("a2"), v.real("tension_cutoff")};
  const auto& points = p.pressure;
  if (points.front() != std::pair{0.0, 0.0} || points.size() < 2)
    diagnostics.error(v.where("pressure"),
                      fmt::format("pressure has {} points and starts with ({}, {}); expected at least two points, the "
                                  "first (0, 0)",
                                  points.size(), points.front().first, points.front().second));
  const double K = elastic ? elastic->bulk_modulus() : 0;
  for (std::size_t i = 1; i < points.size() && elastic; ++i) {
    const double slope = (points[i].second - points[i - 1].second) / (points[i].first - points[i - 1].first);
    if (slope < 0 || slope > K * (1 + 1e-9))
      diagnostics.error(v.where("pressure"),
                        fmt::format("pressure rises by {:.4g} Pa per compaction from {} on; expected 0 to the bulk "
                                    "modulus of 'elastic', {:.4g} Pa, with which the soil unloads",
                                    slope, points[i - 1].first, K));
  }
  return p;
}

}  // namespace

void add_whole_laws(Schema& material) {
  material.variants("hyperelastic", scene::Key::Type::object,
                    {{"neo_hookean", neo_hookean_schema()}, {"mooney_rivlin", mooney_rivlin_schema()}},
                    "Rubber; in place of 'elastic'.");
  material.object("orthotropic", orthotropic_schema(), "Orthotropic elasticity; in place of 'elastic'.");
  material.object("foam", foam_schema(), "Crushable foam; needs 'elastic'.");
  material.object("soil", soil_schema(), "Soil with volumetric yield; needs 'elastic'.");
  material.at_most_one({"elastic", "hyperelastic", "orthotropic"});
  material.at_most_one({"plasticity", "hyperelastic", "orthotropic", "foam", "soil"});
}

WholeLawParameters read_whole_law(const Value& material, const std::optional<Elasticity>& elastic,
                                  scene::Diagnostics& diagnostics) {
  if (material.has("hyperelastic")) return read_hyperelastic(material.child("hyperelastic"), diagnostics);
  if (material.has("orthotropic")) return read_orthotropic(material.child("orthotropic"), diagnostics);
  for (const char* name : {"foam", "soil"})
    if (material.has(name) && !elastic)
      diagnostics.error(material.where(name), fmt::format("{} without elasticity; add an 'elastic' block", name));
  if (material.has("foam")) return read_foam(material.child("foam"), diagnostics);
  if (material.has("soil")) return read_soil(material.child("soil"), elastic, diagnostics);
  return {};
}

}  // namespace tenon
