// SPDX-License-Identifier: BSD-3-Clause
// Exodus II meshes, through the netCDF library that comes with VTK. Names of dimensions and variables: [SY94].
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "framework/mesh_files/netcdf_file.hpp"
#include "framework/mesh_files/read_support.hpp"
#include "framework/mesh_files/readers.hpp"
#include "framework/mesh_files/trial_run.hpp"

namespace tenon {
namespace {

using mesh_file::NetcdfFile;
using mesh_file::refuse;

constexpr const char* supported = "read are HEX8, TETRA4, WEDGE6, PYRAMID5, SHELL4 or QUAD4, TRI3, HEX20 and TETRA10";

class ExodusReader {
 public:
  explicit ExodusReader(const std::string& path) : file_(path), path_(path) {}

  MeshData read() {
    mesh_.source = path_;
    read_sizes();
    read_coordinates();
    read_blocks();
    read_labels();
    read_node_sets();
    read_side_sets();
    mesh_file::finish(mesh_);
    return std::move(mesh_);
  }

 private:
  std::int64_t length(const std::string& dimension) const { return file_.dimension(dimension).value_or(0); }

  void read_sizes() {
    const auto dimension = file_.dimension("num_dim");
    if (!dimension) refuse(path_, "has no dimension 'num_dim': this is not an Exodus II mesh");
    if (*dimension != 2 && *dimension != 3)
      refuse(path_, "has " + std::to_string(*dimension) + " space dimensions, expected 2 or 3");
    dimension_ = static_cast<int>(*dimension);
    nodes_ = length("num_nodes");
    elements_ = length("num_elem");
    if (nodes_ > std::numeric_limits<std::int64_t>::max() / 3) refuse(path_, "has an impossible number of nodes");
    if (nodes_ == 0 || elements_ == 0) refuse(path_, "has no elements: it holds results only, or an empty mesh");
  }

  void read_coordinates() {
    std::vector<double> values;
    if (file_.has("coord")) {
      values = file_.reals("coord", dimension_ * nodes_);
    } else {
      for (int c = 0; c < dimension_; ++c) {
        const std::vector<double> one = file_.reals(std::string("coord") + "xyz"[c], nodes_);
        values.insert(values.end(), one.begin(), one.end());
      }
    }
    mesh_.coordinates.assign(static_cast<std::size_t>(nodes_), Vec3{0, 0, 0});
    for (std::size_t c = 0, at = 0; c < static_cast<std::size_t>(dimension_); ++c)
      for (Vec3& point : mesh_.coordinates) point[c] = values[at++];
  }

  /// Names and ids of the blocks or sets of one kind.
  struct Entry {
    std::string name;
    std::int64_t label;
  };
  std::vector<Entry> read_entries(std::int64_t count, const std::string& prefix, const std::string& fallback) const {
    std::vector<Entry> entries;
    if (count == 0) return entries;
    const std::vector<std::int64_t> labels = file_.integers(prefix + "_prop1", count);
    std::vector<std::string> names(labels.size());
    if (file_.has(prefix + "_names")) names = file_.texts(prefix + "_names", count);
    for (std::size_t i = 0; i < labels.size(); ++i)
      entries.push_back({names[i].empty() ? fallback + "_" + std::to_string(labels[i]) : names[i], labels[i]});
    return entries;
  }

  void read_blocks() {
    int number = 0;
    for (const Entry& entry : read_entries(length("num_el_blk"), "eb", "block"))
      read_block(entry, std::to_string(++number));
    if (read_elements_ != elements_)
      refuse(path_, "its blocks have " + std::to_string(read_elements_) + " elements together, but 'num_elem' says " +
                        std::to_string(elements_));
  }

  void read_block(const Entry& entry, const std::string& number) {
    const std::int64_t size = length("num_el_in_blk" + number);
    const std::string who = "block '" + entry.name + "' (id " + std::to_string(entry.label) + ")";
    const std::string variable = "connect" + number;
    const std::string type = file_.has(variable) ? file_.attribute(variable, "elem_type") : "";
    const std::int64_t per_element = length("num_nod_per_el" + number);
    const std::optional<ElementKind> kind = per_element > 0 && per_element <= max_element_nodes
                                                ? kind_of_exodus(type, static_cast<int>(per_element))
                                                : std::nullopt;
    if (size == 0 && !kind) return;  // a block without elements may be of any type, such as NULL
    if (!kind)
      refuse(path_, who + " has elements of type '" + type + "' with " + std::to_string(per_element) + " nodes; " +
                        supported + ". Other elements of higher order must be converted to these by the mesh program");
    if (dimension_ == 2 && topology(*kind).dimension != 2)
      refuse(path_, who + " has solid elements ('" + type + "') in a mesh of two dimensions");
    BlockData block{entry.name, entry.label, *kind, {}, {}};
    if (size > elements_ - read_elements_) refuse(path_, who + " has more elements than the whole mesh");
    if (size > 0) block.connectivity = file_.integers(variable, size * per_element);
    for (GlobalId& node : block.connectivity) {
      if (node < 1 || node > nodes_)
        refuse(path_,
               who + " uses node " + std::to_string(node) + ", but there are nodes 1 to " + std::to_string(nodes_));
      --node;
    }
    mesh_file::from_file_order(block.connectivity, exodus_node_order(*kind));
    block.labels.assign(static_cast<std::size_t>(size), 0);
    if (*kind == ElementKind::particle && size > 0) read_volumes(block, number);
    first_elements_.push_back(read_elements_);
    read_elements_ += size;
    mesh_.blocks.push_back(std::move(block));
  }

