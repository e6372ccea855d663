// SPDX-License-Identifier: BSD-3-Clause
// The look that all charts share.
#pragma once

#include <cstddef>
#include <string>

#include <vtkAxis.h>
#include <vtkPlot.h>

namespace tenon {

/// The colour of the i-th line of a chart.
void set_line_color(vtkPlot& line, std::size_t i);
void style_axis(vtkAxis& axis, const std::string& title, int font);

}  // namespace tenon
