// SPDX-License-Identifier: BSD-3-Clause
// A vertical colour bar with ticks at round values, exactly where they belong.
#pragma once

#include <string>

#include <vtkLookupTable.h>

#include "framework/io/picture_window.hpp"

namespace tenon {

/// Draws the bar between the corners (left, bottom) and (right, top), in parts of the window, with the title
/// right-justified at `title_right` above it.
void add_color_bar(PictureWindow& window, vtkLookupTable& colors, const std::string& title, double left, double bottom,
                   double right, double top, double title_right);

}  // namespace tenon
