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
  links_.assign(system.matrix.values().begin(), system.matrix.values().end());
  find_points(system);
  int exponent = 0;
  SparseMatrix<std::int64_t> upper = galerkin(system, exponent);
  levels_.build(grid_, points_, gathered(std::move(upper), exponent));
  smoother_ = Chebyshev(Chebyshev::bound(power_iteration(system), greatest_row(system)));
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
  interpolate(free, number);
  coarse_.assign(points_.size(), 0.0);
  coarse_solution_ = coarse_;
  exact_.assign(points_.size(), 0);
}

void Multigrid::interpolate(std::span<const double> free, std::span<const LocalIndex> number) {
  interpolation_ = {};
  interpolation_.columns = static_cast<LocalIndex>(points_.size());
  SparseMatrix<float> owned;
  owned.columns = interpolation_.columns;
  for (std::size_t n = 0; n < free.size(); ++n) {
    if (free[n] > 0)
      grid_.hats(mesh_.coordinates[n], [&](LocalIndex p, double w) {
        interpolation_.add(number[static_cast<std::size_t>(p)], static_cast<float>(w));
      });
    interpolation_.end_row();
  }
  for (const LocalIndex n : mesh_.owned_nodes) {
    for (std::size_t p = interpolation_.begin(n); p < interpolation_.end(n); ++p)
      owned.add(interpolation_.column[p], interpolation_.value[p]);
    owned.end_row();
  }
  restriction_ = transposed(owned);
}

// A P for the free rows; `greatest` sum of the sizes of a row's entries of A.
SparseMatrix<double> Multigrid::times_interpolation(const HeatSystem& system, double& greatest) const {
  const ConductionMatrix& k = system.matrix;
  const SparseMatrix<float>& p = interpolation_;
  SparseMatrix<double> ap;
  ap.columns = p.columns;
  constexpr std::size_t typical = 48;
  ap.column.reserve(typical * rest_.size());
  ap.value.reserve(typical * rest_.size());
  RowSum<double> row(ap);
  greatest = 0;
  for (std::size_t r = 0; r < rest_.size(); ++r) {
    double sum = 0;
    const auto add = [&](LocalIndex node, double entry) {
      sum += std::abs(entry);
      for (std::size_t q = p.begin(node); q < p.end(node); ++q)
        row.add(p.column[q], entry * static_cast<double>(p.value[q]));
    };
    if (system.inverse_diagonal[r] > 0) {
      add(mesh_.owned_nodes[r], system.diagonal[r]);
      for (auto e = static_cast<std::size_t>(k.offsets()[r]); e < static_cast<std::size_t>(k.offsets()[r + 1]); ++e)
        add(k.columns()[e], system.factor * k.values()[e]);
    }
    greatest = std::max(greatest, sum);
    ap.end_row();
  }
  return ap;
}

// This rank's share of the upper half of P^T A P, in units of 2^-exponent.
SparseMatrix<std::int64_t> Multigrid::galerkin(const HeatSystem& system, int& exponent) const {
  double greatest = 0;
  const SparseMatrix<double> ap = times_interpolation(system, greatest);
  exponent = exponent_for(mesh_.comm.max(greatest) * static_cast<double>(most_nodes_));
  const double scale = std::ldexp(1.0, exponent);
  SparseMatrix<std::int64_t> upper;
  upper.columns = restriction_.rows();
  RowSum<std::int64_t> row(upper);
  for (LocalIndex i = 0; i < restriction_.rows(); ++i) {
    for (std::size_t p = restriction_.begin(i); p < restriction_.end(i); ++p) {
      const double w = scale * static_cast<double>(restriction_.value[p]);
      for (std::size_t q = ap.begin(restriction_.column[p]); q < ap.end(restriction_.column[p]); ++q)
        if (ap.column[q] >= i) row.add(ap.column[q], static_cast<std::int64_t>(w * ap.value[q]));
    }
    upper.end_row();
  }
  return upper;
}

// The sum over the ranks and its mirror image, on every rank; columns ascend.
SparseMatrix<double> Multigrid::gathered(SparseMatrix<std::int64_t> upper, int exponent) const {
  const std::int64_t n = upper.columns;
  if (mesh_.comm.size() > 1) {
    std::vector<Entry> entries;
    entries.reserve(upper.column.size());
    for (LocalIndex r = 0; r < upper.rows(); ++r)
      for (std::size_t p = upper.begin(r); p < upper.end(r); ++p)
        entries.push_back({r * n + upper.column[p], upper.value[p]});
    entries = mesh_.comm.gather(std::span<const Entry>(entries));
    merge(entries);
    mesh_.comm.broadcast(entries);
    upper = {};
    upper.columns = static_cast<LocalIndex>(n);
    for (const Entry& e : entries) {
      while (upper.rows() < e.place / n) upper.end_row();
      upper.add(static_cast<LocalIndex>(e.place % n), e.value);
    }
    while (upper.rows() < n) upper.end_row();
  }
  const SparseMatrix<std::int64_t> lower = transposed(upper);
  upper = transposed(lower);
  const double unit = std::ldexp(1.0, -exponent);
  SparseMatrix<double> whole;
  whole.columns = upper.columns;
  whole.column.reserve(2 * upper.column.size());
  whole.value.reserve(2 * upper.column.size());
  for (LocalIndex r = 0; r < upper.rows(); ++r) {
    for (std::size_t p = lower.begin(r); p < lower.end(r); ++p)
      if (lower.column[p] < r) whole.add(lower.column[p], unit * static_cast<double>(lower.value[p]));
    for (std::size_t p = upper.begin(r); p < upper.end(r); ++p)
      whole.add(upper.column[p], unit * static_cast<double>(upper.value[p]));
    whole.end_row();
  }
  return whole;
}

