// SPDX-License-Identifier: BSD-3-Clause
// What the mesh readers share: refusals, access to the file, and the last clean-up of a mesh.
#include "framework/mesh_files/read_support.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <new>
#include <set>
#include <stdexcept>

#include "framework/base/error.hpp"

namespace tenon::mesh_file {

void refuse(const std::string& path, const std::string& what) {
  throw Error(ExitCode::file, path + ": " + what);
}

std::uint64_t size_of(const std::string& path) {
  namespace fs = std::filesystem;
  const std::string expected = "expected a mesh file (Exodus II or Gmsh)";
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) refuse(path, "there is no such file; " + expected);
  if (error) refuse(path, "cannot be examined (" + error.message() + "); " + expected);
  if (status.type() == fs::file_type::directory) refuse(path, "is a directory; " + expected);
  if (status.type() != fs::file_type::regular) refuse(path, "is not a regular file; " + expected);
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) refuse(path, "cannot be examined (" + error.message() + "); " + expected);
  if (size == 0) refuse(path, "is empty; " + expected);
  return size;
}

std::string start_of(const std::string& path, std::size_t count) {
  const std::uint64_t size = size_of(path);
  std::ifstream in(path, std::ios::binary);
  if (!in) refuse(path, std::string("cannot be opened (") + std::strerror(errno) + ")");
  std::string bytes(static_cast<std::size_t>(std::min<std::uint64_t>(count, size)), '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (in.gcount() != static_cast<std::streamsize>(bytes.size())) refuse(path, "cannot be read to its end");
  return bytes;
}

std::string contents_of(const std::string& path) {
  return start_of(path, static_cast<std::size_t>(size_of(path)));
}

std::string printable(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const auto c = static_cast<unsigned char>(text[i]);
    // Length of the sequence that this byte begins; 0xc0, 0xc1 and 0xf5 up never occur in UTF-8.
    const std::size_t length = c >= 0x20 && c < 0x7f   ? 1
                               : c >= 0xc2 && c < 0xe0 ? 2
                               : c >= 0xe0 && c < 0xf0 ? 3
                               : c >= 0xf0 && c < 0xf5 ? 4
                                                       : 0;
    bool valid = length > 0 && length <= text.size() - i;
    for (std::size_t k = 1; valid && k < length; ++k) valid = (static_cast<unsigned char>(text[i + k]) & 0xc0) == 0x80;
    if (valid && length > 2) {
      // Overlong forms, surrogates and numbers beyond U+10FFFF.
      const auto next = static_cast<unsigned char>(text[i + 1]);
      valid = !(c == 0xe0 && next < 0xa0) && !(c == 0xed && next >= 0xa0) && !(c == 0xf0 && next < 0x90) &&
              !(c == 0xf4 && next >= 0x90);
    }
    out += valid ? text.substr(i, length) : "_";
    i += valid ? length : 1;
  }
  return out;
}

MeshData within_memory(const std::string& path, const std::function<MeshData()>& read) {
  try {
    return read();
  } catch (const std::bad_alloc&) {
    refuse(path, "needs more memory than there is; corrupt?");
  } catch (const std::length_error&) {
    refuse(path, "needs more memory than there is; corrupt?");
  }
}

