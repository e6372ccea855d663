// SPDX-License-Identifier: BSD-3-Clause
#include "framework/search/nearest_points.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <tuple>

#include "framework/search/distributed_search.hpp"

namespace tenon {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double greatest_coordinate = 1e150;  // m; its square is still a number
/// Points of this rank by whose neighbours among its own the first reach is judged.
constexpr std::size_t samples = 64;

Box global_box(const Communicator& comm, const Box& mine) {
  std::array<double, 6> ends{-mine.low[0], -mine.low[1], -mine.low[2], mine.high[0], mine.high[1], mine.high[2]};
  comm.max(std::span<double>(ends));
  Box box;
  box.low = {-ends[0], -ends[1], -ends[2]};
  box.high = {ends[3], ends[4], ends[5]};
  return box;
}

bool is_place(const Vec3& x) {
  return std::abs(x[0]) <= greatest_coordinate && std::abs(x[1]) <= greatest_coordinate &&
         std::abs(x[2]) <= greatest_coordinate;
}

/// Collective.
void check(const Communicator& comm, std::span<const CloudPoint> cloud, std::span<const Vec3> points,
           const std::string& name) {
  std::optional<Error> error;
  const auto refuse = [&](const char* which, long long id, const Vec3& x) {
    if (error) return;
    error =
        Error(ExitCode::geometry,
              fmt::format("{}: {} {} is at ({}, {}, {}), not a place; the run that moved it has become unstable, or "
                          "the file is damaged",
                          name, which, id, x[0], x[1], x[2]));
  };
  for (const CloudPoint& p : cloud)
    if (!is_place(p.x)) refuse("source point", p.id, p.x);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!is_place(points[i])) refuse("target point", static_cast<long long>(i), points[i]);
  comm.throw_if_any(error);
}

/// Cloud points in order along a curve, with the tree over them.
class LocalCloud {
 public:
  explicit LocalCloud(std::span<const CloudPoint> cloud) {
    std::vector<Vec3> x;
    for (const CloudPoint& p : cloud) x.push_back(p.x);
    const std::vector<LocalIndex> order = order_along_curve(x);
    points_.reserve(cloud.size());
    std::vector<GlobalId> ids;
    ids.reserve(cloud.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      points_.push_back(cloud[static_cast<std::size_t>(order[i])]);
      x[i] = points_.back().x;
      ids.push_back(points_.back().id);
    }
    tree_ = PointTree(x, ids);
  }

  /// Calls visit(i, neighbours) for the points that have all of their `k` nearest within `reach`.
  template <typename Visit>
  void visit_complete(std::span<const Vec3> points, int k, double reach, Visit&& visit) const {
    std::vector<NearPoint> near;
    tree_.for_each_k_nearest(points, k, reach, [&](LocalIndex i, std::span<const PointTree::Neighbour> found) {
      near.clear();
      for (const PointTree::Neighbour& n : found) near.push_back({points_.data() + n.index, n.squared_distance});
      visit(static_cast<std::size_t>(i), std::span<const NearPoint>(near));
    });
  }

 private:
  std::vector<CloudPoint> points_;
  PointTree tree_;
};

/// Collective. A reach within which about half of the points have their neighbours; at least a hundredth of the mean
/// distance of `in_cloud` points that fill the box, so that points that coincide do not make it nothing.
double first_reach(const Communicator& comm, std::span<const CloudPoint> cloud, int k, const Box& box,
                   std::int64_t in_cloud) {
  std::vector<Vec3> some;
  for (std::size_t s = 0; s < std::min(samples, cloud.size()); ++s)
    some.push_back(cloud[s * cloud.size() / std::min(samples, cloud.size())].x);
  std::vector<double> radii;
  const auto wanted = static_cast<std::size_t>(k) + 1;  // each is its own nearest
  const int at_most = static_cast<int>(std::min(wanted, cloud.size()));
  LocalCloud(cloud).visit_complete(some, at_most, infinity, [&](std::size_t, std::span<const NearPoint> near) {
    double squared = 0;
    for (const NearPoint& n : near) squared = std::max(squared, n.squared_distance);
    radii.push_back(std::sqrt(squared));
  });
  double median = 0;
  if (!radii.empty()) {
    std::nth_element(radii.begin(), radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2), radii.end());
    median = radii[radii.size() / 2];
  }
  return std::max(1.25 * comm.max(median), 0.01 * box.diagonal() / std::cbrt(static_cast<double>(in_cloud)));
}