// As ConductionMatrix::multiply, from half the memory.
void Multigrid::multiply(const HeatSystem& system, std::span<const double> x, std::span<double> out) const {
  const auto offsets = system.matrix.offsets(), columns = system.matrix.columns();
  for (std::size_t r = 0; r < out.size(); ++r) {
    double sum = 0;
    for (auto p = static_cast<std::size_t>(offsets[r]); p < static_cast<std::size_t>(offsets[r + 1]); ++p)
      sum += static_cast<double>(links_[p]) * x[static_cast<std::size_t>(columns[p])];
    out[r] = system.diagonal[r] * x[static_cast<std::size_t>(mesh_.owned_nodes[r])] + system.factor * sum;
  }
}

// Of D^-1 A; collective.
double Multigrid::greatest_row(const HeatSystem& system) const {
  const ConductionMatrix& k = system.matrix;
  double greatest = 0;
  for (std::size_t r = 0; r < rest_.size(); ++r) {
    double sum = system.diagonal[r];
    for (auto p = static_cast<std::size_t>(k.offsets()[r]); p < static_cast<std::size_t>(k.offsets()[r + 1]); ++p)
      sum += std::abs(system.factor * k.values()[p]);
    greatest = std::max(greatest, system.inverse_diagonal[r] * sum);
  }
  return mesh_.comm.max(greatest);
}

// Of D^-1 A, with exact sums; collective.
double Multigrid::power_iteration(const HeatSystem& system) {
  constexpr int turns = 10;
  const auto node = [this](std::size_t k) { return static_cast<std::size_t>(mesh_.owned_nodes[k]); };
  for (std::size_t k = 0; k < rest_.size(); ++k) {
    const std::uint64_t id = static_cast<std::uint64_t>(mesh_.node_ids[node(k)]) * 0x9e3779b97f4a7c15u;
    change_[node(k)] = system.inverse_diagonal[k] > 0 ? 0.5 + static_cast<double>(id >> 40) * 0x1p-24 : 0;
    if (id >> 63) change_[node(k)] *= -1;
  }
  double greatest = 0;
  for (int turn = 0; turn < turns; ++turn) {
    mesh_.node_halo.forward(std::span<const double>(change_), std::span<double>(change_));
    multiply(system, change_, product_);
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
  return greatest;
}

void Multigrid::smooth(const HeatSystem& system, std::span<const double> r, std::span<double> z, bool from_zero) {
  const auto node = [this](std::size_t k) { return static_cast<std::size_t>(mesh_.owned_nodes[k]); };
  if (from_zero) {
    std::ranges::copy(r, rest_.begin());
  } else {  // z's ghosts are those of their owners
    multiply(system, z, product_);
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
    multiply(system, change_, product_);
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
      sum += rounded(
          static_cast<double>(restriction_.value[q]) * rest_[static_cast<std::size_t>(restriction_.column[q])], scale);
    exact_[static_cast<std::size_t>(p)] = sum;
  }
  mesh_.comm.sum(exact_);
  for (std::size_t p = 0; p < exact_.size(); ++p) coarse_[p] = unit * static_cast<double>(exact_[p]);
  levels_.solve(coarse_, coarse_solution_);
  for (LocalIndex n = 0; n < interpolation_.rows(); ++n) {
    double sum = 0;
    for (std::size_t p = interpolation_.begin(n); p < interpolation_.end(n); ++p)
      sum += static_cast<double>(interpolation_.value[p]) *
             coarse_solution_[static_cast<std::size_t>(interpolation_.column[p])];
    z[static_cast<std::size_t>(n)] += sum;
  }
}

void Multigrid::apply(const HeatSystem& system, std::span<const double> r, std::span<double> z) {
  smooth(system, r, z, true);
  mesh_.node_halo.forward(std::span<const double>(z), z);
  multiply(system, z, product_);
  // What is left of a held row is none of ours: its column of the restriction is empty, but its size would count.
  for (std::size_t k = 0; k < rest_.size(); ++k) rest_[k] = system.inverse_diagonal[k] > 0 ? r[k] - product_[k] : 0.0;
  correct(z);
  smooth(system, r, z, false);
}

std::int64_t Multigrid::memory() const {
  return interpolation_.memory() + restriction_.memory() + levels_.memory() +
         static_cast<std::int64_t>(
             (links_.size() / 2 + rest_.size() + product_.size() + change_.size() + 3 * coarse_.size()) * 8);
}

}  // namespace tenon::thermal
