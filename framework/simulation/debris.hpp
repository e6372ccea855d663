// SPDX-License-Identifier: BSD-3-Clause
// Elements that fail and go on as particles: what a component gives up, what another one takes over, and who brings it.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "framework/comm/exact_sum.hpp"
#include "framework/simulation/coupling.hpp"

namespace tenon {

/// What is left of one element.
struct Debris {
  GlobalId element = no_id;  ///< its number within its block, from 0
  double mass = 0;           ///< kg
  Vec3 place{};              ///< centre of mass, m
  Vec3 momentum{};           ///< kg m/s
  double energy = 0;         ///< J: kinetic, and what was stored within
};

/// A component whose elements can fail.
class DebrisSource {
 public:
  virtual ~DebrisSource() = default;
  /// Before `initialize` and `load`. What fails of this block is to be given up. Throws Error(usage) if the block
  /// cannot fail, or its mass cannot go.
  virtual void give_up(const std::string& block) = 0;
  /// Local; the same on every rank. Whether anything may have failed since `take_debris` was last called.
  virtual bool has_debris(const std::string& block) const = 0;
  /// Collective. Mass, momentum and energy of those elements of the block that have failed leave the component: those
  /// that this rank owns, ascending.
  virtual std::vector<Debris> take_debris(const std::string& block) = 0;
};

/// A component with particles that are not there yet, one for each element of a block.
class DebrisTarget {
 public:
  virtual ~DebrisTarget() = default;
  /// Local; the same on every rank. Particles of the block that wait; throws Error(usage) if none do.
  virtual GlobalId waiting(const std::string& block) const = 0;
  /// Collective. Particle `element` of the block begins to move with that mass, momentum and energy.
  virtual void wake(const std::string& block, std::span<const Debris> debris) = 0;
};

/// Turns the elements of a block of the source, as they fail, into the particles of a block of the target. Mass,
/// momentum and energy are kept to round-off, angular momentum up to the spin of the element.
class DebrisLink final : public Coupling {
 public:
  /// Throws Error(usage) where a component cannot do its part, or the blocks differ in size.
  DebrisLink(std::string name, Component& source, std::string source_block, Component& target,
             std::string target_block);

  void initialize() override {}
  void run() override;
  bool runs_at_start() const override { return false; }
  std::vector<std::string> report() override;
  std::vector<std::pair<std::string, ExactSum>> amounts() override;
  void save(CheckpointWriter& file) override;
  void load(const CheckpointReader& file) override;
  std::int64_t memory() const override { return 0; }

 private:
  DebrisSource& from_;
  DebrisTarget& to_;
  std::string source_block_, target_block_;
  std::int64_t count_ = 0;  // of this rank; after a restart on the first one
  ExactSum mass_;
};

}  // namespace tenon
