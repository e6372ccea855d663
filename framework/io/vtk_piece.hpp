// SPDX-License-Identifier: BSD-3-Clause
// One rank's share of a frame as .vtu, and the .pvtu that lists the shares.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "framework/io/vtk_output.hpp"

namespace tenon {

/// Elements of a part that this rank owns. Local.
std::int64_t owned_elements(const OutputPart& part);

/// Throws Error(file) if a field has the wrong size or place. Local.
void check_fields(const OutputPart& part);

/// Writes the elements that this rank owns, and their nodes, to `path` (aside, then renamed). Throws Error(file).
/// Local. Unit of each field as field data `unit_<field>`, names of blocks as `block_names`.
void write_piece(const std::string& path, const OutputPart& part);

/// Text of a .pvtu over these pieces (file names relative to it).
std::string format_pvtu(const OutputPart& part, std::span<const std::string> pieces);

}  // namespace tenon
