// SPDX-License-Identifier: BSD-3-Clause
#include "components/sph/scene_block.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <utility>
#include <variant>

#include "framework/scene/known_names.hpp"

namespace tenon {
namespace {

using scene::Diagnostics;
using scene::Value;

constexpr std::array<const char*, 3> axes{"x", "y", "z"};

template <typename Kind, std::size_t n>
Kind chosen(const std::string& word, const std::array<std::pair<const char*, Kind>, n>& words) {
  for (const auto& [name, kind] : words)
    if (word == name) return kind;
  return words.front().second;
}

void read_start(const Value& v, SphBody& body) {
  for (std::size_t c = 0; c < 3 && v.has("initial_velocity"); ++c)
    body.initial_velocity[c] = SpaceTimeFunction::constant(v.vector("initial_velocity")[c]);
  if (v.has("initial_velocity_field")) {
    const Value field = v.child("initial_velocity_field");
    for (std::size_t c = 0; c < 3; ++c)
      if (field.has(axes[c])) body.initial_velocity[c] = field.field_function(axes[c]);
  }
  const auto take = [&](const char* key, std::optional<SpaceTimeFunction>& into) {
    if (v.has(key)) into = v.field_function(key);
  };
  take("initial_pressure", body.initial_pressure);
  take("initial_density", body.initial_density);
  take("initial_energy", body.initial_energy);
  take("initial_temperature", body.initial_temperature);
}

void read_inflow(const Value& own, const std::vector<SphBody>& bodies, SphBody& body, Diagnostics& diagnostics) {
  const Value v = own.child("inflow");
  SphInflow& inflow = body.inflow.emplace();
  inflow.point = v.vector("point"), inflow.normal = v.vector("normal");
  if (!(norm(inflow.normal) > 0))
    diagnostics.error(v.where("normal"), "normal: expected a direction, found the zero vector");
  if (!body.wall) diagnostics.error(own.where("inflow"), "inflow: only a wall brings particles in; say `wall: true`");
  const std::string& into = v.text("into");
  std::vector<std::string> names;
  for (const SphBody& other : bodies) names.push_back(other.name);
  inflow.into = static_cast<std::size_t>(std::ranges::find(names, into) - names.begin());
  if (inflow.into == names.size() || bodies[inflow.into].name == body.name)
    diagnostics.error(v.where("into"), "into: there is no other block '" + into + "'" + scene::suggestion(into, names));
}

void read_bodies(const Value& value, const MeshSummary& mesh, const std::map<std::string, MaterialDescription>& known,
                 SphOptions& options, Diagnostics& diagnostics) {
  for (const MeshSummary::Entry& block : mesh.blocks)
    if (block.kind != ElementKind::particle) {
      diagnostics.error(value.where("mesh"),
                        fmt::format("mesh: block '{}' consists of {}, not of particles; fill it with a mesh of `type: "
                                    "particles`",
                                    block.name, topology(block.kind).name));
      return;
    }
  scene::each_block(value, mesh.blocks, mesh.source, diagnostics,
                    [&](const MeshSummary::Entry& block, const Value& from) {
                      SphBody& body = options.bodies.emplace_back();
                      body.name = block.name;
                      if (const auto* material = scene::find_material(from, known, diagnostics))
                        body.material = *material;
                      read_start(from, body);
                    });
  for (const auto& [name, own] : value.entries("blocks"))
    for (SphBody& body : options.bodies) {
      if (body.name != name) continue;
      body.wall = own.flag("wall");
      if (own.has("bond")) body.bond = own.text("bond");
      if (own.has("held_temperature")) body.held_temperature = own.function("held_temperature");
      body.waits = own.has("from_elements");
      if (own.has("inflow")) read_inflow(own, options.bodies, body, diagnostics);
      if (body.wall && body.waits)
        diagnostics.error(own.where("wall"), "wall: what elements become is not a wall; leave one of the two out");
      if (own.has("velocity") && !body.wall)
        diagnostics.error(own.where("velocity"),
                          "velocity: only a wall moves as told; say `wall: true`, or `initial_velocity`");
      if (!own.has("velocity")) continue;
      const Value velocity = own.child("velocity");
      for (std::size_t c = 0; c < 3; ++c)
        if (velocity.has(axes[c])) body.velocity[c] = velocity.function(axes[c]);
    }
}

void read_domain(const Value& value, SphOptions& options, Diagnostics& diagnostics) {
  for (std::size_t c = 0; c < 3; ++c) {
    const std::string axis = axes[c];
    ParticleDomain::Axis& planes = options.domain.axes[c];
    if (value.has("symmetry_planes")) {
      const Value mirrors = value.child("symmetry_planes");
      if (mirrors.has(axis + "_min")) planes.low = mirrors.real(axis + "_min");
      if (mirrors.has(axis + "_max")) planes.high = mirrors.real(axis + "_max");
      if (planes.low && planes.high && !(*planes.high > *planes.low))
        diagnostics.error(mirrors.where(axis + "_max"), axis + "_max: expected more than " + axis + "_min");
    }
    if (!value.has("periodic") || !value.child("periodic").has(axis)) continue;
    const Value periods = value.child("periodic");
    const std::vector<double> ends = periods.reals(axis);
    if (ends.size() != 2 || !(ends[1] > ends[0])) {
      diagnostics.error(periods.where(axis),
                        axis + ": expected where the period begins and where it ends, as `[0 m, 1 m]`");
      continue;
    }
    if (planes.low || planes.high)
      diagnostics.error(periods.where(axis), axis + ": either periodic or with symmetry planes, not both");
    planes.periodic = true, planes.low = ends[0], planes.high = ends[1];
  }
  for (auto c = static_cast<std::size_t>(options.dimension); c < 3; ++c)
    if (options.domain.axes[c].low || options.domain.axes[c].high)
      diagnostics.error(
          value.where(value.has("periodic") ? "periodic" : "symmetry_planes"),
          fmt::format("a plane across {}, but the particles fill {} dimensions only", axes[c], options.dimension));
}

void read_accelerations(const Value& value, SphOptions& options, Diagnostics& diagnostics) {
  const Vec3 gravity = value.vector("gravity");
  for (std::size_t c = 0; c < 3; ++c) options.gravity[c] = TimeFunction::constant(gravity[c]);
  if (value.has("body_acceleration")) {
    const Value over_time = value.child("body_acceleration");
    for (std::size_t c = 0; c < 3; ++c)
      if (over_time.has(axes[c])) options.gravity[c] = over_time.function(axes[c]);
  }
  for (auto c = static_cast<std::size_t>(options.dimension); c < 3; ++c)
    if (gravity[c] != 0)
      diagnostics.error(value.where("gravity"), fmt::format("gravity: along {}, but the particles fill {} dimensions "
                                                            "only",
                                                            axes[c], options.dimension));
}

bool depends_on_energy(const EquationOfState& state) {
  if (const auto* p = std::get_if<PolynomialState>(&state.law)) return p->C[4] != 0 || p->C[5] != 0 || p->C[6] != 0;
  if (const auto* g = std::get_if<Gruneisen>(&state.law)) return g->gamma0 != 0 || g->a != 0;
  return !std::holds_alternative<TaitState>(state.law);
}

/// What suits the materials of the bodies that are no walls.
SphFormulation suitable_formulation(const std::vector<SphBody>& bodies) {
  bool strength = false, energy = false, state = false, waits = false;
  for (const SphBody& body : bodies) {
    if (body.wall) continue;
    const MaterialDescription& m = body.material;
    waits = waits || body.waits;
    strength = strength || m.elastic || !std::holds_alternative<std::monostate>(m.whole_law);
    state = state || m.equation_of_state;
    energy = energy || (m.equation_of_state && depends_on_energy(*m.equation_of_state));
  }
  if (strength) return state || waits ? SphFormulation::solid : SphFormulation::total_lagrangian;
  return energy ? SphFormulation::gas : SphFormulation::fluid;
}

/// What the constructors refuse too, here with its place in the scene.
void check_states(const Value& value, const SphOptions& options, Diagnostics& diagnostics) {
  const bool fluid = options.formulation == SphFormulation::fluid;
  if (!fluid && options.formulation != SphFormulation::gas) return;
  for (const SphBody& body : options.bodies) {
    const auto& state = body.material.equation_of_state;
    if (body.material.name.empty()) continue;  // told before
    if (!state)
      diagnostics.error(value.where("formulation"),
                        fmt::format("the material '{}' of '{}' has no equation_of_state, from which its pressure "
                                    "would follow; give it one, or `elastic` to everything that is a solid",
                                    body.material.name, body.name));
    else if (fluid && !(state->bulk_modulus() > 0))
      diagnostics.error(value.where("formulation"),
                        fmt::format("the equation of state of the material '{}' of '{}' has no stiffness without "
                                    "energy, of which fluids keep no account; say `formulation: gas`",
                                    body.material.name, body.name));
  }
}

void refuse_idle_keys(const Value& value, const SphOptions& options, Diagnostics& diagnostics) {
  constexpr std::array<const char*, 4> names{"fluid", "gas", "solid", "total_lagrangian"};
  const std::string formulation = names[static_cast<std::size_t>(options.formulation)];
  if (value.has("fluid") && options.formulation != SphFormulation::fluid)
    diagnostics.error(value.where("fluid"), "fluid: the formulation is '" + formulation + "'; leave it out");
  if (value.has("gas") && options.formulation != SphFormulation::gas)
    diagnostics.error(value.where("gas"), "gas: the formulation is '" + formulation + "'; leave it out");
  if (value.has("solid") && options.formulation != SphFormulation::solid &&
      options.formulation != SphFormulation::total_lagrangian)
    diagnostics.error(value.where("solid"), "solid: the formulation is '" + formulation + "'; leave it out");
  for (const char* key : {"artificial_conduction", "variable_smoothing"})
    if (value.given(key) && options.formulation != SphFormulation::gas)
      diagnostics.error(value.where(key),
                        std::string(key) + ": for `formulation: gas` only, not '" + formulation + "'");
}

}  // namespace

SphOptions read_sph(const Value& value, const MeshSummary& mesh, int dimension,
                    const std::map<std::string, MaterialDescription>& materials, Diagnostics& diagnostics) {
  using Limiter = ArtificialViscosity::Switch;
  SphOptions options;
  options.dimension = dimension;
  options.kernel =
      chosen<SphKernelKind, 4>(value.text("kernel"), {{{"wendland_c2", SphKernelKind::wendland_c2},
                                                       {"wendland_c4", SphKernelKind::wendland_c4},
                                                       {"cubic_spline", SphKernelKind::cubic_spline},
                                                       {"quintic_spline", SphKernelKind::quintic_spline}}});
  options.smoothing = value.real("smoothing");
  options.variable_smoothing = value.flag("variable_smoothing");
  read_bodies(value, mesh, materials, options, diagnostics);
  options.formulation = suitable_formulation(options.bodies);
  if (value.text("formulation") != "by_material")
    options.formulation = chosen<SphFormulation, 4>(value.text("formulation"),
                                                    {{{"fluid", SphFormulation::fluid},
                                                      {"gas", SphFormulation::gas},
                                                      {"solid", SphFormulation::solid},
                                                      {"total_lagrangian", SphFormulation::total_lagrangian}}});
  read_domain(value, options, diagnostics);
  read_accelerations(value, options, diagnostics);
  if (value.has("artificial_viscosity")) {
    const Value v = value.child("artificial_viscosity");
    if (v.has("alpha")) options.artificial_viscosity.alpha = v.real("alpha");
    if (v.has("beta")) options.artificial_viscosity.beta = v.real("beta");
    options.artificial_viscosity.limiter = chosen<Limiter, 3>(
        v.text("limiter"),
        {{{"none", Limiter::none}, {"balsara", Limiter::balsara}, {"cullen_dehnen", Limiter::cullen_dehnen}}});
  }
  options.artificial_conduction = value.real("artificial_conduction");
  if (value.has("fluid")) {
    using Viscosity = FluidOptions::Viscosity;
    using Shifting = FluidOptions::Shifting;
    const Value v = value.child("fluid");
    options.fluid.viscosity = chosen<Viscosity, 3>(
        v.text("viscosity"),
        {{{"artificial", Viscosity::artificial}, {"morris", Viscosity::morris}, {"monaghan", Viscosity::monaghan}}});
    options.fluid.density_diffusion = v.real("density_diffusion");
    options.fluid.hydrostatic_diffusion = v.flag("hydrostatic_diffusion");
    options.fluid.shifting_strength = v.real("shifting_strength");
    options.fluid.background_pressure = v.real("background_pressure");
    options.fluid.slip = v.flag("wall_slip");
    options.fluid.shifting =
        chosen<Shifting, 3>(v.text("shifting"), {{{"none", Shifting::none},
                                                  {"shifting", Shifting::shifting},
                                                  {"transport_velocity", Shifting::transport_velocity}}});
  }
  if (value.has("gas")) {
    using Density = GasOptions::Density;
    const Value v = value.child("gas");
    options.gas.density = chosen<Density, 2>(
        v.text("density"), {{{"summation", Density::summation}, {"continuity", Density::continuity}}});
    options.gas.greatest_smoothing = v.real("greatest_smoothing");
  }
  options.heat_conduction = value.flag("heat_conduction");
  if (value.has("solid")) {
    const Value v = value.child("solid");
    options.solid.hourglass = v.real("hourglass");
    options.solid.contact_stiffness = v.real("contact_stiffness");
    options.solid.artificial_stress = v.real("artificial_stress");
  }
  if (value.has("time_step")) {
    const Value step = value.child("time_step");
    options.time_step.cfl = step.real("cfl");
    if (step.has("fixed")) options.time_step.fixed = step.real("fixed");
    if (step.has("maximum")) options.time_step.maximum = step.real("maximum");
  }
  options.skin = value.real("skin");
  options.always_search = value.flag("always_search");
  refuse_idle_keys(value, options, diagnostics);
  check_states(value, options, diagnostics);
  return options;
}

}  // namespace tenon
