// SPDX-License-Identifier: BSD-3-Clause
// history.csv in memory, and which of its columns belong in one plot.
#pragma once

#include <string>
#include <vector>

namespace tenon {

struct HistoryTable {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;  ///< as long as there are whole rows
  std::size_t rows() const { return columns.empty() ? 0 : columns.front().size(); }
  /// -1 if there is none.
  int find(const std::string& name) const;
};

/// Throws Error(file). A torn last row is left out.
HistoryTable read_history(const std::string& path);

/// Columns that share an axis.
struct PlotGroup {
  std::string quantity, unit;  ///< unit of the file (SI); "" if unknown
  bool logarithmic = false;
  std::vector<int> columns;
};

/// Energies, the ledger's error, and the extrema by their quantity; columns that are zero throughout are left out. At
/// most six.
std::vector<PlotGroup> plot_groups(const HistoryTable& table);

}  // namespace tenon
