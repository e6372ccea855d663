// SPDX-License-Identifier: BSD-3-Clause
// Gmsh meshes: physical groups become blocks, node sets and side sets.
#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>
#include <tuple>

#include "framework/mesh_files/gmsh_parser.hpp"
#include "framework/mesh_files/gmsh_sets.hpp"
#include "framework/mesh_files/read_support.hpp"
#include "framework/mesh_files/readers.hpp"

namespace tenon {
namespace {

using mesh_file::GmshElements;
using mesh_file::GmshFile;
using mesh_file::refuse;
using mesh_file::SideFinder;

constexpr std::int64_t no_group = std::numeric_limits<std::int64_t>::max();  // sorts behind the groups

class GmshReader {
 public:
  explicit GmshReader(const std::string& path) : file_(mesh_file::parse_gmsh(path)) { mesh_.source = path; }

  MeshData read() {
    number_nodes();
    for (const GmshElements& e : file_.elements)
      if (!e.labels.empty()) top_ = std::max(top_, e.dimension);
    if (top_ < 2) refuse(file_.path, "has no volume or surface elements, only points and lines");
    if (top_ == 2) refuse_curved_surfaces();
    if (file_.repeats_elements) drop_repeated_elements();
    collect_groups();
    make_blocks();
    for (int dimension = top_ - 1; dimension >= 0; --dimension) make_sets(dimension);
    mesh_file::finish(mesh_);
    drop_empty_sets();
    return std::move(mesh_);
  }

 private:
  /// Elements of one physical group and type, as places in the file.
  using Members = std::vector<const GmshElements*>;
  struct Group {
    std::map<ElementKind, Members> kinds;  ///< of surfaces and volumes
    Members all;
  };

  /// Replaces the node tags of all elements by positions.
  void number_nodes() {
    const std::size_t count = file_.node_tags.size();
    std::vector<std::pair<std::int64_t, GlobalId>> order(count);
    for (std::size_t n = 0; n < count; ++n) order[n] = {file_.node_tags[n], static_cast<GlobalId>(n)};
    std::sort(order.begin(), order.end());
    for (std::size_t n = 1; n < count; ++n)
      if (order[n].first == order[n - 1].first)
        refuse(file_.path, "node " + std::to_string(order[n].first) + " is defined twice");
    const bool dense = count > 0 && order.back().first - order.front().first + 1 == static_cast<std::int64_t>(count);
    const auto position = [&](std::int64_t tag) {
      if (dense && tag >= order.front().first && tag <= order.back().first)
        return order[static_cast<std::size_t>(tag - order.front().first)].second;
      const auto at = std::lower_bound(order.begin(), order.end(), std::pair<std::int64_t, GlobalId>{tag, 0});
      return at != order.end() && at->first == tag ? at->second : no_id;
    };
    for (GmshElements& elements : file_.elements)
      for (std::size_t i = 0; i < elements.nodes.size(); ++i) {
        const std::int64_t tag = elements.nodes[i];
        elements.nodes[i] = position(tag);
        if (elements.nodes[i] == no_id)
          refuse(file_.path, "element " +
                                 std::to_string(elements.labels[i / static_cast<std::size_t>(elements.nodes_each)]) +
                                 " uses node " + std::to_string(tag) + ", which is not in the file");
      }
    mesh_.coordinates = std::move(file_.coordinates);
    mesh_.node_labels = std::move(file_.node_tags);
  }

  /// Triangles and quadrangles of second order are read as boundaries of solids only.
  void refuse_curved_surfaces() const {
    for (const GmshElements& e : file_.elements)
      if (e.dimension == 2 && !e.labels.empty() && !kind_of_gmsh(e.type))
        refuse(file_.path, "element " + std::to_string(e.labels.front()) +
                               " is a surface element of second order, which is read only as the boundary of volume "
                               "elements; set Mesh.ElementOrder = 1 in Gmsh and mesh again");
  }

