// SPDX-License-Identifier: BSD-3-Clause
// Four points side by side: what materials and elements share of it.
#pragma once

#include "components/materials/pack.hpp"
