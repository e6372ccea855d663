// SPDX-License-Identifier: BSD-3-Clause
// The faces of a body that others can touch: what is exposed of its solids, and its shells.
#pragma once

#include <vector>

#include "components/mechanics/element_groups.hpp"
#include "framework/simulation/contact_party.hpp"

namespace tenon {

/// Sides of the elements of a mesh, those with the same nodes together. A side belongs to the rank that owns its node
/// of least global id: that rank has all elements around the node, so it sees the death of whatever covers the side.
class ContactFaces {
 public:
  /// Local. Sides all of whose nodes are `hidden` are left out.
  ContactFaces(const Mesh& mesh, const MechanicsOptions& options, const ElementGroups& groups,
               const std::vector<char>& hidden);

  /// Local. Faces with an element on one side only, of those that are alive, ascending by id. A shell hides the face of
  /// a solid with the same nodes.
  void list(const ElementGroups& groups, std::vector<ContactFace>& faces) const;
  /// Sides that were left out and that this rank would have shown at the start.
  std::int64_t left_out() const { return left_out_; }
  std::int64_t memory() const;

 private:
  struct Side {
    std::array<LocalIndex, 4> key;  // nodes, ascending
    std::int32_t block;
    LocalIndex element;
    std::int8_t side;
    bool shell;
  };

  std::vector<Side> sides_of(const Mesh& mesh) const;
  ContactFace face(const Mesh& mesh, const MechanicsOptions& options, const ElementGroups& groups,
                   const Side& side) const;

  std::vector<Side> sides_;         // ascending by key, then by block and element
  std::vector<ContactFace> faces_;  // as sides_
  std::int64_t left_out_ = 0;
};

}  // namespace tenon
