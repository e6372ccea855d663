// SPDX-License-Identifier: BSD-3-Clause
// Four points of a batch side by side: what materials and elements share of it.
#pragma once

#include "components/materials/batch.hpp"
#include "framework/base/pack.hpp"

namespace tenon {

static_assert(lanes % pack_width == 0);

}  // namespace tenon
