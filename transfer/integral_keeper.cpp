// SPDX-License-Identifier: BSD-3-Clause
#include "transfer/integral_keeper.hpp"

#include <algorithm>
#include <cmath>

#include "transfer/element_points.hpp"

namespace tenon::transfer {

IntegralKeeper::IntegralKeeper(const Side& source, const Side& target, std::span<const double> volumes)
    : comm_(target.mesh.comm), source_owned_(source.items.owned.begin(), source.items.owned.end()) {
  const std::vector<double> all = item_volumes(source.mesh, source.coordinates, source.location);
  for (const LocalIndex i : source_owned_) source_volumes_.push_back(all[static_cast<std::size_t>(i)]);
  ExactSum sum;
  for (std::size_t i = 0; i < target.items.ids.size(); ++i) {
    const bool owned = target.items.owners[i] == comm_.rank();
    if (owned) sum.add(volumes[i]);
    if (owned || target.location == Location::element) rows_.push_back({static_cast<LocalIndex>(i), owned, volumes[i]});
  }
  volume_ = comm_.sum(sum);
}

void IntegralKeeper::begin(std::span<const double> source, std::size_t width) const {
  if (local_.size() < width * sums) local_.resize(width * sums), global_.resize(width * sums);
  for (std::size_t k = 0; k < width * sums; ++k) local_[k].clear();
  for (std::size_t k = 0; k < source_owned_.size(); ++k)
    for (std::size_t c = 0; c < width; ++c)
      sum(of_source, c).add_product(source_volumes_[k], source[static_cast<std::size_t>(source_owned_[k]) * width + c]);
}

void IntegralKeeper::keep(std::span<const double> source, std::span<double> target, int components,
                          ProjectionOutcome& outcome) const {
  const auto width = static_cast<std::size_t>(components);
  begin(source, width);
  for (const Row& row : rows_) {
    if (!row.owned) continue;
    for (std::size_t c = 0; c < width; ++c) {
      const double u = target[static_cast<std::size_t>(row.item) * width + c];
      sum(of_target, c).add_product(row.volume, u);
      sum(magnitude, c).add_product(row.volume, std::abs(u));
    }
  }
  comm_.sum(std::span<const ExactSum>(local_).first(width * sums), global_);
  for (std::size_t c = 0; c < width; ++c) {
    const double rest = total(of_source, c) - total(of_target, c), scale = total(magnitude, c);
    if (rest == 0) continue;
    outcome.spread = std::max(outcome.spread, std::abs(rest) / (scale > 0 ? scale : std::abs(rest)));
    const bool in_proportion = std::abs(rest) <= scale;
    const double factor = in_proportion ? rest / scale : 0.0;
    const double shift = in_proportion || !(volume_ > 0) ? 0.0 : rest / volume_;
    for (const Row& row : rows_) {
      double& u = target[static_cast<std::size_t>(row.item) * width + c];
      u += factor * std::abs(u) + shift;
    }
  }
}

void IntegralKeeper::clip(std::span<double> target, int components, std::span<const double> low,
                          std::span<const double> high, ProjectionOutcome& outcome) const {
  constexpr double negligible = 1e-6;  // of the greatest value: not worth telling
  const auto width = static_cast<std::size_t>(components);
  double greatest = 0;
  for (const double v : high)
    if (std::isfinite(v)) greatest = std::max(greatest, std::abs(v));
  const double margin = negligible * comm_.max(greatest);
  std::int64_t clipped = 0;
  taken_.assign(rows_.size() * width, 0.0);
  for (std::size_t k = 0; k < rows_.size(); ++k)
    for (std::size_t c = 0; c < width; ++c) {
      double& u = target[static_cast<std::size_t>(rows_[k].item) * width + c];
      const double least = low[k * width + c], most = high[k * width + c];
      if (!(least <= most)) continue;
      clipped += rows_[k].owned && (u < least - margin || u > most + margin);
      const double kept = std::clamp(u, least, most);
      taken_[k * width + c] = rows_[k].volume * (u - kept);
      u = kept;
    }
  outcome.clipped = comm_.sum(clipped);
}

// Every node tells how much room it has, then, how much of its neighbours' room it asks for: room and part are pairs
// (above, below) for each component. A node that is asked for more than it has gives all.
void IntegralKeeper::give_to_neighbours(const SparseRows<float>& neighbours, const ExchangePlan& halo,
                                        std::span<double> target, int components, std::span<const double> low,
                                        std::span<const double> high) const {
  const auto width = static_cast<std::size_t>(components);
  room_.resize(2 * target.size()), part_.assign(2 * target.size(), 0.0);
  const auto at = [&](std::size_t row, std::size_t c) { return static_cast<std::size_t>(rows_[row].item) * width + c; };
  const auto share = [&](std::vector<double>& values) {
    if (comm_.size() > 1) halo.forward(std::span<const double>(values), std::span<double>(values), 2 * components);
  };
  const auto sum_around = [&](const std::vector<double>& values, std::size_t row, std::size_t entry) {
    double sum = 0;
    for (std::size_t k = neighbours.first(row); k < neighbours.last(row); ++k)
      sum += values[2 * static_cast<std::size_t>(neighbours.column[k]) * width + entry];
    return sum;
  };
  for (std::size_t k = 0; k < rows_.size(); ++k)
    for (std::size_t c = 0; c < width; ++c) {
      const double u = target[at(k, c)];
      room_[2 * at(k, c)] = rows_[k].volume * std::max(0.0, high[k * width + c] - u);
      room_[2 * at(k, c) + 1] = rows_[k].volume * std::max(0.0, u - low[k * width + c]);
    }
  share(room_);
  for (std::size_t k = 0; k < rows_.size(); ++k)
    for (std::size_t c = 0; c < width; ++c) {
      const double taken = taken_[k * width + c];
      if (taken == 0) continue;
      const std::size_t below = taken < 0;
      const double room = sum_around(room_, k, 2 * c + below);
      if (room > 0) part_[2 * at(k, c) + below] = std::min(1.0, std::abs(taken) / room);
    }
  share(part_);
  for (std::size_t k = 0; k < rows_.size(); ++k)
    for (std::size_t c = 0; c < width; ++c) {
      const double above = std::min(1.0, sum_around(part_, k, 2 * c));
      const double below = std::min(1.0, sum_around(part_, k, 2 * c + 1));
      double& u = target[at(k, c)];
      const double up = above > 0 ? above * (high[k * width + c] - u) : 0.0;
      const double down = below > 0 ? below * (u - low[k * width + c]) : 0.0;
      if (above > 0 || below > 0) u = std::clamp(u + (up - down), low[k * width + c], high[k * width + c]);
    }
}

void IntegralKeeper::keep_within(std::span<const double> source, std::span<double> target, int components,
                                 std::span<const double> low, std::span<const double> high,
                                 ProjectionOutcome& outcome) const {
  const auto width = static_cast<std::size_t>(components);
  begin(source, width);
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const Row& row = rows_[k];
    if (!row.owned) continue;
    for (std::size_t c = 0; c < width; ++c) {
      const double u = target[static_cast<std::size_t>(row.item) * width + c];
      sum(of_target, c).add_product(row.volume, u);
      sum(magnitude, c).add_product(row.volume, std::abs(u));
      sum(room_above, c).add_product(row.volume, std::max(0.0, high[k * width + c] - u));
      sum(room_below, c).add_product(row.volume, std::max(0.0, u - low[k * width + c]));
    }
  }
  comm_.sum(std::span<const ExactSum>(local_).first(width * sums), global_);
  for (std::size_t c = 0; c < width; ++c) {
    const double rest = total(of_source, c) - total(of_target, c);
    if (rest == 0) continue;
    const double room = total(rest > 0 ? room_above : room_below, c);
    const double placed = std::min(std::abs(rest), room), scale = total(magnitude, c) > 0 ? total(magnitude, c) : 1.0;
    // Round-off of the sums is not worth telling.
    const double unplaced = std::abs(rest) - placed;
    outcome.spread = std::max(outcome.spread, placed / scale);
    outcome.unplaced = std::max(outcome.unplaced, unplaced / scale);
    const double part = room > 0 ? placed / room : 0.0;
    const std::span<const double> bound = rest > 0 ? high : low;
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      double& u = target[static_cast<std::size_t>(rows_[k].item) * width + c];
      const double to = bound[k * width + c];
      if (std::isfinite(to)) u = part < 1 ? u + part * (to - u) : to;
    }
  }
}

std::int64_t IntegralKeeper::memory() const {
  const auto bytes = [](const auto& v) { return static_cast<std::int64_t>(v.capacity() * sizeof(v[0])); };
  return bytes(source_owned_) + bytes(source_volumes_) + bytes(rows_) + bytes(local_) + bytes(global_) + bytes(taken_) +
         bytes(room_) + bytes(part_);
}

}  // namespace tenon::transfer
