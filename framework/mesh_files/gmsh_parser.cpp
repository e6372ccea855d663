// SPDX-License-Identifier: BSD-3-Clause
// Parser of the Gmsh formats MSH 2.x, 4.0 and 4.1. Reference: [GR09], the manual's "MSH file format" and its legacy
// versions.
#include "framework/mesh_files/gmsh_parser.hpp"

#include <algorithm>
#include <set>

#include "framework/mesh/topology.hpp"
#include "framework/mesh_files/gmsh_cursor.hpp"
#include "framework/mesh_files/read_support.hpp"

namespace tenon::mesh_file {
namespace {

constexpr int most_groups = 1000;

/// Names of the types that are refused, for the message.
std::string type_name(int type) {
  static const std::map<int, std::string> names{
      {10, "9-node quadrangle"}, {12, "27-node hexahedron"}, {13, "18-node prism"},
      {14, "14-node pyramid"},   {18, "15-node prism"},      {19, "13-node pyramid"},
      {21, "10-node triangle"},  {26, "4-node line"},        {29, "20-node tetrahedron"}};
  const auto found = names.find(type);
  return "type " + std::to_string(type) + (found == names.end() ? "" : " (" + found->second + ")");
}

class Parser {
 public:
  explicit Parser(const std::string& path) : in_(path, contents_of(path)) { file_.path = path; }

  GmshFile parse() {
    read_format();
    std::set<std::string> seen;
    for (std::string name = in_.next_section(); !name.empty(); name = in_.next_section()) {
      const bool wanted = name == "PhysicalNames" || name == "Entities" || name == "Nodes" || name == "Elements";
      if (wanted && !seen.insert(name).second) in_.refuse_here("a second $" + name);
      if (name == "PartitionedEntities" || name == "GhostElements") refuse_partitioned();
      if (!wanted || (name == "Entities" && major_ == 2)) {
        in_.skip_section(name);
        continue;
      }
      if (name == "PhysicalNames") read_names();
      if (name == "Entities") read_entities();
      if (name == "Nodes") major_ == 2 ? read_nodes_2() : read_nodes_4();
      if (name == "Elements") major_ == 2 ? read_elements_2() : read_elements_4();
      in_.end_section(name);
    }
    for (const char* name : {"Nodes", "Elements"})
      if (!seen.contains(name)) refuse(file_.path, std::string("has no section $") + name + " (truncated?)");
    return std::move(file_);
  }

 private:
  static constexpr const char* convert = "; convert it with: gmsh OLD.msh -save -format msh41 -o NEW.msh";

  void read_format() {
    std::string section = in_.next_section();
    for (; section == "Comments"; section = in_.next_section()) in_.skip_section(section);
    if (section == "NOD") refuse(file_.path, std::string("is of MSH version 1; read are 2.x, 4.0 and 4.1") + convert);
    if (section != "MeshFormat") in_.refuse_here("expected $MeshFormat, the first section of a Gmsh mesh");
    const double version = in_.text_real("the version");
    const std::int64_t binary = in_.text_integer("0 for text or 1 for binary");
    const std::int64_t size = in_.text_integer("the size of a number in bytes");
    major_ = version >= 2 && version < 3 ? 2 : 4;
    old_4_ = version == 4.0;
    if (major_ == 4 && version != 4.0 && version != 4.1) {
      std::string text = std::to_string(version);
      text.erase(text.find_last_not_of('0') + 1);
      in_.refuse_here("MSH version " + text + " is not known; read are 2.x, 4.0 and 4.1" + convert);
    }
    if (binary != 0 && binary != 1) in_.refuse_here("the file type must be 0 (text) or 1 (binary)");
    if (size != 8) in_.refuse_here("numbers of " + std::to_string(size) + " bytes are not read, only of 8" + convert);
    if (old_4_ && binary == 1)
      in_.refuse_here(std::string("MSH version 4.0 is read as text only, as in Gmsh itself") + convert);
    in_.finish_line();
    if (binary == 1) {
      const std::int32_t one = in_.raw_integer32("the number one");
      if (one != 1 && one != 0x01000000) in_.refuse_here("cannot tell the order of the bytes");
      in_.set_binary(one != 1);
    }
    in_.end_section(section);
    file_.repeats_elements = major_ == 2;
  }

  void read_names() {
    const std::int64_t count = in_.text_integer("the number of physical names");
    in_.require_room(count, "number of physical names", 8, 4);
    for (std::int64_t n = 0; n < count; ++n) {
      const std::int64_t dimension = in_.text_integer("the dimension of a physical group");
      const std::int64_t tag = in_.text_integer("the tag of a physical group");
      if (dimension < 0 || dimension > 3) in_.refuse_here("the dimension of a physical group must be 0 to 3");
      const std::string name = in_.quoted_text("the name of a physical group");
      if (!name.empty()) file_.names[{static_cast<int>(dimension), tag}] = name;
    }
  }

