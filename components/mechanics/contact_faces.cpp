// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/contact_faces.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

namespace tenon {

namespace {

constexpr LocalIndex beyond = std::numeric_limits<LocalIndex>::max();

/// Nodes of a face once each, in their order around it; the fourth of a triangle is no_index. Fewer than three: no
/// face.
std::array<LocalIndex, 4> distinct(std::span<const LocalIndex> nodes, std::span<const std::int8_t> corners,
                                   int& count) {
  std::array<LocalIndex, 4> result{no_index, no_index, no_index, no_index};
  count = 0;
  for (const std::int8_t corner : corners) {
    const LocalIndex node = nodes[static_cast<std::size_t>(corner)];
    if (std::find(result.begin(), result.begin() + count, node) != result.begin() + count) continue;
    result[static_cast<std::size_t>(count++)] = node;
  }
  return result;
}

std::span<const std::int8_t> corners_of(const Topology& kind, int side) {
  const auto s = static_cast<std::size_t>(side);
  return {kind.side[s].data(), static_cast<std::size_t>(kind.side_nodes[s])};
}

double area(const std::array<LocalIndex, 4>& nodes, std::span<const Vec3> x) {
  const auto at = [&](std::size_t i) { return x[static_cast<std::size_t>(nodes[i])]; };
  if (nodes[3] == no_index) return 0.5 * norm(cross(at(1) - at(0), at(2) - at(0)));
  return 0.5 * norm(cross(at(2) - at(0), at(3) - at(1)));
}

}  // namespace

ContactFaces::ContactFaces(const Mesh& mesh, const MechanicsOptions& options, const ElementGroups& groups,
                           const std::vector<char>& hidden) {
  const std::vector<Side> all = sides_of(mesh);
  const bool erodes = std::ranges::any_of(groups, [](const auto& group) { return group->can_die; });
  for (std::size_t first = 0, end = 0; first < all.size(); first = end) {
    bool has_shell = false;
    while (end < all.size() && all[end].key == all[first].key) has_shell = has_shell || all[end++].shell;
    if (!mesh.owns_node(all[first].key[0])) continue;
    // What two solids share shows only when one of them dies.
    if (!erodes && end - first > 1 && !has_shell) continue;
    if (std::ranges::all_of(all[first].key, [&](LocalIndex n) {
          return n == beyond || (!hidden.empty() && hidden[static_cast<std::size_t>(n)] != 0);
        })) {
      left_out_ += end - first == 1 || has_shell ? 1 : 0;
      continue;
    }
    for (std::size_t i = first; i < end; ++i) {
      sides_.push_back(all[i]);
      faces_.push_back(face(mesh, options, groups, all[i]));
    }
  }
}

std::vector<ContactFaces::Side> ContactFaces::sides_of(const Mesh& mesh) const {
  std::vector<Side> sides;
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
    const ElementBlock& block = mesh.blocks[b];
    const Topology& kind = topology(block.kind);
    const bool shell = kind.dimension == 2;
    for (LocalIndex e = 0; e < block.size(); ++e)
      for (int s = 0; s < (shell ? 1 : kind.sides); ++s) {
        int count = 0;
        std::array<LocalIndex, 4> key = distinct(block.nodes(e), corners_of(kind, s), count);
        if (count < 3) continue;
        std::ranges::replace(key, no_index, beyond);
        std::ranges::sort(key);
        sides.push_back({key, static_cast<std::int32_t>(b), e, static_cast<std::int8_t>(s), shell});
      }
  }
  std::ranges::sort(sides, {}, [](const Side& s) { return std::tuple(s.key, s.block, s.element, s.side); });
  return sides;
}

// Undeformed sizes: what is asked for later, after erosion or a restart, is the same.
ContactFace ContactFaces::face(const Mesh& mesh, const MechanicsOptions& options, const ElementGroups& groups,
                               const Side& side) const {
  const ElementBlock& block = mesh.blocks[static_cast<std::size_t>(side.block)];
  int count = 0;
  ContactFace f{};
  f.id = 8 * block.ids[static_cast<std::size_t>(side.element)] + side.side;
  f.nodes = distinct(block.nodes(side.element), corners_of(topology(block.kind), side.side), count);
  f.surface = side.block;
  f.two_sided = side.shell;
  if (side.shell) {
    const auto found = std::ranges::find(options.blocks, block.name, &MechanicsOptions::Block::name);
    Vec3 centre{};
    for (const LocalIndex n : block.nodes(side.element))
      centre = centre + mesh.coordinates[static_cast<std::size_t>(n)];
    centre = (1 / static_cast<double>(block.nodes(side.element).size())) * centre;
    f.thickness = found->shell.thickness_field ? found->shell.thickness_field(centre) : found->shell.thickness;
    return f;
  }
  const ElementGroups::Place place = groups.place(static_cast<std::size_t>(side.block), side.element);
  const double size = area(f.nodes, mesh.coordinates), volume = place.group->volume(place.element, mesh.coordinates);
  f.depth = size > 0 ? volume / size : 0;
  std::size_t others = 0;
  for (const LocalIndex n : block.nodes(side.element))
    if (std::ranges::find(f.nodes, n) == f.nodes.end() && others < f.behind.size()) f.behind[others++] = n;
  return f;
}

void ContactFaces::list(const ElementGroups& groups, std::vector<ContactFace>& faces) const {
  faces.clear();
  for (std::size_t first = 0, end = 0; first < sides_.size(); first = end) {
    int solids = 0;
    bool shell = false;
    std::size_t shown = first;
    for (; end < sides_.size() && sides_[end].key == sides_[first].key; ++end) {
      const Side& side = sides_[end];
      const ElementGroups::Place place = groups.place(static_cast<std::size_t>(side.block), side.element);
      if (!place.group->alive(place.element)) continue;
      if (side.shell) {
        if (!shell) shown = end;
        shell = true;
      } else {
        if (!shell) shown = end;
        ++solids;
      }
    }
    if (solids == 1 || (shell && solids == 0)) faces.push_back(faces_[shown]);
  }
  std::ranges::sort(faces, {}, &ContactFace::id);
}

std::int64_t ContactFaces::memory() const {
  return static_cast<std::int64_t>(sides_.size() * (sizeof(Side) + sizeof(ContactFace)));
}

}  // namespace tenon
