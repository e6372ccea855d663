// SPDX-License-Identifier: BSD-3-Clause
// Two bodies in one mesh, for tests of heat that passes between them.
#pragma once

#include "thermal_case.hpp"
#include "two_bodies.hpp"

namespace tenon::testing {

/// Distributed over all ranks; made on rank 0.
template <typename Shape, typename OtherShape>
std::shared_ptr<const Mesh> distributed_pair(const Shape& a, const OtherShape& b) {
  MeshData data;
  if (communicator().rank() == 0) {
    MeshData first = generate(a), second = generate(b);
    add_derived_sets(first), add_derived_sets(second);
    data = together(std::move(first), second);
  }
  return distribute(communicator(), std::move(data), {});
}

/// A bar from x = low to high with `across` elements in each direction across.
inline BoxShape bar_between(double low, double high, int along, int across, double width = 0.02) {
  BoxShape shape;
  shape.low = {low, 0, 0};
  shape.high = {high, width, width};
  shape.elements = {along, across, across};
  return shape;
}

/// Blocks "a_box" and "b_box" of given conductivities; rho c = 4e6 and 2e6 J/(m^3 K).
inline ThermalOptions two_bars(ThermalStepper stepper, double first_conductivity, double second_conductivity) {
  ThermalOptions options;
  options.blocks = {{"a_box", 8000, 500, first_conductivity, 0}, {"b_box", 4000, 500, second_conductivity, 0}};
  options.stepper = stepper;
  return options;
}

/// Between the ends that face each other.
inline ThermalContact contact_of_ends(double conductance) {
  ThermalContact contact;
  contact.first = "a_x_max", contact.second = "b_x_min";
  contact.conductance = TimeFunction::constant(conductance);
  return contact;
}

/// Least and greatest temperature on a node set, on all ranks.
inline std::pair<double, double> range_on(const Thermal& thermal, const std::string& node_set) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const LocalIndex n : thermal.mesh().find_node_set(node_set)->nodes) {
    low = std::min(low, thermal.temperature()[static_cast<std::size_t>(n)]);
    high = std::max(high, thermal.temperature()[static_cast<std::size_t>(n)]);
  }
  return {thermal.mesh().comm.min(low), thermal.mesh().comm.max(high)};
}

}  // namespace tenon::testing
