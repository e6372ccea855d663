// SPDX-License-Identifier: BSD-3-Clause
// Which points are within reach of which: lists that stay good while nobody has moved far.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "framework/base/types.hpp"

namespace tenon {

/// Cubic cells over all of space, whose number gives points their canonical order: by cell (z, then y, then x), then by
/// id, then by image. It is the same on any number of ranks.
class CellGrid {
 public:
  /// Cells of edge `size`, m.
  explicit CellGrid(double size = 1) : scale_(1 / size) {}
  using Key = std::uint64_t;
  /// Points beyond a million cells from the origin count as there; those that are not finite come last.
  Key key(const Vec3& x) const { return part(x[2]) << 2 * bits | part(x[1]) << bits | part(x[0]); }
  /// The key of the cell one further along x, y and z.
  static constexpr Key step_x = 1, step_y = Key{1} << 21, step_z = Key{1} << 42;
  /// The column of cells along z, some cells wide, that a cell is in.
  static Key tile(Key cell) {
    constexpr Key part_of_row = ((Key{1} << bits) - 1) >> tile_bits << tile_bits;
    return cell & (part_of_row << bits | part_of_row);
  }

 private:
  static constexpr int bits = 21, tile_bits = 3;
  static constexpr double half = 1 << 20;
  // Never the first or the last cell of a row: what is beside a cell is never in another row.
  Key part(double x) const {
    const double cell = x * scale_;
    if (!(cell > 1 - half)) return cell == cell ? 1 : static_cast<Key>(2 * half) - 2;
    const double place = cell < half - 2 ? cell : half - 2;
    return static_cast<Key>(static_cast<std::int64_t>(place + half));
  }
  double scale_;
};

/// Points that neighbour lists are made of: those that this rank owns, in canonical order, then copies of others in
/// any.
struct ListedPoints {
  std::span<const Vec3> places;   ///< m
  std::span<const double> reach;  ///< m: two points meet when nearer than the greater of theirs
  std::span<const GlobalId> ids;
  std::span<const std::uint8_t> image;  ///< which copy of the point it is; 0 for the point itself
  std::size_t owned = 0;
};

/// Where a search is given up: the rest of the lists stays empty, and pairs() or tested() is beyond its limit.
struct NeighbourLimits {
  std::int64_t pairs = std::numeric_limits<std::int64_t>::max(), tested = std::numeric_limits<std::int64_t>::max();
};

/// Verlet lists [Ver67]: for each owned point all others nearer than the greater of both reaches and a skin, in
/// canonical order. Local. Nothing is missed until the ways of two points add up to the skin. Memory grows and stays.
class NeighbourLists {
 public:
  /// `skin` in m. Every rank has the same `greatest_reach`, m: it and the skin are the edge of a cell.
  void build(const ListedPoints& points, double greatest_reach, double skin, const NeighbourLimits& most = {});
  /// The same cells and order, with the pairs as they are now: for runs that trust no skin.
  void build_again(const ListedPoints& points, double skin, const NeighbourLimits& most = {});

  /// Places in the arrays of the points, in canonical order; without the point itself. Seven more may be read behind
  /// them: places of some points.
  std::span<const LocalIndex> of(std::size_t owned) const {
    return std::span(list_).subspan(begin_[owned], begin_[owned + 1] - begin_[owned]);
  }
  /// The owned points in another order, by tiles of cells: who works through them so finds what is near in the cache.
  struct Run {
    std::size_t first, last;
  };
  std::span<const Run> runs() const { return runs_; }
  std::size_t pairs() const { return begin_.empty() ? 0 : begin_.back(); }
  /// Distances that the search looked at.
  std::int64_t tested() const { return tested_; }
  std::size_t longest() const { return longest_; }
  std::int64_t memory() const;

  static CellGrid cells(double greatest_reach, double skin) { return CellGrid(greatest_reach + skin); }

 private:
  void sort(const ListedPoints& points, const CellGrid& grid);
  void find_runs(std::span<const CellGrid::Key> owned);
  void fill(const ListedPoints& points, double skin, const NeighbourLimits& most);
  std::size_t append(std::size_t place, double skin, std::size_t end);

  static constexpr std::size_t rows = 9;
  std::vector<Run> runs_;
  std::vector<std::size_t> begin_;
  std::vector<LocalIndex> list_;
  std::size_t longest_ = 0;
  std::int64_t tested_ = 0;
  // In canonical order, owned and copies.
  std::vector<LocalIndex> order_;
  std::vector<CellGrid::Key> keys_;
  std::vector<double> x_, y_, z_, reach_;
  std::array<std::size_t, rows> first_{}, last_{};
};

}  // namespace tenon
