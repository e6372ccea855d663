// SPDX-License-Identifier: BSD-3-Clause
#include "framework/io/history_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <vtkAxis.h>
#include <vtkChartLegend.h>
#include <vtkChartXY.h>
#include <vtkContextScene.h>
#include <vtkContextView.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPen.h>
#include <vtkPlotLine.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkTextProperty.h>

#include "framework/io/chart_style.hpp"
#include "framework/io/color_map.hpp"
#include "framework/io/history_table.hpp"
#include "framework/io/picture_window.hpp"

namespace tenon {

namespace {

constexpr int line_types[] = {vtkPen::DASH_LINE, vtkPen::DASH_DOT_LINE, vtkPen::DOT_LINE, vtkPen::DASH_DOT_DOT_LINE};
constexpr std::size_t most_points = 4000;    // per line; more than any picture has pixels
constexpr double least_shown_error = 1e-17;  // zero has no place on a logarithmic axis

struct Scales {
  ShownUnit time, value;
};

double greatest_of(const HistoryTable& table, const PlotGroup& group) {
  double greatest = 0;
  for (const int c : group.columns)
    for (const double v : table.columns[static_cast<std::size_t>(c)])
      if (std::isfinite(v)) greatest = std::max(greatest, std::abs(v));
  return greatest;
}

/// Rows to plot: all, or some thousands evenly spaced, always with the last.
std::vector<std::size_t> shown_rows(std::size_t rows) {
  std::vector<std::size_t> shown;
  const std::size_t stride = std::max<std::size_t>(1, rows / most_points);
  for (std::size_t r = 0; r + 1 < rows; r += stride) shown.push_back(r);
  if (rows > 0) shown.push_back(rows - 1);
  return shown;
}

/// Time and the columns of a group, in shown units.
vtkSmartPointer<vtkTable> make_table(const HistoryTable& table, const PlotGroup& group, const Scales& scales) {
  auto data = vtkSmartPointer<vtkTable>::New();
  const std::vector<std::size_t> rows = shown_rows(table.rows());
  const auto add = [&](std::size_t column, double scale, bool logarithmic) {
    const vtkNew<vtkDoubleArray> array;
    array->SetName(table.names[column].c_str());
    for (const std::size_t r : rows) {
      const double value = table.columns[column][r] * scale;
      array->InsertNextValue(logarithmic ? std::max(value, least_shown_error) : value);
    }
    data->AddColumn(array);
  };
  add(static_cast<std::size_t>(table.find("time")), scales.time.scale, false);
  for (const int c : group.columns) add(static_cast<std::size_t>(c), scales.value.scale, group.logarithmic);
  return data;
}

void set_range(vtkAxis& axis, vtkTable& data, bool logarithmic) {
  double low = INFINITY, high = -INFINITY;
  for (vtkIdType c = 1; c < data.GetNumberOfColumns(); ++c) {
    const auto* const values = vtkDoubleArray::SafeDownCast(data.GetColumn(c));
    for (vtkIdType r = 0; r < data.GetNumberOfRows(); ++r) {
      if (!std::isfinite(values->GetValue(r))) continue;
      low = std::min(low, values->GetValue(r));
      high = std::max(high, values->GetValue(r));
    }
  }
  if (!(low <= high)) return;
  if (logarithmic) {
    axis.SetLogScale(true);
    const int first = static_cast<int>(std::floor(std::log10(low))),
              last = static_cast<int>(std::ceil(std::log10(high) + 1e-9));
    axis.SetUnscaledRange(std::pow(10, first), std::pow(10, last));
    // Only whole decades: VTK's own ticks cover the plot with lines.
    const vtkNew<vtkDoubleArray> decades;
    const vtkNew<vtkStringArray> labels;
    for (int d = first; d <= last; d += (last - first) / 12 + 1) {
      decades->InsertNextValue(d);
      labels->InsertNextValue(fmt::format("1e{}", d));
    }
    axis.SetCustomTickPositions(decades, labels);
  } else {
    const double room = high > low ? 0.04 * (high - low) : std::max(0.05 * std::abs(high), 1e-12);
    axis.SetRange(low < 0 || low > 0.3 * high ? low - room : 0.0, high + room);
  }
  axis.SetBehavior(vtkAxis::FIXED);
}

// Few entries stand in the emptiest corner of the plot, many beside it.
void place_legend(vtkChartLegend& legend, vtkTable& data) {
  legend.SetHorizontalAlignment(vtkChartLegend::RIGHT);
  legend.SetVerticalAlignment(vtkChartLegend::CENTER);
  legend.SetInline(data.GetNumberOfColumns() <= 5);
  if (!legend.GetInline()) return;
  const double* const times = vtkDoubleArray::SafeDownCast(data.GetColumn(0))->GetValueRange();
  double low = INFINITY, high = -INFINITY;
  for (vtkIdType c = 1; c < data.GetNumberOfColumns(); ++c) {
    const double* const range = vtkDoubleArray::SafeDownCast(data.GetColumn(c))->GetFiniteValueRange();
    low = std::min(low, range[0]), high = std::max(high, range[1]);
  }
  vtkIdType points[2][2] = {};  // right, top
  for (vtkIdType c = 1; c < data.GetNumberOfColumns(); ++c)
    for (vtkIdType r = 0; r < data.GetNumberOfRows(); ++r) {
      const double x = (data.GetValue(r, 0).ToDouble() - times[0]) / (times[1] - times[0]);
      const double y = (data.GetValue(r, c).ToDouble() - low) / (high - low);
      if ((y < 0.35 || y > 0.65)) ++points[x > 0.5][y > 0.5];
    }
  const auto emptiest = std::min_element(&points[0][0], &points[0][0] + 4) - &points[0][0];
  legend.SetHorizontalAlignment(emptiest / 2 == 1 ? vtkChartLegend::RIGHT : vtkChartLegend::LEFT);
  legend.SetVerticalAlignment(emptiest % 2 == 1 ? vtkChartLegend::TOP : vtkChartLegend::BOTTOM);
}

void add_chart(vtkContextScene& scene, const HistoryTable& table, const PlotGroup& group, const vtkRectf& place,
               int font) {
  const int time = table.find("time");
  const double end = table.rows() > 0 ? table.columns[static_cast<std::size_t>(time)].back() : 0;
  const Scales scales{shown_unit("s", end), shown_unit(group.unit, greatest_of(table, group))};
  const vtkSmartPointer<vtkTable> data = make_table(table, group, scales);
  const vtkNew<vtkChartXY> chart;
  chart->SetAutoSize(false);
  chart->SetSize(place);
  chart->SetHiddenAxisBorder(10);
  for (std::size_t i = 0; i < group.columns.size(); ++i) {
    vtkPlot* const line = chart->AddPlot(vtkChart::LINE);
    line->SetInputData(data, 0, static_cast<vtkIdType>(i + 1));
    set_line_color(*line, i);
    // Rows of a ledger often coincide: later ones are thinner and broken, so that those below stay visible.
    line->SetWidth(group.columns.size() > 4 && i < 4 ? 3.0F : 2.2F);
    line->GetPen()->SetLineType(i < 4 ? vtkPen::SOLID_LINE : line_types[(i - 4) % std::size(line_types)]);
  }
  style_axis(*chart->GetAxis(vtkAxis::BOTTOM), title_of("time", scales.time.name), font);
  style_axis(*chart->GetAxis(vtkAxis::LEFT), title_of(group.quantity, scales.value.name), font);
  chart->GetAxis(vtkAxis::BOTTOM)->SetRange(0, end > 0 ? end * scales.time.scale : 1.0);
  chart->GetAxis(vtkAxis::BOTTOM)->SetBehavior(vtkAxis::FIXED);
  set_range(*chart->GetAxis(vtkAxis::LEFT), *data, group.logarithmic);
  if (group.columns.size() > 1) {
    chart->SetShowLegend(true);
    vtkChartLegend& legend = *chart->GetLegend();
    place_legend(legend, *data);
    legend.SetLabelSize(font - 2);
    set_ink(*legend.GetLabelProperties(), font - 2, false);
    legend.GetPen()->SetLineType(vtkPen::NO_PEN);
  } else {
    chart->SetTitle(table.names[static_cast<std::size_t>(group.columns.front())]);
    set_ink(*chart->GetTitleProperties(), font, false);
  }
  scene.AddItem(chart);
}

}  // namespace

void draw_history(const std::string& csv, const std::string& png, int width, int height) {
  const HistoryTable table = read_history(csv);
  const std::vector<PlotGroup> groups = plot_groups(table);
  const vtkNew<vtkContextView> view;
  vtkRenderWindow& window = *view->GetRenderWindow();
  window.SetOffScreenRendering(1);
  window.SetMultiSamples(4);
  window.SetSize(width, height);
  view->GetRenderer()->SetBackground(1, 1, 1);
  const std::size_t across = groups.size() > 4 ? 3 : groups.size() > 1 ? 2 : 1;
  const std::size_t down = std::max<std::size_t>(1, (groups.size() + across - 1) / across);
  const float cell_width = static_cast<float>(width) / static_cast<float>(across);
  const float cell_height = static_cast<float>(height) / static_cast<float>(down),
              margin = 0.012F * static_cast<float>(width);
  const int font = std::max(9, static_cast<int>(std::lround(0.021 * std::min<double>(height, 0.6 * width))));
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const auto column = static_cast<float>(i % across), row = static_cast<float>(down - 1 - i / across);
    add_chart(*view->GetScene(), table, groups[i],
              vtkRectf(column * cell_width + margin, row * cell_height + margin, cell_width - 2 * margin,
                       cell_height - 2 * margin),
              font);
  }
  window.Render();
  save_png(window, png);
}

}  // namespace tenon
