// SPDX-License-Identifier: BSD-3-Clause
// Exodus II meshes, written with the Exodus library that comes with VTK.
#include <vtk_exodusII.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <limits>
#include <set>

#include "framework/base/error.hpp"
#include "framework/mesh_files/read_support.hpp"
#include "framework/mesh_files/readers.hpp"

namespace tenon {
namespace {

constexpr std::size_t usual_name_length = 32;  ///< what every Exodus program can read
constexpr std::size_t longest_name = 255;      ///< what the netCDF library can hold

std::string exodus_type(ElementKind kind) {
  switch (kind) {
    case ElementKind::hex8:
      return "HEX8";
    case ElementKind::tet4:
      return "TETRA4";
    case ElementKind::wedge6:
      return "WEDGE6";
    case ElementKind::pyramid5:
      return "PYRAMID5";
    case ElementKind::quad4:
      return "SHELL4";
    case ElementKind::hex20:
      return "HEX20";
    case ElementKind::tet10:
      return "TETRA10";
    case ElementKind::particle:
      return "SPHERE";
    case ElementKind::tri3:
      break;
  }
  return "TRI3";
}

class ExodusWriter {
 public:
  /// `path` is where the file goes, `target` what messages call it.
  ExodusWriter(const MeshData& mesh, const std::string& path, const std::string& target)
      : mesh_(mesh), target_(target) {
    // Ids beyond 32 bits need a format with 64-bit integers.
    const int format = wide() ? EX_NETCDF4 | EX_ALL_INT64_DB : EX_64BIT_OFFSET;
    int computer = sizeof(double), stored = sizeof(double);
    id_ =
        ex_create(std::filesystem::absolute(path).c_str(), EX_CLOBBER | EX_ALL_INT64_API | format, &computer, &stored);
    if (id_ < 0) mesh_file::refuse(target_, "cannot be created; is the folder there, and may it be written to?");
  }
  ~ExodusWriter() {
    if (id_ >= 0) ex_close(id_);
  }
  ExodusWriter(const ExodusWriter&) = delete;
  ExodusWriter& operator=(const ExodusWriter&) = delete;

  void write() {
    write_sizes();
    write_nodes();
    write_blocks();
    write_sets();
    const int id = id_;
    id_ = -1;
    require(ex_close(id), "the end of the file");
  }

 private:
  void require(int status, const std::string& what) const {
    if (status < 0)
      mesh_file::refuse(target_, "cannot write " + what + " (" + ex_strerror(status) + "); is the disk full?");
  }

  bool wide() const {
    constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
    const auto is_wide = [](std::int64_t label) { return label > most || label < -most; };
    if (mesh_.coordinates.size() > most || mesh_.elements() > most) return true;
    if (std::any_of(mesh_.node_labels.begin(), mesh_.node_labels.end(), is_wide)) return true;
    const auto set_is_wide = [&](const auto& set) { return is_wide(set.label); };
    return std::any_of(mesh_.blocks.begin(), mesh_.blocks.end(),
                       [&](const BlockData& b) {
                         return is_wide(b.label) || std::any_of(b.labels.begin(), b.labels.end(), is_wide);
                       }) ||
           std::any_of(mesh_.node_sets.begin(), mesh_.node_sets.end(), set_is_wide) ||
           std::any_of(mesh_.side_sets.begin(), mesh_.side_sets.end(), set_is_wide);
  }

  template <class Entries>
  std::size_t longest(const Entries& entries, std::size_t length) const {
    for (const auto& entry : entries) length = std::max(length, entry.name.size());
    return length;
  }

  void write_sizes() {
    const std::size_t length =
        longest(mesh_.blocks, longest(mesh_.node_sets, longest(mesh_.side_sets, usual_name_length)));
    if (length > longest_name)
      mesh_file::refuse(target_, "cannot hold a name of " + std::to_string(length) + " characters");
    require(ex_set_max_name_length(id_, static_cast<int>(length)), "the length of names");
    const std::string title = "mesh written by Tenon";
    require(ex_put_init(id_, title.c_str(), 3, static_cast<std::int64_t>(mesh_.coordinates.size()),
                        static_cast<std::int64_t>(mesh_.elements()), static_cast<std::int64_t>(mesh_.blocks.size()),
                        static_cast<std::int64_t>(mesh_.node_sets.size()),
                        static_cast<std::int64_t>(mesh_.side_sets.size())),
            "the sizes");
  }

