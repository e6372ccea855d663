// SPDX-License-Identifier: BSD-3-Clause
// Formulas: values against C++, forms of time and place, refusals with their places, no allocation.
#include "framework/scene/expression.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "allocation_counter.hpp"
#include "rich_schema.hpp"

namespace tenon::scene {
namespace {

double at(const std::string& text, double t = 0, const Vec3& x = {0, 0, 0}) {
  return parse_field_expression(text)(t, x);
}

/// What the text is refused with.
std::string refusal(const std::string& text) {
  try {
    parse_field_expression(text);
  } catch (const std::invalid_argument& wrong) {
    return wrong.what();
  }
  return "";
}

TEST(Expression, ValuesAreThoseOfTheMathematicalLibrary) {
  const double t = 0.37, x = 1.7, y = -0.4, z = 2.25;
  const Vec3 p{x, y, z};
  EXPECT_NEAR(at("10 * sin(2*pi*t/1e-3) * exp(-x^2)", 3.7e-4, p),
              10 * std::sin(0.74 * std::numbers::pi) * std::exp(-(x * x)), 1e-15);
  EXPECT_EQ(at("-x^2", t, p), -(x * x));
  EXPECT_EQ(at("2^3^2"), 512.0);
  EXPECT_EQ(at("x > y ? z : 7", t, p), z);
  EXPECT_EQ(at("x < y || z == 2.25 ? 1 : 0", t, p), 1.0);
  EXPECT_EQ(at("sqrt(x) + atan2(y, x) + log10(z) + ln(z) - log(z)", t, p),
            std::sqrt(x) + std::atan2(y, x) + std::log10(z) + std::log(z) - std::log(z));
  EXPECT_EQ(at("erf(x) + erfc(y) + min(x, y) + max(x, z) + mod(5, 3)", t, p), std::erf(x) + std::erfc(y) + y + z + 2.0);
  EXPECT_EQ(at("step(t - 0.37) + step(t - 0.38) + 2*sign(y)", t, p), 1.0 - 2.0);
  EXPECT_NEAR(at("bessel_j(0, 2.404825557695773)"), 0.0, 1e-15);
  EXPECT_EQ(at("1.5e-3 + 2E+2 + .5"), 1.5e-3 + 2e2 + .5);
  EXPECT_EQ(at("floor(1.5) + ceil(1.2) + round(2.6) + abs(-3)"), 1.0 + 2 + 3 + 3);
}

TEST(Expression, IsEvaluatedAsWritten) {
  for (int n = 0; n < 300; ++n)
    for (const int m : {3, 7, 10, 49}) {
      const auto divisor = std::to_string(m);
      EXPECT_EQ(at("floor((t + 1)/" + divisor + ")", n), (n + 1) / m) << n;
      EXPECT_EQ(at("floor((t + 2)/" + divisor + " + 2*t)", n), std::floor((n + 2) / static_cast<double>(m) + 2 * n))
          << n;
    }
}

TEST(Expression, KnowsWhatItDependsOn) {
  EXPECT_TRUE(parse_field_expression("2 * pi").is_constant());
  const SpaceTimeFunction in_time = parse_field_expression("3 * t");
  EXPECT_TRUE(in_time.is_uniform());
  EXPECT_FALSE(in_time.is_constant());
  EXPECT_EQ(in_time.in_time()(2.0), 6.0);
  EXPECT_FALSE(parse_field_expression("0 * y").is_uniform());
  // Copies outlive the original and do not disturb each other.
  TimeFunction copy;
  {
    const TimeFunction original = parse_field_expression("t^2").in_time();
    copy = original;
  }
  EXPECT_EQ(copy(3.0), 9.0);
  const Expression size("1/axial", {"axial", "radial"});
  EXPECT_TRUE(size.uses("axial"));
  EXPECT_FALSE(size.uses("radial"));
  EXPECT_EQ(size(std::array{4.0, 1.0}), 0.25);
}

TEST(Expression, RefusalsSayWhereAndWhatWasMeant) {
  EXPECT_EQ(refusal("2 * sni(t)"), "expression '2 * sni(t)', position 5: unknown function 'sni', did you mean 'sin'?");
  EXPECT_EQ(refusal("foo + 1"), "expression 'foo + 1', position 1: unknown name 'foo'; valid: t, x, y, z, pi");
  EXPECT_EQ(refusal("2 m"), "expression '2 m', position 3: unknown name 'm'; valid: t, x, y, z, pi");
  EXPECT_EQ(refusal("t(2)"), "expression 't(2)', position 1: 't' is no function; is a '*' missing behind it?");
  EXPECT_EQ(refusal("sin + 1"), "expression 'sin + 1', position 1: 'sin' is a function; write sin(...)");
  EXPECT_EQ(refusal("x = 3"), "expression 'x = 3', position 3: '=' assigns; write '==' to compare");
  EXPECT_EQ(refusal("2t"),
            "expression '2t', position 2: a number is followed by a name; write '*' between them (numbers are in SI, "
            "without units)");
  EXPECT_EQ(refusal("t $ 2"), "expression 't $ 2', position 3: a character that no expression contains");
  EXPECT_EQ(refusal("  "), "expression '  ', position 1: there is nothing in it");
  EXPECT_NE(refusal("2 * (t + 1").find("a ')' is missing"), std::string::npos) << refusal("2 * (t + 1");
  EXPECT_NE(refusal("2 * t)").find("out of place"), std::string::npos) << refusal("2 * t)");
  EXPECT_NE(refusal("2 * ").find("too early"), std::string::npos) << refusal("2 * ");
  EXPECT_NE(refusal("t x").find("an operator is missing before 'x'"), std::string::npos) << refusal("t x");
  EXPECT_NE(refusal("sin(t, x)").find("too many arguments for the function 'sin'"), std::string::npos)
      << refusal("sin(t, x)");
  EXPECT_NE(refusal("atan2(t)").find("too few arguments"), std::string::npos) << refusal("atan2(t)");
  EXPECT_EQ(refusal("2 * bessel_j(0.5, x)"),
            "expression '2 * bessel_j(0.5, x)', position 5: the order of bessel_j is not a whole number (its first "
            "argument)");
  EXPECT_TRUE(std::isnan(at("bessel_j(t, 1)", 0.5)));
  EXPECT_NE(refusal("1, 2").find("','"), std::string::npos) << refusal("1, 2");
  EXPECT_NE(refusal(std::string(5000, '1')).find("at most 4000"), std::string::npos);
}

TEST(Expression, EvaluationAllocatesNothing) {
  const SpaceTimeFunction f = parse_field_expression("10 * sin(2*pi*t/1e-3) * exp(-x^2) + (y > z ? max(y, 1) : z^3)");
  const std::int64_t before = testing::allocations();
  double sum = 0;
  for (int i = 0; i < 1000; ++i) sum += f(1e-6 * i, {0.1 * i, 0.2, 0.3});
  EXPECT_EQ(testing::allocations(), before);
  EXPECT_TRUE(std::isfinite(sum));
}

TEST(Expression, WhateverTheTextItIsReadOrRefused) {
  const std::vector<std::string> words{"t",  "x",  "sin(", "max(", "atan2(", ",",  "(",    ")",  "+",
                                       "-",  "*",  "/",    "^",    "<=",     "?",  ":",    "==", "&&",
                                       "||", "!=", "pi",   "2",    "1e3",    "1e", ".5",   "!",  "=",
                                       " ",  "&",  "step", "0x1F", "e",      ".",  "1.2.3"};
  int read = 0, refused = 0;
  for (unsigned seed = 0; seed < 20000; ++seed) {
    std::mt19937 random(seed);
    std::string text;
    for (std::size_t i = 0; i < 1 + seed % 9; ++i) text += words[random() % words.size()];
    try {
      const SpaceTimeFunction f = parse_field_expression(text);
      f(1, {2, 3, 4});
      ++read;
    } catch (const std::invalid_argument& wrong) {
      EXPECT_EQ(std::string(wrong.what()).substr(0, 12), "expression '") << text;
      ++refused;
    }
  }
  EXPECT_GT(read, 500);
  EXPECT_GT(refused, 10000);
  const std::string deep = std::string(1900, '(') + "t" + std::string(1900, ')');
  EXPECT_EQ(at(deep, 3), 3.0);
  EXPECT_NE(refusal(std::string(3000, '(')), "");
  EXPECT_NE(refusal("sin(" + std::string(2000, '-')), "");
}

Value parse(const std::string& text, const Schema& schema) {
  Diagnostics diagnostics;
  Value root = parse_scene(text, "s", {}, schema, diagnostics);
  EXPECT_EQ(diagnostics.errors(), std::vector<std::string>{});
  return root;
}

std::vector<std::string> wrong(const std::string& text, const Schema& schema) {
  Diagnostics diagnostics;
  parse_scene(text, "s", {}, schema, diagnostics);
  return diagnostics.errors();
}

const Schema& schema() {
  static const Schema made = Schema("s")
                                 .function("f", "Pa", "of time")
                                 .with_range(Range::positive())
                                 .field_function("p", "Pa", "of time and place")
                                 .field_function("temperature", "K", "of time and place")
                                 .table("hardening", "plastic strain", "1", "Pa", "yield stress", Range::positive())
                                 .table("conductivity", "temperature", "K", "W m-1 K-1", "conductivity");
  return made;
}

TEST(ExpressionInScene, UnitsAndForms) {
  EXPECT_EQ(parse("p: {expression: x + t, unit: MPa}", schema()).field_function("p")(2, {3, 0, 0}), 5e6);
  EXPECT_EQ(parse("p: {expression: x}", schema()).field_function("p")(2, {3, 0, 0}), 3.0);
  EXPECT_DOUBLE_EQ(
      parse("temperature: {expression: 10 * t, unit: degC}", schema()).field_function("temperature")(2, {}), 293.15);
  EXPECT_EQ(parse("f: {expression: 4 * t, unit: kPa}", schema()).function("f")(2), 8000.0);
  EXPECT_TRUE(parse("p: 5 bar", schema()).field_function("p").is_constant());
  EXPECT_EQ(parse("p: {table: [[0 s, 1], [1 s, 3]]}", schema()).field_function("p")(0.5, {}), 2.0);
}

TEST(ExpressionInScene, Refusals) {
  using Errors = std::vector<std::string>;
  EXPECT_EQ(wrong("f: {expression: x * t}", schema()),
            (Errors{"s:1:17: f.expression: expression 'x * t': it uses the place (x, y, z), but 'f' takes a function "
                    "of the time t only"}));
  EXPECT_EQ(wrong("p:\n  expression: cso(t)", schema()),
            (Errors{"s:2:15: p.expression: expression 'cso(t)', position 1: unknown function 'cso', did you mean "
                    "'cos'?"}));
  EXPECT_EQ(wrong("p: {expresion: t}", schema()),
            (Errors{"s:1:1: p: missing key: one of 'table', 'sine', 'smooth_step', 'expression' must be given",
                    "s:1:5: p: unknown key 'expresion', did you mean 'expression'?"}));
  EXPECT_EQ(wrong("p: {expression: t, unit: m}", schema()).size(), 1U);
  EXPECT_EQ(wrong("p: {sine: {amplitude: 1, period: 1}, unit: Pa}", schema()).size(), 1U);
  EXPECT_EQ(wrong("f: {expression: 1 - 2}", schema()),
            (Errors{"s:1:17: f.expression: expression '1 - 2' gives -1 Pa, which is out of range; it must be greater "
                    "than 0 Pa"}));
  EXPECT_EQ(wrong("p: {expression: 1 / 0}", schema()).size(), 1U);
  EXPECT_EQ(wrong("p: {expression: [1]}", schema()).size(), 1U);
}

TEST(TableInScene, PointsInSi) {
  using Points = std::vector<std::pair<double, double>>;
  EXPECT_EQ(parse("hardening: [[0, 400 MPa], [0.1, 450 MPa]]", schema()).table("hardening"),
            (Points{{0, 400e6}, {0.1, 450e6}}));
  EXPECT_EQ(parse("conductivity: [[0 K, 5], [100 degC, 6]]", schema()).table("conductivity"),
            (Points{{0, 5}, {373.15, 6}}));
  EXPECT_EQ(parse("hardening: 3 MPa", schema()).table("hardening"), (Points{{0, 3e6}}));
  EXPECT_TRUE(parse("{}", schema()).table("hardening").empty());
}

TEST(TableInScene, Refusals) {
  using Errors = std::vector<std::string>;
  EXPECT_EQ(wrong("hardening: [[0, 1], [0, 2]]", schema()),
            (Errors{"s:1:22: hardening: plastic strain '0' does not come after 0; plastic strains must ascend"}));
  EXPECT_EQ(wrong("hardening: [[0, 1], 3]", schema()),
            (Errors{"s:1:21: hardening: found '3', expected a point [plastic strain, value]"}));
  EXPECT_EQ(wrong("hardening: []", schema()),
            (Errors{"s:1:12: hardening: found an empty list, expected points such as [[0, 117 GPa], ...]"}));
  EXPECT_EQ(wrong("hardening: [[0, -5 MPa]]", schema()).size(), 1U);
  EXPECT_EQ(wrong("hardening: [[0 s, 5 MPa]]", schema()).size(), 1U);
}

}  // namespace
}  // namespace tenon::scene
