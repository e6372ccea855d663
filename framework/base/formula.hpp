// SPDX-License-Identifier: BSD-3-Clause
// What a formula of a scene gives, whatever library reads it.
#pragma once

#include "framework/base/types.hpp"

namespace tenon {

/// A function of time (s) and place (m) in the SI unit of what it drives. Immutable, so copies share it; evaluation
/// allocates nothing. Not to be evaluated by two threads at once.
class Formula {
 public:
  virtual ~Formula() = default;
  virtual double value(double t, const Vec3& x) const = 0;
};

}  // namespace tenon
