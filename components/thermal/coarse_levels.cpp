// SPDX-License-Identifier: BSD-3-Clause
#include "components/thermal/coarse_levels.hpp"

#include <algorithm>
#include <cmath>

namespace tenon::thermal {
namespace {

constexpr LocalIndex few_points = 80;  // solved directly

/// Points of a grid that carry a hat with something below it, and the interpolation to the points of the finer grid.
struct Coarsening {
  RectilinearGrid grid;
  std::vector<LocalIndex> points;
  SparseMatrix<double> interpolation;
};

Coarsening coarsen(const RectilinearGrid& fine, const std::vector<LocalIndex>& points) {
  Coarsening c{fine.coarsened(), {}, {}};
  const auto nx = static_cast<LocalIndex>(fine.lines[0].size()), ny = static_cast<LocalIndex>(fine.lines[1].size());
  std::vector<LocalIndex> number(static_cast<std::size_t>(c.grid.points()), no_index);
  const auto place = [&](LocalIndex p) {
    return Vec3{fine.lines[0][static_cast<std::size_t>(p % nx)], fine.lines[1][static_cast<std::size_t>(p / nx % ny)],
                fine.lines[2][static_cast<std::size_t>(p / nx / ny)]};
  };
  for (const LocalIndex p : points)
    c.grid.hats(place(p), [&](LocalIndex q, double) { number[static_cast<std::size_t>(q)] = 0; });
  for (std::size_t q = 0; q < number.size(); ++q)
    if (number[q] == 0) {
      number[q] = static_cast<LocalIndex>(c.points.size());
      c.points.push_back(static_cast<LocalIndex>(q));
    }
  c.interpolation.columns = static_cast<LocalIndex>(c.points.size());
  for (const LocalIndex p : points) {
    c.grid.hats(place(p), [&](LocalIndex q, double w) { c.interpolation.add(number[static_cast<std::size_t>(q)], w); });
    c.interpolation.end_row();
  }
  return c;
}

/// By power iteration: near the greatest eigenvalue of D^-1 A, unless its eigenvector is a rare one.
double power_iteration(const SparseMatrix<float>& a, const std::vector<double>& inverse_diagonal) {
  constexpr int turns = 12;
  const std::size_t n = inverse_diagonal.size();
  std::vector<double> x(n), y(n);
  for (std::size_t i = 0; i < n; ++i) x[i] = (i % 2 ? -1.0 : 1.0) + 1e-2 * static_cast<double>(i * 2654435761u % 97);
  double greatest = 0;
  for (int turn = 0; turn < turns; ++turn) {
    multiply(a, x, y);
    double above = 0, below = 0, size = 0;
    for (std::size_t i = 0; i < n; ++i) {
      above += x[i] * y[i];
      below += inverse_diagonal[i] > 0 ? x[i] * x[i] / inverse_diagonal[i] : 0;
      y[i] *= inverse_diagonal[i];
      size = std::max(size, std::abs(y[i]));
    }
    if (!(size > 0) || !(below > 0)) break;
    greatest = std::max(greatest, above / below);
    for (std::size_t i = 0; i < n; ++i) x[i] = y[i] / size;
  }
  return greatest;
}

/// Greatest sum of the sizes of a row of D^-1 A: above every eigenvalue (Gershgorin).
double greatest_row(const SparseMatrix<float>& a, const std::vector<double>& inverse_diagonal) {
  double greatest = 0;
  for (LocalIndex r = 0; r < a.rows(); ++r) {
    double sum = 0;
    for (std::size_t p = a.begin(r); p < a.end(r); ++p) sum += std::abs(static_cast<double>(a.value[p]));
    greatest = std::max(greatest, sum * inverse_diagonal[static_cast<std::size_t>(r)]);
  }
  return greatest;
}

}  // namespace

// A regular mesh has few modes at the top of its spectrum, all below 2, which power iteration may miss; a bad element
// has one of its own far above the rest, which it finds. The polynomial bears a quarter more than the bound.
double Chebyshev::bound(double power, double row) {
  constexpr double margin = 1.1, regular = 2;
  return row > 0 ? std::min(row, std::max(margin * power, regular)) : 1.0;
}

void CoarseLevels::build(const RectilinearGrid& grid, std::vector<LocalIndex> points, SparseMatrix<double> matrix) {
  levels_.clear();
  add_level(matrix);
  RectilinearGrid finer = grid;
  const auto times = [](double a, double b) { return a * b; };
  while (matrix.rows() > few_points && finer.points() > 8) {
    Coarsening c = coarsen(finer, points);
    const SparseMatrix<double> to_coarse = transposed(c.interpolation);
    matrix = product<double>(to_coarse, product<double>(matrix, c.interpolation, times), times);
    levels_.back().to_coarse = single(to_coarse);
    levels_.back().from_coarse = single(c.interpolation);
    add_level(matrix);
    finer = std::move(c.grid);
    points = std::move(c.points);
  }
  factor(matrix);
}

void CoarseLevels::add_level(const SparseMatrix<double>& matrix) {
  Level level;
  const auto n = static_cast<std::size_t>(matrix.rows());
  level.inverse_diagonal.assign(n, 0.0);
  for (LocalIndex r = 0; r < matrix.rows(); ++r)
    for (std::size_t p = matrix.begin(r); p < matrix.end(r); ++p)
      if (matrix.column[p] == r && matrix.value[p] > 0)
        level.inverse_diagonal[static_cast<std::size_t>(r)] = 1 / matrix.value[p];
  for (std::vector<double>* v : {&level.right_side, &level.x, &level.rest, &level.change}) v->assign(n, 0.0);
  level.matrix = single(matrix);
  level.smoother = Chebyshev(Chebyshev::bound(power_iteration(level.matrix, level.inverse_diagonal),
                                              greatest_row(level.matrix, level.inverse_diagonal)));
  levels_.push_back(std::move(level));
}

// A pivot that is round-off (hats that depend on each other on few nodes) takes no part: the inverse of what is left.
void CoarseLevels::factor(const SparseMatrix<double>& a) {
  constexpr double round_off = 1e-10;
  const auto n = a.rows() <= few_points ? static_cast<std::size_t>(a.rows()) : 0;
  factor_.assign(n * n, 0.0);
  for (LocalIndex r = 0; r < static_cast<LocalIndex>(n); ++r)
    for (std::size_t p = a.begin(r); p < a.end(r); ++p)
      factor_[static_cast<std::size_t>(r) * n + static_cast<std::size_t>(a.column[p])] += a.value[p];
  for (std::size_t k = 0; k < n; ++k) {
    const double diagonal = factor_[k * n + k], own = levels_.back().inverse_diagonal[k];
    const double inverse = diagonal * own > round_off ? 1 / diagonal : 0;
    for (std::size_t i = k + 1; i < n; ++i) {
      const double l = factor_[i * n + k] * inverse;
      for (std::size_t j = k + 1; j <= i; ++j) factor_[i * n + j] -= l * factor_[j * n + k];
    }
    for (std::size_t i = k + 1; i < n; ++i) factor_[i * n + k] *= inverse;
    factor_[k * n + k] = inverse;
  }
}

void CoarseLevels::solve_directly(Level& level) const {
  const std::size_t n = level.x.size();
  std::vector<double>& x = level.x;
  std::ranges::copy(level.right_side, x.begin());
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < i; ++j) x[i] -= factor_[i * n + j] * x[j];
  for (std::size_t i = 0; i < n; ++i) x[i] *= factor_[i * n + i];
  for (std::size_t i = n; i-- > 0;)
    for (std::size_t j = i + 1; j < n; ++j) x[i] -= factor_[j * n + i] * x[j];
}

