// SPDX-License-Identifier: BSD-3-Clause
// Allocations by operator new since the start of the program.
#pragma once

#include <cstdint>

namespace tenon::transfer::testing {

std::int64_t allocation_count();

}  // namespace tenon::transfer::testing
