// SPDX-License-Identifier: BSD-3-Clause
#include "apps/tenon/study_measure.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "framework/io/history_table.hpp"
#include "framework/mesh/shape_functions.hpp"
#include "framework/simulation/frame_output.hpp"

namespace tenon {

namespace {

[[noreturn]] void refuse(const StudyQuantity& quantity, const std::string& message) {
  throw Error(ExitCode::usage, "quantity '" + quantity.name + "': " + message);
}

Component& component_of(const Simulation& simulation, const StudyQuantity& quantity) {
  std::vector<std::string> names;
  for (const auto& component : simulation.components()) names.push_back(component->name());
  if (quantity.component.empty()) {
    if (names.size() == 1) return *simulation.components().front();
    refuse(quantity, "the scene has several components; give the key 'component'" + scene::suggestion("", names));
  }
  Component* const found = simulation.find(quantity.component);
  if (!found)
    refuse(quantity,
           "there is no component '" + quantity.component + "'" + scene::suggestion(quantity.component, names));
  return *found;
}

/// Place of a part in a field's values.
int part_of(const StudyQuantity& quantity, const FieldDescription& field) {
  static const std::vector<std::string> vector{"x", "y", "z"}, tensor{"xx", "yy", "zz", "xy", "yz", "zx"},
      scalar{"value"};
  const std::vector<std::string>& parts = field.components == 3 ? vector : field.components == 6 ? tensor : scalar;
  const auto found = std::ranges::find(parts, quantity.part);
  if (found == parts.end())
    refuse(quantity,
           fmt::format("the field '{}' has no part '{}'{}", field.name, quantity.part, scene::suggestion("", parts)));
  return static_cast<int>(found - parts.begin());
}

ExportPort port_of(Component& component, const StudyQuantity& quantity) {
  std::vector<std::string> names;
  for (ExportPort& port : component.exports()) {
    if (port.field.kind == FieldKind::total) continue;
    if (port.field.name == quantity.field) {
      part_of(quantity, port.field);
      return std::move(port);
    }
    names.push_back(port.field.name);
  }
  refuse(quantity, "component '" + component.name() + "' shows no field '" + quantity.field + "'" +
                       scene::suggestion(quantity.field, names));
}

/// Volume (or area) and centre of every local element, undeformed.
struct Elements {
  std::vector<double> measure;
  std::vector<Vec3> centre;
  std::vector<bool> owned;
};

Elements elements_of(const Mesh& mesh) {
  Elements all;
  std::vector<Vec3> corners;
  for (const ElementBlock& block : mesh.blocks)
    for (LocalIndex e = 0; e < block.size(); ++e) {
      corners.clear();
      Vec3 sum{};
      for (const LocalIndex n : block.nodes(e)) {
        corners.push_back(mesh.coordinates[static_cast<std::size_t>(n)]);
        sum = sum + corners.back();
      }
      all.measure.push_back(element_measure(block.kind, corners));
      all.centre.push_back((1.0 / static_cast<double>(corners.size())) * sum);
      all.owned.push_back(block.owners[static_cast<std::size_t>(e)] == mesh.comm.rank());
    }
  return all;
}

/// Every element gives equal shares to its nodes. All elements around an owned node are here.
std::vector<double> node_shares(const Mesh& mesh, const Elements& elements) {
  std::vector<double> shares(static_cast<std::size_t>(mesh.nodes()), 0.0);
  std::size_t item = 0;
  for (const ElementBlock& block : mesh.blocks)
    for (LocalIndex e = 0; e < block.size(); ++e, ++item)
      for (const LocalIndex n : block.nodes(e))
        shares[static_cast<std::size_t>(n)] += elements.measure[item] / static_cast<double>(block.nodes(e).size());
  return shares;
}

/// Sums of the squares of the error and of the exact values, and their greatest.
class ErrorNorm {
 public:
  void add(double weight, double value, double exact) {
    const double e = value - exact;
    squares_.add(weight * e * e);
    exact_squares_.add(weight * exact * exact);
    greatest_ = std::max(greatest_, std::isfinite(e) ? std::abs(e) : HUGE_VAL);
    exact_greatest_ = std::max(exact_greatest_, std::abs(exact));
  }
  Measured over(const Communicator& comm) const {
    const double error = std::sqrt(comm.sum(squares_)), exact = std::sqrt(comm.sum(exact_squares_));
    const double greatest = comm.max(greatest_), exact_greatest = comm.max(exact_greatest_);
    return {error, exact > 0 ? error / exact : error, exact_greatest > 0 ? greatest / exact_greatest : greatest};
  }

