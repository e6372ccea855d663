// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/scene_block.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <bit>

#include "components/mechanics/element_kinds.hpp"
#include "components/mechanics/load_scene.hpp"
#include "components/mechanics/scene_reader.hpp"

namespace tenon {
namespace {

using scene::Diagnostics;
using scene::Value;
using Kind = PrescribedMotion::Kind;
using Materials = std::map<std::string, MaterialDescription>;

const MaterialDescription* find_elastic(const Value& value, const Materials& materials, Diagnostics& diagnostics) {
  const MaterialDescription* const material = scene::find_material(value, materials, diagnostics);
  if (!material || material->elastic) return material;
  diagnostics.error(
      value.where("material"),
      fmt::format("material: '{}' has no elastic constants; give it an 'elastic' block", value.text("material")));
  return nullptr;
}

MechanicsOptions::Formulation read_formulation(const Value& value) {
  using Formulation = MechanicsOptions::Formulation;
  return value.text("formulation") == "full" ? Formulation::full : Formulation::automatic;
}

/// Of a block that consists of shells: from its own entry, or else from the component.
ShellSection read_shell(const Value& own, const Value& all, const std::string& block, Diagnostics& diagnostics) {
  ShellSection section;
  const Value& from = own.has("shell") ? own : all;
  if (!from.has("shell")) {
    diagnostics.error(own.where(), fmt::format("block '{}' consists of shells, which have no thickness; give "
                                               "'shell: {{thickness: ...}}'",
                                               block));
    return section;
  }
  const Value s = from.child("shell");
  const SpaceTimeFunction thickness = s.field_function("thickness");
  if (thickness.is_uniform() && !(thickness(0, {}) > 0))
    diagnostics.error(s.where("thickness"), fmt::format("thickness: {:g} m is not positive", thickness(0, {})));
  section.thickness_field = [thickness](const Vec3& x) { return thickness(0, x); };
  section.points = s.has("points") ? static_cast<int>(s.integer("points")) : 0;
  if (s.text("rule") == "lobatto") section.rule = ShellSection::Rule::lobatto;
  if (section.rule == ShellSection::Rule::lobatto && section.points > 0 && section.points < 3)
    diagnostics.error(s.where("points"), "points: the rule lobatto takes 3 to 10");
  using Reference = ShellSection::Reference;
  const std::string& reference = s.text("reference");
  section.reference = reference == "top"      ? Reference::top
                      : reference == "bottom" ? Reference::bottom
                                              : Reference::middle;
  if (s.has("offset")) {
    section.reference = Reference::at, section.offset = s.real("offset");
    if (s.given("reference")) diagnostics.error(s.where("offset"), "offset: give either it or 'reference'");
  }
  return section;
}

void read_block(const Value& value, const MeshSummary::Entry& entry, const Value& from, const Materials& materials,
                MechanicsOptions& options, Diagnostics& diagnostics) {
  const MaterialDescription* const material = find_elastic(from, materials, diagnostics);
  if (!material) return;
  if (!middle_nodes(entry.kind).empty())
    diagnostics.error(value.where("mesh"),
                      fmt::format("mesh: block '{}' consists of {}; mechanics computes elements of first order only: "
                                  "mesh the body with hex8, tet4, wedge6 or pyramid5 (elements of second order can be "
                                  "sources of a transfer)",
                                  entry.name, topology(entry.kind).name));
  options.blocks.push_back({entry.name, *material, read_formulation(from), {}});
  if (topology(entry.kind).dimension == 2)
    options.blocks.back().shell = read_shell(from, value, entry.name, diagnostics);
  const bool plastic = !std::holds_alternative<std::monostate>(material->plasticity);
  if (options.heat != HeatMode::none && plastic && !material->thermal)
    diagnostics.error(from.where("material"),
                      fmt::format("material: '{}' has no thermal properties, which heat: {} needs; give it a "
                                  "'thermal' block",
                                  material->name, value.text("heat")));
}

void read_blocks(const Value& value, const SceneReader& reader, const Materials& materials, MechanicsOptions& options) {
  scene::each_block(value, reader.mesh.blocks, reader.mesh.source, reader.diagnostics,
                    [&](const MeshSummary::Entry& entry, const Value& from) {
                      read_block(value, entry, from, materials, options, reader.diagnostics);
                    });
}

void read_control(const Value& value, MechanicsOptions& options, Diagnostics& diagnostics) {
  const std::string& heat = value.text("heat");
  options.heat = heat == "adiabatic" ? HeatMode::adiabatic : heat == "exported" ? HeatMode::exported : HeatMode::none;
  if (value.has("initial_temperature")) options.initial_temperature = value.real("initial_temperature");
  if (value.has("hourglass")) {
    using Form = HourglassOptions::Form;
    const Value h = value.child("hourglass");
    const std::string& form = h.text("form");
    options.hourglass.form = form == "stiffness"  ? Form::stiffness
                             : form == "physical" ? Form::physical
                             : form == "none"     ? Form::none
                                                  : Form::viscous;
    const double usual = options.hourglass.form == Form::stiffness ? 0.05 : 0.03;
    options.hourglass.coefficient = h.has("coefficient") ? h.real("coefficient") : usual;
  }
  if (value.has("bulk_viscosity")) {
    const Value q = value.child("bulk_viscosity");
    options.viscosity = {q.real("linear"), q.real("quadratic")};
  }
  if (value.has("time_step")) {
    const Value step = value.child("time_step");
    options.time_step.scale = step.real("scale");
    if (step.text("estimate") == "element") options.time_step.estimate = TimeStepOptions::Estimate::element;
    if (step.has("fixed")) options.time_step.fixed = step.real("fixed");
    options.time_step.subcycling = static_cast<int>(step.integer("subcycling"));
    if (!std::has_single_bit(static_cast<unsigned>(options.time_step.subcycling)))
      diagnostics.error(step.where("subcycling"), "subcycling: expected a power of two: 1, 2, 4, 8, ...");
    if (step.has("maximum")) options.time_step.maximum = step.real("maximum");
  }
  if (value.has("erosion")) {
    using LooseNodes = ErosionOptions::LooseNodes;
    const Value erosion = value.child("erosion");
    if (erosion.has("minimum_step")) options.erosion.minimum_step = erosion.real("minimum_step");
    options.erosion.inverted = erosion.text("inverted") == "remove";
    options.erosion.loose_nodes = erosion.text("loose_nodes") == "remove" ? LooseNodes::remove : LooseNodes::keep;
  }
}

void read_initial(const Value& value, const SceneReader& reader, MechanicsOptions& options) {
  if (value.has("initial_velocity"))
    options.initial_velocities.push_back({"", "", value.vector("initial_velocity"), {}, {}});
  for (const Value& item : reader.items(value, "initial_velocities")) {
    InitialVelocity v;
    if (item.has("block")) {
      v.block = item.text("block");
      reader.check_name(item, "block", v.block, reader.mesh.blocks, "block");
    }
    if (item.has("node_set")) {
      v.node_set = item.text("node_set");
      reader.check_name(item, "node_set", v.node_set, reader.mesh.node_sets, "node set");
    }
    v.velocity = item.vector("velocity");
    v.gradient = reader.gradient(item);
    v.centre = item.vector("centre");
    options.initial_velocities.push_back(std::move(v));
  }
}

void read_components(const Value& item, const SceneReader& reader, PrescribedMotion& m) {
  const char* const names[] = {"x", "y", "z"};
  for (std::size_t c = 0; c < 3; ++c) {
    m.components[c] = item.has(names[c]);
    if (m.components[c]) m.value[c] = item.function(names[c]);
  }
  if (m.components == std::array<bool, 3>{})
    reader.diagnostics.error(item.where(), "prescribes nothing; expected at least one of x, y, z");
}

void read_fixed(const Value& item, const SceneReader& reader, PrescribedMotion& m) {
  if (!item.has("components")) return;
  const std::vector<std::string> names{"x", "y", "z", "rx", "ry", "rz"};
  m.components = m.rotations = {};
  for (const std::string& c : item.texts("components")) {
    const auto i = static_cast<std::size_t>(std::ranges::find(names, c) - names.begin());
    if (i < 3)
      m.components[i] = true;
    else if (i < 6)
      m.rotations[i - 3] = true;
    else
      reader.diagnostics.error(item.where("components"),
                               fmt::format("components: '{}' is not one of x, y, z, rx, ry, rz", c));
  }
}

void read_motions(const Value& value, const SceneReader& reader, std::vector<PrescribedMotion>& motions) {
  for (const Value& item : reader.items(value, "fixed")) {
    PrescribedMotion m = reader.motion(item, Kind::fixed, "fixed");
    read_fixed(item, reader, m);
    motions.push_back(std::move(m));
  }
  for (const Value& item : reader.items(value, "prescribed_displacements")) {
    PrescribedMotion m = reader.motion(item, Kind::displacement, "prescribed displacement");
    read_components(item, reader, m);
    motions.push_back(std::move(m));
  }
  for (const Value& item : reader.items(value, "prescribed_velocities")) {
    PrescribedMotion m = reader.motion(item, Kind::velocity, "prescribed velocity");
    read_components(item, reader, m);
    motions.push_back(std::move(m));
  }
  for (const Value& item : reader.items(value, "prescribed_accelerations")) {
    PrescribedMotion m = reader.motion(item, Kind::acceleration, "prescribed acceleration");
    read_components(item, reader, m);
    motions.push_back(std::move(m));
  }
  for (const Value& item : reader.items(value, "prescribed_gradients")) {
    PrescribedMotion m = reader.motion(item, Kind::gradient, "prescribed gradient");
    m.components = reader.components(item);
    m.gradient = reader.gradient(item);
    m.centre = item.vector("centre");
    m.factor = item.function("factor");
    motions.push_back(std::move(m));
  }
  for (const Value& item : reader.items(value, "prescribed_rotations")) {
    PrescribedMotion m = reader.motion(item, Kind::rotation, "prescribed rotation");
    m.axis = reader.direction(item, "axis");
    m.centre = item.vector("centre");
    m.factor = item.function("angle");
    motions.push_back(std::move(m));
  }
  for (const Value& item : reader.items(value, "symmetry_planes")) {
    PrescribedMotion m = reader.motion(item, Kind::symmetry, "symmetry plane");
    m.normal = reader.direction(item, "normal");
    motions.push_back(std::move(m));
  }
}

void read_walls(const Value& value, const SceneReader& reader, MechanicsOptions& options) {
  for (const Value& item : reader.items(value, "rigid_walls")) {
    const TimeFunction motion = item.has("motion") ? item.function("motion") : TimeFunction::constant(0);
    if (!item.flag("bilateral")) {
      options.walls.push_back({item.vector("point"), reader.direction(item, "normal"), motion, reader.node_sets(item),
                               fmt::format("rigid wall {}", options.walls.size() + 1)});
      continue;
    }
    PrescribedMotion m = reader.motion(item, Kind::wall, "bilateral rigid wall");
    if (m.node_sets.empty())
      reader.diagnostics.error(item.where(), "a bilateral rigid wall needs node_sets: the nodes that stay on it");
    m.centre = item.vector("point");
    m.normal = reader.direction(item, "normal");
    m.factor = motion;
    options.motions.push_back(std::move(m));
  }
}

}  // namespace

MechanicsOptions read_mechanics(const Value& value, const MeshSummary& mesh, const Materials& materials,
                                Diagnostics& diagnostics) {
  const SceneReader reader{mesh, diagnostics};
  MechanicsOptions options;
  read_control(value, options, diagnostics);
  read_blocks(value, reader, materials, options);
  read_initial(value, reader, options);
  read_motions(value, reader, options.motions);
  read_walls(value, reader, options);
  read_loads(value, reader, options.loads);
  return options;
}

}  // namespace tenon
