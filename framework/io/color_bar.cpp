// SPDX-License-Identifier: BSD-3-Clause
#include "framework/io/color_bar.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <vtkActor2D.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCoordinate.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkProperty2D.h>
#include <vtkUnsignedCharArray.h>

namespace tenon {

namespace {

/// Multiples of 1, 2 or 5 x 10^n inside the range, some five of them.
std::vector<double> ticks(double low, double high) {
  const double raw = (high - low) / 5, power = std::pow(10, std::floor(std::log10(raw)));
  double step = 10 * power;
  for (const double factor : {5.0, 2.0, 1.0})
    if (factor * power >= raw) step = factor * power;
  std::vector<double> values;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) values.push_back(k * step);
  return values;
}

/// Digits enough to tell neighbouring ticks apart, no more.
std::string label(double value, const std::vector<double>& all) {
  const double step = all.size() > 1 ? all[1] - all[0] : std::abs(value);
  const double greatest = std::max(std::abs(all.front()), std::abs(all.back()));
  if (!(greatest > 0)) return "0";
  if (std::abs(value) < 1e-9 * step) value = 0;
  if (greatest >= 1e6 || step < 1e-4) return fmt::format("{:.4g}", value);
  return fmt::format("{:.{}f}", value, std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9))));
}

/// Shapes in parts of the window, on its sheet.
vtkSmartPointer<vtkActor2D> add_shapes(PictureWindow& window, vtkPolyData* shapes) {
  const vtkNew<vtkCoordinate> parts;
  parts->SetCoordinateSystemToNormalizedViewport();
  const vtkNew<vtkPolyDataMapper2D> mapper;
  mapper->SetInputData(shapes);
  mapper->SetTransformCoordinate(parts);
  auto actor = vtkSmartPointer<vtkActor2D>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(ink[0], ink[1], ink[2]);
  actor->GetProperty()->SetLineWidth(1.5F);
  window.sheet().AddActor2D(actor);
  return actor;
}

}  // namespace

void add_color_bar(PictureWindow& window, vtkLookupTable& colors, const std::string& title, double left, double bottom,
                   double right, double top, double title_right) {
  const vtkNew<vtkPoints> corners;
  const vtkNew<vtkCellArray> strips;
  const vtkNew<vtkUnsignedCharArray> paint;
  paint->SetNumberOfComponents(3);
  const vtkIdType count = colors.GetNumberOfTableValues();
  for (vtkIdType i = 0; i <= count; ++i) {
    const double y = bottom + (top - bottom) * static_cast<double>(i) / static_cast<double>(count);
    corners->InsertNextPoint(left, y, 0);
    corners->InsertNextPoint(right, y, 0);
    if (i == count) break;
    strips->InsertNextCell({2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2});
    const double* const rgb = colors.GetTableValue(i);
    for (int c = 0; c < 3; ++c) paint->InsertNextValue(static_cast<unsigned char>(std::lround(255 * rgb[c])));
  }
  const vtkNew<vtkPolyData> bar;
  bar->SetPoints(corners);
  bar->SetPolys(strips);
  bar->GetCellData()->SetScalars(paint);
  add_shapes(window, bar);

  const double low = colors.GetRange()[0], high = colors.GetRange()[1], tick = 0.3 * (right - left);
  const std::vector<double> values = ticks(low, high);
  const vtkNew<vtkPoints> ends;
  const vtkNew<vtkCellArray> lines;
  for (const double value : values) {
    const double y = bottom + (top - bottom) * (value - low) / (high - low);
    const vtkIdType first = ends->InsertNextPoint(right, y, 0);
    ends->InsertNextPoint(right + tick, y, 0);
    lines->InsertNextCell({first, first + 1});
    const auto text = window.add_text(right + 1.6 * tick, y, 21, false);
    text->SetInput(label(value, values).c_str());
    text->GetTextProperty()->SetVerticalJustificationToCentered();
  }
  const vtkNew<vtkPolyData> marks;
  marks->SetPoints(ends);
  marks->SetLines(lines);
  add_shapes(window, marks);

  const auto text = window.add_text(title_right, top + 0.035, 24, false);
  text->SetInput(title.c_str());
  text->GetTextProperty()->SetJustificationToRight();
}

}  // namespace tenon
