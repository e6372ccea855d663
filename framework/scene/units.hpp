// SPDX-License-Identifier: BSD-3-Clause
// Numbers with units; private to this room.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tenon::scene {

/// Unit of temperature differences: like K, but refuses points on a scale such as 5 degC.
inline constexpr std::string_view temperature_difference = "delta_K";

/// How a number in the user's unit becomes SI: si = scale * x + offset.
struct Conversion {
  double scale = 1, offset = 0;
  double to_si(double x) const { return scale * x + offset; }
  double from_si(double si) const { return (si - offset) / scale; }
};

/// A quantity as read: its value in SI, and the user's unit for messages about it.
struct Quantity {
  double si = 0;
  std::string unit;  ///< as written; the SI unit if none was written
  Conversion conversion;
};

/// Throws std::invalid_argument that says what was found and expected; Error(file) if there is no units database.
Quantity read_quantity(const std::string& text, const std::string& to);

/// What a quantity of this SI unit is called: {"a density", "8930 kg/m^3"}.
struct UnitExample {
  std::string name, example;
};
UnitExample unit_example(const std::string& si_unit);

/// "8930 kg/m^3": a number with its unit, without trailing zeros; just the number for unit "1".
std::string with_unit(double value, const std::string& unit);

/// SI units that have a name and example.
struct KnownUnit {
  std::string unit, name, example;
};
const std::vector<KnownUnit>& known_units();
/// Units that are offered in place of an unknown one.
const std::vector<std::string>& common_units();

}  // namespace tenon::scene
