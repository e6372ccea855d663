// SPDX-License-Identifier: BSD-3-Clause
// Which rank holds a global id, and where in its array.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "framework/base/types.hpp"
#include "framework/comm/communicator.hpp"

namespace tenon {

struct DirectoryEntry {
  int rank = -1;
  LocalIndex index = no_index;
};

/// A distributed table. Ids are spread over the ranks by their value, so no rank holds all of it.
class Directory {
 public:
  /// Collective. Item i of this rank, at `index[i]` of its array, bears `ids[i]`. An id is entered by one rank
  /// only; if several enter it, the lowest rank keeps it.
  Directory(const Communicator& comm, std::span<const GlobalId> ids, std::span<const LocalIndex> index);
  /// Collective. Entry of each id, in order; rank -1 where nobody entered it.
  std::vector<DirectoryEntry> find(std::span<const GlobalId> ids) const;

 private:
  Communicator comm_;
  GlobalId share_ = 1;         // ids per home: id i is at home on rank i / share_
  std::vector<GlobalId> ids_;  // ascending
  std::vector<DirectoryEntry> entries_;
};

}  // namespace tenon
