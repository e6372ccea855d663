// SPDX-License-Identifier: BSD-3-Clause
#include "framework/io/history_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include "framework/base/error.hpp"
#include "framework/io/posix_file.hpp"

namespace tenon {

namespace {

struct Quantity {
  const char* name;
  const char* unit;
};
// Words by which a column shows what it measures; the order is that of the plots.
constexpr Quantity quantities[] = {
    {"eqps", "1"},      {"temperature", "K"}, {"displacement", "m"}, {"von_mises", "Pa"}, {"velocity", "m/s"},
    {"pressure", "Pa"}, {"stress", "Pa"},     {"damage", "1"},       {"force", "N"},      {"dt", "s"}};
constexpr std::size_t most_groups = 6;

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> cells;
  for (;;) {
    const std::size_t comma = line.find(',');
    cells.push_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

bool add_row(HistoryTable& table, std::string_view line) {
  const std::vector<std::string_view> cells = split(line);
  if (cells.size() != table.names.size()) return false;
  std::vector<double> values(cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const auto [end, error] = std::from_chars(cells[c].data(), cells[c].data() + cells[c].size(), values[c]);
    if (error == std::errc::invalid_argument || end != cells[c].data() + cells[c].size()) return false;
    if (!std::isfinite(values[c])) values[c] = std::numeric_limits<double>::quiet_NaN();
  }
  for (std::size_t c = 0; c < values.size(); ++c) table.columns[c].push_back(values[c]);
  return true;
}

bool tells_something(const std::vector<double>& column) {
  return std::ranges::any_of(column, [](double v) { return std::isfinite(v) && v != 0; });
}

}  // namespace

int HistoryTable::find(const std::string& name) const {
  const auto found = std::ranges::find(names, name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

HistoryTable read_history(const std::string& path) {
  const std::string text = read_text(path);
  std::string_view rest = text;
  HistoryTable table;
  for (std::size_t end; (end = rest.find('\n')) != std::string_view::npos; rest.remove_prefix(end + 1)) {
    const std::string_view line = rest.substr(0, end);
    if (table.names.empty()) {
      for (const std::string_view cell : split(line)) table.names.emplace_back(cell);
      table.columns.resize(table.names.size());
    } else if (!add_row(table, line)) {
      throw Error(ExitCode::file,
                  fmt::format("{}: row {} is not {} numbers", path, table.rows() + 2, table.names.size()));
    }
  }
  if (table.find("time") < 0) throw Error(ExitCode::file, fmt::format("{}: has no column 'time'", path));
  return table;
}

std::vector<PlotGroup> plot_groups(const HistoryTable& table) {
  std::vector<PlotGroup> groups{{"energy", "J", false, {}}, {"relative energy error", "1", true, {}}};
  for (const Quantity& q : quantities) groups.push_back({q.name, q.unit, false, {}});
  const int error = table.find("energy_error"), dt = table.find("dt");
  for (int c = 0; c < static_cast<int>(table.names.size()); ++c) {
    if (!tells_something(table.columns[static_cast<std::size_t>(c)])) continue;
    if (c == error)
      groups[1].columns.push_back(c);
    else if (c > dt && c < error)  // the rows of the ledger stand between these two
      groups[0].columns.push_back(c);
    else
      for (std::size_t q = 0; q < std::size(quantities); ++q)
        if (c == dt ? std::string_view(quantities[q].name) == "dt"
                    : table.names[static_cast<std::size_t>(c)].find(quantities[q].name) != std::string::npos) {
          groups[q + 2].columns.push_back(c);
          break;
        }
  }
  std::erase_if(groups, [](const PlotGroup& g) { return g.columns.empty(); });
  if (groups.size() > most_groups) groups.resize(most_groups);
  return groups;
}

}  // namespace tenon
