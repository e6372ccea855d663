// SPDX-License-Identifier: BSD-3-Clause
// Energies, extrema and point values over time, into history.csv.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "framework/io/history.hpp"
#include "framework/simulation/interval.hpp"
#include "framework/simulation/simulation.hpp"

namespace tenon {

/// The value of a field at the node, or in the element, nearest to a point of the undeformed body.
struct PointHistory {
  std::string name;  ///< column, or start of the columns of a vector: name_x, name_y, name_z
  std::string component;
  std::string field;
  Vec3 point{};  ///< reference position, m
};

struct HistoryOptions {
  std::string path;
  Interval every;
  std::vector<PointHistory> points;
};

/// Columns: time, step, dt, one per ledger row, energy_error, amounts of the transfers, extrema, points.
class HistoryOutput : public Observer {
 public:
  explicit HistoryOutput(HistoryOptions options) : options_(std::move(options)) {}
  void start(Simulation& simulation, bool restarted) override;
  void after_step(Simulation& simulation, bool last) override;
  void after_failure(Simulation& simulation) override;
  /// The greatest energy_error of all rows written by this run.
  double greatest_energy_error() const { return greatest_error_; }

 private:
  struct Probe {
    ExportPort port;
    std::size_t item = 0;
    bool mine = false;
    std::vector<double> scratch;
  };
  Probe make_probe(Simulation& simulation, const PointHistory& point);
  std::vector<std::string> columns(Simulation& simulation);
  void write(Simulation& simulation);
  void add_amounts(Simulation& simulation);
  void add_extrema(Simulation& simulation);
  void add_points(Simulation& simulation);

  HistoryOptions options_;
  IntervalClock clock_;
  std::unique_ptr<History> history_;
  std::vector<Probe> probes_;
  std::vector<double> row_;
  double greatest_error_ = 0;
};

}  // namespace tenon
