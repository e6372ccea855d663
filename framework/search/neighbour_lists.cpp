// SPDX-License-Identifier: BSD-3-Clause
#include "framework/search/neighbour_lists.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

#include "framework/base/wide_pack.hpp"

namespace tenon {

void NeighbourLists::build(const ListedPoints& points, double greatest_reach, double skin,
                           const NeighbourLimits& most) {
  sort(points, cells(greatest_reach, skin));
  fill(points, skin, most);
}

void NeighbourLists::build_again(const ListedPoints& points, double skin, const NeighbourLimits& most) {
  fill(points, skin, most);
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
  find_runs(std::span(keys).first(points.owned));
}

// A row of cells goes through the whole domain, and three layers of rows are more than a cache holds; three layers of a
// tile are less.
void NeighbourLists::find_runs(std::span<const CellGrid::Key> owned) {
  runs_.clear();
  for (std::size_t i = 0; i < owned.size(); ++i) {
    const bool same = i > 0 && CellGrid::tile(owned[i]) == CellGrid::tile(owned[i - 1]) &&
                      owned[i] - owned[i - 1] < CellGrid::step_y / 2;
    if (same)
      runs_.back().last = i + 1;
    else
      runs_.push_back({i, i + 1});
  }
  std::ranges::stable_sort(runs_, {}, [&](const Run& run) { return CellGrid::tile(owned[run.first]); });
}

void NeighbourLists::fill(const ListedPoints& points, double skin, const NeighbourLimits& most) {
  const std::size_t count = keys_.size(), room = count + wide_pack_width;
  for (std::vector<double>* const array : {&x_, &y_, &z_}) array->resize(room);
  order_.resize(room, 0);
  reach_.resize(room);
  for (std::size_t m = 0; m < count; ++m) {
    const auto i = static_cast<std::size_t>(order_[m]);
    x_[m] = points.places[i][0], y_[m] = points.places[i][1], z_[m] = points.places[i][2];
    reach_[m] = points.reach[i];
  }
  begin_.assign(1, 0);
  begin_.reserve(points.owned + 1);
  std::size_t end = 0;
  longest_ = 0, tested_ = 0;
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
    for (std::size_t row = 0; row < rows; ++row) tested_ += static_cast<std::int64_t>(last_[row] - first_[row]);
    if (tested_ <= most.tested && static_cast<std::int64_t>(end) <= most.pairs) end = append(m, skin, end);
    longest_ = std::max(longest_, end - begin_.back());
    begin_.push_back(end);
  }
  list_.resize(std::max(list_.size(), end + wide_pack_width));
  std::fill_n(list_.begin() + static_cast<std::ptrdiff_t>(end), wide_pack_width, 0);  // whole packs may be read
}

// Returns where the next list begins. The array keeps its greatest size, so nothing is written twice.
std::size_t NeighbourLists::append(std::size_t place, double skin, std::size_t end) {
  const WidePack x = broadcast<WidePack>(x_[place]), y = broadcast<WidePack>(y_[place]),
                 z = broadcast<WidePack>(z_[place]), reach = broadcast<WidePack>(reach_[place]);
  std::size_t most = wide_pack_width;
  for (std::size_t row = 0; row < rows; ++row) most += last_[row] - first_[row];
  if (list_.size() < end + most) list_.resize(std::max(end + most, 2 * list_.size()));
  const double *const all_x = x_.data(), *const all_y = y_.data(), *const all_z = z_.data(),
                      *const reaches = reach_.data();
  const LocalIndex* const order = order_.data();
  LocalIndex* const list = list_.data();
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t last = last_[row];
    for (std::size_t m = first_[row]; m < last; m += wide_pack_width) {
      const WidePack dx = load_wide(all_x + m) - x, dy = load_wide(all_y + m) - y, dz = load_wide(all_z + m) - z;
      const WidePack together = greater_of<WidePack>(load_wide(reaches + m), reach) + skin;
      unsigned near = where_less(dx * dx + dy * dy + dz * dz, together * together);
      const std::size_t left = last - m, self = place - m;
      if (left < wide_pack_width) near &= (1u << left) - 1;
      if (self < wide_pack_width) near &= ~(1u << self);
      store_chosen(list + end, order + m, near);
      end += static_cast<std::size_t>(std::popcount(near));
    }
  }
  return end;
}

std::int64_t NeighbourLists::memory() const {
  return static_cast<std::int64_t>(begin_.capacity() * sizeof(std::size_t) + list_.capacity() * sizeof(LocalIndex) +
                                   order_.capacity() * (sizeof(LocalIndex) + sizeof(CellGrid::Key)) +
                                   4 * x_.capacity() * sizeof(double));
}

}  // namespace tenon
