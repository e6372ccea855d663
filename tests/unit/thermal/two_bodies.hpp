// SPDX-License-Identifier: BSD-3-Clause
// One mesh of two.
#pragma once

#include "framework/mesh/mesh_data.hpp"

namespace tenon::testing {

/// The second mesh behind the first; names of blocks and sets get "a_" or "b_" in front.
inline MeshData together(MeshData a, const MeshData& b) {
  const auto nodes = static_cast<GlobalId>(a.coordinates.size()), elements = static_cast<GlobalId>(a.elements());
  const auto rename = [](auto& named, const char* prefix) {
    for (auto& item : named) item.name = prefix + item.name;
  };
  rename(a.blocks, "a_"), rename(a.node_sets, "a_"), rename(a.side_sets, "a_");
  a.coordinates.insert(a.coordinates.end(), b.coordinates.begin(), b.coordinates.end());
  for (const std::int64_t label : b.node_labels) a.node_labels.push_back(label + nodes);
  for (BlockData block : b.blocks) {
    block.name = "b_" + block.name;
    block.label += 1000;
    for (GlobalId& n : block.connectivity) n += nodes;
    for (std::int64_t& label : block.labels) label += elements;
    a.blocks.push_back(std::move(block));
  }
  for (NodeSetData set : b.node_sets) {
    set.name = "b_" + set.name;
    set.label += 1000;
    for (GlobalId& n : set.nodes) n += nodes;
    a.node_sets.push_back(std::move(set));
  }
  for (SideSetData set : b.side_sets) {
    set.name = "b_" + set.name;
    set.label += 1000;
    for (SideData& side : set.sides) side.element += elements;
    a.side_sets.push_back(std::move(set));
  }
  return a;
}

}  // namespace tenon::testing
