// SPDX-License-Identifier: BSD-3-Clause
// Arrays over the nodes of a rank.
#pragma once

#include <span>
#include <vector>

#include "framework/base/types.hpp"

namespace tenon {

/// Force on a node with padding, so that it is one machine vector.
struct alignas(32) ForceRow {
  double v[4];
};

/// Nodal arrays as element kernels take them. Vectors lie three doubles apart with one double of padding after the
/// last; forces four apart.
struct NodeArrays {
  const double* position;   ///< m
  const double* velocity;   ///< m/s
  double* force;            ///< internal, resisting: N
  const double* reference;  ///< undeformed positions, m; null unless some material asks for them
  const double* spin;       ///< angular velocity of nodes, rad/s; null unless some group has rotations
  double* moment;           ///< internal, resisting: N m; null unless some group has rotations
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

  /// Nodes get angular velocities, moments and rotary inertia: for elements that need them.
  void add_rotations() {
    inertia.resize(size_), inverse_inertia.resize(size_), moment.resize(size_), spin_.resize(size_ + 1);
  }
  bool has_rotations() const { return !spin_.empty(); }
  /// Undeformed positions are kept for materials that need the deformation gradient.
  void keep_reference() { reference_ = position_; }
  /// What stands is undeformed: before the first step only.
  void renew_reference() {
    if (!reference_.empty()) reference_ = position_;
  }

  std::size_t size() const { return size_; }
  std::span<Vec3> position() { return {position_.data(), size_}; }  ///< m
  std::span<const Vec3> position() const { return {position_.data(), size_}; }
  std::span<Vec3> velocity() { return {velocity_.data(), size_}; }  ///< m/s
  std::span<const Vec3> velocity() const { return {velocity_.data(), size_}; }
  std::span<Vec3> spin() { return {spin_.data(), has_rotations() ? size_ : 0}; }  ///< rad/s
  std::span<const Vec3> spin() const { return {spin_.data(), has_rotations() ? size_ : 0}; }

  std::vector<double> mass, inverse_mass;  ///< kg, 1/kg; 0 where no element of this component touches the node
  std::vector<double> internal_work;       ///< J: work of the node against the internal forces since the start
  std::vector<ForceRow> force;             ///< N: internal, resisting

  // Only with rotations.
  std::vector<double> inertia, inverse_inertia;  ///< kg m^2 and its inverse; 0 where nothing turns the node
  std::vector<ForceRow> moment;                  ///< N m: internal, resisting

  NodeArrays arrays() {
    return {position_.data()->data(),
            velocity_.data()->data(),
            force.empty() ? nullptr : force.data()->v,
            reference_.empty() ? nullptr : reference_.data()->data(),
            spin_.empty() ? nullptr : spin_.data()->data(),
            moment.empty() ? nullptr : moment.data()->v};
  }

 private:
  std::size_t size_ = 0;
  std::vector<Vec3> position_, velocity_;  // one more than there are nodes: kernels load four doubles
  std::vector<Vec3> reference_, spin_;     // likewise, or empty
};

}  // namespace tenon
