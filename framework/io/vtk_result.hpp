// SPDX-License-Identifier: BSD-3-Clause
// Results in ParaView's files: ours, or any unstructured grid of elements that Tenon knows.
#pragma once

#include <string>

#include "framework/fields/result_data.hpp"

namespace tenon {

/// Whether the name of a file ends as .pvd, .pvtu or .vtu.
bool is_vtk_result(const std::string& path);

/// Reads the mesh and all fields of one state, the pieces of all ranks joined. Nodes and elements stand in the order of
/// their global ids, so it does not matter how many ranks have written; elements of a file without are in its order.
/// Blocks are those of the cell field `block` (and of the field data `block_names`), parted by kind. Ghost cells are
/// left out. `part`: of a .pvd with several, say a run's all.pvd, that which is read. Throws Error(file); Error(usage)
/// for a part or a state that is not there.
ResultData read_vtk_result(const std::string& path, const StateChoice& choice, const std::string& part);

}  // namespace tenon
