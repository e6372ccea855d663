// SPDX-License-Identifier: BSD-3-Clause
#include "box_bench.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <numbers>

#include "bench_clock.hpp"
#include "components/sph/sph.hpp"
#include "framework/mesh/generators.hpp"
#include "framework/mesh/mesh.hpp"

namespace tenon::bench {

namespace {

struct BoxSize {
  int particles = 100000, steps = 20, repeats = 5;
  double speed = 0.1;  // greatest, over that of sound
};

constexpr double sound = 10, smoothing = 1.2;

/// A number in [-1, 1) that depends on the place alone.
double noise(const Vec3& x, double seed) {
  const double s = 43758.5453 * std::sin(12.9898 * x[0] + 78.233 * x[1] + 37.719 * x[2] + seed);
  return 2 * (s - std::floor(s)) - 1;
}

/// Jittered particles with 57 neighbours each, in a Taylor-Green vortex that stretches over the unit box.
SphOptions options(const BoxSize& size, double spacing) {
  SphOptions o;
  SphBody body;
  body.name = "fluid";
  body.material.name = "water", body.material.density = 1;
  PolynomialState state;
  state.C[1] = sound * sound;
  EquationOfState equation;
  equation.law = state;
  body.material.equation_of_state = equation;
  o.bodies = {body};
  o.smoothing = smoothing;
  for (ParticleDomain::Axis& axis : o.domain.axes) axis = {true, 0, 1};
  o.displaced = [spacing](const Vec3& x) { return 0.1 * spacing * Vec3{noise(x, 1), noise(x, 2), noise(x, 3)}; };
  const double speed = size.speed * sound;
  o.initial_velocity_function = [speed](const Vec3& x) {
    constexpr double k = 2 * std::numbers::pi;
    return speed * Vec3{std::sin(k * x[0]) * std::cos(k * x[1]) * std::cos(k * x[2]),
                        -std::cos(k * x[0]) * std::sin(k * x[1]) * std::cos(k * x[2]), 0};
  };
  return o;
}

void run(const BoxSize& size) {
  const Communicator comm = Communicator::world();
  const int across = static_cast<int>(std::lround(std::cbrt(size.particles)));
  ParticleBox box;
  box.particles = {across, across, across};
  DistributeOptions how;
  how.method = PartitionMethod::rcb, how.name = "particles";
  Sph body("particles", distribute(comm, comm.rank() == 0 ? generate(box) : MeshData{}, how),
           options(size, 1.0 / across));
  PhaseTimers timers;
  body.use_timers(timers);
  body.initialize();
  const auto steps = [&] {
    for (int s = 0; s < size.steps; ++s) body.advance(body.time_step());
    return 0;
  };
  steps();  // until the renewals and their buffers are what they stay
  const std::int64_t before = body.decomposition().counts().renewals;
  Times times;
  for (int r = 0; r < size.repeats; ++r) times.take(comm, steps);
  const double work = std::pow(across, 3) * size.steps / comm.size();
  const double pairs = static_cast<double>(comm.sum(static_cast<std::int64_t>(body.decomposition().lists().pairs())));
  if (comm.rank() != 0) return;
  fmt::print(
      "{} particles, {} ranks: million particle-steps per processor second and rank: best {:.3f}, median {:.3f}; "
      "per second of wall time and rank: {:.3f}; a renewal every {:.1f} steps, {:.1f} listed\n",
      across * across * across, comm.size(), 1e-6 * work / times.best(), 1e-6 * work / times.median(),
      1e-6 * work / times.median_wall(),
      static_cast<double>(size.steps) * size.repeats /
          static_cast<double>(std::max<std::int64_t>(1, body.decomposition().counts().renewals - before)),
      pairs / std::pow(across, 3));
  for (const PhaseTimer& phase : timers.phases())
    fmt::print("  {:<28} {:7.1f} ns a particle-step\n", phase.name, 1e9 * phase.seconds / (work * (size.repeats + 1)));
}

}  // namespace

void add_fluid(CLI::App& app) {
  auto size = std::make_shared<BoxSize>();
  CLI::App* const command = app.add_subcommand("fluid", "whole steps of a weakly compressible fluid in a box");
  command->add_option("--particles", size->particles);
  command->add_option("--steps", size->steps, "timed together");
  command->add_option("--repeats", size->repeats);
  command->add_option("--speed", size->speed, "greatest, over that of sound");
  command->callback([size] { run(*size); });
}

}  // namespace tenon::bench
