// SPDX-License-Identifier: BSD-3-Clause
// Numbers with units: exact conversion, and what is refused in which words.
#include <gtest/gtest.h>

#include <numbers>
#include <stdexcept>
#include <string>

#include "framework/scene/schema.hpp"

namespace tenon::scene {
namespace {

std::string refusal(const std::string& text, const std::string& unit) {
  try {
    parse_quantity(text, unit);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Units, DecimalPrefixesGiveTheDoubleOfTheSiNumber) {
  EXPECT_EQ(parse_quantity("8930 kg/m^3", "kg/m^3"), 8930.0);
  EXPECT_EQ(parse_quantity("117 GPa", "Pa"), 117e9);
  EXPECT_EQ(parse_quantity("80 us", "s"), 80e-6);
  EXPECT_EQ(parse_quantity("7.85 g/cm3", "kg/m^3"), 7850.0);
  EXPECT_EQ(parse_quantity("7.85 g/cm^3", "kg/m^3"), 7850.0);
  EXPECT_EQ(parse_quantity("32.4 mm", "m"), 0.0324);
  EXPECT_EQ(parse_quantity("3.7ms", "s"), 3.7e-3);
  EXPECT_EQ(parse_quantity("0.1 µs", "s"), 1e-7);
  EXPECT_EQ(parse_quantity("30 %", "1"), 0.3);
  EXPECT_EQ(parse_quantity("4.2 mm/ms", "m/s"), 4.2);
}

TEST(Units, PlainNumbersAreSi) {
  EXPECT_EQ(parse_quantity("0.3", "1"), 0.3);
  EXPECT_EQ(parse_quantity("1e3", "s"), 1000.0);
  EXPECT_EQ(parse_quantity("+5", "m"), 5.0);
  EXPECT_EQ(parse_quantity("-.5e1", "m"), -5.0);
  EXPECT_EQ(parse_quantity("7", "kg/m^3"), 7.0);
  EXPECT_EQ(parse_quantity("0", "Pa"), 0.0);
}

TEST(Units, ProductsAndPowersInSeveralSpellings) {
  for (const char* text :
       {"386 W/(m K)", "386 W/m/K", "386 W/(m·K)", "386 W m-1 K-1", "386 W*m^-1*K^-1", "386 W/(m degC)"})
    EXPECT_EQ(parse_quantity(text, "W/(m K)"), 386.0) << text;
  for (const char* text : {"2 W/m^2", "2 W/m2", "2 W/m²", "2 W/m**2", "2 W m⁻²", "2 W·m^-2", "2 W/(m)²", "2 W m**-2"})
    EXPECT_EQ(parse_quantity(text, "W/m^2"), 2.0) << text;
  EXPECT_EQ(parse_quantity("1.7e-5 1/K", "1/K"), 1.7e-5);
  EXPECT_EQ(parse_quantity("3 N m", "J"), 3.0);
}

TEST(Units, NonDecimalUnits) {
  EXPECT_DOUBLE_EQ(parse_quantity("30 deg", "rad"), std::numbers::pi / 6);
  EXPECT_DOUBLE_EQ(parse_quantity("36 km/h", "m/s"), 10.0);
  EXPECT_DOUBLE_EQ(parse_quantity("2 inch", "m"), 0.0508);
  EXPECT_DOUBLE_EQ(parse_quantity("3 min", "s"), 180.0);
}

TEST(Units, TemperaturesHaveAnOffsetAndDifferencesHaveNot) {
  EXPECT_EQ(parse_quantity("20 degC", "K"), 293.15);
  EXPECT_EQ(parse_quantity("20 °C", "K"), 293.15);
  EXPECT_NEAR(parse_quantity("68 degF", "K"), 293.15, 1e-12 * 293);
  EXPECT_EQ(parse_quantity("293.15 K", "K"), 293.15);
  EXPECT_EQ(parse_quantity("5 K", "delta_K"), 5.0);
  EXPECT_EQ(parse_quantity("5", "delta_K"), 5.0);
  EXPECT_DOUBLE_EQ(parse_quantity("9 degR", "delta_K"), 5.0);
  EXPECT_EQ(refusal("5 degC", "delta_K"),
            "'5 degC': it is a point on a temperature scale, not a difference; write the difference in K; expected a "
            "temperature "
            "difference such as 5 K");
  EXPECT_EQ(refusal("20 C", "K"),
            "'20 C': 'C' is the coulomb (did you mean 'degC'?); expected a temperature such as 20 degC");
}

TEST(Units, WrongDimensionSaysWhatWasFoundAndExpected) {
  EXPECT_EQ(refusal("5 m", "kg/m^3"), "'5 m': it is a length; expected a density such as 8930 kg/m^3");
  EXPECT_EQ(refusal("3 kg", "K"), "'3 kg': it is a mass; expected a temperature such as 20 degC");
  EXPECT_EQ(refusal("3 kg", "kg^2"), "'3 kg': it is a mass; expected a quantity in kg^2 such as 1 kg^2");
  EXPECT_EQ(refusal("3 mol", "m"), "'3 mol': its unit does not fit; expected a length such as 32.4 mm");
  // UDUNITS would convert reciprocals; 5 Hz is no time of 0.2 s.
  EXPECT_EQ(refusal("5 Hz", "s"), "'5 Hz': it is a rate; expected a time such as 80 us");
  EXPECT_EQ(refusal("2 m^3/kg", "kg/m^3"),
            "'2 m^3/kg': it is a specific volume; expected a density such as 8930 kg/m^3");
}

TEST(Units, UnknownUnitsAreNamedWithTheNearest) {
  EXPECT_EQ(
      refusal("3 gpa", "Pa"),
      "'3 gpa': there is no unit 'gpa' (did you mean 'GPa'?); expected a pressure, stress or modulus such as 117 GPa");
  EXPECT_EQ(refusal("3 kg/mmm^3", "kg/m^3"),
            "'3 kg/mmm^3': there is no unit 'mmm' (did you mean 'mm'?); expected a density such as 8930 kg/m^3");
  EXPECT_EQ(refusal("3 qqqqqqq", "m"), "'3 qqqqqqq': there is no unit 'qqqqqqq'; expected a length such as 32.4 mm");
}

TEST(Units, RefusesWhatUdunitsWouldTurnIntoAnotherNumber) {
  for (const char* text : {"5 5 m",   "5 m @ 3", "5 m from 3", "5 lg(re 1 m)", "5 2",     "5 m:3",   "5 m^999", "5 m)",
                           "5 (m",    "5 ()",    "5 m -2",     "5 m +2",       "5 m--2",  "5 m^1.1", "5 m 2",   "5 2 m",
                           "5 m^2^3", "5 m*2",   "5 m/",       "5 m.5",        "5 (m)-2", "5 m*-2"})
    EXPECT_NE(refusal(text, "m"), "accepted") << text;
}

TEST(Units, RefusesWhatIsNoFiniteNumber) {
  for (const char* text : {"inf",
                           "-inf",
                           "nan",
                           ".inf",
                           ".nan",
                           "infinity",
                           "",
                           " ",
                           "m",
                           "kg/m^3",
                           "-",
                           "+",
                           ".",
                           "e5",
                           "0x10",
                           "1e999",
                           "1e99999999999999999999",
                           "1e308 km",
                           "--5",
                           "1,5 mm",
                           "1_000 m"})
    EXPECT_NE(refusal(text, "m"), "accepted") << text;
  EXPECT_EQ(refusal("nan", "m"), "'nan': it does not begin with a finite number; expected a length such as 32.4 mm");
  EXPECT_EQ(refusal("1,5 mm", "m"), "'1,5 mm': write a decimal point, not a comma; expected a length such as 32.4 mm");
  EXPECT_EQ(refusal("1e999 m", "m"),
            "'1e999 m': the number is too large or too small; expected a length such as 32.4 mm");
}

TEST(Units, AnUnknownUnitInTheSchemaIsAProgrammingError) {
  EXPECT_THROW(parse_quantity("5 m", "furlongs_per_blip"), std::logic_error);
  EXPECT_THROW(Schema("x").quantity("a", "furlongs_per_blip", "doc"), std::logic_error);
}

}  // namespace
}  // namespace tenon::scene
