// SPDX-License-Identifier: BSD-3-Clause
// A contact party whose nodes only show what moves on other ranks: it need not do so while nothing is near.
#pragma once

#include <span>

#include "framework/base/types.hpp"

namespace tenon {

/// Beside ContactParty: each step of such a party brings places and velocities to its nodes, by messages. After a
/// search that found nothing near any surface contact lets it rest: from then on the party says itself how much of
/// their skins its nodes have used up, where the numbers are, and shows them only when contact asks for it.
class DistantParty {
 public:
  virtual ~DistantParty() = default;
  /// Collective, after a search that found nothing, and before any other push: places stay where they were sought,
  /// contact_positions(). `inverse_square`: of the skins of all nodes, 1/m^2; 0 where it is not of interest.
  virtual void rest(std::span<const double> inverse_square) = 0;
  /// Local; the same on every rank.
  virtual bool resting() const = 0;
  /// Local, while it rests. Greatest share of a skin that is used at the start or at the end of a step, squared: a node
  /// that was sought at X is at x, and x - X - before and x + v dt - X - before - step count. `step` (m) is what all
  /// nodes have in common in it. Infinite if something is not a number.
  virtual double used_squared(const Vec3& before, const Vec3& step, double dt) const = 0;
  /// Collective. Ends the rest: contact_positions(), contact_velocities() and those of before the kick are up to date.
  virtual void show() = 0;
};

}  // namespace tenon
