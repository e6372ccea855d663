// SPDX-License-Identifier: BSD-3-Clause
// Enthalpy of the nodes as a function of temperature: specific heat over temperature, and latent heat.
#pragma once

#include <span>
#include <vector>

#include "components/materials/temperature_table.hpp"
#include "framework/base/types.hpp"

namespace tenon::thermal {

/// Specific enthalpy of a material, J/kg: the integral of the specific heat, plus the latent heat, which is taken up
/// evenly between solidus and liquidus [VSC87].
struct Enthalpy {
  TemperatureTable specific_heat;    ///< J/(kg K) over K
  double latent_heat = 0;            ///< J/kg; 0: none
  double solidus = 0, liquidus = 0;  ///< K

  bool is_linear() const { return latent_heat == 0 && specific_heat.is_constant(); }
  double operator()(double temperature) const;
  /// Its slope, J/(kg K); where it jumps, that above or below.
  double slope(double temperature, bool above) const;
  /// The end of the stretch of one slope that a change from `from` to `to` must not run past: the first of solidus and
  /// liquidus between the two, or `to`.
  double stop(double from, double to) const;
};

/// Lumped: mass of each block at each owned node.
class HeatContent {
 public:
  /// `masses`: for each row, pairs (block, kg), one row after the other from `offsets`.
  struct Share {
    LocalIndex block;
    double mass;
  };
  HeatContent() = default;
  HeatContent(std::vector<Enthalpy> of_block, std::vector<LocalIndex> offsets, std::vector<Share> shares);

  /// True if energy = capacity times rise, everywhere.
  bool is_linear() const { return linear_; }
  /// J, between two temperatures of a row.
  double difference(std::size_t row, double from, double to) const;
  /// J/K.
  double slope(std::size_t row, double temperature, bool above) const;
  double stop(std::size_t row, double from, double to) const;
  std::int64_t memory() const;

 private:
  std::span<const Share> shares(std::size_t row) const {
    return std::span(shares_).subspan(static_cast<std::size_t>(offsets_[row]),
                                      static_cast<std::size_t>(offsets_[row + 1] - offsets_[row]));
  }
  std::vector<Enthalpy> of_block_;
  std::vector<LocalIndex> offsets_;
  std::vector<Share> shares_;
  bool linear_ = true;
};

}  // namespace tenon::thermal
