// SPDX-License-Identifier: BSD-3-Clause
// How well a material conducts: a number, a table over temperature, or three numbers along three axes.
#pragma once

#include <array>
#include <optional>

#include "components/materials/temperature_table.hpp"
#include "framework/base/types.hpp"

namespace tenon::thermal {

/// k of q = -k grad T, W/(m K).
struct Conductivity {
  Conductivity(double constant = 0) : over_temperature(constant) {}
  TemperatureTable over_temperature;
  /// Symmetric, positive definite; takes the place of the number. Fixed in space.
  std::optional<std::array<Vec3, 3>> tensor;

  bool is_constant() const { return tensor || over_temperature.is_constant(); }
  /// k g at a temperature.
  Vec3 times(const Vec3& g, double temperature) const {
    if (!tensor) return over_temperature(temperature) * g;
    return {dot((*tensor)[0], g), dot((*tensor)[1], g), dot((*tensor)[2], g)};
  }
};

}  // namespace tenon::thermal