  // Format 4: an entity (point, curve, surface, volume) lists its physical groups; nodes and elements come by entity.

  void read_entities() {
    std::int64_t counts[4];
    for (std::int64_t& count : counts) count = in_.count("number of entities", 36, 5);
    for (int dimension = 0; dimension < 4; ++dimension) {
      in_.require_room(counts[dimension], "number of entities", 36, 5);
      for (std::int64_t n = 0; n < counts[dimension]; ++n) {
        const std::int64_t tag = in_.integer32("the tag of an entity");
        const int box = dimension == 0 && !old_4_ ? 3 : 6;
        for (int i = 0; i < box; ++i) in_.real("a coordinate of the entity's box");
        std::vector<std::int64_t> groups(static_cast<std::size_t>(in_.count("number of physical tags", 4, 1)));
        for (std::int64_t& group : groups) group = in_.integer32("a physical tag");
        if (dimension > 0) {
          const std::int64_t bounding = in_.count("number of bounding entities", 4, 1);
          for (std::int64_t i = 0; i < bounding; ++i) in_.integer32("the tag of a bounding entity");
        }
        if (!groups.empty()) entity_groups_[{dimension, tag}] = std::move(groups);
      }
    }
  }

  void add_node(std::int64_t tag) {
    if (tag < 1) in_.refuse_here("impossible node tag " + std::to_string(tag));
    file_.node_tags.push_back(tag);
  }
  Vec3 read_point() {
    Vec3 point;
    for (double& x : point) x = in_.real("a coordinate");
    return point;
  }

  /// Dimension and tag of the entity that the next nodes or elements belong to; format 4.0 has them the other way.
  std::pair<int, std::int64_t> read_entity() {
    std::int64_t dimension = in_.integer32("the dimension of an entity");
    std::int64_t tag = in_.integer32("the tag of an entity");
    if (old_4_) std::swap(dimension, tag);
    if (dimension < 0 || dimension > 3) in_.refuse_here("the dimension of an entity must be 0 to 3");
    return {static_cast<int>(dimension), tag};
  }

  void skip_range() {
    if (old_4_) return;
    in_.integer64("the smallest tag");
    in_.integer64("the greatest tag");
  }

  void read_nodes_4() {
    const std::int64_t blocks = in_.count("number of node blocks", 20, 4);
    const std::int64_t total = in_.count("number of nodes", 28, 4);
    skip_range();
    for (std::int64_t b = 0; b < blocks; ++b) {
      const int dimension = read_entity().first;
      const int parameters = in_.integer32("0 or 1 for parametric nodes") == 0 ? 0 : dimension;
      const std::int64_t count = in_.count("number of nodes", 32, 4);
      if (!old_4_)
        for (std::int64_t n = 0; n < count; ++n) add_node(in_.integer64("a node tag"));
      for (std::int64_t n = 0; n < count; ++n) {
        if (old_4_) add_node(in_.integer64("a node tag"));
        file_.coordinates.push_back(read_point());
        for (int p = 0; p < parameters; ++p) in_.real("a parameter of a node");
      }
    }
    if (static_cast<std::int64_t>(file_.node_tags.size()) != total)
      in_.refuse_here("found " + std::to_string(file_.node_tags.size()) + " nodes, expected " + std::to_string(total));
  }

  void read_elements_4() {
    const std::int64_t blocks = in_.count("number of element blocks", 20, 4);
    const std::int64_t total = in_.count("number of elements", 8, 2);
    skip_range();
    std::int64_t found = 0;
    for (std::int64_t b = 0; b < blocks; ++b) {
      const auto entity = read_entity();
      GmshElements& elements = start_elements(in_.integer32("an element type"));
      const std::size_t nodes = static_cast<std::size_t>(elements.nodes_each);
      const std::int64_t count = in_.count("number of elements", 8 * (1 + nodes), 1 + nodes);
      if (const auto groups = entity_groups_.find(entity); groups != entity_groups_.end())
        set_groups(elements, groups->second);
      for (std::int64_t e = 0; e < count; ++e) {
        elements.labels.push_back(in_.integer64("an element tag"));
        for (std::size_t n = 0; n < nodes; ++n) elements.nodes.push_back(in_.integer64("a node tag"));
      }
      found += count;
    }
    if (found != total)
      in_.refuse_here("found " + std::to_string(found) + " elements, expected " + std::to_string(total));
  }

