// SPDX-License-Identifier: BSD-3-Clause
// history.csv: one header row, one row per sampled step.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "framework/comm/communicator.hpp"

namespace tenon {

class History {
 public:
  /// Collective; rank 0 writes. On restart (`resume_step` >= 0) rows with a later step are cut off and the header must
  /// agree. Column names must not repeat. Throws Error(file).
  History(const Communicator& comm, std::string path, std::vector<std::string> columns, std::int64_t resume_step);
  ~History();
  /// Local. Values in the order of the columns, written with 17 digits (integers without a point); only rank 0's count.
  /// Reaches the system at once, so that a kill loses none; a failure shows at the next `flush`.
  void row(std::span<const double> values);
  /// Collective. Throws Error(file) on all ranks if a row since the last flush could not be written.
  void flush();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tenon
