// SPDX-License-Identifier: BSD-3-Clause
#include "framework/decomposition/rcb.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/decomposition/zoltan_partitioner.hpp"

namespace tenon {

struct Rcb::Impl {
  Impl(const Communicator& comm_in, int parts_in)
      : comm(comm_in),
        parts(parts_in),
        found_ranks(static_cast<std::size_t>(std::max(parts, comm.size()))),
        found_parts(found_ranks.size()) {
    if (parts == 1) return;
    zoltan = std::make_unique<ZoltanPartitioner>(comm, parts);
    zoltan->set("LB_METHOD", "RCB");
    zoltan->set("KEEP_CUTS", "1");
    zoltan->set("RCB_LOCK_DIRECTIONS", "1");  // otherwise cuts turn, and half of all points move
    zoltan->set("AVERAGE_CUTS", "1");         // cuts between points: fewer boxes of a regular mesh touch them
    zoltan->set("CHECK_GEOM", "0");
  }

  Communicator comm;
  int parts;
  std::unique_ptr<ZoltanPartitioner> zoltan;  // none for one part
  bool has_cuts = false;
  std::vector<int> found_ranks, found_parts;
};

Rcb::Rcb(const Communicator& comm) : Rcb(comm, comm.size()) {}

Rcb::Rcb(const Communicator& comm, int parts) : impl_(std::make_shared<Impl>(comm, parts)) {}

std::vector<int> Rcb::partition(std::span<const Vec3> coordinates, std::span<const double> weights) {
  std::vector<int> part(coordinates.size(), 0);
  if (!impl_->zoltan) return part;
  // Bisection would not end with a coordinate that is not finite; such points stay on rank 0.
  std::vector<std::size_t> kept;
  kept.reserve(coordinates.size());
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    if (std::isfinite(coordinates[i][0]) && std::isfinite(coordinates[i][1]) && std::isfinite(coordinates[i][2]))
      kept.push_back(i);
  impl_->has_cuts = impl_->comm.any(!kept.empty());
  if (!impl_->has_cuts) return part;
  PartitionItems items{.coordinates = coordinates, .weights = weights};
  std::vector<Vec3> kept_coordinates;
  std::vector<double> kept_weights;
  if (kept.size() < coordinates.size()) {
    for (const std::size_t i : kept) kept_coordinates.push_back(coordinates[i]);
    if (!weights.empty())
      for (const std::size_t i : kept) kept_weights.push_back(weights[i]);
    items.coordinates = kept_coordinates;
    items.weights = kept_weights;
  }
  const std::vector<int> kept_part = impl_->zoltan->partition(items);
  for (std::size_t k = 0; k < kept.size(); ++k) part[kept[k]] = kept_part[k];
  return part;
}

namespace {

bool is_finite(const Vec3& x) {
  return std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2]);
}

/// The box of a part, endless where it has no neighbour.
Box box_of_part(Zoltan_Struct* zoltan, int part) {
  Box box;
  int dimension = 0;
  if (Zoltan_RCB_Box(zoltan, part, &dimension, &box.low[0], &box.low[1], &box.low[2], &box.high[0], &box.high[1],
                     &box.high[2]) != ZOLTAN_OK)
    throw Error(ExitCode::usage, "Zoltan fails to give the box of a part");
  return box;
}

}  // namespace

std::vector<int> Rcb::partition_by_sample(std::span<const Vec3> coordinates, std::span<const double> weights) {
  constexpr std::int64_t sample_of_rank = 20000;
  const Communicator& comm = impl_->comm;
  const std::int64_t all = comm.sum(static_cast<std::int64_t>(coordinates.size()));
  const std::int64_t stride = all / (sample_of_rank * impl_->parts);
  if (!impl_->zoltan || stride < 2) return partition(coordinates, weights);
  std::vector<Vec3> sample;
  std::vector<double> sample_weights;
  for (std::size_t i = 0; i < coordinates.size(); i += static_cast<std::size_t>(stride)) {
    sample.push_back(coordinates[i]);
    if (!weights.empty()) sample_weights.push_back(weights[i]);
  }
  partition(sample, sample_weights);
  std::vector<int> part(coordinates.size(), 0);
  if (!impl_->has_cuts) return part;
  constexpr int few = 16;
  std::vector<Box> boxes;
  for (int r = 0; r < impl_->parts && impl_->parts <= few; ++r) boxes.push_back(box_of_part(impl_->zoltan->get(), r));
  int last = 0;
  const auto holds = [&](int r, const Vec3& x) {
    const Box& box = boxes[static_cast<std::size_t>(r)];
    return box.low[0] <= x[0] && x[0] < box.high[0] && box.low[1] <= x[1] && x[1] < box.high[1] && box.low[2] <= x[2] &&
           x[2] < box.high[2];
  };
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const Vec3& x = coordinates[i];
    if (!is_finite(x)) continue;
    if (boxes.empty()) {
      double point[3] = {x[0], x[1], x[2]};
      int rank = 0;
      if (Zoltan_LB_Point_PP_Assign(impl_->zoltan->get(), point, &rank, &last) != ZOLTAN_OK)
        throw Error(ExitCode::usage, "Zoltan fails to find the part that a point lies in");
    } else if (!holds(last, x)) {
      for (int r = 0; r < impl_->parts; ++r)
        if (holds(r, x)) last = r;
    }
    part[i] = last;
  }
  return part;
}

void Rcb::ranks_overlapping(const Box& box, std::vector<int>& ranks) const {
  if (box.empty()) return;
  if (!impl_->has_cuts) {
    ranks.push_back(0);
    return;
  }
  int rank_count = 0, part_count = 0;
  const int status = Zoltan_LB_Box_PP_Assign(impl_->zoltan->get(), box.low[0], box.low[1], box.low[2], box.high[0],
                                             box.high[1], box.high[2], impl_->found_ranks.data(), &rank_count,
                                             impl_->found_parts.data(), &part_count);
  if (status != ZOLTAN_OK) throw Error(ExitCode::usage, "Zoltan fails to find the parts that a box overlaps");
  const auto first = impl_->found_parts.begin();
  std::sort(first, first + part_count);
  ranks.insert(ranks.end(), first, first + part_count);
}

Box Rcb::part(int rank) const {
  constexpr double infinity = std::numeric_limits<double>::infinity(), greatest = std::numeric_limits<double>::max();
  Box box{{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}};
  if (!impl_->has_cuts) return rank == 0 ? box : Box();
  box = box_of_part(impl_->zoltan->get(), rank);
  for (std::size_t c = 0; c < 3; ++c) {
    if (box.low[c] <= -greatest) box.low[c] = -infinity;
    if (box.high[c] >= greatest) box.high[c] = infinity;
  }
  return box;
}

}  // namespace tenon
