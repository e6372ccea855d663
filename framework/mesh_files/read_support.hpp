// SPDX-License-Identifier: BSD-3-Clause
// What the mesh readers share: refusals, access to the file, and the last clean-up of a mesh. Private to the room.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "framework/mesh/mesh_data.hpp"

namespace tenon::mesh_file {

/// Throws Error(file) with "path: what".
[[noreturn]] void refuse(const std::string& path, const std::string& what);

/// Size in bytes. Refuses what is missing, a directory, unreadable or empty, saying what was expected.
std::uint64_t size_of(const std::string& path);
/// The first `count` bytes, or fewer if the file is shorter. Refuses as size_of does.
std::string start_of(const std::string& path, std::size_t count);
std::string contents_of(const std::string& path);

/// Text of a file that may be shown and stored: control characters and what is not UTF-8 become '_'.
std::string printable(std::string_view text);

/// Runs `read`; running out of memory, which only a corrupt file or a small computer does, becomes a refusal.
MeshData within_memory(const std::string& path, const std::function<MeshData()>& read);

/// Puts the nodes of elements into our order; node i of an element stands at order[i] in the file, an empty order is
/// ours.
void from_file_order(std::span<std::int64_t> connectivity, std::span<const std::int8_t> order);

/// Last step of every reader: refuses coordinates that are not finite and meshes without elements, drops nodes that no
/// element uses, gives distinct names and ids, and sorts the sets. Indices must have been checked before.
void finish(MeshData& mesh);

}  // namespace tenon::mesh_file
