// SPDX-License-Identifier: BSD-3-Clause
// Plots of history.csv.
#pragma once

#include <string>

namespace tenon {

/// Energies, ledger error and extrema over time, one plot per quantity. Needs a display. Throws Error(file).
void draw_history(const std::string& csv, const std::string& png, int width, int height);

}  // namespace tenon
