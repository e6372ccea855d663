// SPDX-License-Identifier: BSD-3-Clause
// The k nearest of the points of all ranks: brought together with those who ask by a rendezvous of doubling reach.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "framework/comm/communicator.hpp"
#include "framework/search/point_tree.hpp"

namespace tenon {

/// A point of a cloud as it travels, and where its owner keeps it.
struct CloudPoint {
  Vec3 x{};  ///< m
  GlobalId id = no_id;
  int owner = -1;
  LocalIndex at_owner = no_index;
};

/// A neighbour of the point that asks.
struct NearPoint {
  const CloudPoint* point;
  double squared_distance;  ///< m^2
};

/// Receives a point that asks, its neighbours in ascending order of their ids, and room for its result.
using WithNeighbours = std::function<void(const Vec3&, std::span<const NearPoint>, std::span<std::byte>)>;

/// Collective. For each of `points` of this rank, calls `work` with the k nearest of `cloud` (this rank's points; over
/// all ranks, ids are unique), or with all if there are fewer, on the rank where they met; what it writes returns into
/// the `bytes` bytes per point of `results`. Of equal distances, the smaller ids are nearer, so the neighbours
/// depend on nothing but the two sets. `work` may run more than once for a point and must not communicate.
/// A cloud without any point gives every point no neighbours. Throws Error(geometry) for coordinates that are not
/// finite or too great to be squared.
void for_each_with_nearest(const Communicator& comm, std::span<const CloudPoint> cloud, std::span<const Vec3> points,
                           int k, std::size_t bytes, std::span<std::byte> results, const WithNeighbours& work,
                           const std::string& name);

/// A neighbour as it is handed back.
struct Nearest {
  GlobalId id = no_id;  ///< no_id where the cloud has fewer than k points
  double squared_distance = 0;
};

/// Collective. k neighbours of each point, one after the other, in ascending order of (squared distance, id).
std::vector<Nearest> k_nearest(const Communicator& comm, std::span<const CloudPoint> cloud,
                               std::span<const Vec3> points, int k, const std::string& name);

}  // namespace tenon
