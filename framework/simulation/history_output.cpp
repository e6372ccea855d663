// SPDX-License-Identifier: BSD-3-Clause
#include "framework/simulation/history_output.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <limits>

#include "framework/simulation/frame_output.hpp"

namespace tenon {

namespace {

const char* const suffix3[] = {"_x", "_y", "_z"};
const char* const suffix6[] = {"_xx", "_yy", "_zz", "_xy", "_yz", "_zx"};

std::vector<std::string> point_columns(const std::string& name, int components) {
  if (components == 1) return {name};
  std::vector<std::string> columns;
  for (int c = 0; c < components; ++c) columns.push_back(name + (components == 3 ? suffix3[c] : suffix6[c]));
  return columns;
}

struct Nearest {
  double distance = std::numeric_limits<double>::infinity();
  GlobalId id = std::numeric_limits<GlobalId>::max();
  std::size_t item = 0;
  void offer(double d, GlobalId candidate, std::size_t position) {
    if (d < distance || (d == distance && candidate < id)) *this = {d, candidate, position};
  }
};

Nearest nearest_owned_node(const Mesh& mesh, const Vec3& point) {
  Nearest best;
  for (const LocalIndex n : mesh.owned_nodes) {
    const auto i = static_cast<std::size_t>(n);
    best.offer(norm(mesh.coordinates[i] - point), mesh.node_ids[i], i);
  }
  return best;
}

Nearest nearest_owned_element(const Mesh& mesh, const Vec3& point) {
  Nearest best;
  std::size_t item = 0;
  for (const ElementBlock& block : mesh.blocks)
    for (LocalIndex e = 0; e < block.size(); ++e, ++item) {
      if (block.owners[static_cast<std::size_t>(e)] != mesh.comm.rank()) continue;
      Vec3 centre{};
      for (const LocalIndex n : block.nodes(e)) centre = centre + mesh.coordinates[static_cast<std::size_t>(n)];
      centre = (1.0 / static_cast<double>(block.nodes(e).size())) * centre;
      best.offer(norm(centre - point), block.ids[static_cast<std::size_t>(e)], item);
    }
  return best;
}

}  // namespace

HistoryOutput::Probe HistoryOutput::make_probe(Simulation& simulation, const PointHistory& point) {
  Component* component = simulation.find(point.component);
  if (!component)
    throw Error(ExitCode::usage, fmt::format("history point '{}': no component '{}'", point.name, point.component));
  std::vector<ExportPort> ports = component->exports();
  const auto port = std::find_if(ports.begin(), ports.end(), [&](const ExportPort& p) {
    return p.field.name == point.field && p.field.kind != FieldKind::total;
  });
  if (port == ports.end())
    throw Error(ExitCode::usage, fmt::format("history point '{}': component '{}' shows no field '{}'", point.name,
                                             point.component, point.field));
  const Mesh& mesh = component->mesh();
  const Nearest best = port->field.location == Location::node ? nearest_owned_node(mesh, point.point)
                                                              : nearest_owned_element(mesh, point.point);
  const double distance = simulation.comm().min(best.distance);
  const GlobalId candidate = best.distance == distance ? best.id : std::numeric_limits<GlobalId>::max();
  const bool mine = simulation.comm().min(candidate) == candidate && best.distance == distance;
  const std::size_t size = local_items(mesh, port->field.location) * static_cast<std::size_t>(port->field.components);
  return {std::move(*port), best.item, mine, std::vector<double>(size)};
}

std::vector<std::string> HistoryOutput::columns(Simulation& simulation) {
  std::vector<std::string> names{"time", "step", "dt"};
  for (const std::string& row : simulation.ledger().columns()) names.push_back(row);
  names.push_back("energy_error");
  for (const auto& coupling : simulation.couplings())
    for (const auto& [column, amount] : coupling->amounts()) names.push_back(column);
  for (const auto& interaction : simulation.interactions())
    for (const auto& [column, amount] : interaction->amounts()) names.push_back(column);
  for (const auto& component : simulation.components())
    for (const HistoryValue& value : component->history_values()) {
      const bool taken = std::ranges::find(names, value.column) != names.end();
      names.push_back(taken ? component->name() + "." + value.column : value.column);
    }
  for (const auto& interaction : simulation.interactions())
    for (const HistoryValue& value : interaction->history_values()) names.push_back(value.column);
  for (std::size_t p = 0; p < probes_.size(); ++p)
    for (const std::string& column : point_columns(options_.points[p].name, probes_[p].port.field.components))
      names.push_back(column);
  return names;
}

void HistoryOutput::start(Simulation& simulation, bool restarted) {
  clock_ = IntervalClock(options_.every, simulation.start_time());
  clock_.reset(simulation.time(), simulation.steps());
  for (const PointHistory& point : options_.points) probes_.push_back(make_probe(simulation, point));
  history_ = std::make_unique<History>(simulation.comm(), options_.path, columns(simulation),
                                       restarted ? simulation.steps() : -1);
  if (!restarted) write(simulation);
}

void HistoryOutput::after_step(Simulation& simulation, bool last) {
  if (clock_.due(simulation.time(), simulation.steps()) || (last && !simulation.stopped())) write(simulation);
  if (last) history_->flush();
}

void HistoryOutput::after_failure(Simulation&) {
  if (history_) history_->flush();
}

void HistoryOutput::write(Simulation& simulation) {
  const ScopedTimer timer(simulation.timers().phase("output: history"));
  const LedgerSnapshot ledger = simulation.ledger().take();
  row_ = {simulation.time(), static_cast<double>(simulation.steps()), simulation.dt()};
  for (const LedgerRow& row : ledger.rows) row_.push_back(row.value);
  row_.push_back(ledger.error);
  greatest_error_ = std::max(greatest_error_, ledger.error);
  add_amounts(simulation);
  add_extrema(simulation);
  add_points(simulation);
  history_->row(row_);
}

void HistoryOutput::add_amounts(Simulation& simulation) {
  std::vector<ExactSum> sums;
  for (const auto& coupling : simulation.couplings())
    for (const auto& [column, amount] : coupling->amounts()) sums.push_back(amount);
  for (const auto& interaction : simulation.interactions())
    for (const auto& [column, amount] : interaction->amounts()) sums.push_back(amount);
  std::vector<double> values(sums.size());
  simulation.comm().sum(sums, values);
  row_.insert(row_.end(), values.begin(), values.end());
}

// Minima travel as maxima of the negative, so one reduction serves all; sums go exactly.
void HistoryOutput::add_extrema(Simulation& simulation) {
  std::vector<HistoryValue> all;
  for (const auto& component : simulation.components())
    for (HistoryValue& value : component->history_values()) all.push_back(std::move(value));
  for (const auto& interaction : simulation.interactions())
    for (HistoryValue& value : interaction->history_values()) all.push_back(std::move(value));
  std::vector<double> extrema(all.size());
  std::vector<ExactSum> sums(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].reduce == HistoryValue::Reduce::sum)
      sums[i].add(all[i].local);
    else
      extrema[i] = all[i].reduce == HistoryValue::Reduce::min ? -all[i].local : all[i].local;
  }
  simulation.comm().max(extrema);
  std::vector<double> totals(all.size());
  simulation.comm().sum(sums, totals);
  for (std::size_t i = 0; i < all.size(); ++i)
    row_.push_back(all[i].reduce == HistoryValue::Reduce::sum   ? totals[i]
                   : all[i].reduce == HistoryValue::Reduce::min ? -extrema[i]
                                                                : extrema[i]);
}

void HistoryOutput::add_points(Simulation& simulation) {
  std::vector<double> values;
  for (Probe& probe : probes_) {
    probe.port.read(probe.scratch);
    const auto width = static_cast<std::size_t>(probe.port.field.components);
    for (std::size_t c = 0; c < width; ++c)
      values.push_back(probe.mine ? probe.scratch[probe.item * width + c] : -std::numeric_limits<double>::infinity());
  }
  simulation.comm().max(values);
  row_.insert(row_.end(), values.begin(), values.end());
}

}  // namespace tenon
