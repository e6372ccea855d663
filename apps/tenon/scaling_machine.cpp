// SPDX-License-Identifier: BSD-3-Clause
#include "apps/tenon/scaling_machine.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>

#include "apps/tenon/load_scene.hpp"
#include "framework/scene/schema.hpp"

namespace tenon {

namespace {

// Messages through shared memory, as measured with two ranks on one node by many: of the order of a microsecond.
Machine here() {
  return {"here", "ranks of one node, messages through shared memory: 1 us, 5 GB/s assumed; work as measured", 1e-6,
          5e9, 1};
}

// ASCI Red [MH98]: two Pentium Pro of 200 MHz a node, one of them computing; the LINPACK record of 1.338 TFLOPS on 9152
// processors is 146 MFLOPS each, about a hundredth of what a core of today does with vectors. MPI under Cougar.
Machine tflops() {
  return {"tflops",
          "Sandia/Intel TFLOPS (1997): 20 us and 310 MB/s for MPI assumed; a unit of work costs 100 times what it does "
          "here (146 MFLOPS of LINPACK a processor)",
          20e-6, 310e6, 100};
}

Machine cluster() {
  return {"cluster",
          "a cluster of today: 1.5 us, 10 GB/s for each rank assumed (a share of a 200 Gbit/s link); work as here",
          1.5e-6, 10e9, 1};
}

}  // namespace

namespace {

scene::Schema machine_schema() {
  using scene::Range;
  scene::Schema s("A parallel machine for `tenon plan --machine FILE`.");
  s.required_quantity("latency", "s", "Of a message.", Range::positive());
  s.required_quantity("bandwidth", "1", "Of a rank, bytes per second.", Range::positive());
  s.quantity("slowness", "1", "What a unit of work costs, in terms of what it costs on this machine.", "1",
             Range::positive());
  return s;
}

Machine read_machine(const std::string& path) {
  scene::Diagnostics diagnostics;
  const scene::Value v =
      scene::parse_scene(read_scene_text(Communicator::self(), path), path, {}, machine_schema(), diagnostics);
  diagnostics.throw_if_any();
  return {path, path, v.real("latency"), v.real("bandwidth"), v.real("slowness")};
}

}  // namespace

Machine find_machine(const std::string& name) {
  if (name == "here") return here();
  if (name == "tflops") return tflops();
  if (name == "cluster") return cluster();
  if (!std::filesystem::exists(name))
    throw Error(ExitCode::usage, "machine '" + name +
                                     "': expected here, tflops, cluster, or a YAML file with latency, bandwidth and "
                                     "slowness");
  return read_machine(name);
}

PhaseTime predict(const PhaseLoad& load, const Machine& machine) {
  PhaseTime time;
  const auto parts = load.work.size();
  const double unit = load.whole > 0 ? machine.slowness * load.seconds / load.whole : 0;
  for (std::size_t p = 0; p < parts; ++p) {
    const double messages = load.messages.empty() ? 0 : load.messages[p];
    const double bytes = load.bytes.empty() ? 0 : load.bytes[p];
    time.work_max = std::max(time.work_max, load.work[p]);
    time.messages = std::max(time.messages, messages), time.bytes = std::max(time.bytes, bytes);
    time.seconds = std::max(time.seconds, unit * load.work[p] + messages * machine.latency + bytes / machine.bandwidth);
  }
  time.work_mean = std::accumulate(load.work.begin(), load.work.end(), 0.0) / static_cast<double>(parts);
  time.computing = unit * time.work_max;
  time.seconds += load.reductions * machine.latency * std::ceil(std::log2(static_cast<double>(parts)));
  return time;
}

}  // namespace tenon
