// SPDX-License-Identifier: BSD-3-Clause
// The Hilbert curve through a box, along which neighbours stay near each other.
#pragma once

#include <cstdint>
#include <vector>

#include "framework/base/box.hpp"
#include "framework/base/types.hpp"

namespace tenon {

/// A point's place on the curve.
struct HilbertPlace {
  std::uint64_t code;
  LocalIndex index;
};

/// The curve through 2^48 cubic cells over a box. Unlike Morton's it does not jump, so neighbours along it make compact
/// groups.
class HilbertCurve {
 public:
  explicit HilbertCurve(const Box& bounds);
  /// Points outside count as on the bounds; those that are not finite come first.
  std::uint64_t code(const Vec3& x) const;

 private:
  Vec3 low_{};
  double scale_ = 0;
};

/// Stable: equal codes stay in their order.
void sort_along_curve(std::vector<HilbertPlace>& places);

}  // namespace tenon
