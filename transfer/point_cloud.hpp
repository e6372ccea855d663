// SPDX-License-Identifier: BSD-3-Clause
// Points without a mesh, distributed over ranks: particles, probes, integration points.
#pragma once

#include <string>
#include <vector>

#include "framework/base/types.hpp"
#include "framework/comm/communicator.hpp"

namespace tenon::transfer {

/// The points that this rank owns; every point belongs to one rank, and there are no ghosts. Places are given where
/// they are needed, since points move.
struct PointCloud {
  Communicator comm;
  std::vector<GlobalId> ids;      ///< ascending on each rank, distinct over all
  std::string source = "points";  ///< for messages
};

}  // namespace tenon::transfer
