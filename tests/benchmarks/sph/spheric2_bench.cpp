// SPDX-License-Identifier: BSD-3-Clause
#include "spheric2_bench.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fluid_case.hpp"

namespace tenon::bench {

namespace {

using namespace testing;

constexpr double gravity = 9.81, density = 1000;

/// m. Half of the tank: its walls and its middle are mirrors, without friction.
struct Tank {
  static constexpr double length = 3.22, middle = 0.5, side = 1, height = 0.55, dam = 1.228;
  static constexpr double face = dam + 1.1675, box = 0.161, box_side = middle + 0.2015;
  static constexpr double height_gauge = dam + 0.504;
  static constexpr std::array<double, 2> pressure_gauges{0.021, 0.101};  ///< P1 and P3, above the ground
};

/// What the experiment showed: pressures as means of a tenth of a second around, Pa.
struct Experiment {
  struct Mean {
    double time, pressure;
  };
  static constexpr std::array<double, 2> rises{0.396, 0.421}, peaks{10910, 6570}, peak_times{0.405, 0.458};
  static constexpr std::array<std::array<Mean, 4>, 2> later{
      {{{{0.647, 4190}, {0.748, 3700}, {0.848, 3460}, {0.949, 3160}}},
       {{{0.672, 3690}, {0.773, 3740}, {0.874, 3650}, {0.974, 3290}}}}};
};

struct Size {
  double spacing = 0.04, end = 1, alpha = 0.02;
  std::string csv;
};

/// A box of particles about `spacing` apart that fill it exactly.
MeshData filled(const Vec3& low, const Vec3& high, double spacing) {
  ParticleBox box;
  box.low = low, box.high = high;
  for (std::size_t c = 0; c < 3; ++c)
    box.particles[c] = std::max(1, static_cast<int>(std::lround((high[c] - low[c]) / spacing)));
  return generate(box);
}

SphScene scene_of(const Size& size) {
  SphScene scene;
  const double sound = 10 * std::sqrt(2 * gravity * Tank::height);
  scene.mesh =
      particle_bodies({{"water", filled({0, Tank::middle, 0}, {Tank::dam, Tank::side, Tank::height}, size.spacing)},
                       {"box", filled({Tank::face, Tank::middle, 0},
                                      {Tank::face + Tank::box, Tank::box_side, Tank::box}, size.spacing)}});
  SphBody water = body_of("water", liquid(density, sound)), box = body_of("box", liquid(density, sound));
  water.initial_pressure = of_place([](const Vec3& x) { return density * gravity * (Tank::height - x[2]); });
  box.wall = true;
  scene.options.bodies = {water, box};
  scene.options.artificial_viscosity.alpha = size.alpha;
  scene.options.gravity[2] = TimeFunction::constant(-gravity);
  auto& axes = scene.options.domain.axes;
  axes[0].low = 0, axes[0].high = Tank::length, axes[1].low = Tank::middle, axes[1].high = Tank::side, axes[2].low = 0;
  scene.end = size.end;
  return scene;
}

/// Pressures of the outermost dummy particles at one height, as a mean over the middle of the face.
class Gauge {
 public:
  Gauge(const SphRun& run, double height, double spacing) {
    const double rows = std::max(1.0, std::round(Tank::box / spacing)), thick = Tank::box / rows;
    row_ = thick * (std::floor(std::min(height, Tank::box - 1e-9) / thick) + 0.5);
    layer_ = Tank::face + thick, near_ = 0.1 * thick;
    count_ = run.sum([this](const ParticleData& p, std::size_t i) { return is_at(p, i) ? 1 : 0; });
  }

  /// Collective.
  void read(const SphRun& run) {
    const Column& pressure = *run.particles().find("pressure");
    time_.push_back(run.time());
    pressure_.push_back(run.sum([&](const ParticleData& p, std::size_t i) { return is_at(p, i) ? pressure[i] : 0; }) /
                        count_);
  }

  /// First time at which the mean over the 2 ms before is above that; infinity: never.
  double rises(double above) const {
    for (std::size_t k = 0; k < time_.size(); ++k)
      if (mean(time_[k] - filter, time_[k]) > above) return time_[k];
    return std::numeric_limits<double>::infinity();
  }
  /// Greatest mean over 2 ms, and when.
  std::pair<double, double> peak() const {
    std::pair<double, double> found{0, 0};
    for (const double t : time_) found = std::max(found, {mean(t - filter, t), t});
    return found;
  }
  double mean(double after, double until) const {
    const auto first = std::ranges::upper_bound(time_, after) - time_.begin(),
               last = std::ranges::upper_bound(time_, until) - time_.begin();
    double sum = 0;
    for (auto k = first; k < last; ++k) sum += pressure_[static_cast<std::size_t>(k)];
    return last > first ? sum / static_cast<double>(last - first) : 0;
  }
  const std::vector<double>& times() const { return time_; }
  const std::vector<double>& pressures() const { return pressure_; }

