// SPDX-License-Identifier: BSD-3-Clause
#include "framework/io/log_log_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <vtkAxis.h>
#include <vtkChartLegend.h>
#include <vtkChartXY.h>
#include <vtkContextScene.h>
#include <vtkContextView.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPen.h>
#include <vtkPlotPoints.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkTextProperty.h>

#include "framework/io/chart_style.hpp"
#include "framework/io/picture_window.hpp"

namespace tenon {

namespace {

struct Span {
  double low = INFINITY, high = 0;
  void add(double v) { low = std::min(low, v), high = std::max(high, v); }
  bool empty() const { return !(low <= high); }
};

bool shown(double x, double y) {
  return std::isfinite(x) && std::isfinite(y) && x > 0 && y > 0;
}

std::string tick_label(double value) {
  return value >= 0.9e-3 && value < 9999 ? fmt::format("{:g}", value) : fmt::format("{:.0e}", value);
}

/// Ticks at 1, 2 and 5 of every decade, at 1 only where there are many decades. The positions are logarithms, as VTK
/// wants them.
void set_log_axis(vtkAxis& axis, const Span& span) {
  const double room = std::pow(span.high / span.low, 0.06) * 1.12;
  const double low = span.low / room, high = span.high * room;
  axis.SetLogScale(true);
  axis.SetUnscaledRange(low, high);
  const vtkNew<vtkDoubleArray> positions;
  const vtkNew<vtkStringArray> labels;
  const int first = static_cast<int>(std::floor(std::log10(low))), last = static_cast<int>(std::ceil(std::log10(high)));
  const int stride = (last - first) / 9 + 1;
  for (int decade = first; decade <= last; decade += stride)
    for (const int digit : {1, 2, 5}) {
      const double value = digit * std::pow(10, decade);
      if (value < low || value > high || (digit > 1 && last - first > 3)) continue;
      positions->InsertNextValue(std::log10(value));
      labels->InsertNextValue(tick_label(value));
    }
  axis.SetCustomTickPositions(positions, labels);
  axis.SetBehavior(vtkAxis::FIXED);
}

vtkSmartPointer<vtkTable> make_table(const LogLogLine& line, std::size_t number) {
  auto data = vtkSmartPointer<vtkTable>::New();
  const vtkNew<vtkDoubleArray> x, y;
  x->SetName(fmt::format("x{}", number).c_str());
  y->SetName(line.name.c_str());
  std::vector<std::pair<double, double>> points;
  for (std::size_t i = 0; i < std::min(line.x.size(), line.y.size()); ++i)
    if (shown(line.x[i], line.y[i])) points.emplace_back(line.x[i], line.y[i]);
  std::sort(points.begin(), points.end());
  for (const auto& [a, b] : points) x->InsertNextValue(a), y->InsertNextValue(b);
  data->AddColumn(x);
  data->AddColumn(y);
  return data;
}

void add_line(vtkChartXY& chart, const LogLogLine& line, std::size_t number, int font) {
  const vtkSmartPointer<vtkTable> data = make_table(line, number);
  if (data->GetNumberOfRows() == 0) return;
  vtkPlot* const plot = chart.AddPlot(vtkChart::LINE);
  plot->SetInputData(data, 0, 1);
  plot->SetLabel(line.name);
  if (line.guide) {
    plot->SetColor(120, 120, 124, 255);
    plot->SetWidth(1.4F);
    plot->GetPen()->SetLineType(vtkPen::DASH_LINE);
    return;
  }
  set_line_color(*plot, number);
  plot->SetWidth(2.4F);
  if (auto* const points = vtkPlotPoints::SafeDownCast(plot)) {
    points->SetMarkerStyle(vtkPlotPoints::CIRCLE);
    points->SetMarkerSize(0.55F * static_cast<float>(font));
  }
}

void add_panel(vtkContextScene& scene, const LogLogPanel& panel, const vtkRectf& place, int font) {
  Span x, y;
  for (const LogLogLine& line : panel.lines)
    for (std::size_t i = 0; i < std::min(line.x.size(), line.y.size()); ++i)
      if (shown(line.x[i], line.y[i])) x.add(line.x[i]), y.add(line.y[i]);
  const vtkNew<vtkChartXY> chart;
  chart->SetAutoSize(false);
  chart->SetSize(place);
  chart->SetHiddenAxisBorder(10);
  chart->SetTitle(panel.title + (x.empty() ? " (nothing to show)" : ""));
  set_ink(*chart->GetTitleProperties(), font, false);
  style_axis(*chart->GetAxis(vtkAxis::BOTTOM), panel.x_title, font);
  style_axis(*chart->GetAxis(vtkAxis::LEFT), panel.y_title, font);
  if (!x.empty()) {
    for (std::size_t i = 0; i < panel.lines.size(); ++i) add_line(*chart, panel.lines[i], i, font);
    set_log_axis(*chart->GetAxis(vtkAxis::BOTTOM), x);
    set_log_axis(*chart->GetAxis(vtkAxis::LEFT), y);
    chart->SetShowLegend(panel.legend != LegendPlace::none);
    vtkChartLegend& legend = *chart->GetLegend();
    legend.SetInline(panel.legend == LegendPlace::inside);
    legend.SetHorizontalAlignment(vtkChartLegend::RIGHT);
    legend.SetVerticalAlignment(panel.legend_on_top ? vtkChartLegend::TOP : vtkChartLegend::BOTTOM);
    legend.SetLabelSize(font - 2);
    set_ink(*legend.GetLabelProperties(), font - 2, false);
    legend.GetPen()->SetLineType(vtkPen::NO_PEN);
  }
  scene.AddItem(chart);
}

}  // namespace

void draw_log_log(const std::vector<LogLogPanel>& panels, const std::string& png, int width, int height) {
  const vtkNew<vtkContextView> view;
  vtkRenderWindow& window = *view->GetRenderWindow();
  window.SetOffScreenRendering(1);
  window.SetMultiSamples(4);
  window.SetSize(width, height);
  view->GetRenderer()->SetBackground(1, 1, 1);
  const auto share = [](const LogLogPanel& panel) { return panel.legend == LegendPlace::beside ? 1.5F : 1.0F; };
  float shares = panels.empty() ? 1.0F : 0.0F;
  for (const LogLogPanel& panel : panels) shares += share(panel);
  const float unit = static_cast<float>(width) / shares, margin = 0.012F * static_cast<float>(width);
  const int font = std::max(9, static_cast<int>(std::lround(0.026 * std::min<double>(height, 0.5 * width))));
  float left = 0;
  for (const LogLogPanel& panel : panels) {
    const float cell = unit * share(panel);
    add_panel(*view->GetScene(), panel,
              vtkRectf(left + margin, margin, cell - 2 * margin, static_cast<float>(height) - 2 * margin), font);
    left += cell;
  }
  window.Render();
  save_png(window, png);
}

}  // namespace tenon
