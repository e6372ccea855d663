// SPDX-License-Identifier: BSD-3-Clause
// Random distorted single elements and points at their faces; what the search says of them against the oracle.
#pragma once

#include <string>
#include <vector>

#include "extended_oracle.hpp"

namespace tenon::transfer::testing {

struct OracleRun {
  ElementKind kind = ElementKind::hex8;
  int elements = 0;
  int starts = 3;           ///< of the brute force, in every direction
  int thoroughly_each = 1;  ///< one element in so many has its outside points checked by brute force
  std::uint64_t seed = 1;
};

struct OracleCount {
  int elements = 0, inside = 0, outside = 0, brute_forced = 0;
  int lost = 0;         ///< points inside that were not found
  int invented = 0;     ///< points that were found where they are not
  int disagreeing = 0;  ///< one at a time and many at a time differ
  std::string first;    ///< what the first faults are
};

OracleCount compare_with_oracle(const OracleRun& run);

}  // namespace tenon::transfer::testing
