// SPDX-License-Identifier: BSD-3-Clause
// Quadrature points of the source, where they lie in the target, brought to the ranks that have the target elements.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "transfer/element_points.hpp"
#include "transfer/rows.hpp"

namespace tenon::transfer {

/// A quadrature point of a source element that lies in a target element.
struct Sample {
  std::array<double, max_linear_nodes> target_value{};  ///< shape functions of the target element's nodes there
  double weight = 0;                                    ///< volume that it stands for, m^3
  GlobalId source_element = no_id;
  LocalIndex source_item = no_index;  ///< place of the source element at its owner
  int source_owner = -1;
  LocalIndex target_item = no_index;  ///< local element that it lies in
  std::uint16_t point = 0;            ///< of the table
  std::uint8_t kind = 0, cells = 0;   ///< which table
};

/// The tables of quadrature points by kind of element and number of cells along an edge, made when first asked for.
class SampleTables {
 public:
  const PointTable& of(ElementKind kind, int cells) { return table(kind, cells).points; }
  /// Their shape functions alone, padded to max_linear_nodes or max_nodes for each point.
  std::span<const double> values(ElementKind kind, int cells) { return table(kind, cells).values; }

 private:
  struct Table {
    PointTable points;
    std::vector<double> values;
  };
  const Table& table(ElementKind kind, int cells);
  std::array<std::vector<Table>, element_kinds> tables_;
};

/// The samples in each local target element, owned or ghost: begin[t] .. begin[t+1]), ascending by source element and
/// point, the same on every rank that has the element.
struct TargetSamples {
  std::vector<Sample> samples;
  std::vector<std::size_t> begin;
  GlobalId points = 0, outside = 0;  ///< over all ranks: sought, and found to lie in no target element
  std::span<const Sample> in(LocalIndex element) const {
    const auto t = static_cast<std::size_t>(element);
    return std::span(samples).subspan(begin[t], begin[t + 1] - begin[t]);
  }
};

/// Collective. Midpoints of sub-cells of the source elements, so fine that there are about `per_edge` of them along an
/// edge of the mean target element, to the nearest number, but at least 2 and at most 6 along one of the source
/// element. Points outside the target are dropped.
TargetSamples samples_in_target(const Side& source, const Side& target, const PlaceRules& rules, double per_edge,
                                SampleTables& tables, const std::string& name);

}  // namespace tenon::transfer
