// SPDX-License-Identifier: BSD-3-Clause
#include "apps/tenon/build_simulation.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>

#include "apps/tenon/scene_meshes.hpp"
#include "apps/tenon/scene_schema.hpp"
#include "components/contact/contact.hpp"
#include "components/contact/scene_block.hpp"
#include "components/materials/read_material.hpp"
#include "components/mechanics/mechanics.hpp"
#include "components/mechanics/scene_block.hpp"
#include "components/sph/scene_block.hpp"
#include "components/sph/sph.hpp"
#include "components/thermal/scene_block.hpp"
#include "components/thermal/thermal.hpp"
#include "transfer/field_link.hpp"

namespace tenon {

namespace {

using scene::Diagnostics;
using scene::Value;

using Materials = std::map<std::string, MaterialDescription>;
using MakeComponent = std::function<std::unique_ptr<Component>(std::shared_ptr<const Mesh>)>;

/// A component that passed all checks and waits for its part of the mesh.
struct Planned {
  std::string name;
  std::size_t mesh;
  ElementCost cost;
  MakeComponent make;
  PartitionMethod partition = PartitionMethod::automatic;
};

std::vector<SceneMesh> read_meshes(const Communicator& comm, Log& log, const LoadedScene& scene,
                                   Diagnostics& diagnostics) {
  std::vector<SceneMesh> meshes;
  for (const auto& [name, block] : scene.value.entries("meshes")) {
    meshes.push_back(make_mesh(comm, name, block, scene.folder, meshes, diagnostics));
    for (const std::string& warning : meshes.back().data.warnings) log.warning(name + ": " + warning);
    const MeshSummary& s = meshes.back().summary;
    log.print("mesh {}: {} nodes, {} elements in {} blocks ({})", name, s.nodes, s.elements, s.blocks.size(), s.source);
    if (!meshes.back().numbering.empty()) log.print("  {}", meshes.back().numbering);
  }
  return meshes;
}

Materials read_materials(const LoadedScene& scene, Diagnostics& diagnostics) {
  Materials materials;
  for (const auto& [name, block] : scene.value.entries("materials"))
    materials.emplace(name, read_material(name, block, diagnostics));
  return materials;
}

std::size_t find_mesh(const Value& block, const std::vector<SceneMesh>& meshes, Diagnostics& diagnostics) {
  std::vector<std::string> names;
  for (const SceneMesh& mesh : meshes) names.push_back(mesh.name);
  const std::string& wanted = block.text("mesh");
  const auto found = std::ranges::find(names, wanted);
  if (found == names.end())
    diagnostics.error(block.where("mesh"),
                      "mesh: there is no mesh '" + wanted + "'" + scene::suggestion(wanted, names));
  return static_cast<std::size_t>(found - names.begin());
}

std::vector<Planned> plan_components(const LoadedScene& scene, const std::vector<SceneMesh>& meshes,
                                     const Materials& materials, Diagnostics& diagnostics) {
  std::vector<Planned> planned;
  for (const auto& [name, block] : scene.value.entries("components")) {
    const std::size_t mesh = find_mesh(block, meshes, diagnostics);
    if (mesh == meshes.size()) continue;
    const MeshSummary& summary = meshes[mesh].summary;
    if (block.text("type") == "explicit_mechanics") {
      MechanicsOptions options = read_mechanics(block, summary, materials, diagnostics);
      ElementCost cost = mechanics_cost(options);
      planned.push_back({name, mesh, std::move(cost), [name = name, options](std::shared_ptr<const Mesh> m) {
                           return std::make_unique<Mechanics>(name, std::move(m), options);
                         }});
    } else if (block.text("type") == "sph") {
      SphOptions options = read_sph(block, summary, meshes[mesh].dimension, materials, diagnostics);
      planned.push_back({name,
                         mesh,
                         {},
                         [name = name, options](std::shared_ptr<const Mesh> m) {
                           return std::make_unique<Sph>(name, std::move(m), options);
                         },
                         PartitionMethod::rcb});  // particles have no graph
    } else {
      ThermalOptions options = read_thermal(block, summary, materials, diagnostics);
      if (options.stepper == ThermalStepper::steady && !options.fixed_step &&
          scene.value.entries("components").size() > 1)
        diagnostics.error(block.where("stepper"),
                          "stepper: 'steady' knows no time, so beside another component it must be told how often to "
                          "solve; give time_step: {fixed: ...}");
      planned.push_back({name, mesh, {}, [name = name, options](std::shared_ptr<const Mesh> m) {
                           return std::make_unique<Thermal>(name, std::move(m), options);
                         }});
    }
  }
  return planned;
}

// Components that share a mesh still own a decomposition each, so all but the last take a copy.
void distribute_to(const Communicator& comm, std::vector<SceneMesh>& meshes, const std::vector<Planned>& planned,
                   Simulation& simulation) {
  for (std::size_t p = 0; p < planned.size(); ++p) {
    const bool last = std::none_of(planned.begin() + static_cast<std::ptrdiff_t>(p) + 1, planned.end(),
                                   [&](const Planned& other) { return other.mesh == planned[p].mesh; });
    SceneMesh& mesh = meshes[planned[p].mesh];
    MeshData data = last ? std::move(mesh.data) : mesh.data;
    DistributeOptions options;
    options.cost = planned[p].cost;
    options.method = planned[p].partition;
    options.name = planned[p].name;
    simulation.add(planned[p].make(distribute(comm, std::move(data), options)));
  }
}

/// "component.field" -> component and field; complaints with the nearest name.
std::pair<Component*, std::string> find_end(const Simulation& simulation, const Value& block, const std::string& key,
                                            Diagnostics& diagnostics) {
  const std::string& text = block.text(key);
  const std::size_t point = text.find('.');
  std::vector<std::string> names;
  for (const auto& component : simulation.components()) names.push_back(component->name());
  if (point == std::string::npos) {
    diagnostics.error(block.where(key),
                      key + ": '" + text + "' is not component.field, as `" + names.front() + ".temperature`");
    return {nullptr, ""};
  }
  const std::string component = text.substr(0, point), field = text.substr(point + 1);
  Component* found = simulation.find(component);
  if (!found) {
    diagnostics.error(block.where(key),
                      key + ": there is no component '" + component + "'" + scene::suggestion(component, names));
    return {nullptr, ""};
  }
  std::vector<std::string> fields;
  if (key == "from")
    for (const ExportPort& port : found->exports()) fields.push_back(port.field.name);
  else
    for (const ImportPort& port : found->imports()) fields.push_back(port.field.name);
  if (std::ranges::find(fields, field) != fields.end()) return {found, field};
  diagnostics.error(block.where(key), key + ": component '" + component + "' " + (key == "from" ? "gives" : "takes") +
                                          " no field '" + field + "'" + scene::suggestion(field, fields));
  return {nullptr, ""};
}

transfer::Method transfer_method(const std::string& name) {
  using transfer::Method;
  if (name == "interpolate") return Method::interpolate;
  if (name == "nearest_projection") return Method::nearest_projection;
  if (name == "conserve") return Method::conserve;
  if (name == "project") return Method::project;
  if (name == "moving_least_squares") return Method::moving_least_squares;
  return name == "copy" ? Method::copy : Method::automatic;
}

transfer::FieldLinkOptions link_options(const Value& block, std::string source_field, std::string target_field) {
  transfer::FieldLinkOptions options;
  options.source_field = std::move(source_field);
  options.target_field = std::move(target_field);
  options.transfer.method = transfer_method(block.text("method"));
  options.transfer.bounded = block.flag("bounded");
  options.transfer.neighbours = static_cast<int>(block.integer("neighbours"));
  if (block.has("blocks")) options.blocks = block.texts("blocks");
  options.show_outside = block.flag("show_outside");
  options.full_report = block.text("report") == "full";
  if (block.has("side_set")) options.side_set = block.text("side_set");
  const std::string& outside = block.text("outside");
  options.transfer.outside = outside == "extrapolate" ? transfer::OutsidePolicy::extrapolate
                             : outside == "value"     ? transfer::OutsidePolicy::value
                             : outside == "error"     ? transfer::OutsidePolicy::error
                                                      : transfer::OutsidePolicy::nearest;
  options.transfer.outside_value = block.real("outside_value");
  if (block.has("greatest_distance")) options.transfer.greatest_distance = block.real("greatest_distance");
  if (block.text("configuration") == "current") options.configuration = transfer::Configuration::current;
  if (block.text("between_samples") == "linear") options.between_samples = transfer::BetweenSamples::linear;
  if (block.text("every") == "source_step") options.schedule = CouplingSchedule::source_step;
  return options;
}

bool is_total(Component& component, const std::string& field) {
  for (const ExportPort& port : component.exports())
    if (port.field.name == field) return port.field.kind == FieldKind::total;
  return false;
}

void add_transfers(const LoadedScene& scene, Simulation& simulation, Diagnostics& diagnostics) {
  std::set<std::pair<const Component*, std::string>> taken, filled;
  for (const auto& [name, block] : scene.value.entries("transfers")) {
    const auto [source, source_field] = find_end(simulation, block, "from", diagnostics);
    const auto [target, target_field] = find_end(simulation, block, "to", diagnostics);
    if (!source || !target) continue;
    if (source == target) {
      diagnostics.error(block.where("to"), "to: a transfer goes to another component than the one it comes from");
      continue;
    }
    if (is_total(*source, source_field)) {
      if (!taken.emplace(source, source_field).second)
        diagnostics.error(block.where("from"),
                          "from: '" + source_field + "' is taken by an earlier transfer; a total can go one way only");
    } else if (!filled.emplace(target, target_field).second) {
      diagnostics.error(block.where("to"), "to: '" + target_field + "' is set by an earlier transfer already");
    }
    try {
      simulation.add(std::make_unique<transfer::FieldLink>(name, *source, *target,
                                                           link_options(block, source_field, target_field)));
    } catch (const Error& problem) {
      diagnostics.error(block.where(), problem.what());
    }
  }
}

// Before anything asks for fields: parties show those of contact once they are in it.
void add_contact(const Communicator& comm, const LoadedScene& scene, Simulation& simulation, Diagnostics& diagnostics) {
  if (!scene.value.has("contact")) return;
  const Value block = scene.value.child("contact");
  const ContactOptions options = read_contact(block, diagnostics);
  std::vector<Component*> parties;
  std::vector<std::string> names;
  for (const auto& component : simulation.components()) names.push_back(component->name());
  const auto take = [&](Component& component) {
    try {
      if (ContactParty* party = component.contact_party()) {
        party->contact_fields();
        parties.push_back(&component);
        return true;
      }
    } catch (const Error& problem) {
      diagnostics.error(block.where(), problem.what());
    }
    return false;
  };
  if (block.has("components")) {
    for (const std::string& name : block.texts("components")) {
      Component* component = simulation.find(name);
      if (!component)
        diagnostics.error(block.where("components"),
                          "components: there is no component '" + name + "'" + scene::suggestion(name, names));
      else if (!take(*component) && !diagnostics.any())
        diagnostics.error(block.where("components"),
                          "components: '" + name + "' has no surface that could touch anything; leave it out");
    }
  } else {
    for (const auto& component : simulation.components()) take(*component);
  }
  if (diagnostics.any()) return;
  try {
    simulation.add(std::make_unique<Contact>("contact", comm, std::move(parties), options));
  } catch (const Error& problem) {
    diagnostics.error(block.where(), problem.what());
  }
}

// Particles that wait for the elements of another component to fail.
void add_debris_links(const LoadedScene& scene, Simulation& simulation, Diagnostics& diagnostics) {
  std::vector<std::string> names;
  for (const auto& component : simulation.components()) names.push_back(component->name());
  for (const auto& [name, component] : scene.value.entries("components")) {
    if (component.text("type") != "sph") continue;
    for (const auto& [block, own] : component.entries("blocks")) {
      if (!own.has("from_elements")) continue;
      const std::string& text = own.text("from_elements");
      const std::size_t point = text.find('.');
      Component* const source = simulation.find(text.substr(0, point));
      if (point == std::string::npos || !source) {
        diagnostics.error(own.where("from_elements"), "from_elements: '" + text + "' is not component.block" +
                                                          scene::suggestion(text.substr(0, point), names));
        continue;
      }
      try {
        simulation.add(std::make_unique<DebrisLink>("debris_" + block, *source, text.substr(point + 1),
                                                    *simulation.find(name), block));
      } catch (const Error& problem) {
        diagnostics.error(own.where("from_elements"), problem.what());
      }
    }
  }
}

std::vector<std::string> shown_fields(Component& component) {
  std::vector<std::string> names;
  for (const ExportPort& port : component.exports())
    if (port.field.kind != FieldKind::total) names.push_back(port.field.name);
  return names;
}

PointHistory read_point(const Simulation& simulation, const std::string& name, const Value& block,
                        Diagnostics& diagnostics) {
  PointHistory point{name, "", block.text("field"), block.vector("point")};
  std::vector<std::string> names;
  for (const auto& component : simulation.components()) names.push_back(component->name());
  if (block.has("component"))
    point.component = block.text("component");
  else if (names.size() == 1)
    point.component = names.front();
  else
    diagnostics.error(block.where(), "point '" + name + "': key 'component' is needed, as the scene has several" +
                                         scene::suggestion("", names));
  if (point.component.empty()) return point;
  Component* component = simulation.find(point.component);
  if (!component) {
    diagnostics.error(block.where("component"), "component: there is no component '" + point.component + "'" +
                                                    scene::suggestion(point.component, names));
    return point;
  }
  const std::vector<std::string> fields = shown_fields(*component);
  if (std::ranges::find(fields, point.field) == fields.end())
    diagnostics.error(block.where("field"), "field: component '" + point.component + "' shows no field '" +
                                                point.field + "'" + scene::suggestion(point.field, fields));
  return point;
}

void check_frame_fields(const Simulation& simulation, const Value& block, const std::vector<std::string>& wanted,
                        Diagnostics& diagnostics) {
  std::vector<std::string> known;
  for (const auto& component : simulation.components())
    for (const std::string& field : shown_fields(*component)) known.push_back(field);
  for (const std::string& field : wanted)
    if (std::ranges::find(known, field) == known.end())
      diagnostics.error(block.where("fields"),
                        "fields: no component shows '" + field + "'" + scene::suggestion(field, known));
}

OutputPlan read_output(const LoadedScene& scene, const Simulation& simulation, Diagnostics& diagnostics) {
  OutputPlan plan;
  const double duration = simulation.end_time() - simulation.start_time();
  plan.frames.time = duration / 20, plan.history.time = duration / 200, plan.log.time = duration / 20;
  plan.checkpoint.time = duration / 10;
  if (!scene.value.has("output")) return plan;
  const Value output = scene.value.child("output");
  const auto interval = [&](const char* section, Interval& target) {
    if (output.has(section) && output.child(section).has("every"))
      target = read_interval(output.child(section), "every", diagnostics);
  };
  interval("frames", plan.frames);
  interval("history", plan.history);
  interval("checkpoint", plan.checkpoint);
  interval("log", plan.log);
  if (output.has("frames") && output.child("frames").has("fields")) {
    plan.frame_fields = output.child("frames").texts("fields");
    check_frame_fields(simulation, output.child("frames"), plan.frame_fields, diagnostics);
  }
  if (output.has("history"))
    for (const auto& [name, block] : output.child("history").entries("points"))
      plan.points.push_back(read_point(simulation, name, block, diagnostics));
  return plan;
}

}  // namespace

BuiltScene build_simulation(const Communicator& comm, Log& log, const LoadedScene& scene) {
  Diagnostics diagnostics;
  const double start = scene.value.real("start_time"), end = scene.value.real("end_time");
  if (!(end >= start))
    diagnostics.error(scene.value.where("end_time"), "end_time: expected a time not before start_time");
  const Materials materials = read_materials(scene, diagnostics);
  std::vector<SceneMesh> meshes = read_meshes(comm, log, scene, diagnostics);
  diagnostics.throw_if_any();
  const std::vector<Planned> planned = plan_components(scene, meshes, materials, diagnostics);
  diagnostics.throw_if_any();

  BuiltScene built;
  built.simulation = std::make_unique<Simulation>(comm, log, start, end);
  built.simulation->limit_steps(scene.value.integer("maximum_steps"));
  distribute_to(comm, meshes, planned, *built.simulation);
  for (const Planned& p : planned) built.divisions.push_back({p.cost, p.partition});
  add_contact(comm, scene, *built.simulation, diagnostics);
  add_transfers(scene, *built.simulation, diagnostics);
  add_debris_links(scene, *built.simulation, diagnostics);
  built.output = read_output(scene, *built.simulation, diagnostics);
  diagnostics.throw_if_any();
  built.warnings = diagnostics.warnings();
  return built;
}

void print_warnings(Log& log, const BuiltScene& built) {
  for (const std::string& warning : built.warnings) log.warning(warning);
  for (const auto& component : built.simulation->components())
    for (const std::string& warning : component->warnings()) log.warning(warning);
  for (const auto& interaction : built.simulation->interactions())
    for (const std::string& warning : interaction->warnings()) log.warning(warning);
}

}  // namespace tenon
