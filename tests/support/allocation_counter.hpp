// SPDX-License-Identifier: BSD-3-Clause
// Allocations by operator new since the start of the program.
#pragma once

#include <cstdint>

namespace tenon::testing {

std::int64_t allocations();

}  // namespace tenon::testing
