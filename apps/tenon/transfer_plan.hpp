// SPDX-License-Identifier: BSD-3-Clause
// The command line of `tenon transfer`, checked: which fields go how.
#pragma once

#include <string>
#include <vector>

#include "framework/fields/result_data.hpp"
#include "transfer/grid_transfer.hpp"

namespace tenon {

struct TransferArguments {
  std::string source, target;
  std::string output;                ///< .vtu or .pvtu; empty: TARGET's name with .fields.vtu, in this folder
  std::vector<std::string> fields;   ///< NAME or NAME:METHOD; empty: all of the source
  std::vector<std::string> kinds;    ///< NAME:KIND
  std::string method = "automatic";  ///< of fields that name none
  std::string outside = "nearest";   ///< nearest, extrapolate, value=X, error
  std::string greatest_distance;     ///< "2 mm"; empty: any
  std::string time = "last";         ///< of the source's state
  std::string part;                  ///< of a .pvd with several
  std::string at;                    ///< nodes or elements of the target; empty: as the source has them
  std::string source_unit = "m", target_unit = "m";  ///< of coordinates
  std::vector<std::string> blocks;                   ///< of the source, that points are sought in; empty: all
  std::string sides;                                 ///< of the source, for nearest_projection
  bool bounded = false;                              ///< of project
  int neighbours = 20;                               ///< of moving_least_squares
  bool status = false;                               ///< write what became of each point, too
  bool report = false;                               ///< say more
};

/// Options that do not depend on what the source has.
struct TransferSettings {
  transfer::TransferOptions options;
  StateChoice state;
  double source_unit = 1, target_unit = 1;  ///< m
  std::string output;
};
/// Throws Error(usage).
TransferSettings transfer_settings(const TransferArguments& arguments);

/// A field on its way; fields with the same way share a map.
struct PlannedField {
  std::size_t stored = 0;        ///< which of the source's fields
  FieldDescription description;  ///< at the source, with its kind
  Location to = Location::node;
  transfer::Method method = transfer::Method::automatic;
  bool shares_map(const PlannedField& other) const;
};

/// Which of the source's `fields` go how. Throws Error(usage) with the nearest valid name.
std::vector<PlannedField> plan_fields(const TransferArguments& arguments, const std::vector<FieldData>& fields);

std::string method_name(transfer::Method method);
/// All of them, for the help.
std::string method_names();

}  // namespace tenon