void CoarseLevels::smooth(Level& level, bool from_zero) {
  const Chebyshev& c = level.smoother;
  const std::size_t n = level.x.size();
  if (from_zero)
    std::ranges::copy(level.right_side, level.rest.begin());
  else
    residual(level.matrix, level.x, level.right_side, level.rest);
  const double sigma = c.theta / c.delta;
  double rho = 1 / sigma;
  for (std::size_t i = 0; i < n; ++i) {
    level.change[i] = level.inverse_diagonal[i] * level.rest[i] / c.theta;
    level.x[i] = from_zero ? level.change[i] : level.x[i] + level.change[i];
  }
  for (int step = 1; step < Chebyshev::degree; ++step) {
    residual(level.matrix, level.change, level.rest, level.rest);
    const double next = 1 / (2 * sigma - rho);
    for (std::size_t i = 0; i < n; ++i) {
      level.change[i] = next * rho * level.change[i] + 2 * next / c.delta * level.inverse_diagonal[i] * level.rest[i];
      level.x[i] += level.change[i];
    }
    rho = next;
  }
}

void CoarseLevels::cycle(std::size_t l) {
  Level& level = levels_[l];
  if (l + 1 == levels_.size()) {
    if (level.matrix.rows() <= few_points) return solve_directly(level);
    smooth(level, true);
    return smooth(level, false);
  }
  smooth(level, true);
  residual(level.matrix, level.x, level.right_side, level.rest);
  multiply(level.to_coarse, level.rest, levels_[l + 1].right_side);
  cycle(l + 1);
  multiply(level.from_coarse, levels_[l + 1].x, level.rest);
  for (std::size_t i = 0; i < level.x.size(); ++i) level.x[i] += level.rest[i];
  smooth(level, false);
}

void CoarseLevels::solve(std::span<const double> b, std::span<double> result) {
  if (b.empty()) return;
  std::ranges::copy(b, levels_.front().right_side.begin());
  cycle(0);
  std::ranges::copy(levels_.front().x, result.begin());
}

std::int64_t CoarseLevels::memory() const {
  std::int64_t bytes = static_cast<std::int64_t>(factor_.size()) * 8;
  for (const Level& l : levels_)
    bytes += l.matrix.memory() + l.to_coarse.memory() + l.from_coarse.memory() +
             static_cast<std::int64_t>(5 * l.x.size()) * 8;
  return bytes;
}

}  // namespace tenon::thermal
