// SPDX-License-Identifier: BSD-3-Clause
// All groups of a body, and where the elements of the mesh are in them.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "components/mechanics/element_group.hpp"

namespace tenon {

/// One group for each block of the mesh, in its order, until `replace` brings several for one.
class ElementGroups {
 public:
  struct Place {
    ElementGroup* group;
    LocalIndex element;  ///< in the group
  };
  using Places = std::vector<std::vector<Place>>;  ///< by block, then by element of the block

  void push_back(std::unique_ptr<ElementGroup> group) { groups_.push_back(std::move(group)); }
  std::size_t size() const { return groups_.size(); }
  auto begin() const { return groups_.begin(); }
  auto end() const { return groups_.end(); }
  const std::unique_ptr<ElementGroup>& operator[](std::size_t group) const { return groups_[group]; }
  const std::unique_ptr<ElementGroup>& back() const { return groups_.back(); }

  /// Where a local element of a block of the mesh is.
  Place place(std::size_t block, LocalIndex element) const {
    if (places_.empty()) return {groups_[block].get(), element};
    return places_[block][static_cast<std::size_t>(element)];
  }
  ElementGroup& group_of(std::size_t block, LocalIndex element) const { return *place(block, element).group; }

  /// visit(group, element of the group) for all local elements, as fields of elements have them: by block, ascending.
  template <typename Visit>
  void in_mesh_order(Visit visit) const {
    if (places_.empty()) {
      for (const auto& group : groups_)
        for (LocalIndex e = 0; e < group->size(); ++e) visit(*group, e);
      return;
    }
    for (const std::vector<Place>& block : places_)
      for (const Place& place : block) visit(*place.group, place.element);
  }

  /// Other groups for the same elements.
  void replace(std::vector<std::unique_ptr<ElementGroup>> groups, Places places) {
    groups_ = std::move(groups), places_ = std::move(places);
  }

 private:
  std::vector<std::unique_ptr<ElementGroup>> groups_;
  Places places_;
};

/// The state arrays of groups, each list made once.
class GroupStates {
 public:
  const std::vector<StateArray>& of(ElementGroup& group) {
    auto [found, is_new] = states_.try_emplace(&group);
    if (is_new) found->second = group.state();
    return found->second;
  }

 private:
  std::map<const ElementGroup*, std::vector<StateArray>> states_;
};

}  // namespace tenon