 private:
  ExactSum squares_, exact_squares_;
  double greatest_ = 0, exact_greatest_ = 0;
};

double value_at(const HistoryTable& table, const std::vector<double>& column, const StudyQuantity& quantity) {
  const double time = quantity.time;
  const std::vector<double>& times = table.columns[static_cast<std::size_t>(table.find("time"))];
  const auto next = std::ranges::lower_bound(times, time);
  if (next == times.end() || (next == times.begin() && *next > time))
    refuse(quantity, fmt::format("time: {:.6g} s lies outside the history of this run, {:.6g} s to {:.6g} s", time,
                                 times.front(), times.back()));
  const auto i = static_cast<std::size_t>(next - times.begin());
  if (*next == time || i == 0) return column[i];
  return column[i - 1] + (column[i] - column[i - 1]) * ((time - times[i - 1]) / (times[i] - times[i - 1]));
}

}  // namespace

void check_fields(const StudyPlan& plan, const Simulation& simulation) {
  for (const StudyQuantity& quantity : plan.quantities)
    if (quantity.is_field) port_of(component_of(simulation, quantity), quantity);
}

void check_columns(const Communicator& comm, const StudyPlan& plan, const std::string& csv) {
  std::string wrong;
  comm.vote_on_root([&] {
    const HistoryTable table = read_history(csv);
    for (const StudyQuantity& q : plan.quantities)
      if (!q.is_field && table.find(q.column) < 0)
        wrong += (wrong.empty() ? "quantity '" : "\nquantity '") + q.name + "': history.csv has no column '" +
                 q.column + "'" + scene::suggestion(q.column, table.names);
    if (!wrong.empty()) throw Error(ExitCode::usage, wrong);
  });
}

double mean_element_size(const Simulation& simulation) {
  const Mesh& mesh = simulation.components().front()->mesh();
  const Elements elements = elements_of(mesh);
  ExactSum volume;
  for (std::size_t e = 0; e < elements.measure.size(); ++e)
    if (elements.owned[e]) volume.add(elements.measure[e]);
  const double mean = simulation.comm().sum(volume) / static_cast<double>(std::max<GlobalId>(1, mesh.global_elements));
  const bool solid = mesh.blocks.empty() || topology(mesh.blocks.front().kind).dimension == 3;
  return solid ? std::cbrt(mean) : std::sqrt(mean);
}

Measured measure_field(const Simulation& simulation, const StudyQuantity& quantity) {
  Component& component = component_of(simulation, quantity);
  const ExportPort port = port_of(component, quantity);
  const Mesh& mesh = component.mesh();
  const auto stride = static_cast<std::size_t>(port.field.components);
  const auto part = static_cast<std::size_t>(part_of(quantity, port.field));
  std::vector<double> values(local_items(mesh, port.field.location) * stride);
  port.read(values);
  const Elements elements = elements_of(mesh);
  const double t = component.time();
  ErrorNorm norm;
  if (port.field.location == Location::node) {
    const std::vector<double> shares = node_shares(mesh, elements);
    for (const LocalIndex n : mesh.owned_nodes) {
      const auto i = static_cast<std::size_t>(n);
      norm.add(shares[i], values[i * stride + part], (*quantity.exact)(t, mesh.coordinates[i]));
    }
  } else {
    for (std::size_t e = 0; e < elements.measure.size(); ++e)
      if (elements.owned[e])
        norm.add(elements.measure[e], values[e * stride + part], (*quantity.exact)(t, elements.centre[e]));
  }
  return norm.over(simulation.comm());
}

Measured measure_history(const Communicator& comm, const std::string& csv, const StudyQuantity& quantity,
                         const std::vector<double>& values) {
  Measured result;
  comm.vote_on_root([&] {
    const HistoryTable table = read_history(csv);
    const int place = table.find(quantity.column);
    if (place < 0 || table.rows() == 0) throw Error(ExitCode::file, csv + ": has no column '" + quantity.column + "'");
    const std::vector<double>& column = table.columns[static_cast<std::size_t>(place)];
    const std::vector<double>& times = table.columns[static_cast<std::size_t>(table.find("time"))];
    std::vector<double> arguments{quantity.take == StudyQuantity::Take::at ? quantity.time : times.back()};
    arguments.insert(arguments.end(), values.begin(), values.end());
    using Take = StudyQuantity::Take;
    result.value = quantity.take == Take::maximum   ? *std::ranges::max_element(column)
                   : quantity.take == Take::minimum ? *std::ranges::min_element(column)
                   : quantity.take == Take::at      ? value_at(table, column, quantity)
                                                    : column.back();
    if (!quantity.reference) return;
    const double reference = (*quantity.reference)(arguments);
    if (!std::isfinite(reference))
      refuse(quantity, "reference: '" + quantity.reference->text() + "' is not a finite number for this run");
    result.error = std::abs(result.value - reference) / (reference != 0 ? std::abs(reference) : 1.0);
  });
  std::vector<double> both{result.value, result.error};
  comm.broadcast(both);
  return {both[0], both[1], unknown};
}

}  // namespace tenon
