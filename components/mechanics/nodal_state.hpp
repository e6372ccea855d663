// SPDX-License-Identifier: BSD-3-Clause
// Arrays over the nodes of a rank.
#pragma once

#include <span>
#include <vector>

#include "components/mechanics/hex8_kernel.hpp"
#include "framework/base/types.hpp"

namespace tenon {

/// Force on a node with padding, so that it is one machine vector.
struct alignas(32) ForceRow {
  double v[4];
};

/// Nodes of a rank, owned and ghost, in the order of the mesh. Velocities are those of the last half step.
class NodalState {
 public:
  NodalState() = default;
  explicit NodalState(std::span<const Vec3> reference)
      : mass(reference.size()),
        inverse_mass(reference.size()),
        internal_work(reference.size()),
        force(reference.size()),
        size_(reference.size()),
        position_(reference.begin(), reference.end()),
        velocity_(reference.size() + 1) {
    position_.push_back({});
  }

  std::size_t size() const { return size_; }
  std::span<Vec3> position() { return {position_.data(), size_}; }  ///< m
  std::span<const Vec3> position() const { return {position_.data(), size_}; }
  std::span<Vec3> velocity() { return {velocity_.data(), size_}; }  ///< m/s
  std::span<const Vec3> velocity() const { return {velocity_.data(), size_}; }

  std::vector<double> mass, inverse_mass;  ///< kg, 1/kg; 0 where no element of this component touches the node
  std::vector<double> internal_work;       ///< J: work of the node against the internal forces since the start
  std::vector<ForceRow> force;             ///< N: internal, resisting

  NodeArrays arrays() {
    return {position_.data()->data(), velocity_.data()->data(), force.empty() ? nullptr : force.data()->v};
  }

 private:
  std::size_t size_ = 0;
  std::vector<Vec3> position_, velocity_;  // one more than there are nodes: kernels load four doubles
};

}  // namespace tenon
