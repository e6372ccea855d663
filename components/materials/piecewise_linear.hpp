// SPDX-License-Identifier: BSD-3-Clause
// A function given by a table: straight between its points.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "components/materials/lane_root.hpp"

namespace tenon {

/// y(x) through points of ascending x. Left of the first point y is held; right of the last it is held or goes on with
/// the last slope. A single point is a constant.
class PiecewiseLinear {
 public:
  enum class End { hold, continue_slope };
  PiecewiseLinear() = default;
  PiecewiseLinear(const std::vector<std::pair<double, double>>& points, End end) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto& [x, y] = points[i];
      const bool last = i + 1 == points.size();
      const double slope = last ? (end == End::continue_slope && i > 0 ? slope_.back() : 0.0)
                                : (points[i + 1].second - y) / (points[i + 1].first - x);
      x_.push_back(x), y_.push_back(y), slope_.push_back(slope);
    }
  }

  std::size_t size() const { return x_.size(); }
  double x(std::size_t i) const { return x_[i]; }
  double y(std::size_t i) const { return y_[i]; }
  /// Right of point i.
  double slope(std::size_t i) const { return slope_[i]; }

  double operator()(double at) const {
    double value = y_[0];
    for (std::size_t i = 0; i < size(); ++i)
      if (at >= x_[i]) value = y_[i] + slope_[i] * (at - x_[i]);
    return value;
  }

  /// The same for eight arguments, with the slope to the right.
  void evaluate(const LaneValues& at, LaneValues& value, LaneValues& slope) const {
#pragma GCC ivdep
    for (int l = 0; l < lanes; ++l) value[l] = y_[0], slope[l] = 0;
    for (std::size_t i = 0; i < size(); ++i) {
      const double x = x_[i], y = y_[i], k = slope_[i];
#pragma GCC ivdep
      for (int l = 0; l < lanes; ++l) {
        const double here = y + k * (at[l] - x);
        value[l] = at[l] >= x ? here : value[l];
        slope[l] = at[l] >= x ? k : slope[l];
      }
    }
  }

 private:
  std::vector<double> x_, y_, slope_;
};

}  // namespace tenon