 private:
  static constexpr double filter = 2e-3;

  bool is_at(const ParticleData& p, std::size_t i) const {
    return p.body[i] == 1 && p.position[3 * i] < layer_ && p.position[3 * i + 1] < Tank::middle + 0.05 &&
           std::abs(p.position[3 * i + 2] - row_) < near_;
  }

  double row_, layer_, near_, count_ = 0;
  std::vector<double> time_, pressure_;
};

void print(const std::array<Gauge, 2>& gauges) {
  for (std::size_t g = 0; g < 2; ++g) {
    const auto [peak, at] = gauges[g].peak();
    fmt::print("P{}: rises at {:.3f} s ({}), peak {:.2f} kPa ({}) at {:.3f} s ({})\n", 2 * g + 1, gauges[g].rises(1000),
               Experiment::rises[g], 1e-3 * peak, 1e-3 * Experiment::peaks[g], at, Experiment::peak_times[g]);
    for (const auto& [t, p] : Experiment::later[g]) {
      if (gauges[g].times().back() < t + 0.05) continue;
      const double mean = gauges[g].mean(t - 0.05, t + 0.05);
      fmt::print("  at {:.3f} s {:.2f} kPa ({:.2f}, {:+.0f} %)\n", t, 1e-3 * mean, 1e-3 * p, 100 * (mean / p - 1));
    }
  }
}

void run(const Size& size) {
  const Communicator comm = Communicator::world();
  SphRun run(scene_of(size), comm);
  const std::int64_t particles = comm.sum(static_cast<std::int64_t>(run.particles().owned()));
  std::array<Gauge, 2> gauges{Gauge(run, Tank::pressure_gauges[0], size.spacing),
                              Gauge(run, Tank::pressure_gauges[1], size.spacing)};
  double wet = std::numeric_limits<double>::infinity();
  run.run(size.end, [&] {
    const ParticleData& p = run.particles();
    double front = 0;
    for (std::size_t i = 0; i < p.owned(); ++i)
      if (p.body[i] == 0) front = std::max(front, p.position[3 * i]);
    if (comm.max(front) + 0.5 * size.spacing > Tank::height_gauge) wet = std::min(wet, run.time());
    for (Gauge& gauge : gauges) gauge.read(run);
  });
  const double half = 0.5 * size.spacing, inside = run.sum([half](const ParticleData&p, std::size_t i) {
    const Vec3 x = p.position.vec(i);
    return p.body[i] == 0 && x[0] > Tank::face + half && x[0] < Tank::face + Tank::box - half &&
           x[1] < Tank::box_side - half && x[2] < Tank::box - half;
  });
  const double ledger = run.ledger_error();
  if (comm.rank() != 0) return;
  fmt::print(
      "{} particles {} m apart, {} steps, alpha {}: ledger {:.1e}; deeper than half a spacing in the box: {}\n"
      "gauge of height wet at {:.3f} s (0.185 to 0.200)\n",
      particles, size.spacing, run.simulation().steps(), size.alpha, ledger, inside, wet);
  print(gauges);
  if (size.csv.empty()) return;
  std::ofstream file(size.csv);
  file << "time_s,P1_Pa,P3_Pa\n";
  for (std::size_t k = 0; k < gauges[0].times().size(); ++k)
    file << fmt::format("{},{},{}\n", gauges[0].times()[k], gauges[0].pressures()[k], gauges[1].pressures()[k]);
}

}  // namespace

void add_spheric2(CLI::App& app) {
  auto size = std::make_shared<Size>();
  CLI::App* const command = app.add_subcommand("spheric2", "a dam breaks onto a box: arrival and pressures");
  command->add_option("--spacing", size->spacing, "of particles, m");
  command->add_option("--end", size->end, "s");
  command->add_option("--alpha", size->alpha, "artificial viscosity");
  command->add_option("--csv", size->csv, "pressures over time");
  command->callback([size] { run(*size); });
}

}  // namespace tenon::bench