  /// Format 2 writes an element of several groups once for each of them, under different numbers: the one of the group
  /// with the smallest tag stays.
  void drop_repeated_elements() {
    struct Copy {
      std::array<GlobalId, max_element_nodes> nodes;
      std::int64_t group;
      std::size_t chunk, element;
    };
    std::vector<Copy> copies;
    std::set<std::int64_t> groups;
    for (std::size_t c = 0; c < file_.elements.size(); ++c) {
      const GmshElements& chunk = file_.elements[c];
      if (chunk.dimension != top_) continue;
      const std::int64_t group = chunk.groups.empty() ? no_group : chunk.groups.front();
      groups.insert(group);
      const auto each = static_cast<std::size_t>(chunk.nodes_each);
      for (std::size_t e = 0; e < chunk.labels.size(); ++e) {
        Copy copy{{}, group, c, e};
        copy.nodes.fill(no_id);
        std::copy_n(&chunk.nodes[e * each], each, copy.nodes.begin());
        std::sort(copy.nodes.begin(), copy.nodes.end());
        copies.push_back(copy);
      }
    }
    if (groups.size() < 2) return;
    std::sort(copies.begin(), copies.end(), [](const Copy& a, const Copy& b) {
      return std::tie(a.nodes, a.group, a.chunk, a.element) < std::tie(b.nodes, b.group, b.chunk, b.element);
    });
    std::vector<std::vector<bool>> dropped(file_.elements.size());
    std::size_t count = 0;
    for (std::size_t i = 1; i < copies.size(); ++i) {
      if (copies[i].nodes != copies[i - 1].nodes) continue;
      std::vector<bool>& marks = dropped[copies[i].chunk];
      marks.resize(file_.elements[copies[i].chunk].labels.size());
      marks[copies[i].element] = true;
      ++count;
    }
    for (std::size_t c = 0; c < dropped.size(); ++c)
      if (!dropped[c].empty()) remove(file_.elements[c], dropped[c]);
    if (count > 0) warn_several_groups(count);
  }

  static void remove(GmshElements& chunk, const std::vector<bool>& dropped) {
    const auto each = static_cast<std::size_t>(chunk.nodes_each);
    std::size_t kept = 0;
    for (std::size_t e = 0; e < chunk.labels.size(); ++e) {
      if (dropped[e]) continue;
      chunk.labels[kept] = chunk.labels[e];
      std::copy_n(&chunk.nodes[e * each], each, &chunk.nodes[kept * each]);
      ++kept;
    }
    chunk.labels.resize(kept);
    chunk.nodes.resize(kept * each);
  }

  void warn_several_groups(std::size_t count) {
    mesh_.warnings.push_back(std::to_string(count) +
                             " elements are in several physical groups; each is in the block of "
                             "its group with the smallest tag");
  }

  void collect_groups() {
    std::size_t several = 0;
    for (const GmshElements& chunk : file_.elements) {
      if (chunk.labels.empty()) continue;
      std::vector<std::int64_t> tags = chunk.groups;
      if (chunk.dimension == top_) {
        if (tags.size() > 1) several += chunk.labels.size();
        tags = {tags.empty() ? no_group : tags.front()};
      }
      for (const std::int64_t tag : tags) {
        Group& group = groups_[static_cast<std::size_t>(chunk.dimension)][tag];
        group.all.push_back(&chunk);
        if (chunk.dimension >= 2 && kind_of_gmsh(chunk.type)) group.kinds[*kind_of_gmsh(chunk.type)].push_back(&chunk);
      }
    }
    if (several > 0) warn_several_groups(several);
  }

  std::string name_of(int dimension, std::int64_t tag, const std::string& fallback) const {
    const auto found = file_.names.find({dimension, tag});
    return found != file_.names.end() ? found->second : fallback + "_" + std::to_string(tag);
  }

  void make_blocks() {
    const auto& groups = groups_[static_cast<std::size_t>(top_)];
    for (const auto& [tag, group] : groups) {
      const bool grouped = tag != no_group;
      const std::string rest = top_ == 3 ? "volume" : "surface";
      if (!grouped && groups.size() > 1)
        mesh_.warnings.push_back("elements outside all physical groups are in the block '" + rest + "'");
      add_blocks(group, grouped ? name_of(top_, tag, "block") : rest, grouped ? tag : 0);
    }
  }

