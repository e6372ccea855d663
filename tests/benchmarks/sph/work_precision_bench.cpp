// SPDX-License-Identifier: BSD-3-Clause
#include "work_precision_bench.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "bench_clock.hpp"
#include "framework/base/error.hpp"
#include "framework/io/log_log_plot.hpp"
#include "framework/io/posix_file.hpp"
#include "shock_case.hpp"
#include "taylor_green_case.hpp"

namespace tenon::bench {

namespace {

using testing::SphRun;
using testing::SphScene;

struct Sizes {
  std::vector<int> vortices{12, 25, 50, 100}, tubes{160, 320, 640, 1280};
  std::string csv = "sph-work-error.csv", png;
};

struct Found {
  double seconds, error;
};

/// Processor seconds of a whole run, set-up included.
template <typename Error>
Found measure(const Communicator& comm, const SphScene& scene, double end, Error&& error) {
  Times times;
  double wrong = 0;
  times.take(comm, [&] {
    SphRun run(scene, comm);
    run.run(end);
    wrong = error(run);
    return 0;
  });
  return {times.best(), wrong};
}

class WorkPrecision {
 public:
  WorkPrecision(const Communicator& comm, Sizes sizes) : comm_(comm), sizes_(std::move(sizes)) {}

  void run() {
    vortices("plain, h = 2.4 dx", FluidOptions::Shifting::none);
    vortices("shifting, h = 2 dx", FluidOptions::Shifting::shifting);
    vortices("transport velocity, h = 2 dx", FluidOptions::Shifting::transport_velocity);
    using Switch = ArtificialViscosity::Switch;
    using Density = GasOptions::Density;
    tubes("density by summation", Density::summation, Switch::none, 1);
    tubes("summation, Cullen-Dehnen switch", Density::summation, Switch::cullen_dehnen, 1);
    tubes("summation, no conduction", Density::summation, Switch::none, 0);
    tubes("density by continuity", Density::continuity, Switch::none, 1);
    write_and_rename(sizes_.csv, csv_);
    if (sizes_.png.empty()) return;
    // Work grows with the third power of the size for the vortices, with the second for the tubes.
    add_guide(panels_[0], "second order", 2.0 / 3);
    add_guide(panels_[1], "first order", 1.0 / 2);
    draw_log_log(panels_, sizes_.png, 1500, 640);
  }

 private:
  void vortices(const std::string& name, FluidOptions::Shifting shifting) {
    panels_[0].lines.push_back({name, {}, {}, false});
    for (const int across : sizes_.vortices)
      add("taylor_green", 0, name, across,
          measure(comm_, testing::TaylorGreen::scene(across, shifting), 1,
                  [](SphRun& run) { return testing::TaylorGreen::error(run); }));
  }

  void tubes(const std::string& name, GasOptions::Density density, ArtificialViscosity::Switch limiter,
             double conduction) {
    panels_[1].lines.push_back({name, {}, {}, false});
    for (const int dense : sizes_.tubes) {
      SphScene scene = testing::sod_tube(dense, 1);
      scene.options.gas.density = density;
      scene.options.artificial_viscosity.limiter = limiter;
      scene.options.artificial_conduction = conduction;
      add("sod", 1, name, dense,
          measure(comm_, scene, scene.end, [](SphRun& run) { return testing::end_of_tube(run).density_error; }));
    }
  }

  void add(const std::string& of, std::size_t panel, const std::string& name, int size, const Found& found) {
    panels_[panel].lines.back().x.push_back(found.seconds);
    panels_[panel].lines.back().y.push_back(found.error);
    const std::string row = fmt::format("{},\"{}\",{},{:.4g},{:.4g}\n", of, name, size, found.seconds, found.error);
    fmt::print("{}", row);
    csv_ += row;
  }

  static void add_guide(LogLogPanel& panel, const std::string& name, double power) {
    const LogLogLine& first = panel.lines.back();
    LogLogLine guide{name, {}, {}, true};
    for (const double x : {first.x.front(), first.x.back()}) {
      guide.x.push_back(x);
      guide.y.push_back(0.6 * first.y.front() * std::pow(x / first.x.front(), -power));
    }
    panel.lines.push_back(guide);
  }

  const Communicator& comm_;
  Sizes sizes_;
  std::string csv_ = "case,formulation,across,processor_seconds,error\n";
  std::vector<LogLogPanel> panels_{
      {"Taylor-Green vortices, Re 100", "processor seconds", "error of velocity at t = 1", {}, true},
      {"Sod's tube", "processor seconds", "error of density", {}, true}};
};

}  // namespace

void add_work_precision(CLI::App& app) {
  auto sizes = std::make_shared<Sizes>();
  CLI::App* const command = app.add_subcommand("work_precision", "run time against error, of all formulations");
  command->add_option("--vortices", sizes->vortices, "particles along an edge of Taylor-Green vortices");
  command->add_option("--tubes", sizes->tubes, "particles per unit length on the dense side of Sod's tube");
  command->add_option("--csv", sizes->csv, "table to write");
  command->add_option("--png", sizes->png, "picture to draw");
  command->callback([sizes] {
    const Communicator comm = Communicator::world();
    if (comm.size() > 1) throw Error(ExitCode::usage, "work_precision: on one rank, whose time it takes");
    WorkPrecision(comm, *sizes).run();
  });
}

}  // namespace tenon::bench
