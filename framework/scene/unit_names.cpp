// SPDX-License-Identifier: BSD-3-Clause
// What quantities are called, and an example of each.
#include <fmt/core.h>

#include "framework/scene/units.hpp"

namespace tenon::scene {

const std::vector<KnownUnit>& known_units() {
  static const std::vector<KnownUnit> units{
      {"1", "a plain number", "0.3"},
      {"m", "a length", "32.4 mm"},
      {"s", "a time", "80 us"},
      {"kg", "a mass", "2.5 kg"},
      {"K", "a temperature", "20 degC"},
      {"delta_K", "a temperature difference", "5 K"},
      {"rad", "an angle", "30 degree"},
      {"m^2", "an area", "12 mm^2"},
      {"m^3", "a volume", "3 cm^3"},
      {"m/s", "a velocity", "227 m/s"},
      {"m/s^2", "an acceleration", "9.81 m/s^2"},
      {"1/s", "a rate", "1 1/s"},
      {"rad/s", "an angular velocity", "100 rad/s"},
      {"Hz", "a frequency", "50 Hz"},
      {"kg/m^3", "a density", "8930 kg/m^3"},
      {"kg/m^2", "a mass per area", "7.85 kg/m^2"},
      {"m^3/kg", "a specific volume", "1e-3 m^3/kg"},
      {"N", "a force", "5 kN"},
      {"N/m", "a stiffness", "10 N/mm"},
      {"N/m^3", "a stiffness per area", "1e12 N/m^3"},
      {"Pa", "a pressure, stress or modulus", "117 GPa"},
      {"1/Pa", "a compliance", "1e-11 1/Pa"},
      {"Pa s", "a viscosity", "1e-3 Pa s"},
      {"J", "an energy", "12 kJ"},
      {"J/kg", "a specific energy", "205 kJ/kg"},
      {"J/m^2", "an energy per area", "500 J/m^2"},
      {"W", "a power", "1.5 kW"},
      {"W/m^2", "a heat flux", "10 kW/m^2"},
      {"W/m^3", "a heat source", "1 MW/m^3"},
      {"W/(m K)", "a thermal conductivity", "386 W/(m K)"},
      {"J/(kg K)", "a specific heat", "383 J/(kg K)"},
      {"W/(m^2 K)", "a heat transfer coefficient", "25 W/(m^2 K)"},
      {"1/K", "a thermal expansion", "1.7e-5 1/K"},
      {"K/m", "a temperature gradient", "100 K/m"},
      {"m^2/s", "a diffusivity", "1.1e-4 m^2/s"},
      {"1/m", "a quantity per length", "10 1/m"},
  };
  return units;
}

const std::vector<std::string>& common_units() {
  static const std::vector<std::string> units{
      "m",      "mm",     "cm", "um",     "nm",    "km",    "inch",     "foot",   "s",      "ms",    "us",  "ns",
      "min",    "hour",   "kg", "g",      "mg",    "t",     "lb",       "Pa",     "kPa",    "MPa",   "GPa", "bar",
      "psi",    "ksi",    "N",  "mN",     "kN",    "MN",    "J",        "mJ",     "kJ",     "MJ",    "W",   "mW",
      "kW",     "MW",     "K",  "mK",     "degC",  "degF",  "kelvin",   "Hz",     "kHz",    "MHz",   "rad", "deg",
      "degree", "radian", "%",  "second", "metre", "meter", "kilogram", "newton", "pascal", "joule", "watt"};
  return units;
}

UnitExample unit_example(const std::string& si_unit) {
  for (const KnownUnit& known : known_units())
    if (known.unit == si_unit) return {known.name, known.example};
  return {"a quantity in " + si_unit, "1 " + si_unit};
}

std::string with_unit(double value, const std::string& unit) {
  return unit == "1" || unit.empty() ? fmt::format("{:.10g}", value) : fmt::format("{:.10g} {}", value, unit);
}

}  // namespace tenon::scene
