// SPDX-License-Identifier: BSD-3-Clause
// What stands behind a Communicator. For the sources of this room and its tests only.
#pragma once

#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "framework/comm/communicator.hpp"

namespace tenon {

struct Communicator::Impl {
  /// Takes the communicator over and frees it, unless MPI has ended before.
  Impl(MPI_Comm taken, std::shared_ptr<std::deque<ExchangeCount>> shared_counts);
  ~Impl();
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  /// A tag that no message in flight bears. Ranks call it in the same order, so they agree on it.
  int next_tag();

  MPI_Comm mpi;
  int rank = 0;
  int size = 1;
  int tag_limit = 32767;  // greatest tag that MPI guarantees, replaced by that of the library
  int last_tag = 0;
  /// Longer messages are split: MPI counts in int.
  std::size_t largest_message = std::size_t{1} << 30;
  std::shared_ptr<std::deque<ExchangeCount>> counts;
  std::vector<std::int64_t> scratch;  // of reductions; grows to the longest
};

}  // namespace tenon
