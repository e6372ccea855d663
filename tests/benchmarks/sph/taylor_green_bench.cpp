// SPDX-License-Identifier: BSD-3-Clause
#include "taylor_green_bench.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "bench_clock.hpp"
#include "taylor_green_case.hpp"

namespace tenon::bench {

namespace {

struct Variant {
  std::vector<int> across{25, 50, 100, 200};
  std::string shifting = "transport_velocity", kernel = "wendland_c2";
  double smoothing = 1.3, strength = 1, background = 0, diffusion = 0.1, end = 1, jitter = 0.2;
};

testing::SphScene scene_of(const Variant& variant, int across) {
  using Shifting = FluidOptions::Shifting;
  testing::SphScene scene =
      testing::TaylorGreen::scene(across, variant.shifting == "none"       ? Shifting::none
                                          : variant.shifting == "shifting" ? Shifting::shifting
                                                                           : Shifting::transport_velocity);
  scene.options.smoothing = variant.smoothing;
  scene.options.fluid.shifting_strength = variant.strength;
  scene.options.fluid.background_pressure = variant.background;
  scene.options.fluid.density_diffusion = variant.diffusion;
  const double shake = variant.jitter / across;
  scene.options.displaced = [shake](const Vec3& x) {
    return shake * Vec3{testing::noise(x, 1), testing::noise(x, 2), 0};
  };
  if (variant.kernel == "quintic_spline") scene.options.kernel = SphKernelKind::quintic_spline;
  if (variant.kernel == "wendland_c4") scene.options.kernel = SphKernelKind::wendland_c4;
  if (variant.kernel == "cubic_spline") scene.options.kernel = SphKernelKind::cubic_spline;
  return scene;
}

void run(const Variant& variant) {
  const Communicator comm = Communicator::world();
  if (comm.rank() == 0) fmt::print("across, steps, processor s, error of velocity, rate of decay over exact\n");
  for (const int across : variant.across) {
    testing::SphRun run(scene_of(variant, across), comm);
    const double first = testing::TaylorGreen::greatest_speed(run);
    Times times;
    times.take(comm, [&] {
      run.run(variant.end);
      return 0;
    });
    const double last = testing::TaylorGreen::greatest_speed(run), error = testing::TaylorGreen::error(run);
    if (comm.rank() == 0)
      fmt::print("{}, {}, {:.3f}, {:.5f}, {:.4f}\n", across, run.simulation().steps(), times.best(), error,
                 std::log(first / last) / run.time() / testing::TaylorGreen::rate);
  }
}

}  // namespace

void add_taylor_green(CLI::App& app) {
  auto variant = std::make_shared<Variant>();
  CLI::App* const command = app.add_subcommand("taylor_green", "run time against error at t = 1 and Re = 100");
  command->add_option("--across", variant->across, "particles along an edge");
  command->add_option("--shifting", variant->shifting, "none, shifting or transport_velocity");
  command->add_option("--kernel", variant->kernel);
  command->add_option("--smoothing", variant->smoothing);
  command->add_option("--strength", variant->strength, "of shifting, over what is usual");
  command->add_option("--background", variant->background, "pressure, Pa");
  command->add_option("--diffusion", variant->diffusion, "of density");
  command->add_option("--jitter", variant->jitter, "of particles at the start, over the spacing");
  command->add_option("--end", variant->end, "s");
  command->callback([variant] { run(*variant); });
}

}  // namespace tenon::bench
