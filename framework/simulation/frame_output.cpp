// SPDX-License-Identifier: BSD-3-Clause
#include "framework/simulation/frame_output.hpp"

#include <algorithm>
#include <limits>

namespace tenon {

std::size_t local_items(const Mesh& mesh, Location location) {
  return static_cast<std::size_t>(location == Location::node ? mesh.nodes() : mesh.elements());
}

void FrameOutput::start(Simulation& simulation, bool restarted) {
  clock_ = IntervalClock(options_.every, simulation.start_time());
  clock_.reset(simulation.time(), simulation.steps());
  const double kept = restarted ? simulation.time() : std::numeric_limits<double>::quiet_NaN();
  output_ = std::make_unique<VtkOutput>(simulation.comm(), options_.folder, kept);
  const auto wanted = [&](const FieldDescription& field) {
    // Reading a total takes it away from the component that is waiting for it.
    if (field.kind == FieldKind::total) return false;
    return options_.fields.empty() || std::ranges::find(options_.fields, field.name) != options_.fields.end();
  };
  for (const auto& component : simulation.components()) {
    Part part{component.get(), {}};
    std::vector<ExportPort> ports;
    for (ExportPort& port : component->exports())
      if (wanted(port.field)) ports.push_back(std::move(port));
    for (const auto& coupling : simulation.couplings())
      if (&coupling->target() == component.get())
        for (ExportPort& port : coupling->shown_on_target()) ports.push_back(std::move(port));
    for (ExportPort& port : ports) {
      const std::size_t size =
          local_items(component->mesh(), port.field.location) * static_cast<std::size_t>(port.field.components);
      part.fields.push_back({std::move(port), std::vector<double>(size)});
    }
    parts_.push_back(std::move(part));
  }
  if (!restarted) write(simulation);
}

void FrameOutput::after_step(Simulation& simulation, bool last) {
  // A run that stops on request goes on later: the frame at its end would be one too many.
  if (clock_.due(simulation.time(), simulation.steps()) || (last && !simulation.stopped())) write(simulation);
}

void FrameOutput::after_failure(Simulation& simulation) {
  try {
    if (output_) write(simulation);
  } catch (const Error& error) {
    simulation.log().warning(std::string("the frame of the failed state was not written: ") + error.what());
  }
}

void FrameOutput::write(Simulation& simulation) {
  const ScopedTimer timer(simulation.timers().phase("output: frames"));
  std::vector<OutputPart> shown;
  for (Part& part : parts_) {
    OutputPart out{part.component->name(), &part.component->mesh(), part.component->current_coordinates(), {}};
    for (Shown& field : part.fields) {
      field.port.read(field.values);
      out.fields.push_back({field.port.field, field.values});
    }
    shown.push_back(std::move(out));
  }
  output_->write(simulation.time(), simulation.steps(), shown);
}

}  // namespace tenon