namespace {

void check_coordinates(const MeshData& mesh) {
  for (std::size_t n = 0; n < mesh.coordinates.size(); ++n)
    for (const double x : mesh.coordinates[n])
      if (!std::isfinite(x))
        refuse(mesh.source, "node " + std::to_string(mesh.node_labels[n]) + " has a coordinate that is not finite");
}

void drop_unused_nodes(MeshData& mesh) {
  const std::size_t count = mesh.coordinates.size();
  std::vector<GlobalId> number(count, no_id);
  for (const BlockData& block : mesh.blocks)
    for (const GlobalId node : block.connectivity) number[static_cast<std::size_t>(node)] = 0;
  std::size_t kept = 0;
  for (std::size_t n = 0; n < count; ++n) {
    if (number[n] == no_id) continue;
    number[n] = static_cast<GlobalId>(kept);
    mesh.coordinates[kept] = mesh.coordinates[n];
    mesh.node_labels[kept] = mesh.node_labels[n];
    if (!mesh.volumes.empty()) mesh.volumes[kept] = mesh.volumes[n];
    ++kept;
  }
  if (kept == count) return;
  mesh.warnings.push_back(std::to_string(count - kept) + " nodes belong to no element and are left out");
  mesh.coordinates.resize(kept);
  mesh.node_labels.resize(kept);
  if (!mesh.volumes.empty()) mesh.volumes.resize(kept);
  const auto renumber = [&](GlobalId node) { return number[static_cast<std::size_t>(node)]; };
  for (BlockData& block : mesh.blocks)
    std::transform(block.connectivity.begin(), block.connectivity.end(), block.connectivity.begin(), renumber);
  for (NodeSetData& set : mesh.node_sets) {
    std::transform(set.nodes.begin(), set.nodes.end(), set.nodes.begin(), renumber);
    std::erase(set.nodes, no_id);
  }
}

template <class Item>
void sort_unique(std::vector<Item>& items) {
  std::sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

/// A name can be used once; the next one of that name gets its label, or a number, behind it.
template <class Entry>
void make_names_distinct(std::vector<Entry>& entries, const char* what, std::vector<std::string>& warnings) {
  std::set<std::string> taken;
  for (const Entry& entry : entries) taken.insert(entry.name);
  std::set<std::string> seen;
  for (Entry& entry : entries) {
    if (seen.insert(entry.name).second) continue;
    const std::string old = entry.name;
    std::string fresh = old + "_" + std::to_string(entry.label);
    for (int k = 2; taken.contains(fresh); ++k) fresh = old + "_" + std::to_string(k);
    entry.name = fresh;
    taken.insert(fresh);
    seen.insert(fresh);
    warnings.push_back("a second " + std::string(what) + " named '" + old + "' is called '" + fresh + "'");
  }
}

/// Ids are what an Exodus file tells its blocks and sets apart by: positive, each once. Gmsh counts the groups of every
/// dimension from one, so that curves and surfaces share them.
template <class Entry>
void make_labels_distinct(std::vector<Entry>& entries) {
  std::int64_t greatest = 0;
  for (const Entry& entry : entries) greatest = std::max(greatest, entry.label);
  if (greatest > std::numeric_limits<std::int64_t>::max() - static_cast<std::int64_t>(entries.size())) greatest = 0;
  std::set<std::int64_t> seen;
  for (Entry& entry : entries)
    while (entry.label < 1 || !seen.insert(entry.label).second) entry.label = ++greatest;
}

}  // namespace

void from_file_order(std::span<std::int64_t> connectivity, std::span<const std::int8_t> order) {
  if (order.empty()) return;
  std::array<std::int64_t, max_element_nodes> stored{};
  for (std::size_t first = 0; first < connectivity.size(); first += order.size()) {
    const auto element = connectivity.subspan(first, order.size());
    std::copy(element.begin(), element.end(), stored.begin());
    for (std::size_t i = 0; i < order.size(); ++i) element[i] = stored[static_cast<std::size_t>(order[i])];
  }
}

void finish(MeshData& mesh) {
  if (mesh.elements() == 0) refuse(mesh.source, "has no elements");
  drop_unused_nodes(mesh);
  check_coordinates(mesh);
  for (NodeSetData& set : mesh.node_sets) sort_unique(set.nodes);
  for (SideSetData& set : mesh.side_sets) sort_unique(set.sides);
  make_names_distinct(mesh.blocks, "block", mesh.warnings);
  make_names_distinct(mesh.node_sets, "node set", mesh.warnings);
  make_names_distinct(mesh.side_sets, "side set", mesh.warnings);
  make_labels_distinct(mesh.blocks);
  make_labels_distinct(mesh.node_sets);
  make_labels_distinct(mesh.side_sets);
}

}  // namespace tenon::mesh_file
