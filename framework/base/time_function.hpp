// SPDX-License-Identifier: BSD-3-Clause
// Values that change with time: constants, tables, sines, smooth steps and formulas.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "framework/base/formula.hpp"

namespace tenon {

/// f(t) in the unit of what it drives. Value semantics, cheap to evaluate, no allocation.
class TimeFunction {
 public:
  TimeFunction() = default;
  static TimeFunction constant(double value) {
    TimeFunction f;
    f.a_ = value;
    return f;
  }
  /// Linear between the points (time s ascending, value), held constant outside. At least one point.
  static TimeFunction table(std::vector<std::pair<double, double>> points) {
    TimeFunction f;
    f.form_ = Form::table;
    f.points_ = std::move(points);
    return f;
  }
  /// offset + amplitude sin(2 pi t / period + phase), phase in rad.
  static TimeFunction sine(double amplitude, double period, double phase, double offset) {
    TimeFunction f;
    f.form_ = Form::sine;
    f.a_ = amplitude, f.b_ = period, f.c_ = phase, f.d_ = offset;
    return f;
  }
  /// From `first` before `start` to `last` after `end` with zero first and second derivatives at both (quintic).
  static TimeFunction smooth_step(double first, double last, double start, double end) {
    TimeFunction f;
    f.form_ = Form::smooth_step;
    f.a_ = first, f.b_ = last, f.c_ = start, f.d_ = end;
    return f;
  }
  /// A formula that does not use the place.
  static TimeFunction formula(std::shared_ptr<const Formula> formula) {
    TimeFunction f;
    f.form_ = Form::formula;
    f.formula_ = std::move(formula);
    return f;
  }

  double operator()(double t) const {
    switch (form_) {
      case Form::constant:
        return a_;
      case Form::sine:
        return d_ + a_ * std::sin(2 * std::numbers::pi * t / b_ + c_);
      case Form::smooth_step: {
        const double s = std::clamp((t - c_) / (d_ - c_), 0.0, 1.0);
        return a_ + (b_ - a_) * s * s * s * (10 + s * (6 * s - 15));
      }
      case Form::formula:
        return formula_->value(t, {0, 0, 0});
      case Form::table:
        break;
    }
    return in_table(t);
  }
  bool is_constant() const { return form_ == Form::constant; }

 private:
  enum class Form { constant, table, sine, smooth_step, formula };
  double in_table(double t) const {
    const auto next = std::upper_bound(points_.begin(), points_.end(), t,
                                       [](double x, const std::pair<double, double>& p) { return x < p.first; });
    if (next == points_.begin()) return points_.front().second;
    if (next == points_.end()) return points_.back().second;
    const auto& [t0, f0] = *(next - 1);
    const auto& [t1, f1] = *next;
    return f0 + (f1 - f0) * ((t - t0) / (t1 - t0));
  }
  Form form_ = Form::constant;
  double a_ = 0, b_ = 0, c_ = 0, d_ = 0;
  std::vector<std::pair<double, double>> points_;
  std::shared_ptr<const Formula> formula_;
};

}  // namespace tenon
