// SPDX-License-Identifier: BSD-3-Clause
#include "components/thermal/multigrid.hpp"

#include <algorithm>
#include <cmath>

namespace tenon::thermal {
namespace {

constexpr int bits = 61;  // of a sum of integers, without the sign, one to spare

/// The power of two by which terms are multiplied before they are rounded to integers, if no sum exceeds `bound`.
int exponent_for(double bound) {
  return bound > 0 ? bits - 1 - std::ilogb(bound) : 0;
}

std::int64_t rounded(double value, double scale) {
  return static_cast<std::int64_t>(value * scale);
}

/// One entry of the coarse matrix, as it travels.
struct Entry {
  std::int64_t place, value;
};

/// Sorted by place, entries of one place added.
void merge(std::vector<Entry>& entries) {
  std::ranges::sort(entries, {}, &Entry::place);
  std::size_t last = 0;
  for (std::size_t i = 1; i < entries.size(); ++i) {
    if (entries[i].place == entries[last].place)
      entries[last].value += entries[i].value;
    else
      entries[++last] = entries[i];
  }
  if (!entries.empty()) entries.resize(last + 1);
}

}  // namespace

Multigrid::Multigrid(const Mesh& mesh) : mesh_(mesh), grid_(auxiliary_grid(mesh)) {
  rest_.assign(mesh.owned_nodes.size(), 0.0);
  product_ = rest_;
  change_.assign(static_cast<std::size_t>(mesh.nodes()), 0.0);
}

void Multigrid::build(const HeatSystem& system) {
  find_points(system);
  int exponent = 0;
  const SparseMatrix<std::int64_t> local = galerkin(system, exponent);
  levels_.build(grid_, points_, gathered(local, exponent));
  smoother_ = Chebyshev(greatest_eigenvalue(system));
  factor_ = system.factor;
  built_ = true;
}

// Points whose hat is positive at a node that is not held, on any rank.
void Multigrid::find_points(const HeatSystem& system) {
  std::vector<double> free(change_.size(), 0.0);
  for (std::size_t k = 0; k < rest_.size(); ++k)
    free[static_cast<std::size_t>(mesh_.owned_nodes[k])] = system.inverse_diagonal[k] > 0 ? 1.0 : 0.0;
  std::vector<std::int64_t> nodes(static_cast<std::size_t>(grid_.points()), 0);
  for (const LocalIndex n : mesh_.owned_nodes)
    if (free[static_cast<std::size_t>(n)] > 0)
      grid_.hats(mesh_.coordinates[static_cast<std::size_t>(n)],
                 [&](LocalIndex p, double) { ++nodes[static_cast<std::size_t>(p)]; });
  mesh_.comm.sum(nodes);
  mesh_.node_halo.forward(std::span<const double>(free), std::span<double>(free));
  points_.clear();
  std::vector<LocalIndex> number(nodes.size(), no_index);
  most_nodes_ = 1;
  for (std::size_t p = 0; p < nodes.size(); ++p) {
    if (nodes[p] == 0) continue;
    number[p] = static_cast<LocalIndex>(points_.size());
    points_.push_back(static_cast<LocalIndex>(p));
    most_nodes_ = std::max(most_nodes_, nodes[p]);
  }
  interpolation_ = {};
  interpolation_.columns = static_cast<LocalIndex>(points_.size());
  SparseMatrix<double> owned;
  owned.columns = interpolation_.columns;
  for (std::size_t n = 0; n < free.size(); ++n) {
    if (free[n] > 0)
      grid_.hats(mesh_.coordinates[n],
                 [&](LocalIndex p, double w) { interpolation_.add(number[static_cast<std::size_t>(p)], w); });
    interpolation_.end_row();
  }
  for (const LocalIndex n : mesh_.owned_nodes) {
    for (std::size_t p = interpolation_.begin(n); p < interpolation_.end(n); ++p)
      owned.add(interpolation_.column[p], interpolation_.value[p]);
    owned.end_row();
  }
  restriction_ = transposed(owned);
  coarse_.assign(points_.size(), 0.0);
  coarse_solution_ = coarse_;
  exact_.assign(points_.size(), 0);
}

// This rank's share of P^T A P, in units of 2^-exponent.
SparseMatrix<std::int64_t> Multigrid::galerkin(const HeatSystem& system, int& exponent) const {
  const ConductionMatrix& k = system.matrix;
  SparseMatrix<double> a;  // rows of the free nodes
  a.columns = mesh_.nodes();
  a.column.reserve(k.columns().size() + rest_.size());
  a.value.reserve(k.columns().size() + rest_.size());
  double greatest = 0;
  for (std::size_t r = 0; r < rest_.size(); ++r) {
    if (system.inverse_diagonal[r] > 0) {
      double sum = system.diagonal[r];
      a.add(mesh_.owned_nodes[r], system.diagonal[r]);
      for (auto p = static_cast<std::size_t>(k.offsets()[r]); p < static_cast<std::size_t>(k.offsets()[r + 1]); ++p) {
        a.add(k.columns()[p], system.factor * k.values()[p]);
        sum += std::abs(a.value.back());
      }
      greatest = std::max(greatest, sum);
    }
    a.end_row();
  }
  exponent = exponent_for(mesh_.comm.max(greatest) * static_cast<double>(most_nodes_));
  const double scale = std::ldexp(1.0, exponent);
  const auto times = [](double x, double y) { return x * y; };
  const SparseMatrix<double> ap = product<double>(a, interpolation_, times);
  return product<std::int64_t>(restriction_, ap, [scale](double x, double y) { return rounded(x * y, scale); });
}

// The sum over the ranks, symmetric to the last bit, on every rank.
SparseMatrix<double> Multigrid::gathered(const SparseMatrix<std::int64_t>& local, int exponent) const {
  const std::int64_t n = local.columns;
  std::vector<Entry> entries;
  entries.reserve(local.column.size());
  for (LocalIndex r = 0; r < local.rows(); ++r)
    for (std::size_t p = local.begin(r); p < local.end(r); ++p)
      entries.push_back({r * n + local.column[p], local.value[p]});
  entries = mesh_.comm.gather(std::span<const Entry>(entries));
  merge(entries);
  mesh_.comm.broadcast(entries);
  SparseMatrix<std::int64_t> whole;
  whole.columns = local.columns;
  for (const Entry& e : entries) {
    while (whole.rows() < e.place / n) whole.end_row();
    whole.add(static_cast<LocalIndex>(e.place % n), e.value);
  }
  while (whole.rows() < n) whole.end_row();
  const SparseMatrix<std::int64_t> other = transposed(whole);  // of the same pattern
  SparseMatrix<double> result;
  result.columns = whole.columns;
  result.offsets = whole.offsets;
  result.column = whole.column;
  result.value.reserve(whole.value.size());
  const double unit = std::ldexp(1.0, -exponent - 1);
  for (std::size_t p = 0; p < whole.value.size(); ++p)
    result.value.push_back(unit * static_cast<double>(whole.value[p] + other.value[p]));
  return result;
}

// Of D^-1 A, by power iteration with exact sums, a little above.
double Multigrid::greatest_eigenvalue(const HeatSystem& system) {
  constexpr int turns = 10;
  constexpr double margin = 1.1;
  const auto node = [this](std::size_t k) { return static_cast<std::size_t>(mesh_.owned_nodes[k]); };
  for (std::size_t k = 0; k < rest_.size(); ++k) {
    const std::uint64_t id = static_cast<std::uint64_t>(mesh_.node_ids[node(k)]) * 0x9e3779b97f4a7c15u;
    change_[node(k)] = system.inverse_diagonal[k] > 0 ? 0.5 + static_cast<double>(id >> 40) * 0x1p-24 : 0;
    if (id >> 63) change_[node(k)] *= -1;
  }
  double greatest = 0;
  for (int turn = 0; turn < turns; ++turn) {
    mesh_.node_halo.forward(std::span<const double>(change_), std::span<double>(change_));
    system.matrix.multiply(system.diagonal, system.factor, change_, product_);
    std::array<ExactSum, 2> local;
    double size = 0;
    for (std::size_t k = 0; k < rest_.size(); ++k) {
      double& x = change_[node(k)];
      local[0].add(x * product_[k]);
      local[1].add(x * system.diagonal[k] * x);
      x = system.inverse_diagonal[k] * product_[k];
      size = std::max(size, std::abs(x));
    }
    std::array<double, 2> sums;
    mesh_.comm.sum(local, sums);
    size = mesh_.comm.max(size);
    if (!(sums[1] > 0) || !(size > 0)) break;
    greatest = std::max(greatest, sums[0] / sums[1]);
    for (std::size_t k = 0; k < rest_.size(); ++k) change_[node(k)] /= size;
  }
  return greatest > 0 ? margin * greatest : 1.0;
}

void Multigrid::smooth(const HeatSystem& system, std::span<const double> r, std::span<double> z, bool from_zero) {
  const auto node = [this](std::size_t k) { return static_cast<std::size_t>(mesh_.owned_nodes[k]); };
  if (from_zero) {
    std::ranges::copy(r, rest_.begin());
  } else {  // z's ghosts are those of their owners
    system.matrix.multiply(system.diagonal, system.factor, z, product_);
    for (std::size_t k = 0; k < rest_.size(); ++k) rest_[k] = r[k] - product_[k];
  }
  const double sigma = smoother_.theta / smoother_.delta, inverse_theta = 1 / smoother_.theta;
  double rho = 1 / sigma;
  for (std::size_t k = 0; k < rest_.size(); ++k) {
    change_[node(k)] = inverse_theta * system.inverse_diagonal[k] * rest_[k];
    z[node(k)] = from_zero ? change_[node(k)] : z[node(k)] + change_[node(k)];
  }
  for (int step = 1; step < Chebyshev::degree; ++step) {
    mesh_.node_halo.forward(std::span<const double>(change_), std::span<double>(change_));
    system.matrix.multiply(system.diagonal, system.factor, change_, product_);
    const double next = 1 / (2 * sigma - rho), keep = next * rho, take = 2 * next / smoother_.delta;
    for (std::size_t k = 0; k < rest_.size(); ++k) {
      rest_[k] -= product_[k];
      change_[node(k)] = keep * change_[node(k)] + take * system.inverse_diagonal[k] * rest_[k];
      z[node(k)] += change_[node(k)];
    }
    rho = next;
  }
}

// z += P (coarse solution for the residual in rest_), ghosts included.
void Multigrid::correct(std::span<double> z) {
  double greatest = 0;
  for (const double v : rest_) greatest = std::isfinite(v) ? std::max(greatest, std::abs(v)) : INFINITY;
  greatest = mesh_.comm.max(greatest);
  if (!(greatest > 0) || !std::isfinite(greatest) || points_.empty()) return;
  const int exponent = exponent_for(greatest * static_cast<double>(most_nodes_));
  const double scale = std::ldexp(1.0, exponent), unit = std::ldexp(1.0, -exponent);
  for (LocalIndex p = 0; p < restriction_.rows(); ++p) {
    std::int64_t sum = 0;
    for (std::size_t q = restriction_.begin(p); q < restriction_.end(p); ++q)
      sum += rounded(restriction_.value[q] * rest_[static_cast<std::size_t>(restriction_.column[q])], scale);
    exact_[static_cast<std::size_t>(p)] = sum;
  }
  mesh_.comm.sum(exact_);
  for (std::size_t p = 0; p < exact_.size(); ++p) coarse_[p] = unit * static_cast<double>(exact_[p]);
  levels_.solve(coarse_, coarse_solution_);
  for (LocalIndex n = 0; n < interpolation_.rows(); ++n) {
    double sum = 0;
    for (std::size_t p = interpolation_.begin(n); p < interpolation_.end(n); ++p)
      sum += interpolation_.value[p] * coarse_solution_[static_cast<std::size_t>(interpolation_.column[p])];
    z[static_cast<std::size_t>(n)] += sum;
  }
}

void Multigrid::apply(const HeatSystem& system, std::span<const double> r, std::span<double> z) {
  smooth(system, r, z, true);
  mesh_.node_halo.forward(std::span<const double>(z), z);
  system.matrix.multiply(system.diagonal, system.factor, z, product_);
  // What is left of a held row is none of ours: its column of the restriction is empty, but its size would count.
  for (std::size_t k = 0; k < rest_.size(); ++k) rest_[k] = system.inverse_diagonal[k] > 0 ? r[k] - product_[k] : 0.0;
  correct(z);
  smooth(system, r, z, false);
}

std::int64_t Multigrid::memory() const {
  return interpolation_.memory() + restriction_.memory() + levels_.memory() +
         static_cast<std::int64_t>((rest_.size() + product_.size() + change_.size() + 3 * coarse_.size()) * 8);
}

}  // namespace tenon::thermal
