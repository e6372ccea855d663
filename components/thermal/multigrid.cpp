// SPDX-License-Identifier: BSD-3-Clause
#include "components/thermal/multigrid.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

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

/// As chebyshev.hpp wants it: vectors of all local nodes, rows of the owned ones, sums exact and over all ranks. The
/// numbers are those of ConductionMatrix in half the memory.
struct MeshMatrix {
  using Sum = ExactSum;
  const Mesh& mesh;
  const HeatSystem& system;
  std::span<const float> links;

  std::size_t rows() const { return system.diagonal.size(); }
  double& entry(std::span<double> v, std::size_t k) const { return v[static_cast<std::size_t>(mesh.owned_nodes[k])]; }
  double inverse_diagonal(std::size_t k) const { return system.inverse_diagonal[k]; }
  /// `v` with ghosts.
  void multiply_here(std::span<const double> v, std::span<double> out) const {
    const auto offsets = system.matrix.offsets(), columns = system.matrix.columns();
    for (std::size_t r = 0; r < out.size(); ++r) {
      double sum = 0;
      for (auto p = static_cast<std::size_t>(offsets[r]); p < static_cast<std::size_t>(offsets[r + 1]); ++p)
        sum += static_cast<double>(links[p]) * v[static_cast<std::size_t>(columns[p])];
      out[r] = system.diagonal[r] * v[static_cast<std::size_t>(mesh.owned_nodes[r])] + system.factor * sum;
    }
  }
  void multiply(std::span<double> v, std::span<double> out) const {
    system.matrix.halo().forward(std::span<const double>(v), v);
    multiply_here(v, out);
  }
  double row_size(std::size_t k) const {
    const auto offsets = system.matrix.offsets();
    double sum = system.diagonal[k];
    for (auto p = static_cast<std::size_t>(offsets[k]); p < static_cast<std::size_t>(offsets[k + 1]); ++p)
      sum += std::abs(system.factor * system.matrix.values()[p]);
    return sum;
  }
  std::array<double, 2> sums(const std::array<ExactSum, 2>& local) const {
    std::array<double, 2> all;
    mesh.comm.sum(local, all);
    return all;
  }
  double greatest(double local) const { return mesh.comm.max(local); }
};

}  // namespace

Multigrid::Multigrid(const Mesh& mesh) : mesh_(mesh), grid_(auxiliary_grid(mesh)) {
  rest_.assign(mesh.owned_nodes.size(), 0.0);
  product_ = rest_;
}

void Multigrid::build(const HeatSystem& system, const ContactConductance* contact) {
  if (contact) ties_.build(system, *contact);
  links_.assign(system.matrix.values().begin(), system.matrix.values().end());
  if (!built_) lay_out(system);
  const int exponent = galerkin(system);
  if (!built_) lay_out_sums();
  add_up(exponent);
  levels_.fill(whole_);
  bound_ = bound(system);
  smoother_ = Chebyshev(bound_);
  built_ = true;
}

