// SPDX-License-Identifier: BSD-3-Clause
#include "framework/search/neighbour_lists.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

#include "framework/base/wide_pack.hpp"

namespace tenon {

void NeighbourLists::build(const ListedPoints& points, double greatest_reach, double skin) {
  sort(points, cells(greatest_reach, skin));
  fill(points, skin);
}

void NeighbourLists::build_again(const ListedPoints& points, double skin) {
  fill(points, skin);
}

// The owned ones are in order; the copies are sorted and merged with them.
void NeighbourLists::sort(const ListedPoints& points, const CellGrid& grid) {
  const std::size_t count = points.places.size();
  std::vector<CellGrid::Key> keys(count);
  for (std::size_t i = 0; i < count; ++i) keys[i] = grid.key(points.places[i]);
  const auto before = [&](LocalIndex a, LocalIndex b) {
    const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
    if (keys[i] != keys[j]) return keys[i] < keys[j];
    if (points.ids[i] != points.ids[j]) return points.ids[i] < points.ids[j];
    return points.image[i] < points.image[j];
  };
  order_.resize(count);
  std::iota(order_.begin(), order_.end(), 0);
  const auto copies = order_.begin() + static_cast<std::ptrdiff_t>(points.owned);
  std::sort(copies, order_.end(), before);
  std::inplace_merge(order_.begin(), copies, order_.end(), before);
  keys_.resize(count);
  for (std::size_t m = 0; m < count; ++m) keys_[m] = keys[static_cast<std::size_t>(order_[m])];
}

void NeighbourLists::fill(const ListedPoints& points, double skin) {
  const std::size_t count = order_.size(), room = count + wide_pack_width;
  for (std::vector<double>* const array : {&x_, &y_, &z_}) array->resize(room);
  reach_.resize(room);
  for (std::size_t m = 0; m < count; ++m) {
    const auto i = static_cast<std::size_t>(order_[m]);
    x_[m] = points.places[i][0], y_[m] = points.places[i][1], z_[m] = points.places[i][2];
    reach_[m] = points.reach[i];
  }
  begin_.assign(1, 0);
  begin_.reserve(points.owned + 1);
  list_.clear();
  longest_ = 0;
  first_.fill(0), last_.fill(0);
  CellGrid::Key cell = 0;
  for (std::size_t m = 0; m < count; ++m) {
    if (static_cast<std::size_t>(order_[m]) >= points.owned) continue;
    // Keys ascend, and so do those of the nine rows of cells around: each row is walked through once.
    for (std::size_t row = 0; row < rows && (begin_.size() == 1 || keys_[m] != cell); ++row) {
      const CellGrid::Key middle =
          keys_[m] + (row / 3) * CellGrid::step_z + (row % 3) * CellGrid::step_y - CellGrid::step_z - CellGrid::step_y;
      while (first_[row] < count && keys_[first_[row]] < middle - CellGrid::step_x) ++first_[row];
      while (last_[row] < count && keys_[last_[row]] <= middle + CellGrid::step_x) ++last_[row];
    }
    cell = keys_[m];
    append(m, points, skin);
    longest_ = std::max(longest_, list_.size() - begin_.back());
    begin_.push_back(list_.size());
  }
  list_.resize(list_.size() + wide_pack_width, 0);  // what reads whole packs may read on
}

void NeighbourLists::append(std::size_t place, const ListedPoints&, double skin) {
  const WidePack x = broadcast<WidePack>(x_[place]), y = broadcast<WidePack>(y_[place]),
                 z = broadcast<WidePack>(z_[place]), reach = broadcast<WidePack>(reach_[place]);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t m = first_[row]; m < last_[row]; m += wide_pack_width) {
      const WidePack dx = load_wide(&x_[m]) - x, dy = load_wide(&y_[m]) - y, dz = load_wide(&z_[m]) - z;
      const WidePack together = greater_of<WidePack>(load_wide(&reach_[m]), reach) + skin;
      unsigned near = bits(dx * dx + dy * dy + dz * dz < together * together);
      const std::size_t left = last_[row] - m;
      if (left < wide_pack_width) near &= (1u << left) - 1;
      for (; near != 0; near &= near - 1) {
        const std::size_t other = m + static_cast<std::size_t>(std::countr_zero(near));
        if (other != place) list_.push_back(order_[other]);
      }
    }
  }
}

std::int64_t NeighbourLists::memory() const {
  return static_cast<std::int64_t>(begin_.capacity() * sizeof(std::size_t) + list_.capacity() * sizeof(LocalIndex) +
                                   order_.capacity() * (sizeof(LocalIndex) + sizeof(CellGrid::Key)) +
                                   4 * x_.capacity() * sizeof(double));
}

}  // namespace tenon
