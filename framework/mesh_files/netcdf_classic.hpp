// SPDX-License-Identifier: BSD-3-Clause
// Validates the header of a netCDF classic file before the library sees it. Private to the room.
#pragma once

#include <string>

namespace tenon::mesh_file {

/// Reads the header of a CDF-1, CDF-2 (64-bit offset) or CDF-5 file, and refuses it if a count, name, type or dimension
/// in it cannot be, or if values lie beyond the end of the file: the library would silently deliver zeros for them.
/// Format: netCDF Users Guide, appendix "File Format Specifications".
void validate_classic(const std::string& path);

}  // namespace tenon::mesh_file