// Points whose hat is positive at a node that is not held, on any rank.
void Multigrid::lay_out(const HeatSystem& system) {
  change_.assign(system.matrix.width(), 0.0);
  std::vector<double> free(change_.size(), 0.0);
  for (std::size_t k = 0; k < rest_.size(); ++k)
    free[static_cast<std::size_t>(mesh_.owned_nodes[k])] = system.inverse_diagonal[k] > 0 ? 1.0 : 0.0;
  std::vector<std::int64_t> nodes(static_cast<std::size_t>(grid_.points()), 0);
  for (const LocalIndex n : mesh_.owned_nodes)
    if (free[static_cast<std::size_t>(n)] > 0)
      grid_.hats(mesh_.coordinates[static_cast<std::size_t>(n)],
                 [&](LocalIndex p, double) { ++nodes[static_cast<std::size_t>(p)]; });
  mesh_.comm.sum(nodes);
  system.matrix.halo().forward(std::span<const double>(free), std::span<double>(free));
  points_.clear();
  std::vector<LocalIndex> number(nodes.size(), no_index);
  most_nodes_ = 1;
  for (std::size_t p = 0; p < nodes.size(); ++p) {
    if (nodes[p] == 0) continue;
    number[p] = static_cast<LocalIndex>(points_.size());
    points_.push_back(static_cast<LocalIndex>(p));
    most_nodes_ = std::max(most_nodes_, nodes[p]);
  }
  std::vector<Vec3> places = mesh_.coordinates;
  places.resize(change_.size());
  system.matrix.halo().forward(std::span<const Vec3>(places), std::span(places));
  interpolate(places, free, number);
  if (ties_.any()) follow_ties(system);
  make_restriction();
  coarse_.assign(points_.size(), 0.0);
  coarse_solution_ = coarse_;
  exact_.assign(points_.size(), 0);
  levels_.lay_out(grid_, points_);
}

void Multigrid::interpolate(std::span<const Vec3> places, std::span<const double> free,
                            std::span<const LocalIndex> number) {
  interpolation_ = {};
  interpolation_.columns = static_cast<LocalIndex>(points_.size());
  for (std::size_t n = 0; n < free.size(); ++n) {
    if (free[n] > 0)
      grid_.hats(places[n], [&](LocalIndex p, double w) {
        interpolation_.add(number[static_cast<std::size_t>(p)], static_cast<float>(w));
      });
    interpolation_.end_row();
  }
}

// A node that is tied takes what the nodes across take: rows of theirs instead of its own, also where it is a ghost.
void Multigrid::follow_ties(const HeatSystem& system) {
  struct Entry {
    LocalIndex point;
    float weight;
  };
  std::map<LocalIndex, std::map<LocalIndex, double>> owned;
  ties_.each_tie([&](LocalIndex b, LocalIndex a, double weight) {
    std::map<LocalIndex, double>& row = owned[b];
    for (std::size_t p = interpolation_.begin(a); p < interpolation_.end(a); ++p)
      row[interpolation_.column[p]] += weight * static_cast<double>(interpolation_.value[p]);
  });
  std::map<LocalIndex, std::vector<Entry>> rows;
  std::vector<LocalIndex> counts(static_cast<std::size_t>(mesh_.nodes()), 0);
  std::vector<Entry> entries;
  for (const auto& [b, row] : owned) {
    for (const auto& [point, weight] : row) rows[b].push_back({point, static_cast<float>(weight)});
    counts[static_cast<std::size_t>(b)] = static_cast<LocalIndex>(rows[b].size());
    entries.insert(entries.end(), rows[b].begin(), rows[b].end());
  }
  const auto theirs =
      system.matrix.halo().forward_varying(std::span<const LocalIndex>(counts), std::span<const Entry>(entries));
  auto next = theirs.values.begin();
  for (std::size_t i = 0; i < theirs.counts.size(); ++i) {
    if (theirs.counts[i] > 0) rows[system.matrix.arrivals()[i]].assign(next, next + theirs.counts[i]);
    next += theirs.counts[i];
  }
  const SparseMatrix<float> plain = std::exchange(interpolation_, {});
  interpolation_.columns = plain.columns;
  std::vector<std::int64_t> nodes(points_.size(), 0);
  for (LocalIndex n = 0; n < plain.rows(); ++n) {
    if (const auto found = rows.find(n); found != rows.end()) {
      for (const Entry& entry : found->second) interpolation_.add(entry.point, entry.weight);
    } else {
      for (std::size_t p = plain.begin(n); p < plain.end(n); ++p) interpolation_.add(plain.column[p], plain.value[p]);
    }
    interpolation_.end_row();
    for (std::size_t p = interpolation_.begin(n); n < mesh_.nodes() && mesh_.owns_node(n) && p < interpolation_.end(n);
         ++p)
      ++nodes[static_cast<std::size_t>(interpolation_.column[p])];
  }
  mesh_.comm.sum(nodes);
  constexpr auto weight = static_cast<std::int64_t>(ContactTies::greatest_weight * ContactTies::greatest_weight);
  for (const std::int64_t count : nodes) most_nodes_ = std::max(most_nodes_, weight * count);
}

