// SPDX-License-Identifier: BSD-3-Clause
// Zoltan behind spans and values. For the sources of this room only.
#pragma once

#include <zoltan.h>

#include <span>
#include <string>
#include <vector>

#include "framework/base/types.hpp"
#include "framework/comm/communicator.hpp"

namespace tenon {

/// What is to be divided: items of this rank. A neighbour in the graph is named by its rank and its place there.
struct PartitionItems {
  std::span<const Vec3> coordinates;
  std::span<const double> weights{};      ///< empty: equal
  std::span<const LocalIndex> offsets{};  ///< graph methods only
  std::span<const int> neighbour_rank{};
  std::span<const LocalIndex> neighbour_index{};
};

/// Owns a Zoltan object, and with it the cuts that it keeps.
class ZoltanPartitioner {
 public:
  /// Collective. Silent, parts numbered as they come (no REMAP).
  ZoltanPartitioner(const Communicator& comm, int parts);
  ~ZoltanPartitioner();
  ZoltanPartitioner(const ZoltanPartitioner&) = delete;
  ZoltanPartitioner& operator=(const ZoltanPartitioner&) = delete;

  void set(const std::string& parameter, const std::string& value);
  /// Collective. Part of each item of this rank. There must be an item on some rank. Throws Error(usage) on all
  /// ranks if Zoltan fails.
  std::vector<int> partition(const PartitionItems& items);
  Zoltan_Struct* get() const { return zoltan_; }

 private:
  Communicator comm_;
  Zoltan_Struct* zoltan_ = nullptr;
  PartitionItems items_;
  int rank_ = 0;
  int assumed_part_ = 0;  ///< of every item of this rank before
  friend struct ZoltanCallbacks;
};

}  // namespace tenon
