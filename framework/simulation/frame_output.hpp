// SPDX-License-Identifier: BSD-3-Clause
// Frames for ParaView at intervals of a run.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "framework/io/vtk_output.hpp"
#include "framework/simulation/interval.hpp"
#include "framework/simulation/simulation.hpp"

namespace tenon {

struct FrameOptions {
  std::string folder;
  Interval every;
  std::vector<std::string> fields;  ///< empty: every field of every component
};

class FrameOutput : public Observer {
 public:
  explicit FrameOutput(FrameOptions options) : options_(std::move(options)) {}
  void start(Simulation& simulation, bool restarted) override;
  void after_step(Simulation& simulation, bool last) override;
  void after_failure(Simulation& simulation) override;

 private:
  struct Shown {
    ExportPort port;
    std::vector<double> values;
  };
  struct Part {
    Component* component;
    std::vector<Shown> fields;
  };
  void write(Simulation& simulation);
  FrameOptions options_;
  IntervalClock clock_;
  std::unique_ptr<VtkOutput> output_;
  std::vector<Part> parts_;
};

/// Local items at a location: nodes, or elements of all blocks.
std::size_t local_items(const Mesh& mesh, Location location);

}  // namespace tenon
