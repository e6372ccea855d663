// SPDX-License-Identifier: BSD-3-Clause
// The communicator that a test program runs on.
#pragma once

#include "framework/comm/communicator.hpp"

namespace tenon::testing {

/// All ranks of the test program; made by its main.
const Communicator& communicator();

}  // namespace tenon::testing
