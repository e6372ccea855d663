// SPDX-License-Identifier: BSD-3-Clause
// One hexahedron at a time, by the same formulas as the batches: for masses, exports and messages.
#pragma once

#include <span>

#include "components/mechanics/hex8_mean_gradient.hpp"
#include "framework/base/types.hpp"

namespace tenon {

/// Modes of a nodal vector on one element.
inline HexModes<double> hex8_modes(std::span<const LocalIndex> nodes, std::span<const Vec3> values) {
  double x[8], y[8], z[8];
  const Vec3 origin = values[static_cast<std::size_t>(nodes[0])];
  for (std::size_t i = 0; i < 8; ++i) {
    const Vec3 p = values[static_cast<std::size_t>(nodes[i])] - origin;
    x[i] = p[0], y[i] = p[1], z[i] = p[2];
  }
  return hex_modes(x, y, z);
}

/// Exact volume, m^3.
inline double hex8_volume(std::span<const LocalIndex> nodes, std::span<const Vec3> coordinates) {
  return mean_gradient(hex8_modes(nodes, coordinates)).volume_192 / 192.0;
}

}  // namespace tenon
