// SPDX-License-Identifier: BSD-3-Clause
// What stands in a Gmsh file, before it is made into a mesh. Private to the room.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "framework/base/types.hpp"

namespace tenon::mesh_file {

/// Element types besides those of topology.hpp. The last three bound elements of second order.
inline constexpr int gmsh_line = 1, gmsh_point = 15, gmsh_line3 = 8, gmsh_tri6 = 9, gmsh_quad8 = 16;

/// Elements that follow each other in the file and have all of this in common.
struct GmshElements {
  int type = 0;       ///< Gmsh's number of the element type
  int dimension = 0;  ///< of the elements
  int nodes_each = 0;
  int corners = 0;                   ///< of the elements of a boundary; their middle nodes stand behind them
  std::vector<std::int64_t> groups;  ///< physical tags, ascending; negative ones (reversed) by their magnitude
  bool reversed = false;             ///< the first group wants the opposite orientation
  std::vector<std::int64_t> labels;
  std::vector<std::int64_t> nodes;  ///< tags of the file
};

struct GmshFile {
  std::string path;
  std::map<std::pair<int, std::int64_t>, std::string> names;  ///< of physical groups, by dimension and tag
  std::vector<std::int64_t> node_tags;
  std::vector<Vec3> coordinates;
  std::vector<GmshElements> elements;
  bool repeats_elements = false;  ///< format 2 writes an element once for every group that it is in
};

/// Reads MSH 2.x, 4.0 and 4.1, text or binary. Throws Error(file); indices are not resolved yet.
GmshFile parse_gmsh(const std::string& path);

}  // namespace tenon::mesh_file
