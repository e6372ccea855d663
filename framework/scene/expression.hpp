// SPDX-License-Identifier: BSD-3-Clause
// Formulas as text: "10 * sin(2*pi*t/1e-3) * exp(-x^2)".
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "framework/base/space_time_function.hpp"

namespace tenon::scene {

/// A formula of named variables. Operators + - * / ^, comparisons, && || and c ? a : b; the functions of
/// `function_names()`; the constant pi. Copies share the parsed form; evaluation allocates nothing and is not to be
/// done by two threads at once.
class Expression {
 public:
  /// Throws std::invalid_argument that says what is wrong where in the text, with the nearest valid name.
  Expression(const std::string& text, std::vector<std::string> variables);
  /// Values in the order of the variables.
  double operator()(std::span<const double> values) const;
  bool uses(const std::string& variable) const;
  const std::string& text() const;
  static const std::vector<std::string>& function_names();

 private:
  struct Parsed;
  std::shared_ptr<const Parsed> parsed_;
};

/// What a formula sees of a value such as "4" or "20 mm": the number in SI, whatever it measures; nothing if it is
/// none.
std::optional<double> number_in_si(const std::string& text);

/// The expression of t, x, y, z (SI) as a function: scale * expression + offset. Uniform if it does not use x, y, z,
/// constant if it uses no variable. Throws as Expression.
SpaceTimeFunction parse_field_expression(const std::string& text, double scale = 1, double offset = 0);

}  // namespace tenon::scene
