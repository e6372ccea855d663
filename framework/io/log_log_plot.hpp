// SPDX-License-Identifier: BSD-3-Clause
// Plots with two logarithmic axes, side by side.
#pragma once

#include <string>
#include <vector>

namespace tenon {

struct LogLogLine {
  std::string name;          ///< in the legend
  std::vector<double> x, y;  ///< pairs that are not both above zero and finite are left out
  bool guide = false;        ///< a slope to compare with: thin, dashed, without marks
};

enum class LegendPlace {
  inside,
  beside,  ///< to the right of the panel, which is half as wide again for it
  none
};

struct LogLogPanel {
  std::string title, x_title, y_title;
  std::vector<LogLogLine> lines;
  bool legend_on_top = false;  ///< where the lines leave room: below right if they rise, above right if they fall
  LegendPlace legend = LegendPlace::inside;
};

/// Needs a display. A panel without any point says so in its title. Throws Error(file).
void draw_log_log(const std::vector<LogLogPanel>& panels, const std::string& png, int width, int height);

}  // namespace tenon
