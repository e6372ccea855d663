// SPDX-License-Identifier: BSD-3-Clause
#include "framework/simulation/progress.hpp"

namespace tenon {
namespace {

/// More would not fit a line.
constexpr std::size_t most_columns = 8;

struct Sums {
  double kinetic = 0, other = 0, supplied = 0;
};

Sums sums_of(const std::vector<LedgerRow>& rows) {
  Sums sums;
  for (const LedgerRow& row : rows) {
    if (row.role == EnergyTerm::Role::memo) continue;
    const bool kinetic = row.role == EnergyTerm::Role::stored && row.row == "kinetic_energy";
    (kinetic ? sums.kinetic : row.role == EnergyTerm::Role::stored ? sums.other : sums.supplied) += row.value;
  }
  return sums;
}

}  // namespace

void Progress::start(Simulation& simulation, bool) {
  clock_ = IntervalClock(every_, simulation.start_time());
  clock_.reset(simulation.time(), simulation.steps());
  began_ = std::chrono::steady_clock::now();
  first_time_ = simulation.time();
  for (const auto& component : simulation.components()) told_.push_back(component->warnings().size());
  header(simulation);
}

void Progress::after_step(Simulation& simulation, bool last) {
  if (clock_.due(simulation.time(), simulation.steps()) || last) line(simulation);
}

void Progress::header(Simulation& simulation) {
  std::vector<std::string> names = simulation.ledger().columns();
  const bool summed = names.size() > most_columns;
  if (summed) names = {"kinetic", "other", "supplied"};
  std::string rows;
  for (std::string& name : names) {
    if (const auto tail = name.rfind("_energy"); tail != std::string::npos) name.resize(tail);
    rows += fmt::format(" {:>11.11}", name);
  }
  simulation.log().print("{:>8} {:>11} {:>10}{} {:>8} {:>7}  energies in J{}; what limits the step", "step", "time s",
                         "dt s", rows, "error", "to go", summed ? " (rows of each component: history.csv)" : "");
}

// Those of the start stand in the log already.
void Progress::new_warnings(Simulation& simulation) {
  for (std::size_t c = 0; c < told_.size(); ++c) {
    const std::vector<std::string> warnings = simulation.components()[c]->warnings();
    for (; told_[c] < warnings.size(); ++told_[c]) simulation.log().warning(warnings[told_[c]]);
  }
}

void Progress::line(Simulation& simulation) {
  new_warnings(simulation);
  const LedgerSnapshot ledger = simulation.ledger().take();
  std::string rows;
  if (ledger.rows.size() > most_columns) {
    const Sums sums = sums_of(ledger.rows);
    rows = fmt::format(" {:>11.4e} {:>11.4e} {:>11.4e}", sums.kinetic, sums.other, sums.supplied);
  } else {
    for (const LedgerRow& row : ledger.rows) rows += fmt::format(" {:>11.4e}", row.value);
  }
  const StepLimiter limiter = simulation.leader().limiter();
  const double left = seconds_left(simulation);
  simulation.log().print("{:>8} {:>11.5e} {:>10.4e}{} {:>8.1e} {:>6.0f}s  {}: {}", simulation.steps(),
                         simulation.time(), simulation.dt(), rows, ledger.error, left, simulation.leader().name(),
                         limiter.reason);
}

double Progress::seconds_left(const Simulation& simulation) const {
  const double done = simulation.time() - first_time_;
  const double spent = std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
  return done > 0 ? spent * (simulation.end_time() - simulation.time()) / done : 0.0;
}

}  // namespace tenon
