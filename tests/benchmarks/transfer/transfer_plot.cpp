// SPDX-License-Identifier: BSD-3-Clause
// transfer_plot OUT.png TRANSFER.csv
// What `transfer_bench methods` wrote: processor seconds of the set-up with one application, and of one application
// alone, against the error; a line per method.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <sstream>

#include "framework/base/error.hpp"
#include "framework/io/log_log_plot.hpp"
#include "framework/io/pictures.hpp"
#include "framework/io/posix_file.hpp"

namespace {

using namespace tenon;

struct Row {
  std::string panel, method;
  double set_up = 0, apply = 0, error = 0;
};

/// panel,"method",n,targets,set_up,apply,rms_error,...
std::vector<Row> read(const std::string& file) {
  std::vector<Row> rows;
  std::istringstream lines(read_text(file));
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    const std::size_t open = line.find('"'), close = line.find('"', open + 1);
    if (open == std::string::npos || close == std::string::npos)
      throw Error(ExitCode::file, fmt::format("{}: no method between quotation marks in '{}'", file, line));
    Row row{line.substr(0, line.find(',')), line.substr(open + 1, close - open - 1), 0, 0, 0};
    std::istringstream numbers(line.substr(close + 2));
    std::vector<double> values;
    for (std::string cell; std::getline(numbers, cell, ',');) values.push_back(std::stod(cell));
    if (values.size() < 5)
      throw Error(ExitCode::file, fmt::format("{}: five numbers expected after the method in '{}'", file, line));
    row.set_up = values[2], row.apply = values[3], row.error = values[4];
    rows.push_back(row);
  }
  return rows;
}

LogLogPanel panel(const std::vector<Row>& rows, const std::string& which, const std::string& title, bool set_up,
                  LegendPlace legend) {
  LogLogPanel result{title, "processor seconds", "relative rms error", {}, true, legend};
  for (const Row& row : rows) {
    if (row.panel != which) continue;
    auto line = std::ranges::find(result.lines, row.method, &LogLogLine::name);
    if (line == result.lines.end()) line = result.lines.insert(line, {row.method, {}, {}, false});
    line->x.push_back(row.apply + (set_up ? row.set_up : 0));
    line->y.push_back(row.error);
  }
  if (result.lines.empty()) return result;
  // Targets grow as n^3 and an error of second order falls as n^-2.
  const LogLogLine& first = result.lines.front();
  const double power = which == "volume" ? -2.0 / 3 : -1;
  LogLogLine guide{"second order", {}, {}, true};
  for (const double x : {first.x.front(), first.x.back()}) {
    guide.x.push_back(x);
    guide.y.push_back(0.5 * first.y.front() * std::pow(x / first.x.front(), power));
  }
  result.lines.push_back(guide);
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    fmt::print(stderr, "usage: transfer_plot OUT.png TRANSFER.csv\n");
    return 2;
  }
  try {
    ensure_display(argc, argv);
    const std::vector<Row> rows = read(argv[2]);
    std::vector<LogLogPanel> panels{panel(rows, "volume", "Cube: set-up and one application", true, LegendPlace::none),
                                    panel(rows, "volume", "Cube: each application", false, LegendPlace::beside)};
    if (std::ranges::count(rows, "surface", &Row::panel) > 0)
      panels.push_back(panel(rows, "surface", "Sphere: set-up and one application", true, LegendPlace::inside));
    draw_log_log(panels, argv[1], 700 * static_cast<int>(panels.size()) + 350, 720);
  } catch (const std::exception& error) {
    fmt::print(stderr, "transfer_plot: {}\n", error.what());
    return 3;
  }
  return 0;
}
