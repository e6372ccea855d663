// SPDX-License-Identifier: BSD-3-Clause
// Values that change with time and place.
#pragma once

#include <memory>
#include <utility>

#include "framework/base/formula.hpp"
#include "framework/base/time_function.hpp"
#include "framework/base/types.hpp"

namespace tenon {

/// f(t, x) in the unit of what it drives: uniform in space, or a formula. Value semantics, no allocation when
/// evaluated.
class SpaceTimeFunction {
 public:
  SpaceTimeFunction() = default;
  /// The same everywhere.
  explicit SpaceTimeFunction(TimeFunction uniform) : in_time_(std::move(uniform)) {}
  static SpaceTimeFunction constant(double value) { return SpaceTimeFunction(TimeFunction::constant(value)); }
  static SpaceTimeFunction formula(std::shared_ptr<const Formula> formula) {
    SpaceTimeFunction f;
    f.formula_ = std::move(formula);
    return f;
  }

  double operator()(double t, const Vec3& x) const { return formula_ ? formula_->value(t, x) : in_time_(t); }
  /// The same everywhere: evaluate it once per step.
  bool is_uniform() const { return !formula_; }
  /// The same everywhere and always.
  bool is_constant() const { return is_uniform() && in_time_.is_constant(); }
  /// The function of time of a uniform one.
  const TimeFunction& in_time() const { return in_time_; }

 private:
  TimeFunction in_time_;
  std::shared_ptr<const Formula> formula_;
};

}  // namespace tenon