void Multigrid::make_restriction() {
  SparseMatrix<float> owned;
  owned.columns = interpolation_.columns;
  for (const LocalIndex n : mesh_.owned_nodes) {
    for (std::size_t p = interpolation_.begin(n); p < interpolation_.end(n); ++p)
      owned.add(interpolation_.column[p], interpolation_.value[p]);
    owned.end_row();
  }
  restriction_ = transposed(owned);
}

// A P for the free rows; returns the greatest sum of the sizes of a row's entries of A.
double Multigrid::times_interpolation(const HeatSystem& system) {
  const ConductionMatrix& k = system.matrix;
  const SparseMatrix<float>& p = interpolation_;
  SparseMatrix<double>& ap = times_interpolation_;
  if (!built_) {
    constexpr std::size_t typical = 48;
    ap.column.reserve(typical * rest_.size());
    ap.value.reserve(typical * rest_.size());
  }
  ap.clear(p.columns);
  RowSum<double> row(ap, place_);
  double greatest = 0;
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
  return greatest;
}

// This rank's share of the upper half of P^T A P, in units of 2^-(what is returned).
int Multigrid::galerkin(const HeatSystem& system) {
  const double greatest = times_interpolation(system);
  const int exponent = exponent_for(mesh_.comm.max(greatest) * static_cast<double>(most_nodes_));
  const double scale = std::ldexp(1.0, exponent);
  const SparseMatrix<double>& ap = times_interpolation_;
  upper_.clear(restriction_.rows());
  RowSum<std::int64_t> row(upper_, place_);
  for (LocalIndex i = 0; i < restriction_.rows(); ++i) {
    for (std::size_t p = restriction_.begin(i); p < restriction_.end(i); ++p) {
      const double w = scale * static_cast<double>(restriction_.value[p]);
      for (std::size_t q = ap.begin(restriction_.column[p]); q < ap.end(restriction_.column[p]); ++q)
        if (ap.column[q] >= i) row.add(ap.column[q], static_cast<std::int64_t>(w * ap.value[q]));
    }
    upper_.end_row();
  }
  return exponent;
}

