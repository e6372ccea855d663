// SPDX-License-Identifier: BSD-3-Clause
// What `tenon transfer` says of the fields that it has carried over.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "transfer/grid_transfer.hpp"

namespace tenon {

struct TransferredField {
  FieldDescription description;  ///< at the source
  Location to = Location::node;
  std::string method;
  transfer::TransferReport report;
  std::optional<double> round_trip = {};  ///< greatest difference after the way there and back, unit of the field
};

/// A line for each field: integrals before and after, misses, errors. `solid`: integrals are over volumes, not areas.
std::string transfer_table(std::span<const TransferredField> fields, bool solid);
/// Further lines, for --report.
std::string transfer_details(std::span<const TransferredField> fields);

}  // namespace tenon
