// SPDX-License-Identifier: BSD-3-Clause
#include "components/thermal/surface.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "components/thermal/element_conduction.hpp"
#include "components/thermal/surface_projection.hpp"
#include "framework/base/error.hpp"

namespace tenon::thermal {

Surface::Surface(const Mesh& mesh, const std::string& side_set) : mesh_(mesh), sides_(mesh.find_side_set(side_set)) {
  if (!sides_)
    throw Error(ExitCode::usage,
                fmt::format("heat conduction: the mesh {} has no side set '{}'", mesh.source, side_set));
  std::vector<LocalIndex> nodes;
  for (const Side& side : sides_->sides) {
    const SideCorners corners = side_corners(mesh, side);
    nodes.insert(nodes.end(), corners.nodes.begin(),
                 corners.nodes.begin() + static_cast<std::ptrdiff_t>(corners.count));
  }
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  std::erase_if(nodes, [&](LocalIndex n) { return !mesh.owns_node(n); });
  const auto position = [](const std::vector<LocalIndex>& in, LocalIndex n) {
    const auto found = std::ranges::lower_bound(in, n);
    return found != in.end() && *found == n ? static_cast<LocalIndex>(found - in.begin()) : no_index;
  };
  for (const LocalIndex n : nodes) rows_.push_back(position(mesh.owned_nodes, n));
  areas_.assign(rows_.size(), 0.0);
  for (const Side& side : sides_->sides) {
    const SideCorners corners = side_corners(mesh, side);
    for (std::size_t a = 0; a < max_side_nodes; ++a)
      entries_.push_back(a < corners.count ? position(nodes, corners.nodes[a]) : no_index);
  }
}

void Surface::update(std::span<const Vec3> coordinates) {
  std::ranges::fill(areas_, 0.0);
  std::array<Vec3, max_side_nodes> place{};
  std::array<double, max_side_nodes> area{};
  std::size_t entry = 0;
  for (const Side& side : sides_->sides) {
    const SideCorners corners = side_corners(mesh_, side);
    for (std::size_t a = 0; a < corners.count; ++a) place[a] = coordinates[static_cast<std::size_t>(corners.nodes[a])];
    nodal_areas(std::span(place).first(corners.count), std::span(area).first(corners.count));
    for (std::size_t a = 0; a < max_side_nodes; ++a, ++entry)
      if (entries_[entry] != no_index) areas_[static_cast<std::size_t>(entries_[entry])] += area[a];
  }
}

void Surface::links(std::span<const Vec3> coordinates,
                    const std::function<void(LocalIndex, LocalIndex, double)>& use) const {
  std::array<Vec3, max_side_nodes> place{};
  for (const Side& side : sides_->sides) {
    const SideCorners corners = side_corners(mesh_, side);
    for (std::size_t a = 0; a < corners.count; ++a) place[a] = coordinates[static_cast<std::size_t>(corners.nodes[a])];
    const SideLinks link = side_links(std::span(place).first(corners.count));
    for (std::size_t a = 0; a < corners.count; ++a)
      for (std::size_t b = a + 1; b < corners.count; ++b) use(corners.nodes[a], corners.nodes[b], link[a][b]);
  }
}

}  // namespace tenon::thermal
