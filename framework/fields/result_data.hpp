// SPDX-License-Identifier: BSD-3-Clause
// A result as a file holds it: a whole mesh with the fields of one state. Lives on rank 0 until it is distributed.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "framework/fields/field.hpp"
#include "framework/mesh/mesh_data.hpp"

namespace tenon {

/// Values in the order of MeshData's nodes, or of the elements of its blocks one after the other. The kind is not in
/// files: it is left a point value.
struct FieldData {
  FieldDescription description;
  std::vector<double> values;
  std::string missing;  ///< "block 'a'": elements without values (which are 0 here); empty: none
};

struct ResultData {
  MeshData mesh;  ///< as the file places it
  std::vector<FieldData> fields;
  std::optional<double> time;  ///< of the state, s
};

/// Which state of several is read: the one whose time is nearest, or the last.
struct StateChoice {
  std::optional<double> time;  ///< s
};

/// The state of these times, of which there is one at least.
std::size_t chosen_state(std::span<const double> times, const StateChoice& choice);

}  // namespace tenon