  /// Attributes of spheres: the radius, and, where there are more, the volume.
  void read_volumes(const BlockData& block, const std::string& number) {
    const std::string variable = "attrib" + number;
    const std::int64_t count = length("num_att_in_blk" + number), size = static_cast<std::int64_t>(block.size());
    if (!file_.has(variable) || count < 1 || count > std::numeric_limits<std::int64_t>::max() / size) return;
    const std::vector<double> values = file_.reals(variable, size * count);
    mesh_.volumes.resize(static_cast<std::size_t>(nodes_));
    for (std::size_t e = 0; e < block.size(); ++e) {
      const double* const attributes = &values[e * static_cast<std::size_t>(count)];
      mesh_.volumes[static_cast<std::size_t>(block.connectivity[e])] =
          count > 1 ? attributes[1] : 4 * std::numbers::pi / 3 * std::pow(attributes[0], 3);
    }
  }

  /// The ids that the mesh program showed to its user; without a map, the numbers 1, 2, 3 ...
  std::vector<std::int64_t> label_map(const char* variable, std::int64_t count) const {
    if (file_.has(variable)) return file_.integers(variable, count);
    std::vector<std::int64_t> labels(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < labels.size(); ++i) labels[i] = static_cast<std::int64_t>(i) + 1;
    return labels;
  }

  void read_labels() {
    mesh_.node_labels = label_map("node_num_map", nodes_);
    const std::vector<std::int64_t> labels = label_map("elem_num_map", elements_);
    auto next = labels.begin();
    for (BlockData& block : mesh_.blocks) {
      std::copy_n(next, block.labels.size(), block.labels.begin());
      next += static_cast<std::ptrdiff_t>(block.labels.size());
    }
  }

  void read_node_sets() {
    int n = 0;
    for (const Entry& entry : read_entries(length("num_node_sets"), "ns", "nodelist")) {
      const std::string number = std::to_string(++n);
      NodeSetData set{entry.name, entry.label, {}};
      if (const std::int64_t size = length("num_nod_ns" + number); size > 0)
        set.nodes = file_.integers("node_ns" + number, size);
      for (GlobalId& node : set.nodes) {
        if (node < 1 || node > nodes_)
          refuse(path_, "node set '" + set.name + "' has node " + std::to_string(node) + ", but there are nodes 1 to " +
                            std::to_string(nodes_));
        --node;
      }
      mesh_.node_sets.push_back(std::move(set));
    }
  }

  void read_side_sets() {
    int n = 0;
    for (const Entry& entry : read_entries(length("num_side_sets"), "ss", "surface")) {
      const std::string number = std::to_string(++n);
      SideSetData set{entry.name, entry.label, {}};
      if (const std::int64_t size = length("num_side_ss" + number); size > 0) {
        const std::vector<std::int64_t> elements = file_.integers("elem_ss" + number, size);
        const std::vector<std::int64_t> sides = file_.integers("side_ss" + number, size);
        for (std::size_t i = 0; i < elements.size(); ++i) set.sides.push_back(side_of(set.name, elements[i], sides[i]));
      }
      mesh_.side_sets.push_back(std::move(set));
    }
  }

  /// From the numbers in the file, which count from one. In two dimensions the sides of an element are its edges only,
  /// which stand behind the two faces in the shells of three dimensions.
  SideData side_of(const std::string& set, std::int64_t element, std::int64_t side) const {
    if (element < 1 || element > elements_)
      refuse(path_, "side set '" + set + "' has element " + std::to_string(element) + ", but there are elements 1 to " +
                        std::to_string(elements_));
    const Topology& shape = topology(kind_of(element - 1));
    const int faces_before = dimension_ == 2 ? 2 : 0;
    if (side < 1 || side > shape.sides - faces_before)
      refuse(path_, "side set '" + set + "' has side " + std::to_string(side) + " of element " +
                        std::to_string(element) + ", but a " + std::string(shape.name) + " has sides 1 to " +
                        std::to_string(shape.sides - faces_before));
    return {element - 1, static_cast<int>(side) - 1 + faces_before};
  }

  ElementKind kind_of(std::int64_t element) const {
    // The last block that begins at or before the element; empty blocks begin where the next one does.
    const auto next = std::upper_bound(first_elements_.begin(), first_elements_.end(), element);
    return mesh_.blocks[static_cast<std::size_t>(next - first_elements_.begin()) - 1].kind;
  }

  NetcdfFile file_;
  std::string path_;
  MeshData mesh_;
  int dimension_ = 3;
  std::int64_t nodes_ = 0, elements_ = 0, read_elements_ = 0;
  std::vector<std::int64_t> first_elements_;  ///< of each block
};

MeshData read_within_memory(const std::string& path) {
  return mesh_file::within_memory(path, [&] { return ExodusReader(path).read(); });
}

}  // namespace

MeshData read_exodus(const std::string& path) {
  // The HDF5 library can crash on corrupt files. A classic file is validated to the last count before it is read.
  if (mesh_file::is_hdf5(mesh_file::start_of(path, 8)))
    mesh_file::trial_run(path, mesh_file::size_of(path), [&] { read_within_memory(path); });
  return read_within_memory(path);
}

}  // namespace tenon