  void write_nodes() {
    std::vector<double> values[3];
    for (std::size_t c = 0; c < 3; ++c)
      for (const Vec3& x : mesh_.coordinates) values[c].push_back(x[c]);
    if (!mesh_.coordinates.empty()) {
      require(ex_put_coord(id_, values[0].data(), values[1].data(), values[2].data()), "coordinates");
      require(ex_put_id_map(id_, EX_NODE_MAP, mesh_.node_labels.data()), "node ids");
    }
    char x[] = "x", y[] = "y", z[] = "z";
    char* names[] = {x, y, z};
    require(ex_put_coord_names(id_, names), "coordinate names");
  }

  void write_blocks() {
    std::vector<std::int64_t> labels;
    for (const BlockData& block : mesh_.blocks) {
      const auto count = static_cast<std::int64_t>(block.size());
      require(ex_put_block(id_, EX_ELEM_BLOCK, block.label, exodus_type(block.kind).c_str(), count,
                           topology(block.kind).nodes, 0, 0, 0),
              "block '" + block.name + "'");
      require(ex_put_name(id_, EX_ELEM_BLOCK, block.label, block.name.c_str()), "the name '" + block.name + "'");
      labels.insert(labels.end(), block.labels.begin(), block.labels.end());
      if (count == 0) continue;
      std::vector<GlobalId> nodes = from_one(block.connectivity);
      // Exodus and we exchange two rows of middle nodes: the permutation is its own inverse.
      mesh_file::from_file_order(nodes, exodus_node_order(block.kind));
      require(ex_put_conn(id_, EX_ELEM_BLOCK, block.label, nodes.data(), nullptr, nullptr),
              "block '" + block.name + "'");
    }
    if (!labels.empty()) require(ex_put_id_map(id_, EX_ELEM_MAP, labels.data()), "element ids");
  }

  static std::vector<std::int64_t> from_one(std::vector<GlobalId> numbers) {
    for (GlobalId& n : numbers) ++n;
    return numbers;
  }

  void write_sets() {
    for (const NodeSetData& set : mesh_.node_sets) {
      const std::vector<std::int64_t> nodes = from_one(set.nodes);
      write_set(EX_NODE_SET, set.label, set.name, nodes, {});
    }
    for (const SideSetData& set : mesh_.side_sets) {
      std::vector<std::int64_t> elements, sides;
      for (const SideData& side : set.sides) {
        elements.push_back(side.element + 1);
        sides.push_back(side.side + 1);
      }
      write_set(EX_SIDE_SET, set.label, set.name, elements, sides);
    }
  }

  void write_set(ex_entity_type type, std::int64_t label, const std::string& name,
                 const std::vector<std::int64_t>& items, const std::vector<std::int64_t>& sides) {
    require(ex_put_set_param(id_, type, label, static_cast<std::int64_t>(items.size()), 0), "the set '" + name + "'");
    require(ex_put_name(id_, type, label, name.c_str()), "the name '" + name + "'");
    if (!items.empty())
      require(ex_put_set(id_, type, label, items.data(), sides.empty() ? nullptr : sides.data()),
              "the set '" + name + "'");
  }

  const MeshData& mesh_;
  std::string target_;
  int id_ = -1;
};

/// An Exodus file tells its blocks and sets apart by their ids, so these must differ and be positive.
template <class Entries>
void check_labels(const Entries& entries, const std::string& what, const std::string& path) {
  std::set<std::int64_t> seen;
  for (const auto& entry : entries)
    if (entry.label < 1 || !seen.insert(entry.label).second)
      mesh_file::refuse(path, what + " '" + entry.name + "' has the id " + std::to_string(entry.label) +
                                  ", which is not positive or not its own; an Exodus file needs distinct ids");
}

}  // namespace

void write_exodus(const MeshData& mesh, const std::string& path) {
  check_labels(mesh.blocks, "block", path);
  check_labels(mesh.node_sets, "node set", path);
  check_labels(mesh.side_sets, "side set", path);
  ex_opts(0);  // errors come back as codes and are not printed
  // Written aside and renamed when whole.
  const std::string part = path + ".part";
  try {
    ExodusWriter(mesh, part, path).write();
    std::error_code error;
    std::filesystem::rename(part, path, error);
    if (error) mesh_file::refuse(path, "cannot be put in place (" + error.message() + ")");
  } catch (const Error&) {
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    throw;
  }
}

}  // namespace tenon
