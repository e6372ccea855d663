// SPDX-License-Identifier: BSD-3-Clause
// Bodies with every kind of load and constraint, for the tests of ranks and restarts.
#pragma once

#include "mechanics_case.hpp"

namespace tenon::testing {

/// Several boxes side by side in one mesh, each its own block with node and side sets "<name>_x_min" ...
struct Part {
  std::string name;
  BoxShape shape;
  int top_layers = 0;  ///< of elements, which become a block "<name>_top" that shares nodes with the rest
};

inline MeshData joined(const std::vector<Part>& parts) {
  MeshData all;
  if (communicator().rank() != 0) return all;
  all.source = "parts";
  GlobalId elements = 0;
  for (const Part& part : parts) {
    MeshData more = generate(part.shape);
    const auto count = static_cast<GlobalId>(more.elements());
    const auto first = static_cast<GlobalId>(all.coordinates.size());
    all.coordinates.insert(all.coordinates.end(), more.coordinates.begin(), more.coordinates.end());
    for (BlockData& block : more.blocks) {
      for (auto& n : block.connectivity) n += first;
      block.name = part.name;
      BlockData top;
      top.name = part.name + "_top", top.kind = block.kind;
      const auto keep = static_cast<std::ptrdiff_t>(block.size()) -
                        static_cast<std::ptrdiff_t>(part.top_layers) * part.shape.elements[0] * part.shape.elements[1];
      top.connectivity.assign(block.connectivity.begin() + 8 * keep, block.connectivity.end());
      top.labels.assign(block.labels.begin() + keep, block.labels.end());
      block.connectivity.resize(8 * static_cast<std::size_t>(keep)),
          block.labels.resize(static_cast<std::size_t>(keep));
      all.blocks.push_back(block);
      if (part.top_layers > 0) all.blocks.push_back(top);
    }
    for (NodeSetData& set : more.node_sets) {
      for (auto& n : set.nodes) n += first;
      set.name = part.name + "_" + set.name;
      all.node_sets.push_back(set);
    }
    for (SideSetData& set : more.side_sets) {
      for (auto& s : set.sides) s.element += elements;
      set.name = part.name + "_" + set.name;
      all.side_sets.push_back(set);
    }
    elements += count;
  }
  for (std::size_t n = 0; n < all.coordinates.size(); ++n) all.node_labels.push_back(static_cast<std::int64_t>(n) + 1);
  std::int64_t label = 0;
  for (BlockData& block : all.blocks)
    for (std::int64_t& l : block.labels) l = ++label;
  return all;
}

inline BoxShape box(const Vec3& low, const Vec3& high, std::array<int, 3> elements, double distortion = 0) {
  BoxShape shape;
  shape.low = low, shape.high = high, shape.elements = elements, shape.distortion = distortion;
  return shape;
}

inline SpaceTimeFunction always(double value) {
  return SpaceTimeFunction::constant(value);
}

}  // namespace tenon::testing
