// SPDX-License-Identifier: BSD-3-Clause
// What the cases of weakly compressible fluids have in common: shapes, pressures at the start, walls.
#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "sph_case.hpp"

namespace tenon::testing {

/// A function of place in the place of a formula of a scene.
inline SpaceTimeFunction of_place(std::function<double(const Vec3&)> function) {
  class Given final : public Formula {
   public:
    explicit Given(std::function<double(const Vec3&)> f) : f_(std::move(f)) {}
    double value(double, const Vec3& x) const override { return f_(x); }

   private:
    std::function<double(const Vec3&)> f_;
  };
  return SpaceTimeFunction::formula(std::make_shared<Given>(std::move(function)));
}

/// Between -1 and 1, by the place.
inline double noise(const Vec3& x, double seed) {
  const double s = 43758.5453 * std::sin(12.9898 * x[0] + 78.233 * x[1] + 37.719 * x[2] + seed);
  return 2 * (s - std::floor(s)) - 1;
}

/// The particles of a body that are where `inside` says.
inline MeshData part_of(const MeshData& body, const std::function<bool(const Vec3&)>& inside) {
  MeshData part;
  part.blocks.push_back(body.blocks.front());
  BlockData& block = part.blocks.front();
  block.connectivity.clear(), block.labels.clear();
  for (std::size_t n = 0; n < body.coordinates.size(); ++n) {
    if (!inside(body.coordinates[n])) continue;
    const auto next = static_cast<GlobalId>(part.coordinates.size());
    block.connectivity.push_back(next), block.labels.push_back(next + 1);
    part.coordinates.push_back(body.coordinates[n]), part.volumes.push_back(body.volumes[n]);
  }
  return part;
}

/// A tank of dummy particles, open at the top: four layers around what is between `low` and `high`.
inline MeshData tank(const Vec3& low, const Vec3& high, double spacing) {
  constexpr int layers = 4;
  const double thick = layers * spacing, half = 0.5 * spacing;
  const auto across = static_cast<int>(std::lround((high[0] - low[0]) / spacing)) + 2 * layers;
  return part_of(flat_box({low[0] - thick, low[1] - thick, 0}, {high[0] + thick, high[1], 0}, across),
                 [=](const Vec3& x) {
                   return x[0] < low[0] - 0.5 * half || x[0] > high[0] + 0.5 * half || x[1] < low[1] - 0.5 * half;
                 });
}

}  // namespace tenon::testing