/// One rendezvous; `done` tells which points had all their neighbours within reach.
void rendezvous(const Communicator& comm, std::span<const CloudPoint> cloud, std::span<const Vec3> points, int k,
                double reach, std::size_t bytes, std::vector<std::byte>& results, std::vector<char>& done,
                const WithNeighbours& work, const std::string& name) {
  std::vector<Box> boxes;
  boxes.reserve(cloud.size());
  for (const CloudPoint& p : cloud) boxes.push_back({p.x, p.x});
  const DistributedSearch search(comm, boxes, points, reach, name);
  std::vector<CloudPoint> arrived(static_cast<std::size_t>(search.boxes().received()));
  {
    std::vector<CloudPoint> sent;
    sent.reserve(search.box_of_send().size());
    for (const LocalIndex i : search.box_of_send()) sent.push_back(cloud[static_cast<std::size_t>(i)]);
    search.boxes().forward(std::span<const CloudPoint>(sent), std::span<CloudPoint>(arrived));
  }
  const std::span<const Vec3> here = search.arrived_points();
  std::vector<std::byte> found(here.size() * bytes);
  std::vector<char> complete(here.size(), 0);
  LocalCloud(arrived).visit_complete(here, k, reach, [&](std::size_t i, std::span<const NearPoint> near) {
    work(here[i], near, std::span(found).subspan(i * bytes, bytes));
    complete[i] = 1;
  });
  results.resize(points.size() * bytes);
  done.resize(points.size());
  const std::array<ExchangeItem, 2> back{
      ExchangeItem{found.data(), results.data(), bytes},
      ExchangeItem{reinterpret_cast<const std::byte*>(complete.data()), reinterpret_cast<std::byte*>(done.data()), 1}};
  search.points().reverse(std::span<const ExchangeItem>(back));
}

}  // namespace

void for_each_with_nearest(const Communicator& comm, std::span<const CloudPoint> cloud, std::span<const Vec3> points,
                           int k, std::size_t bytes, std::span<std::byte> results, const WithNeighbours& work,
                           const std::string& name) {
  check(comm, cloud, points, name);
  const std::int64_t in_cloud = comm.sum(static_cast<std::int64_t>(cloud.size()));
  const int at_most = static_cast<int>(std::min<std::int64_t>(k, in_cloud));
  if (comm.size() == 1 || at_most == 0) {  // nothing to bring together
    LocalCloud(cloud).visit_complete(points, at_most, infinity, [&](std::size_t i, std::span<const NearPoint> near) {
      work(points[i], near, results.subspan(i * bytes, bytes));
    });
    return;
  }
  Box mine;
  for (const CloudPoint& p : cloud) mine.add(p.x);
  const Box source = global_box(comm, mine);
  Box everything;
  for (const Vec3& x : points) everything.add(x);
  everything = global_box(comm, everything);
  everything.add(source);
  double reach = first_reach(comm, cloud, at_most, everything, in_cloud);
  std::vector<std::size_t> missing(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) missing[i] = i;
  std::vector<Vec3> asking(points.begin(), points.end());
  std::vector<std::byte> found;
  std::vector<char> done;
  for (std::int64_t left = 0; (left = comm.sum(static_cast<std::int64_t>(missing.size()))) > 0;) {
    Box around;
    double nearest = infinity;
    for (const Vec3& x : asking) around.add(x), nearest = std::min(nearest, source.distance(x));
    // No point can be done before the nearest of them reaches the cloud at all.
    reach = std::max({reach, comm.min(nearest), std::numeric_limits<double>::min()});
    around = global_box(comm, around);
    around.inflate(reach);
    std::vector<CloudPoint> near_cloud;
    for (const CloudPoint& p : cloud)
      if (around.contains(p.x)) near_cloud.push_back(p);
    rendezvous(comm, near_cloud, asking, at_most, reach, bytes, found, done, work, name);
    std::size_t unfinished = 0;
    for (std::size_t j = 0; j < asking.size(); ++j) {
      if (done[j]) {
        if (bytes > 0) std::memcpy(results.data() + missing[j] * bytes, found.data() + j * bytes, bytes);
        continue;
      }
      missing[unfinished] = missing[j], asking[unfinished] = asking[j], ++unfinished;
    }
    missing.resize(unfinished), asking.resize(unfinished);
    // Where few ask, a round costs more than what they bring together.
    reach *= 16 * left < in_cloud ? 4 : 2;
  }
}

std::vector<Nearest> k_nearest(const Communicator& comm, std::span<const CloudPoint> cloud,
                               std::span<const Vec3> points, int k, const std::string& name) {
  const auto width = static_cast<std::size_t>(std::max(k, 0));
  std::vector<Nearest> all(points.size() * width);
  for_each_with_nearest(
      comm, cloud, points, k, width * sizeof(Nearest), std::as_writable_bytes(std::span(all)),
      [](const Vec3&, std::span<const NearPoint> near, std::span<std::byte> result) {
        std::vector<Nearest> mine;
        for (const NearPoint& n : near) mine.push_back({n.point->id, n.squared_distance});
        std::sort(mine.begin(), mine.end(), [](const Nearest& a, const Nearest& b) {
          return std::tie(a.squared_distance, a.id) < std::tie(b.squared_distance, b.id);
        });
        mine.resize(result.size() / sizeof(Nearest));
        if (!mine.empty()) std::memcpy(result.data(), mine.data(), result.size());
      },
      name);
  return all;
}

}  // namespace tenon
