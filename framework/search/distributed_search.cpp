// SPDX-License-Identifier: BSD-3-Clause
#include "framework/search/distributed_search.hpp"

#include <algorithm>
#include <cmath>

namespace tenon {

namespace {

// Shipping and sorting a box costs about half of shipping a point and answering for it.
constexpr double box_weight = 0.5;

bool is_finite(const Box& box) {
  bool finite = !box.empty();
  for (std::size_t c = 0; c < 3; ++c) finite = finite && std::isfinite(box.low[c]) && std::isfinite(box.high[c]);
  return finite;
}

// Greatest coordinate of all items on all ranks: the scale of round-off.
double extent(const Communicator& comm, std::span<const Box> boxes, std::span<const Vec3> points) {
  double greatest = 0;
  const auto take = [&](const Vec3& x) {
    for (const double value : x)
      if (std::isfinite(value)) greatest = std::max(greatest, std::abs(value));
  };
  for (const Box& box : boxes) take(box.low), take(box.high);
  for (const Vec3& point : points) take(point);
  return comm.max(greatest);
}

}  // namespace

DistributedSearch::DistributedSearch(const Communicator& comm, std::span<const Box> boxes, std::span<const Vec3> points,
                                     double reach, std::string name) {
  Rcb rcb(comm);
  search(comm, rcb, boxes, points, reach, name, {});
}

DistributedSearch::DistributedSearch(const Communicator& comm, Rcb& rcb, std::span<const Box> boxes,
                                     std::span<const Vec3> points, double reach, std::string name,
                                     std::span<const float> work) {
  search(comm, rcb, boxes, points, reach, name, work);
}

void DistributedSearch::move_points(std::span<const Vec3> points) {
  point_plan_.forward(points, std::span(arrived_points_));
}

void DistributedSearch::search(const Communicator& comm, Rcb& rcb, std::span<const Box> boxes,
                               std::span<const Vec3> points, double reach, const std::string& name,
                               std::span<const float> work) {
  std::vector<Vec3> items;
  std::vector<double> weights;
  items.reserve(points.size() + boxes.size()), weights.reserve(points.size() + boxes.size());
  items.assign(points.begin(), points.end());
  weights.assign(points.size(), 1.0);
  if (!work.empty()) std::copy(work.begin(), work.end(), weights.begin());
  for (const Box& box : boxes)
    if (is_finite(box)) {
      items.push_back(0.5 * (box.low + box.high));
      weights.push_back(box_weight);
    }
  const std::vector<int> part = rcb.partition_by_sample(items, weights);

  // A point stands in the part that the partition gave it, which may be on either side of a cut that it lies on; so
  // a box also goes where it only touches, with room for the rounding of the cut.
  const double margin = reach + 1e-14 * (reach + extent(comm, boxes, points));
  std::vector<int> ranks, rank_of_send;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (!is_finite(boxes[i])) continue;
    Box inflated = boxes[i];
    inflated.inflate(margin);
    ranks.clear();
    rcb.ranks_overlapping(inflated, ranks);
    for (const int rank : ranks) {
      rank_of_send.push_back(rank);
      box_of_send_.push_back(static_cast<LocalIndex>(i));
    }
  }
  point_plan_ = ExchangePlan::to_ranks(comm, std::span(part).first(points.size()), name + " points");
  box_plan_ = ExchangePlan::to_ranks(comm, rank_of_send, name + " boxes");

  std::vector<Box> sent;
  sent.reserve(box_of_send_.size());
  for (const LocalIndex i : box_of_send_) sent.push_back(boxes[static_cast<std::size_t>(i)]);
  arrived_boxes_.resize(static_cast<std::size_t>(box_plan_.received()));
  box_plan_.forward(std::span<const Box>(sent), std::span(arrived_boxes_));
  arrived_points_.resize(static_cast<std::size_t>(point_plan_.received()));
  point_plan_.forward(points, std::span(arrived_points_));
  tree_.build(arrived_boxes_);
}

}  // namespace tenon
