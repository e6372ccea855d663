// SPDX-License-Identifier: BSD-3-Clause
// rival_plot OUT.png TITLE FILE.csv ERROR_COLUMN [TITLE FILE.csv ERROR_COLUMN ...]
// Run time against error, a panel each: one line per value of the column `code`. Rows without seconds are values
// published without a time; they stand as dashed lines at their error.
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
using Cells = std::vector<std::string>;

Cells split(const std::string& line) {
  Cells cells;
  std::istringstream rest(line);
  for (std::string cell; std::getline(rest, cell, ',');) cells.push_back(cell);
  return cells;
}

std::size_t place(const Cells& names, const std::string& name, const std::string& file) {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) throw Error(ExitCode::file, file + ": has no column " + name);
  return static_cast<std::size_t>(found - names.begin());
}

LogLogPanel panel(const std::string& title, const std::string& file, const std::string& column) {
  LogLogPanel result{title, "processor seconds", "relative error", {}, true};
  std::istringstream lines(read_text(file));
  std::string line;
  std::getline(lines, line);
  const Cells names = split(line);
  const std::size_t code = place(names, "code", file), seconds = place(names, "seconds", file);
  const std::size_t error = place(names, column, file);
  double first = HUGE_VAL, last = 0;
  while (std::getline(lines, line)) {
    const Cells cells = split(line);
    if (cells.size() <= std::max({code, seconds, error})) continue;
    auto found = std::ranges::find(result.lines, cells[code], &LogLogLine::name);
    if (found == result.lines.end()) {
      result.lines.push_back({cells[code], {}, {}, cells[seconds].empty()});
      found = result.lines.end() - 1;
    }
    found->y.push_back(std::stod(cells[error]));
    if (found->guide) continue;
    found->x.push_back(std::stod(cells[seconds]));
    first = std::min(first, found->x.back()), last = std::max(last, found->x.back());
  }
  for (LogLogLine& guide : result.lines)
    if (guide.guide) guide.x = {first, last}, guide.y = {guide.y.front(), guide.y.front()};
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5 || (argc - 2) % 3 != 0) {
    fmt::print(stderr, "usage: rival_plot OUT.png TITLE FILE.csv ERROR_COLUMN [TITLE FILE.csv ERROR_COLUMN ...]\n");
    return 2;
  }
  try {
    ensure_display(argc, argv);
    std::vector<LogLogPanel> panels;
    for (int i = 2; i < argc; i += 3) panels.push_back(panel(argv[i], argv[i + 1], argv[i + 2]));
    draw_log_log(panels, argv[1], 800 * static_cast<int>(panels.size()), 720);
  } catch (const std::exception& error) {
    fmt::print(stderr, "rival_plot: {}\n", error.what());
    return 3;
  }
  return 0;
}
