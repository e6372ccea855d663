// SPDX-License-Identifier: BSD-3-Clause
#include "framework/io/chart_style.hpp"

#include <iterator>

#include <vtkPen.h>
#include <vtkTextProperty.h>

#include "framework/io/picture_window.hpp"

namespace tenon {

namespace {

// Colours that stay apart for the colour-blind (Okabe and Ito, "Color Universal Design", 2008), darkest first.
constexpr unsigned line_colors[] = {0x0072b2, 0xd55e00, 0x009e73, 0xcc79a7, 0xe69f00,
                                    0x56b4e9, 0x222222, 0x8c6d31, 0x7f7f7f};

}  // namespace

void set_line_color(vtkPlot& line, std::size_t i) {
  const unsigned color = line_colors[i % std::size(line_colors)];
  line.SetColor(static_cast<unsigned char>(color >> 16), static_cast<unsigned char>(color >> 8),
                static_cast<unsigned char>(color), 255);
}

void style_axis(vtkAxis& axis, const std::string& title, int font) {
  axis.SetTitle(title);
  set_ink(*axis.GetTitleProperties(), font, false);
  set_ink(*axis.GetLabelProperties(), font - 2, false);
  axis.GetPen()->SetColor(60, 60, 64, 255);
  axis.GetPen()->SetWidth(1.2F);
  axis.GetGridPen()->SetColor(225, 225, 228, 255);
}

}  // namespace tenon