// The places of the entries, on any rank, of the upper half, row by row; and of the whole, whose columns ascend.
void Multigrid::lay_out_sums() {
  const std::int64_t n = upper_.columns;
  std::vector<std::int64_t> mine;
  mine.reserve(upper_.column.size());
  for (LocalIndex r = 0; r < upper_.rows(); ++r)
    for (std::size_t p = upper_.begin(r); p < upper_.end(r); ++p) mine.push_back(r * n + upper_.column[p]);
  std::vector<std::int64_t> all = mesh_.comm.gather(std::span<const std::int64_t>(mine));
  std::ranges::sort(all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  mesh_.comm.broadcast(all);
  sums_.assign(all.size(), 0);
  for (const std::int64_t place : mine)
    place_in_sums_.push_back(static_cast<LocalIndex>(std::ranges::lower_bound(all, place) - all.begin()));
  SparseMatrix<LocalIndex> upper;
  upper.columns = static_cast<LocalIndex>(n);
  for (std::size_t i = 0; i < all.size(); ++i) {
    while (upper.rows() < all[i] / n) upper.end_row();
    upper.add(static_cast<LocalIndex>(all[i] % n), static_cast<LocalIndex>(i));
  }
  while (upper.rows() < n) upper.end_row();
  const SparseMatrix<LocalIndex> lower = transposed(upper);
  const auto add = [this](LocalIndex column, LocalIndex place) {
    whole_.add(column, 0.0);
    place_of_whole_.push_back(place);
  };
  whole_.clear(upper.columns);
  for (LocalIndex r = 0; r < upper.rows(); ++r) {
    for (std::size_t p = lower.begin(r); p < lower.end(r); ++p)
      if (lower.column[p] < r) add(lower.column[p], lower.value[p]);
    for (std::size_t p = upper.begin(r); p < upper.end(r); ++p) add(upper.column[p], upper.value[p]);
    whole_.end_row();
  }
}

// The sum over the ranks and its mirror image, on every rank.
void Multigrid::add_up(int exponent) {
  std::ranges::fill(sums_, 0);
  for (std::size_t i = 0; i < place_in_sums_.size(); ++i)
    sums_[static_cast<std::size_t>(place_in_sums_[i])] = upper_.value[i];
  mesh_.comm.sum(sums_);
  const double unit = std::ldexp(1.0, -exponent);
  for (std::size_t i = 0; i < place_of_whole_.size(); ++i)
    whole_.value[i] = unit * static_cast<double>(sums_[static_cast<std::size_t>(place_of_whole_[i])]);
}

// Of the spectrum of D^-1 A; collective.
double Multigrid::bound(const HeatSystem& system) {
  for (std::size_t k = 0; k < rest_.size(); ++k) {
    const auto n = static_cast<std::size_t>(mesh_.owned_nodes[k]);
    const std::uint64_t id = static_cast<std::uint64_t>(mesh_.node_ids[n]) * 0x9e3779b97f4a7c15u;
    change_[n] = system.inverse_diagonal[k] > 0 ? 0.5 + static_cast<double>(id >> 40) * 0x1p-24 : 0;
    if (id >> 63) change_[n] *= -1;
  }
  return spectral_bound(MeshMatrix{mesh_, system, links_}, change_, product_);
}

void Multigrid::smooth_mesh(const HeatSystem& system, std::span<const double> r, std::span<double> z, bool from_zero) {
  const MeshMatrix a{mesh_, system, links_};
  if (from_zero) {
    std::ranges::copy(r, rest_.begin());
  } else {  // z's ghosts are those of their owners
    a.multiply_here(z, product_);
    for (std::size_t k = 0; k < rest_.size(); ++k) rest_[k] = r[k] - product_[k];
  }
  smooth(smoother_, a, from_zero, rest_, change_, product_, z);
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

// What is left of a held row is none of ours: its column of the restriction is empty, but its size would count.
void Multigrid::find_rest(const HeatSystem& system, std::span<const double> r, std::span<const double> z) {
  MeshMatrix{mesh_, system, links_}.multiply_here(z, product_);
  for (std::size_t k = 0; k < rest_.size(); ++k) rest_[k] = system.inverse_diagonal[k] > 0 ? r[k] - product_[k] : 0.0;
}

void Multigrid::apply(const HeatSystem& system, std::span<const double> r, std::span<double> z) {
  smooth_mesh(system, r, z, true);
  system.matrix.halo().forward(std::span<const double>(z), z);
  find_rest(system, r, z);
  if (ties_.any()) {
    ties_.smooth(bound_, rest_, z);
    find_rest(system, r, z);
  }
  correct(z);
  if (ties_.any()) {
    find_rest(system, r, z);
    ties_.smooth(bound_, rest_, z);
  }
  smooth_mesh(system, r, z, false);
}

std::int64_t Multigrid::memory() const {
  return interpolation_.memory() + restriction_.memory() + times_interpolation_.memory() + upper_.memory() +
         whole_.memory() + levels_.memory() + ties_.memory() +
         4 * static_cast<std::int64_t>(place_in_sums_.size() + place_of_whole_.size()) +
         static_cast<std::int64_t>(
             (links_.size() / 2 + sums_.size() + rest_.size() + product_.size() + change_.size() + 3 * coarse_.size()) *
             8);
}

}  // namespace tenon::thermal