  /// One block for every kind in the group.
  void add_blocks(const Group& group, const std::string& name, std::int64_t label) {
    for (const auto& [kind, members] : group.kinds) {
      BlockData block{name, label, kind, {}, {}};
      if (group.kinds.size() > 1) block.name.append("_").append(topology(kind).name);
      for (const GmshElements* chunk : members) {
        block.labels.insert(block.labels.end(), chunk->labels.begin(), chunk->labels.end());
        const auto each = static_cast<std::ptrdiff_t>(chunk->nodes_each);
        const std::size_t start = block.connectivity.size();
        block.connectivity.insert(block.connectivity.end(), chunk->nodes.begin(), chunk->nodes.end());
        mesh_file::from_file_order(std::span(block.connectivity).subspan(start), gmsh_node_order(kind));
        if (chunk->reversed)
          for (auto e = block.connectivity.begin() + static_cast<std::ptrdiff_t>(start); e != block.connectivity.end();
               e += each)
            std::reverse(e + 1, e + each);
      }
      mesh_.blocks.push_back(std::move(block));
    }
  }

  /// Node sets, and side sets where the elements of the group lie on sides. A surface group of a solid mesh that lies
  /// on no solid at all is a shell structure, and becomes a block.
  void make_sets(int dimension) {
    const auto& groups = groups_[static_cast<std::size_t>(dimension)];
    if (groups.empty()) return;
    std::vector<bool> wanted(mesh_.coordinates.size(), false);
    for (const auto& [tag, group] : groups)
      for (const GmshElements* chunk : group.all)
        for (const GlobalId node : chunk->nodes) wanted[static_cast<std::size_t>(node)] = true;
    const SideFinder finder(mesh_, dimension, wanted);
    for (const auto& [tag, group] : groups) {
      NodeSetData nodes{name_of(dimension, tag, "nodelist"), tag, {}};
      SideSetData sides{name_of(dimension, tag, "surface"), tag, {}};
      std::size_t count = 0;
      for (const GmshElements* chunk : group.all) {
        nodes.nodes.insert(nodes.nodes.end(), chunk->nodes.begin(), chunk->nodes.end());
        count += chunk->labels.size();
        if (dimension > 0) find_sides(finder, *chunk, sides.sides);
      }
      if (sides.sides.empty() && dimension == 2 && !group.kinds.empty()) {
        mesh_.warnings.push_back("the surface group '" + sides.name +
                                 "' lies on no volume element and becomes a block of shells");
        add_blocks(group, name_of(2, tag, "block"), tag);
        continue;
      }
      if (!sides.sides.empty() && sides.sides.size() < count)
        mesh_.warnings.push_back(std::to_string(count - sides.sides.size()) + " of " + std::to_string(count) +
                                 " elements of the group '" + sides.name +
                                 "' lie on no side and are left out of the side set");
      if (!sides.sides.empty()) mesh_.side_sets.push_back(std::move(sides));
      mesh_.node_sets.push_back(std::move(nodes));
    }
  }

  /// Points of the geometry that are not in the mesh.
  void drop_empty_sets() {
    for (const NodeSetData& set : mesh_.node_sets)
      if (set.nodes.empty())
        mesh_.warnings.push_back("no element has a node of the group '" + set.name + "', which is left out");
    std::erase_if(mesh_.node_sets, [](const NodeSetData& set) { return set.nodes.empty(); });
  }

  static void find_sides(const SideFinder& finder, const GmshElements& chunk, std::vector<SideData>& sides) {
    const auto each = static_cast<std::size_t>(chunk.nodes_each), corners = static_cast<std::size_t>(chunk.corners);
    for (std::size_t e = 0; e < chunk.labels.size(); ++e)
      if (const auto side = finder.find(std::span(chunk.nodes).subspan(e * each, corners))) sides.push_back(*side);
  }

  GmshFile file_;
  MeshData mesh_;
  int top_ = 0;                                          ///< highest dimension of an element
  std::array<std::map<std::int64_t, Group>, 4> groups_;  ///< by dimension and tag
};

}  // namespace

MeshData read_gmsh(const std::string& path) {
  return mesh_file::within_memory(path, [&] { return GmshReader(path).read(); });
}

}  // namespace tenon
