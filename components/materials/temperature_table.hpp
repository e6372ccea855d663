// SPDX-License-Identifier: BSD-3-Clause
// A property over temperature, and its integral.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

namespace tenon {

/// Linear between its points, constant outside. Value semantics.
class TemperatureTable {
 public:
  TemperatureTable(double constant = 0) : points_{{0.0, constant}}, integrals_{0.0} {}
  /// x ascending, at least one point.
  explicit TemperatureTable(std::vector<std::pair<double, double>> points) : points_(std::move(points)) {
    integrals_.push_back(0);
    for (std::size_t i = 1; i < points_.size(); ++i)
      integrals_.push_back(integrals_.back() + 0.5 * (points_[i].first - points_[i - 1].first) *
                                                   (points_[i].second + points_[i - 1].second));
  }
  bool is_constant() const { return points_.size() == 1; }
  double operator()(double x) const {
    const std::size_t i = segment(x);
    if (i == 0) return points_.front().second;
    if (i == points_.size()) return points_.back().second;
    const auto& [x0, y0] = points_[i - 1];
    const auto& [x1, y1] = points_[i];
    return y0 + (y1 - y0) * ((x - x0) / (x1 - x0));
  }
  /// From the first point to x.
  double integral(double x) const {
    const std::size_t i = segment(x);
    if (i == 0) return (x - points_.front().first) * points_.front().second;
    const auto& [x0, y0] = points_[i - 1];
    return integrals_[i - 1] + 0.5 * (x - x0) * (y0 + (*this)(x));
  }

 private:
  /// Number of points at or below x.
  std::size_t segment(double x) const {
    const auto after = std::upper_bound(points_.begin(), points_.end(), x,
                                        [](double v, const std::pair<double, double>& p) { return v < p.first; });
    return static_cast<std::size_t>(after - points_.begin());
  }
  std::vector<std::pair<double, double>> points_;
  std::vector<double> integrals_;  // up to each point
};

}  // namespace tenon