  /// Appends an empty group of elements, or refuses the type.
  GmshElements& start_elements(int type) {
    GmshElements elements;
    elements.type = type;
    if (type == gmsh_point || type == gmsh_line) {
      elements.dimension = type == gmsh_line ? 1 : 0;
      elements.nodes_each = elements.dimension + 1;
      elements.corners = elements.nodes_each;
    } else if (type == gmsh_line3 || type == gmsh_tri6 || type == gmsh_quad8) {
      elements.dimension = type == gmsh_line3 ? 1 : 2;
      elements.corners = type == gmsh_line3 ? 2 : type == gmsh_tri6 ? 3 : 4;
      elements.nodes_each = type == gmsh_line3 ? 3 : 2 * elements.corners;
    } else if (const auto kind = kind_of_gmsh(type)) {
      elements.dimension = topology(*kind).dimension;
      elements.nodes_each = topology(*kind).nodes;
      elements.corners = corner_count(*kind);
    } else {
      in_.refuse_here(
          "elements of " + type_name(type) +
          " are not read; read are points, 2-node lines, 3-node triangles, 4-node quadrangles, 4-node "
          "tetrahedra, 8-node hexahedra, 6-node prisms and 5-node pyramids, and of second order 10-node tetrahedra and "
          "20-node hexahedra with their boundaries. For other meshes of higher order, set Mesh.ElementOrder = 1 in "
          "Gmsh "
          "(for hexahedra, Mesh.SecondOrderIncomplete = 1) and mesh again");
    }
    file_.elements.push_back(std::move(elements));
    return file_.elements.back();
  }

  /// In format 4 a negative tag asks for the opposite orientation, which matters to surfaces; in format 2 the elements
  /// have it already.
  void set_groups(GmshElements& elements, std::vector<std::int64_t> groups) const {
    const auto before = [](std::int64_t a, std::int64_t b) { return std::abs(a) < std::abs(b); };
    std::sort(groups.begin(), groups.end(), before);
    std::erase(groups, 0);
    elements.reversed = major_ == 4 && elements.dimension == 2 && !groups.empty() && groups.front() < 0;
    for (std::int64_t& group : groups) group = std::abs(group);
    groups.erase(std::unique(groups.begin(), groups.end()), groups.end());
    elements.groups = std::move(groups);
  }

  // Format 2: every element carries tags, the first of which is its physical group.

  void read_nodes_2() {
    const std::int64_t count = in_.text_integer("the number of nodes");
    in_.finish_line();
    in_.require_room(count, "number of nodes", 28, 4);
    for (std::int64_t n = 0; n < count; ++n) {
      add_node(in_.integer32("a node number"));
      file_.coordinates.push_back(read_point());
    }
  }

  void read_elements_2() {
    const std::int64_t count = in_.text_integer("the number of elements");
    in_.finish_line();
    in_.require_room(count, "number of elements", 8, 4);
    for (std::int64_t e = 0; e < count;) {
      if (!in_.binary()) {
        const std::int64_t label = in_.integer32("an element number");
        const std::int32_t type = in_.integer32("an element type");
        read_element_2(label, type, in_.integer32("the number of tags"));
        ++e;
        continue;
      }
      const std::int32_t type = in_.integer32("an element type");
      const std::int32_t follow = in_.integer32("the number of elements that follow");
      const std::int32_t tags = in_.integer32("the number of tags");
      if (follow < 1 || follow > count - e) in_.refuse_here("impossible number of elements that follow");
      for (std::int32_t f = 0; f < follow; ++f) read_element_2(in_.integer32("an element number"), type, tags);
      e += follow;
    }
  }

  void read_element_2(std::int64_t label, std::int32_t type, std::int32_t tags) {
    if (tags < 0 || tags > most_groups) in_.refuse_here("impossible number of tags");
    std::int64_t group = 0, partitions = 0;
    for (std::int32_t t = 0; t < tags; ++t) {
      const std::int32_t tag = in_.integer32("a tag of an element");
      if (t == 0) group = tag;
      if (t == 2) partitions = tag;
      // A file with one and the same partition everywhere is a whole mesh.
      if (t == 3 && partition_ == 0) partition_ = tag;
      if (t >= 3 && (partitions > 1 || tag != partition_)) refuse_partitioned();
    }
    if (file_.elements.empty() || file_.elements.back().type != type || group != last_group_)
      set_groups(start_elements(type), {group});
    last_group_ = group;
    GmshElements& elements = file_.elements.back();
    elements.labels.push_back(label);
    for (int n = 0; n < elements.nodes_each; ++n) elements.nodes.push_back(in_.integer32("a node number"));
  }

  [[noreturn]] void refuse_partitioned() const {
    in_.refuse_here(
        "the mesh is partitioned, which is not read: Tenon partitions meshes itself. In Gmsh choose Mesh > "
        "Unpartition (or set Mesh.NbPartitions = 0) and save again");
  }

  GmshCursor in_;
  GmshFile file_;
  int major_ = 4;
  bool old_4_ = false;  ///< version 4.0
  std::map<std::pair<int, std::int64_t>, std::vector<std::int64_t>> entity_groups_;
  std::int64_t last_group_ = 0, partition_ = 0;
};

}  // namespace

GmshFile parse_gmsh(const std::string& path) {
  return Parser(path).parse();
}

}  // namespace tenon::mesh_file
