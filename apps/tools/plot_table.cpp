// SPDX-License-Identifier: BSD-3-Clause
// Draws a table of lines as a picture with logarithmic axes: tenon_plot_table TABLE.csv PICTURE.png [WIDTH HEIGHT].
// Columns: panel, x_title, y_title, line, x, y, guide (1: a dashed line to compare with). Rows of one panel and line
// belong together; panels stand side by side in the order of their first rows.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "framework/base/error.hpp"
#include "framework/io/log_log_plot.hpp"
#include "framework/io/pictures.hpp"

namespace {

using tenon::Error;
using tenon::ExitCode;
using tenon::LogLogLine;
using tenon::LogLogPanel;

constexpr std::size_t columns = 7;

std::vector<std::string> split(const std::string& row) {
  std::vector<std::string> cells;
  std::istringstream stream(row);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

template <typename Item, typename Name>
Item& find_or_add(std::vector<Item>& items, Name Item::*name, const std::string& wanted) {
  const auto found = std::ranges::find(items, wanted, name);
  if (found != items.end()) return *found;
  items.emplace_back();
  items.back().*name = wanted;
  return items.back();
}

std::vector<LogLogPanel> read_panels(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw Error(ExitCode::file, path + ": cannot be read");
  std::vector<LogLogPanel> panels;
  std::string row;
  std::getline(file, row);  // names
  while (std::getline(file, row)) {
    const std::vector<std::string> cells = split(row);
    if (cells.size() != columns)
      throw Error(ExitCode::file, path + ": expected panel,x_title,y_title,line,x,y,guide in each row: " + row);
    LogLogPanel& panel = find_or_add(panels, &LogLogPanel::title, cells[0]);
    panel.x_title = cells[1], panel.y_title = cells[2], panel.legend = tenon::LegendPlace::beside;
    LogLogLine& line = find_or_add(panel.lines, &LogLogLine::name, cells[3]);
    line.x.push_back(std::atof(cells[4].c_str()));
    line.y.push_back(std::atof(cells[5].c_str()));
    line.guide = cells[6] == "1";
  }
  return panels;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3 && argc != 5) {
    std::fprintf(stderr, "usage: tenon_plot_table TABLE.csv PICTURE.png [WIDTH HEIGHT]\n");
    return static_cast<int>(ExitCode::usage);
  }
  try {
    tenon::ensure_display(argc, argv);
    const int width = argc == 5 ? std::atoi(argv[3]) : 1600, height = argc == 5 ? std::atoi(argv[4]) : 640;
    tenon::draw_log_log(read_panels(argv[1]), argv[2], width, height);
    return 0;
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return static_cast<int>(error.code());
  }
}
