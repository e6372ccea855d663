// SPDX-License-Identifier: BSD-3-Clause
#include "apps/tenon/study_picture.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <sstream>
#include <vector>

#include "apps/tenon/study_plan.hpp"
#include "framework/base/error.hpp"
#include "framework/io/log_log_plot.hpp"
#include "framework/io/posix_file.hpp"

namespace tenon {

namespace {

namespace fs = std::filesystem;
using Cells = std::vector<std::string>;

Cells split_cells(const std::string& line) {
  Cells cells{""};
  bool quoted = false;
  for (const char c : line) {
    if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      cells.emplace_back();
    else
      cells.back() += c;
  }
  return cells;
}

/// Columns of numbers by name; cells that are none are NaN.
struct Table {
  Cells names;
  std::vector<Cells> rows;
  std::vector<double> column(const std::string& name) const {
    const auto place = static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
    std::vector<double> values;
    for (const Cells& row : rows)
      values.push_back(place < row.size() ? scene::number_in_si(row[place]).value_or(NAN) : NAN);
    return values;
  }
};

Table read_table(const std::string& path) {
  std::istringstream lines(read_text(path));
  Table table;
  for (std::string line; std::getline(lines, line);) {
    if (table.names.empty())
      table.names = split_cells(line);
    else
      table.rows.push_back(split_cells(line));
  }
  if (table.names.empty()) throw Error(ExitCode::file, path + ": is empty");
  return table;
}

/// The order of the two finest rows, nearest whole number; 0 if there is none.
int whole_order(const std::vector<double>& orders) {
  for (std::size_t i = orders.size(); i-- > 0;)
    if (std::isfinite(orders[i])) return static_cast<int>(std::lround(orders[i]));
  return 0;
}

std::string legend(const std::string& name, const std::vector<double>& orders) {
  for (std::size_t i = orders.size(); i-- > 0;)
    if (std::isfinite(orders[i])) return fmt::format("{}, order {:.2f}", name, orders[i]);
  return name;
}

/// A straight line of this slope through the first of the finest points, a little below.
LogLogLine guide(const LogLogLine& line, int order) {
  LogLogLine slope{fmt::format("order {}", order), {}, {}, true};
  double low = HUGE_VAL, high = 0, at = 0;
  for (std::size_t i = 0; i < line.x.size(); ++i) {
    if (!(line.x[i] > 0) || !(line.y[i] > 0)) continue;
    if (line.x[i] < low) low = line.x[i], at = line.y[i];
    high = std::max(high, line.x[i]);
  }
  if (high > low) slope.x = {low, high}, slope.y = {0.7 * at, 0.7 * at * std::pow(high / low, order)};
  return slope;
}

}  // namespace

bool is_study_folder(const std::string& folder) {
  return fs::exists(folder + "/study.csv");
}

std::string draw_study(const std::string& folder) {
  const Table table = read_table(folder + "/study.csv");
  const std::vector<double> size = table.column("size"), seconds = table.column("seconds");
  LogLogPanel over_size{"error over size", "size h", "relative error", {}, false};
  LogLogPanel over_time{"error over run time", "seconds of stepping", "relative error", {}, true};
  for (const std::string& name : table.names) {
    const std::size_t end = name.size() >= 6 ? name.size() - 6 : 0;
    if (name.substr(end) != "_error" || (end > 9 && name.substr(end - 9, 9) == "_greatest")) continue;
    const std::string quantity = name.substr(0, end);
    const std::vector<double> errors = table.column(name), orders = table.column(quantity + "_order");
    over_size.lines.push_back({legend(quantity, orders), size, errors, false});
    over_time.lines.push_back({quantity, seconds, errors, false});
  }
  if (!over_size.lines.empty()) {
    const std::string first = over_time.lines.front().name;
    if (const int order = whole_order(table.column(first + "_order")); order > 0)
      over_size.lines.push_back(guide(over_size.lines.front(), order));
  }
  const std::string png = folder + "/study.png";
  draw_log_log({over_size, over_time}, png, 1600, 720);
  return png;
}

std::string draw_in_process_of_its_own(const std::string& folder) {
  const std::string failed = " (study.png could not be drawn; see tenon picture " + folder + ")";
  std::error_code problem;
  std::string self = fs::read_symlink("/proc/self/exe", problem).string();
  if (problem) return failed;
  std::string word = "picture", path = folder;
  char* arguments[] = {self.data(), word.data(), path.data(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int started = ::posix_spawn(&child, self.c_str(), &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  if (started != 0 || ::waitpid(child, &status, 0) != child || status != 0) return failed;
  return ", study.png";
}

}  // namespace tenon
