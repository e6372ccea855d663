// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/kinetic_relaxation.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace tenon {

KineticRelaxation::KineticRelaxation(const RelaxationOptions& options, const Mesh& mesh)
    : options_(options),
      mesh_(mesh),
      before_(static_cast<std::size_t>(mesh.nodes())),
      taken_(static_cast<std::size_t>(mesh.nodes())) {}

namespace {

double kinetic_energy(const NodalState& nodes, std::size_t n) {
  double energy = 0.5 * nodes.mass[n] * dot(nodes.velocity()[n], nodes.velocity()[n]);
  if (nodes.has_rotations()) energy += 0.5 * nodes.inertia[n] * dot(nodes.spin()[n], nodes.spin()[n]);
  return energy;
}

}  // namespace

bool KineticRelaxation::begin(NodalState& nodes) {
  if (turning_) {
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      taken_[n] += kinetic_energy(nodes, n);
      nodes.velocity()[n] = {};
      if (nodes.has_rotations()) nodes.spin()[n] = {};
    }
  }
  std::ranges::copy(nodes.velocity(), before_.begin());
  if (nodes.has_rotations()) spin_before_.assign(nodes.spin().begin(), nodes.spin().end());
  return turning_;
}

// The velocities for the way back are those before the kick, which led here.
void KineticRelaxation::turn_back(NodalState& nodes, double factor) {
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    taken_[n] += kinetic_energy(nodes, n);
    nodes.velocity()[n] = factor * before_[n];
    if (nodes.has_rotations()) nodes.spin()[n] = factor * spin_before_[n];
    taken_[n] -= kinetic_energy(nodes, n);
  }
}

void KineticRelaxation::watch(NodalState& nodes, const Loads& loads, double kick, double previous_dt, double dt,
                              double time) {
  std::array<ExactSum, 4> sums;  // kinetic energy, |m a|^2, |loads and reactions|^2, work on the elements
  for (const LocalIndex node : mesh_.owned_nodes) {
    const auto n = static_cast<std::size_t>(node);
    const Vec3 inertia = (nodes.mass[n] / kick) * (nodes.velocity()[n] - before_[n]);
    const double* f = nodes.force[n].v;
    const Vec3 outer = inertia + Vec3{f[0], f[1], f[2]} + loads.force(n);
    sums[0].add(kinetic_energy(nodes, n));
    sums[1].add(dot(inertia, inertia));
    sums[2].add(dot(outer, outer));
    sums[3].add(nodes.internal_work[n] + loads.work(n));
  }
  std::array<double, 4> totals{};
  mesh_.comm.sum(sums, totals);
  ++steps_;
  const double energy = totals[0], load = std::sqrt(totals[2]);
  residual_ = load > 0 ? std::sqrt(totals[1]) / load : 1;
  const double still = options_.tolerance * options_.tolerance * std::abs(totals[3]);
  converged_ = time >= options_.after && residual_ <= options_.tolerance && energy <= still;
  turning_ = !converged_ && energy < energy_;
  if (!turning_) {
    energy_before_ = energy_, energy_ = energy;
    return;
  }
  // Vertex of the parabola through the energies of the last three half steps: `back` steps before the present
  // positions, which lie half a step before the last energy [Bar99].
  const double bend = energy - 2 * energy_ + energy_before_;
  const double back = bend < 0 ? std::clamp((energy - energy_) / bend, 0.0, 1.0) : 0.5;
  turn_back(nodes, -back * previous_dt / dt);
  energy_ = energy_before_ = 0;
  ++peaks_;
}

std::string KineticRelaxation::report() const {
  return fmt::format(
      "dynamic relaxation {} after {} steps and {} peaks: residual {:.3g} of loads and reactions "
      "(tolerance {:.3g})",
      converged_ ? "converged" : "has not converged", steps_, peaks_, residual_, options_.tolerance);
}

void KineticRelaxation::restore(const State& state) {
  energy_ = state.energy, energy_before_ = state.energy_before;
  turning_ = state.turning != 0;
  steps_ = state.steps, peaks_ = state.peaks;
}

}  // namespace tenon
