// SPDX-License-Identifier: BSD-3-Clause
// First contact between ranks that do not know who will write to them.
#pragma once

#include <span>
#include <vector>

#include "framework/base/types.hpp"
#include "framework/comm/communicator.hpp"

namespace tenon {

/// Index lists by rank, ascending; list k is `values[begin[k] .. begin[k+1])`.
struct RankLists {
  std::vector<int> ranks;
  std::vector<std::size_t> begin{0};
  std::vector<LocalIndex> values;

  std::span<const LocalIndex> list(std::size_t k) const {
    return std::span(values).subspan(begin[k], begin[k + 1] - begin[k]);
  }
};

/// Collective. Sends each list to its rank (this one included) and returns what the others sent, in rank order. Work
/// and messages grow with the neighbours only, besides one barrier (nonblocking consensus [HSL10]).
RankLists exchange_sparse(const Communicator& comm, const RankLists& outgoing);

}  // namespace tenon
