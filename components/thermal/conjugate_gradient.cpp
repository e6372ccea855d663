// SPDX-License-Identifier: BSD-3-Clause
#include "components/thermal/conjugate_gradient.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tenon::thermal {

ConjugateGradient::ConjugateGradient(const Mesh& mesh) : mesh_(mesh) {
  const std::size_t rows = mesh.owned_nodes.size();
  u_.assign(static_cast<std::size_t>(mesh.nodes()), 0.0);
  for (std::vector<double>* v : {&w_, &p_, &s_}) v->assign(rows, 0.0);
}

void ConjugateGradient::true_residual(const HeatSystem& system, std::span<const double> b, std::span<double> x,
                                      std::span<double> r) {
  system.matrix.halo().forward(std::span<const double>(x), x);
  system.matrix.multiply(system.diagonal, system.factor, x, w_);
  for (std::size_t k = 0; k < r.size(); ++k) r[k] = b[k] - w_[k];
}

ConjugateGradient::Dots ConjugateGradient::precondition(const HeatSystem& system, std::span<const double> r) {
  if (multigrid_)
    multigrid_->apply(system, r, u_);
  else
    for (std::size_t k = 0; k < r.size(); ++k)
      u_[static_cast<std::size_t>(mesh_.owned_nodes[k])] = system.inverse_diagonal[k] * r[k];
  system.matrix.halo().forward(std::span<const double>(u_), std::span<double>(u_));
  system.matrix.multiply(system.diagonal, system.factor, u_, w_);
  std::array<ExactSum, 3> local;
  for (std::size_t k = 0; k < r.size(); ++k) {
    const double u = u_[static_cast<std::size_t>(mesh_.owned_nodes[k])];
    local[0].add(r[k] * u);
    local[1].add(w_[k] * u);
    if (multigrid_) local[2].add(system.inverse_diagonal[k] * r[k] * r[k]);
  }
  std::array<double, 3> dots;
  mesh_.comm.sum(local, dots);
  return {dots[0], dots[1], multigrid_ ? dots[2] : dots[0]};
}

double ConjugateGradient::scale_of(const HeatSystem& system, std::span<const double> b, std::span<const double> x) {
  for (std::size_t k = 0; k < b.size(); ++k) {
    const auto n = static_cast<std::size_t>(mesh_.owned_nodes[k]);
    u_[n] = system.inverse_diagonal[k] == 0 ? x[n] : 0.0;
  }
  system.matrix.halo().forward(std::span<const double>(u_), std::span<double>(u_));
  system.matrix.multiply(system.diagonal, system.factor, u_, w_);
  ExactSum local;
  for (std::size_t k = 0; k < b.size(); ++k) local.add(system.inverse_diagonal[k] * (b[k] - w_[k]) * (b[k] - w_[k]));
  return mesh_.comm.sum(local);
}

int ConjugateGradient::iterate(const HeatSystem& system, std::span<double> x, std::span<double> r, double target,
                               int budget) {
  auto [gamma, delta, size] = precondition(system, r);
  double alpha = gamma / delta, beta = 0;
  int iteration = 0;
  while (size > target && iteration < budget && alpha > 0 && std::isfinite(alpha)) {
    ++iteration;
    for (std::size_t k = 0; k < r.size(); ++k) {
      const auto n = static_cast<std::size_t>(mesh_.owned_nodes[k]);
      p_[k] = iteration == 1 ? u_[n] : u_[n] + beta * p_[k];
      s_[k] = iteration == 1 ? w_[k] : w_[k] + beta * s_[k];
      x[n] += alpha * p_[k];
      r[k] -= alpha * s_[k];
    }
    const double before = gamma;
    const Dots next = precondition(system, r);
    gamma = next.gamma, delta = next.delta, size = next.size;
    beta = gamma / before;
    alpha = gamma / (delta - beta * gamma / alpha);
  }
  return iteration;
}

// r.r / diagonal, what convergence is measured by.
double ConjugateGradient::size_of(const HeatSystem& system, std::span<const double> r) const {
  ExactSum local;
  for (std::size_t k = 0; k < r.size(); ++k) {
    const double u = system.inverse_diagonal[k] * r[k];
    local.add(r[k] * u);
  }
  return mesh_.comm.sum(local);
}

SolveReport ConjugateGradient::solve(const HeatSystem& system, std::span<const double> b, std::span<double> x,
                                     std::span<double> residual, double tolerance, int max_iterations,
                                     Multigrid* multigrid) {
  constexpr int restarts = 5;
  constexpr double round_off = 64 * std::numeric_limits<double>::epsilon();
  multigrid_ = multigrid;
  u_.resize(system.matrix.width());
  const double scale = scale_of(system, b, x);
  // Nothing drives the free rows: from a guess that is not zero, iterations would only ever come nearer.
  for (std::size_t k = 0; k < b.size() && scale == 0; ++k)
    if (system.inverse_diagonal[k] != 0) x[static_cast<std::size_t>(mesh_.owned_nodes[k])] = 0;
  SolveReport report;
  for (int attempt = 0; attempt <= restarts; ++attempt) {
    true_residual(system, b, x, residual);
    const double rest = size_of(system, residual);
    report.residual = scale > 0 ? std::sqrt(rest / scale) : 0;
    ExactSum size;
    for (std::size_t k = 0; k < b.size(); ++k) {
      const double xk = x[static_cast<std::size_t>(mesh_.owned_nodes[k])];
      size.add(system.diagonal[k] * xk * xk);
    }
    const double floor = round_off * round_off * mesh_.comm.sum(size);
    report.converged = rest <= std::max(tolerance * tolerance * scale, floor);
    if (report.converged || report.iterations >= max_iterations || !std::isfinite(rest)) break;
    // A little below the aim, so that the true residual reaches it at once.
    const double target = 0.25 * tolerance * tolerance * scale;
    report.iterations += iterate(system, x, residual, target, max_iterations - report.iterations);
  }
  return report;
}

std::int64_t ConjugateGradient::memory() const {
  return static_cast<std::int64_t>((u_.size() + w_.size() + p_.size() + s_.size()) * sizeof(double));
}

}  // namespace tenon::thermal
