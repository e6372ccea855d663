// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/element_levels.hpp"

#include <algorithm>
#include <limits>

namespace tenon {

namespace {

constexpr std::int32_t none = std::numeric_limits<std::int32_t>::max();

bool has_one_level(const ElementGroup& group) {
  return group.passes() > 1 || group.rigid;
}

/// Collective. Blocks of the mesh in which all elements must take the same step, by any of their groups.
std::vector<std::int64_t> blocks_of_one_level(const Mesh& mesh, const ElementGroups& groups) {
  std::vector<std::int64_t> result(mesh.blocks.size());
  for (const auto& group : groups)
    if (has_one_level(*group)) result[group->block()] = 1;
  mesh.comm.max(std::span<std::int64_t>(result));
  return result;
}

void level_blocks(const Mesh& mesh, const std::vector<std::int64_t>& uniform, ElementLevels& levels) {
  std::vector<std::int64_t> least(levels.size(), -none);
  for (std::size_t b = 0; b < levels.size(); ++b)
    for (const std::int32_t level : levels[b]) least[b] = std::max(least[b], -std::int64_t{level});
  mesh.comm.max(std::span<std::int64_t>(least));
  for (std::size_t b = 0; b < levels.size(); ++b)
    if (uniform[b]) std::ranges::fill(levels[b], static_cast<std::int32_t>(-least[b]));
}

}  // namespace

std::vector<std::int32_t> node_levels(const Mesh& mesh, const ElementLevels& levels) {
  std::vector<std::int32_t> least(static_cast<std::size_t>(mesh.nodes()), none);
  for (std::size_t b = 0; b < levels.size(); ++b)
    for (LocalIndex e = 0; e < mesh.blocks[b].size(); ++e)
      for (const LocalIndex n : mesh.blocks[b].nodes(e)) {
        std::int32_t& level = least[static_cast<std::size_t>(n)];
        level = std::min(level, levels[b][static_cast<std::size_t>(e)]);
      }
  for (std::int32_t& level : least) level = level == none ? 0 : level;
  mesh.node_halo.forward<std::int32_t>(least, least);
  return least;
}

ElementLevels find_levels(const Mesh& mesh, const ElementGroups& groups, const LevelRules& rules,
                          std::span<const std::int32_t> stiff) {
  const std::vector<std::int64_t> uniform = blocks_of_one_level(mesh, groups);
  ElementLevels levels(mesh.blocks.size());
  for (std::size_t b = 0; b < levels.size(); ++b) {
    levels[b].resize(static_cast<std::size_t>(mesh.blocks[b].size()));
    for (LocalIndex e = 0; e < mesh.blocks[b].size(); ++e) {
      const ElementGroups::Place place = groups.place(b, e);
      std::int32_t& level = levels[b][static_cast<std::size_t>(e)];
      if (place.group->rigid) continue;
      const double allowed = std::min(rules.share * value_of(place.group->steps, place.element), rules.longest);
      while (level < rules.greatest && static_cast<double>(std::int64_t{2} << level) * rules.step <= allowed) ++level;
    }
  }
  bool again = true;
  while (again) {
    level_blocks(mesh, uniform, levels);
    std::vector<std::int32_t> least = node_levels(mesh, levels);
    for (std::size_t n = 0; n < least.size(); ++n)
      if (stiff[n]) least[n] = 0;
    again = false;
    for (std::size_t b = 0; b < levels.size(); ++b)
      for (LocalIndex e = 0; e < mesh.blocks[b].size(); ++e) {
        std::int32_t& level = levels[b][static_cast<std::size_t>(e)];
        std::int32_t most = level;
        for (const LocalIndex n : mesh.blocks[b].nodes(e))
          most = std::min(most, least[static_cast<std::size_t>(n)] + 1);
        again = again || most < level;
        level = most;
      }
    again = mesh.comm.any(again);
  }
  return levels;
}

}  // namespace tenon
