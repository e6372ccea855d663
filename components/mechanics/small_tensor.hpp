// SPDX-License-Identifier: BSD-3-Clause
// Vectors and 3 x 3 tensors: what elements and particles share of them.
#pragma once

#include "components/materials/small_tensor.hpp"
#include "components/mechanics/pack.hpp"
