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
  SparseMatrix<float> interpolation;
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
    c.grid.hats(place(p), [&](LocalIndex q, double w) {
      c.interpolation.add(number[static_cast<std::size_t>(q)], static_cast<float>(w));
    });
    c.interpolation.end_row();
  }
  return c;
}

/// As chebyshev.hpp wants it; serial.
struct LevelMatrix {
  struct Sum {
    double value = 0;
    void add(double term) { value += term; }
  };
  const SparseMatrix<float>& matrix;
  const std::vector<double>& inverse;

  std::size_t rows() const { return inverse.size(); }
  double& entry(std::span<double> v, std::size_t k) const { return v[k]; }
  double inverse_diagonal(std::size_t k) const { return inverse[k]; }
  void multiply(std::span<const double> v, std::span<double> out) const { thermal::multiply(matrix, v, out); }
  double row_size(std::size_t k) const {
    double sum = 0;
    const auto r = static_cast<LocalIndex>(k);
    for (std::size_t p = matrix.begin(r); p < matrix.end(r); ++p) sum += std::abs(static_cast<double>(matrix.value[p]));
    return sum;
  }
  static std::array<double, 2> sums(const std::array<Sum, 2>& local) { return {local[0].value, local[1].value}; }
  static double greatest(double local) { return local; }
};

}  // namespace

void CoarseLevels::lay_out(const RectilinearGrid& grid, std::vector<LocalIndex> points) {
  levels_.clear();
  levels_.emplace_back();
  RectilinearGrid finer = grid;
  for (;;) {
    Level& level = levels_.back();
    for (std::vector<double>* v :
         {&level.inverse_diagonal, &level.right_side, &level.x, &level.rest, &level.change, &level.product})
      v->assign(points.size(), 0.0);
    if (static_cast<LocalIndex>(points.size()) <= few_points || finer.points() <= 8) return;
    Coarsening c = coarsen(finer, points);
    level.to_coarse = transposed(c.interpolation);
    level.from_coarse = std::move(c.interpolation);
    finer = std::move(c.grid);
    points = std::move(c.points);
    levels_.emplace_back();
  }
}

void CoarseLevels::fill(const SparseMatrix<double>& matrix) {
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    Level& level = levels_[l];
    const SparseMatrix<double>& mine = l == 0 ? matrix : level.exact;
    fill_level(level, mine);
    if (l + 1 == levels_.size()) return factor(mine);
    product(mine, level.from_coarse, level.half, place_);
    product(level.to_coarse, level.half, levels_[l + 1].exact, place_);
  }
}

void CoarseLevels::fill_level(Level& level, const SparseMatrix<double>& matrix) {
  std::ranges::fill(level.inverse_diagonal, 0.0);
  for (LocalIndex r = 0; r < matrix.rows(); ++r)
    for (std::size_t p = matrix.begin(r); p < matrix.end(r); ++p)
      if (matrix.column[p] == r && matrix.value[p] > 0)
        level.inverse_diagonal[static_cast<std::size_t>(r)] = 1 / matrix.value[p];
  make_single(matrix, level.matrix);
  for (std::size_t i = 0; i < level.x.size(); ++i)
    level.x[i] = (i % 2 ? -1.0 : 1.0) + 1e-2 * static_cast<double>(i * 2654435761u % 97);
  level.smoother = Chebyshev(spectral_bound(LevelMatrix{level.matrix, level.inverse_diagonal}, level.x, level.product));
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

void CoarseLevels::smooth_level(Level& level, bool from_zero) {
  if (from_zero)
    std::ranges::copy(level.right_side, level.rest.begin());
  else
    residual(level.matrix, level.x, level.right_side, level.rest);
  smooth(level.smoother, LevelMatrix{level.matrix, level.inverse_diagonal}, from_zero, level.rest, level.change,
         level.product, level.x);
}

void CoarseLevels::cycle(std::size_t l) {
  Level& level = levels_[l];
  if (l + 1 == levels_.size()) {
    if (level.matrix.rows() <= few_points) return solve_directly(level);
    smooth_level(level, true);
    return smooth_level(level, false);
  }
  smooth_level(level, true);
  residual(level.matrix, level.x, level.right_side, level.rest);
  multiply(level.to_coarse, level.rest, levels_[l + 1].right_side);
  cycle(l + 1);
  multiply(level.from_coarse, levels_[l + 1].x, level.rest);
  for (std::size_t i = 0; i < level.x.size(); ++i) level.x[i] += level.rest[i];
  smooth_level(level, false);
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
    bytes += l.exact.memory() + l.half.memory() + l.matrix.memory() + l.to_coarse.memory() + l.from_coarse.memory() +
             static_cast<std::int64_t>(6 * l.x.size()) * 8;
  return bytes;
}

}  // namespace tenon::thermal
