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
  constexpr double round_off = 1e-12;  // of the bounds: not worth telling
  const auto width = static_cast<std::size_t>(components);
  std::int64_t clipped = 0;
  for (std::size_t k = 0; k < rows_.size(); ++k)
    for (std::size_t c = 0; c < width; ++c) {
      double& u = target[static_cast<std::size_t>(rows_[k].item) * width + c];
      const double least = low[k * width + c], greatest = high[k * width + c];
      if (!(least <= greatest)) continue;
      const double margin = round_off * std::max(std::abs(least), std::abs(greatest));
      clipped += rows_[k].owned && (u < least - margin || u > greatest + margin);
      u = std::clamp(u, least, greatest);
    }
  outcome.clipped = comm_.sum(clipped);
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
      if (std::isfinite(to)) u += part * (to - u);
    }
  }
}

std::int64_t IntegralKeeper::memory() const {
  const auto bytes = [](const auto& v) { return static_cast<std::int64_t>(v.capacity() * sizeof(v[0])); };
  return bytes(source_owned_) + bytes(source_volumes_) + bytes(rows_) + bytes(local_) + bytes(global_);
}

}  // namespace tenon::transfer
