// SPDX-License-Identifier: BSD-3-Clause
#include "components/thermal/scene_block.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "framework/scene/known_names.hpp"

namespace tenon {
namespace {

using scene::Diagnostics;
using scene::Range;
using scene::Schema;
using scene::Value;

const std::vector<std::pair<std::string, ThermalStepper>> steppers{{"explicit", ThermalStepper::explicit_euler},
                                                                   {"backward_euler", ThermalStepper::backward_euler},
                                                                   {"crank_nicolson", ThermalStepper::crank_nicolson},
                                                                   {"tr_bdf2", ThermalStepper::tr_bdf2},
                                                                   {"steady", ThermalStepper::steady}};
const std::vector<std::pair<std::string, ThermalPreconditioner>> preconditioners{
    {"automatic", ThermalPreconditioner::automatic},
    {"jacobi", ThermalPreconditioner::jacobi},
    {"multigrid", ThermalPreconditioner::multigrid}};

Schema block_schema() {
  Schema s("Material of a block of the mesh.");
  s.text("material", "Name of a material.").required();
  return s;
}

Schema time_step_schema() {
  Schema s("Time step of the component.");
  s.quantity("fixed", "s", "Step; needed by backward_euler and crank_nicolson; tr_bdf2 chooses its own without it.", "",
             Range::positive());
  s.quantity("tolerance", "delta_K", "Greatest error of any temperature in one step of tr_bdf2.", "0.1 K",
             Range::positive());
  s.quantity("initial", "s",
             "First step that tr_bdf2 tries; without it one that changes no temperature by more than "
             "the tolerance.",
             "", Range::positive());
  s.quantity("maximum", "s",
             "Longest step of tr_bdf2; give it where a load may come and go within one step, and where heat comes only "
             "once in a step.",
             "", Range::positive());
  s.quantity("scale", "1", "Share of the stable limit that the explicit stepper takes.", "0.9", {0, 1, true, false});
  return s;
}

Schema solver_schema() {
  Schema s("Conjugate gradients of the implicit steppers.");
  s.quantity("tolerance", "1", "Greatest residual relative to the right-hand side.", "1e-12", {0, 1e-2, true, false});
  s.integer("max_iterations", "The run stops as unstable if they are not enough.", "2000", {1, 1e9, false, false});
  s.quantity("nonlinear_tolerance", "1", "Residual at which Newton's iterations stop, relative to their first one.",
             "1e-8", {0, 1e-2, true, false});
  s.choice(
      "preconditioner", {"automatic", "jacobi", "multigrid"},
      "`jacobi` is quickest for short steps, `multigrid` for long ones and large meshes; `automatic` changes to it "
      "for good when a solution takes more than 60 iterations.",
      "automatic");
  return s;
}

Schema initial_schema() {
  Schema s("Initial temperature of a block, of a node set, or everywhere; later entries win.");
  s.text("block", "Block of the mesh.");
  s.text("node_set", "Node set of the mesh.");
  s.required_quantity("temperature", "K", "Temperature (at the origin, if there is a gradient).");
  s.vector("gradient", "K/m", "The temperature grows by gradient . x.", "[0, 0, 0]");
  s.at_most_one({"block", "node_set"});
  return s;
}

Schema prescribed_schema() {
  Schema s("Temperature that a node set has from the start on.");
  s.text("node_set", "Node set of the mesh.").required();
  s.function("temperature", "K", "Temperature over time.").required();
  return s;
}

Schema flux_schema() {
  Schema s("Heat flux into the body.");
  s.text("side_set", "Side set of the mesh.").required();
  s.function("flux", "W/m^2", "Flux over time, per current area; positive warms.").required();
  return s;
}

Schema convection_schema() {
  Schema s("Exchange with the surroundings: coefficient times (ambient - T) into the body.");
  s.text("side_set", "Side set of the mesh.").required();
  s.required_quantity("coefficient", "W/(m^2 K)", "Heat transfer coefficient.", Range::positive());
  s.function("ambient", "K", "Temperature of the surroundings over time.").required();
  return s;
}

Schema radiation_schema() {
  Schema s("Radiation to and from the surroundings; not with the explicit stepper.");
  s.text("side_set", "Side set of the mesh.").required();
  s.required_quantity("emissivity", "1", "Emissivity of the surface.", {0, 1, true, false});
  s.function("ambient", "K", "Absolute temperature of the surroundings over time.").required();
  return s;
}

Schema contact_schema() {
  Schema s(
      "Heat that passes between two surfaces whose meshes need not match: (h + k / gap) times the difference of "
      "temperature, h where they touch and k / gap across a narrow gap. The surfaces are where the body has moved to.");
  s.text("first", "Side set of the mesh.").required();
  s.text("second", "Side set of the mesh.").required();
  s.function("conductance", "W/(m^2 K)", "Conductance h over time where the surfaces touch.");
  s.table("conductance_over_pressure", "pressure", "Pa", "W/(m^2 K)",
          "Conductance h over the pressure that is transferred to `contact_pressure`, in place of `conductance`; held "
          "constant outside of the points. Without a transfer the pressure is 0.",
          Range::not_negative());
  s.at_most_one({"conductance", "conductance_over_pressure"});
  s.quantity("reference_pressure", "Pa",
             "With it, h is conductance times (pressure / reference_pressure)^exponent once a transfer has brought the "
             "pressure to `contact_pressure`.",
             "", Range::positive());
  s.quantity("exponent", "1", "Of the pressure; 0.95 for rough surfaces that conform [Yov82].", "0.95",
             Range::positive());
  s.quantity("touching_gap", "m",
             "Surfaces that are no farther apart touch, and so do those that overlap; without it, a tenth of the size "
             "of the sides.",
             "", Range::positive());
  s.quantity("gap_conductivity", "W/(m K)", "Conductivity k of what fills the gap.", "", Range::positive());
  s.quantity("least_gap", "m", "Narrower gaps count as this: the roughness of the surfaces.", "", Range::positive());
  s.quantity("greatest_gap", "m", "Nothing passes across wider gaps.", "", Range::positive());
  return s;
}

Schema source_schema() {
  Schema s("Heat source within a block.");
  s.text("block", "Block of the mesh.").required();
  s.function("power", "W/m^3", "Power over time, per undeformed volume.").required();
  return s;
}

/// Complains unless `entries` has the name that stands under `key`.
void check_name(const Value& value, const std::string& key, const std::vector<MeshSummary::Entry>& entries,
                const std::string& what, const MeshSummary& mesh, Diagnostics& diagnostics) {
  if (value.has(key)) scene::check_name(value, key, value.text(key), entries, what, mesh.source, diagnostics);
}

using Materials = std::map<std::string, MaterialDescription>;

/// Properties of a material as one block takes them; complaints if it is missing or does not conduct.
ThermalBlock thermal_block(const std::string& block, const Value& value, const Materials& materials,
                           Diagnostics& diagnostics) {
  const MaterialDescription* const material = scene::find_material(value, materials, diagnostics);
  if (!material) return {};
  if (!material->thermal) {
    diagnostics.error(
        value.where("material"),
        fmt::format("material: '{}' has no thermal properties; give it a 'thermal' block", value.text("material")));
    return {};
  }
  const ThermalProperties& t = *material->thermal;
  return {block,
          material->density,
          t.specific_heat,
          t.conductivity,
          t.reference_temperature,
          t.conductivity_over_temperature,
          t.specific_heat_over_temperature,
          t.conductivity_tensor,
          t.latent_heat,
          t.solidus,
          t.liquidus};
}

std::vector<ThermalBlock> read_blocks(const Value& value, const MeshSummary& mesh, const Materials& materials,
                                      Diagnostics& diagnostics) {
  std::vector<ThermalBlock> blocks;
  scene::each_block(
      value, mesh.blocks, mesh.source, diagnostics, [&](const MeshSummary::Entry& entry, const Value& from) {
        if (topology(entry.kind).dimension != 3)
          diagnostics.error(value.where("mesh"),
                            fmt::format("mesh: block '{}' consists of {}; only solid elements conduct heat", entry.name,
                                        topology(entry.kind).name));
        if (!middle_nodes(entry.kind).empty())
          diagnostics.error(value.where("mesh"),
                            fmt::format("mesh: block '{}' consists of {}; heat is conducted by elements of first order "
                                        "only: mesh the body with hex8, tet4, wedge6 or pyramid5 (elements of second "
                                        "order can be sources of a transfer)",
                                        entry.name, topology(entry.kind).name));
        blocks.push_back(thermal_block(entry.name, from, materials, diagnostics));
      });
  return blocks;
}

void read_initial(const Value& value, const MeshSummary& mesh, ThermalOptions& options, Diagnostics& diagnostics) {
  if (value.has("initial_temperature")) options.initial.push_back({"", "", value.real("initial_temperature"), {}});
  if (!value.has("initial_temperatures")) return;
  for (const Value& item : value.items("initial_temperatures")) {
    check_name(item, "block", mesh.blocks, "block", mesh, diagnostics);
    check_name(item, "node_set", mesh.node_sets, "node set", mesh, diagnostics);
    options.initial.push_back({item.has("block") ? item.text("block") : "",
                               item.has("node_set") ? item.text("node_set") : "", item.real("temperature"),
                               item.vector("gradient")});
  }
}

/// At the start; what a function gives later is judged when the time has come (Thermal::absolute_ambient).
void check_absolute(const Value& item, const TimeFunction& temperature, Diagnostics& diagnostics) {
  if (temperature(0) < 0)
    diagnostics.error(item.where("ambient"), fmt::format("ambient: {:.6g} K; expected an absolute temperature, 0 K or "
                                                         "more, as `20 degC` or `293.15 K`",
                                                         temperature(0)));
}

/// Complains about keys that mean nothing without another one.
void check_contact(const Value& item, Diagnostics& diagnostics) {
  const auto needs = [&](const char* key, const char* other) {
    if (item.given(key) && !item.has(other))
      diagnostics.error(item.where(key), fmt::format("{}: means nothing without '{}'; give both or none", key, other));
  };
  needs("reference_pressure", "conductance");
  needs("exponent", "reference_pressure");
  for (const char* key : {"least_gap", "greatest_gap"}) {
    needs(key, "gap_conductivity");
    needs("gap_conductivity", key);
  }
  if (!item.has("conductance") && !item.has("conductance_over_pressure") && !item.has("gap_conductivity"))
    diagnostics.error(item.where(),
                      "contact_conductance: nothing passes; expected 'conductance', 'conductance_over_pressure' or "
                      "'gap_conductivity'");
  if (item.text("first") == item.text("second"))
    diagnostics.error(item.where("second"),
                      fmt::format("second: '{}' is also 'first'; expected two surfaces", item.text("second")));
}

ThermalContact read_contact(const Value& item, const MeshSummary& mesh, Diagnostics& diagnostics) {
  check_name(item, "first", mesh.side_sets, "side set", mesh, diagnostics);
  check_name(item, "second", mesh.side_sets, "side set", mesh, diagnostics);
  check_contact(item, diagnostics);
  ThermalContact contact;
  contact.first = item.text("first"), contact.second = item.text("second");
  if (item.has("conductance")) contact.conductance = item.function("conductance");
  if (contact.conductance(0) < 0)
    diagnostics.error(item.where("conductance"),
                      fmt::format("conductance: {:.6g} W/(m^2 K); expected 0 or more", contact.conductance(0)));
  if (item.has("reference_pressure")) contact.reference_pressure = item.real("reference_pressure");
  contact.exponent = item.real("exponent");
  if (item.has("conductance_over_pressure"))
    contact.over_pressure = TimeFunction::table(item.table("conductance_over_pressure"));
  if (item.has("gap_conductivity")) contact.gap_conductivity = item.real("gap_conductivity");
  if (item.has("least_gap")) contact.least_gap = item.real("least_gap");
  if (item.has("greatest_gap")) contact.greatest_gap = item.real("greatest_gap");
  if (item.has("touching_gap")) contact.touching_gap = item.real("touching_gap");
  return contact;
}

void read_conditions(const Value& value, const MeshSummary& mesh, ThermalOptions& options, Diagnostics& diagnostics) {
  const auto items = [&](const char* key) { return value.has(key) ? value.items(key) : std::vector<Value>{}; };
  for (const Value& item : items("prescribed_temperatures")) {
    check_name(item, "node_set", mesh.node_sets, "node set", mesh, diagnostics);
    options.prescribed.push_back({item.text("node_set"), item.function("temperature")});
  }
  for (const Value& item : items("fluxes")) {
    check_name(item, "side_set", mesh.side_sets, "side set", mesh, diagnostics);
    options.fluxes.push_back({item.text("side_set"), item.function("flux")});
  }
  for (const Value& item : items("convection")) {
    check_name(item, "side_set", mesh.side_sets, "side set", mesh, diagnostics);
    options.convection.push_back({item.text("side_set"), item.real("coefficient"), item.function("ambient")});
  }
  for (const Value& item : items("radiation")) {
    check_name(item, "side_set", mesh.side_sets, "side set", mesh, diagnostics);
    options.radiation.push_back({item.text("side_set"), item.real("emissivity"), item.function("ambient")});
    check_absolute(item, options.radiation.back().ambient, diagnostics);
  }
  for (const Value& item : items("contact_conductance"))
    options.contacts.push_back(read_contact(item, mesh, diagnostics));
  for (const Value& item : items("sources")) {
    check_name(item, "block", mesh.blocks, "block", mesh, diagnostics);
    options.sources.push_back({item.text("block"), item.function("power")});
  }
}

/// Complains about keys that the stepper does not look at.
void check_keys(const Value& value, const ThermalOptions& options, Diagnostics& diagnostics) {
  const auto refuse = [&](const char* section, const char* key, const std::string& why) {
    if (value.has(section) && value.child(section).given(key))
      diagnostics.error(value.child(section).where(key), fmt::format("{}.{}: {}", section, key, why));
  };
  const std::string stepper = "the stepper is '" + value.text("stepper") + "'; ";
  const bool explicit_stepper = options.stepper == ThermalStepper::explicit_euler;
  for (const char* key : {"tolerance", "initial", "maximum"}) {
    if (options.stepper != ThermalStepper::tr_bdf2)
      refuse("time_step", key, stepper + "only tr_bdf2 chooses a step by this");
    else if (options.fixed_step)
      refuse("time_step", key, "the step is fixed; leave one of the two out");
  }
  if (!explicit_stepper) refuse("time_step", "scale", stepper + "only the explicit one has a stable limit to scale");
  for (const char* key : {"tolerance", "max_iterations", "nonlinear_tolerance", "preconditioner"})
    if (explicit_stepper) refuse("solver", key, stepper + "nothing is solved for; leave it out");
}

void read_stepping(const Value& value, ThermalOptions& options, Diagnostics& diagnostics) {
  for (const auto& [name, stepper] : steppers)
    if (value.text("stepper") == name) options.stepper = stepper;
  if (value.has("time_step")) {
    const Value step = value.child("time_step");
    if (step.has("fixed")) options.fixed_step = step.real("fixed");
    options.step_scale = step.real("scale");
    options.control.tolerance = step.real("tolerance");
    if (step.has("initial")) options.control.initial = step.real("initial");
    if (step.has("maximum")) options.control.maximum = step.real("maximum");
  }
  if (value.has("solver")) {
    const Value solver = value.child("solver");
    options.tolerance = solver.real("tolerance");
    options.max_iterations = static_cast<int>(solver.integer("max_iterations"));
    options.nonlinear_tolerance = solver.real("nonlinear_tolerance");
    for (const auto& [name, preconditioner] : preconditioners)
      if (solver.text("preconditioner") == name) options.preconditioner = preconditioner;
  }
  check_keys(value, options, diagnostics);
  const bool needs_step =
      options.stepper == ThermalStepper::backward_euler || options.stepper == ThermalStepper::crank_nicolson;
  if (needs_step && !options.fixed_step)
    diagnostics.error(value.where("stepper"),
                      fmt::format("stepper: '{}' needs a step; give time_step: {{fixed: ...}}", value.text("stepper")));
}

/// What goes only together, or not at all.
void check_stepper(const Value& value, const ThermalOptions& options, Diagnostics& diagnostics) {
  const bool warm = std::ranges::any_of(options.blocks, [](const ThermalBlock& b) {
    return b.conductivity_over_temperature || b.specific_heat_over_temperature || b.latent_heat > 0;
  });
  if (options.stepper == ThermalStepper::explicit_euler && (warm || !options.radiation.empty()))
    diagnostics.error(
        value.where("stepper"),
        "stepper: 'explicit' knows no properties over temperature, latent heat or radiation; choose tr_bdf2, "
        "backward_euler or crank_nicolson");
  if (options.stepper == ThermalStepper::steady && options.prescribed.empty() && options.convection.empty() &&
      options.radiation.empty())
    diagnostics.error(value.where("stepper"),
                      "stepper: nothing determines the steady temperature; give prescribed_temperatures, convection or "
                      "radiation");
}

}  // namespace

Schema thermal_schema() {
  Schema s(
      "Heat conduction in solids, explicit or implicit; moves with the body when a displacement is transferred to it.");
  s.text("mesh", "Name of a mesh.").required();
  s.text("material", "Material of every block that is not named under `blocks`.");
  s.named("blocks", block_schema(), "Materials block by block.");
  s.choice(
      "stepper", {"explicit", "backward_euler", "crank_nicolson", "tr_bdf2", "steady"},
      "`explicit` is limited by the smallest element; `backward_euler` and `crank_nicolson` (first and second order) "
      "take "
      "any fixed step; `tr_bdf2` (second order, no ringing) chooses its own; `steady` finds the steady state in every "
      "step, which beside another component must be fixed.",
      "explicit");
  s.object("time_step", time_step_schema(), "Time step of the component.");
  s.object("solver", solver_schema(), "Conjugate gradients of the implicit steppers.");
  s.quantity("initial_temperature", "K", "Temperature at the start; without it the material's reference temperature.");
  s.list("initial_temperatures", initial_schema(),
         "Initial temperatures by block or node set, after `initial_temperature`.");
  s.list("prescribed_temperatures", prescribed_schema(), "Temperatures that node sets have.");
  s.list("fluxes", flux_schema(), "Heat fluxes through side sets.");
  s.list("convection", convection_schema(), "Exchange with the surroundings through side sets.");
  s.list("radiation", radiation_schema(), "Radiation to and from the surroundings through side sets.");
  s.list("contact_conductance", contact_schema(), "Heat that passes between surfaces of this mesh.");
  s.list("sources", source_schema(), "Heat sources within blocks.");
  return s;
}

ThermalOptions read_thermal(const Value& value, const MeshSummary& mesh,
                            const std::map<std::string, MaterialDescription>& materials, Diagnostics& diagnostics) {
  ThermalOptions options;
  options.blocks = read_blocks(value, mesh, materials, diagnostics);
  read_stepping(value, options, diagnostics);
  read_initial(value, mesh, options, diagnostics);
  read_conditions(value, mesh, options, diagnostics);
  check_stepper(value, options, diagnostics);
  return options;
}

}  // namespace tenon
