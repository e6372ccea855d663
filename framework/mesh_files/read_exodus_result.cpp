// SPDX-License-Identifier: BSD-3-Clause
// Nodal and element variables of Exodus II files, in one state. Names of dimensions and variables: [SY94].
#include <algorithm>
#include <array>
#include <cctype>
#include <limits>

#include "framework/mesh_files/netcdf_file.hpp"
#include "framework/mesh_files/read_support.hpp"
#include "framework/mesh_files/readers.hpp"
#include "framework/mesh_files/trial_run.hpp"

namespace tenon {
namespace {

using mesh_file::NetcdfFile;

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// Endings of the components of a vector and of a symmetric tensor, in our order.
const std::vector<std::vector<std::string>>& endings() {
  static const std::vector<std::vector<std::string>> all{
      {"xx", "yy", "zz", "xy", "yz", "zx"}, {"xx", "yy", "zz", "xy", "yz", "xz"}, {"x", "y", "z"}};
  return all;
}

/// Variables that make a field: one, or the components of a vector or tensor.
struct Group {
  std::string name;
  std::vector<std::size_t> variables;
};

std::size_t find(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

/// The field whose first component is variable `first`; of that variable alone if others are missing.
Group group_of(const std::vector<std::string>& names, const std::vector<std::string>& lowered, std::size_t first) {
  for (const std::vector<std::string>& ending : endings()) {
    if (!lowered[first].ends_with(ending[0]) || lowered[first].size() == ending[0].size()) continue;
    const std::size_t stem = lowered[first].size() - ending[0].size();
    Group group{names[first].substr(0, stem), {}};
    for (const std::string& part : ending)
      if (const std::size_t found = find(lowered, lowered[first].substr(0, stem) + part); found < names.size())
        group.variables.push_back(found);
    if (group.variables.size() != ending.size()) continue;
    while (group.name.size() > 1 && group.name.back() == '_') group.name.pop_back();
    return group;
  }
  return {names[first], {first}};
}

/// Vectors and tensors first, so that no component passes for a field of its own; in the order of the file.
std::vector<Group> groups_of(const std::vector<std::string>& names) {
  std::vector<std::string> lowered;
  for (const std::string& name : names) lowered.push_back(lower(name));
  std::vector<Group> all;
  std::vector<bool> taken(names.size(), false);
  for (const bool several : {true, false})
    for (std::size_t v = 0; v < names.size(); ++v) {
      const Group group = several ? group_of(names, lowered, v) : Group{names[v], {v}};
      const auto is_taken = [&](std::size_t i) { return taken[i]; };
      if ((group.variables.size() > 1) != several) continue;
      if (std::any_of(group.variables.begin(), group.variables.end(), is_taken)) continue;
      for (const std::size_t i : group.variables) taken[i] = true;
      all.push_back(group);
    }
  std::sort(all.begin(), all.end(), [](const Group& a, const Group& b) { return a.variables < b.variables; });
  return all;
}

class ResultReader {
 public:
  ResultReader(const std::string& path, const StateChoice& choice) : path_(path), choice_(choice) {
    result_.mesh = read_exodus(path);
  }

  ResultData read() {
    const NetcdfFile file(path_);
    const std::int64_t states = file.dimension("time_step").value_or(0);
    if (states == 0 || !file.has("time_whole")) return std::move(result_);
    const std::vector<double> times = file.reals("time_whole", states);
    state_ = static_cast<std::int64_t>(chosen_state(times, choice_));
    result_.time = times[static_cast<std::size_t>(state_)];
    read_nodal(file);
    read_elements(file);
    return std::move(result_);
  }

 private:
  static std::vector<std::string> names(const NetcdfFile& file, const std::string& count, const std::string& variable) {
    const std::int64_t number = file.dimension(count).value_or(0);
    return number == 0 ? std::vector<std::string>() : file.texts(variable, number);
  }

  /// Nodes of the file that some element uses; the reader of the mesh leaves the others out.
  static std::vector<bool> used_nodes(const NetcdfFile& file, std::int64_t nodes) {
    std::vector<bool> used(static_cast<std::size_t>(nodes), false);
    const std::int64_t blocks = file.dimension("num_el_blk").value_or(0);
    for (std::int64_t b = 1; b <= blocks; ++b) {
      const std::string number = std::to_string(b);
      const std::int64_t size = file.dimension("num_el_in_blk" + number).value_or(0);
      if (size == 0) continue;
      const std::int64_t width = file.dimension("num_nod_per_el" + number).value_or(0);
      for (const std::int64_t n : file.integers("connect" + number, size * width))
        used[static_cast<std::size_t>(n - 1)] = true;  // 1 .. nodes: the mesh has been read
    }
    return used;
  }

  void add(const std::string& name, Location location, std::vector<double>&& values, std::size_t components) {
    FieldData field;
    field.description.name = name;
    field.description.location = location;
    field.description.components = static_cast<int>(components);
    field.values = std::move(values);
    result_.fields.push_back(std::move(field));
  }

  void read_nodal(const NetcdfFile& file) {
    const std::int64_t nodes = file.dimension("num_nodes").value_or(0);
    const std::vector<bool> used = used_nodes(file, nodes);
    for (const Group& group : groups_of(names(file, "num_nod_var", "name_nod_var"))) {
      const std::size_t width = group.variables.size();
      std::vector<double> values(result_.mesh.coordinates.size() * width);
      for (std::size_t c = 0; c < width; ++c) {
        const std::vector<double> all =
            file.reals_of_row("vals_nod_var" + std::to_string(group.variables[c] + 1), state_, nodes);
        std::size_t at = 0;
        for (std::size_t n = 0; n < all.size(); ++n)
          if (used[n]) values[at++ * width + c] = all[n];
      }
      add(group.name, Location::node, std::move(values), width);
    }
  }

  void read_elements(const NetcdfFile& file) {
    // The numbers in the file of the blocks that the mesh has elements of, in the same order.
    std::vector<std::string> numbers;
    for (std::int64_t b = 1; b <= file.dimension("num_el_blk").value_or(0); ++b)
      if (file.dimension("num_el_in_blk" + std::to_string(b)).value_or(0) > 0) numbers.push_back(std::to_string(b));
    for (const Group& group : groups_of(names(file, "num_elem_var", "name_elem_var"))) {
      const std::size_t width = group.variables.size();
      std::vector<double> values(result_.mesh.elements() * width, 0.0);
      std::string missing;
      std::size_t first = 0, number = 0;
      for (const BlockData& block : result_.mesh.blocks) {
        if (block.size() == 0) continue;
        const std::string& in_file = numbers.at(number++);
        bool there = true;
        for (std::size_t c = 0; c < width; ++c) {
          const std::string variable = "vals_elem_var" + std::to_string(group.variables[c] + 1) + "eb" + in_file;
          there = there && file.has(variable);
          if (!there) continue;
          const std::vector<double> all = file.reals_of_row(variable, state_, static_cast<std::int64_t>(block.size()));
          for (std::size_t e = 0; e < all.size(); ++e) values[(first + e) * width + c] = all[e];
        }
        if (!there) missing += (missing.empty() ? "block '" : ", block '") + block.name + "'";
        first += block.size();
      }
      add(group.name, Location::element, std::move(values), width);
      result_.fields.back().missing = missing;
    }
  }

  std::string path_;
  StateChoice choice_;
  ResultData result_;
  std::int64_t state_ = 0;
};

}  // namespace

ResultData read_exodus_result(const std::string& path, const StateChoice& choice) {
  // The HDF5 library can crash on corrupt files.
  if (mesh_file::is_hdf5(mesh_file::start_of(path, 8)))
    mesh_file::trial_run(path, mesh_file::size_of(path), [&] { ResultReader(path, choice).read(); });
  return ResultReader(path, choice).read();
}

}  // namespace tenon
