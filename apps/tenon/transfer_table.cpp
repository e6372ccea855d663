// SPDX-License-Identifier: BSD-3-Clause
#include "apps/tenon/transfer_table.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tenon {

namespace {

using Row = std::vector<std::string>;

/// Columns as wide as their widest word, two blanks apart; the first five to the left.
std::string aligned(const std::vector<Row>& rows) {
  std::vector<std::size_t> width(rows[0].size(), 0);
  for (const Row& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c) width[c] = std::max(width[c], row[c].size());
  std::string text;
  for (const Row& row : rows) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c)
      line += c < 5 ? fmt::format("{:<{}}  ", row[c], width[c]) : fmt::format("{:>{}}  ", row[c], width[c]);
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

/// Nothing for numbers without a unit.
std::string plain_unit(const FieldDescription& field) {
  return field.unit == "1" ? "" : field.unit;
}

/// Unit of the integral; a total is summed up as it is.
std::string integral_unit(const FieldDescription& field, bool solid) {
  const std::string unit = plain_unit(field);
  if (field.kind == FieldKind::total) return unit;
  return unit + (unit.empty() ? "" : " ") + (solid ? "m^3" : "m^2");
}

std::string shown_name(const FieldDescription& field) {
  return field.components == 1 ? field.name : fmt::format("{} ({})", field.name, field.components);
}

}  // namespace

std::string transfer_table(std::span<const TransferredField> fields, bool solid) {
  std::vector<Row> rows{{"field", "from", "to", "kind", "method", "source integral", "target integral", "mismatch",
                         "outside", "farthest", "estimated error"}};
  for (const TransferredField& f : fields) {
    const transfer::TransferReport& r = f.report;
    const std::string unit = integral_unit(f.description, solid);
    // Methods that keep integrals have no interpolation error to estimate.
    const std::string error =
        r.error_estimate > 0 ? fmt::format("{:.3g} {}", r.error_estimate, plain_unit(f.description)) : std::string("-");
    rows.push_back({shown_name(f.description), fmt::format("{}s", to_string(f.description.location)),
                    fmt::format("{}s", to_string(f.to)), std::string(to_string(f.description.kind)), f.method,
                    fmt::format("{:.9g} {}", r.source_integral, unit),
                    fmt::format("{:.9g} {}", r.target_integral, unit), fmt::format("{:.1e}", r.mismatch),
                    fmt::format("{} of {}", r.outside, r.targets),
                    r.outside > 0 ? fmt::format("{:.3g} m", r.greatest_distance) : std::string("-"), error});
  }
  return aligned(rows);
}

std::string transfer_details(std::span<const TransferredField> fields) {
  std::string text;
  for (const TransferredField& f : fields) {
    const transfer::TransferReport& r = f.report;
    text += fmt::format("{}: {} points sought, {} outside the {}", f.description.name, r.targets, r.outside,
                        f.method == "conserve" ? "target" : "source");
    if (r.outside > 0)
      text += fmt::format(", the farthest {:.9g} m away at ({:.9g}, {:.9g}, {:.9g}) m", r.greatest_distance,
                          r.farthest[0], r.farthest[1], r.farthest[2]);
    if (r.skipped > 0) text += fmt::format("; {} elements without volume left out", r.skipped);
    text += fmt::format("\n  integrals {}: {:.17g} before, {:.17g} after\n",
                        f.description.components > 1 ? "of the first component" : "of the field", r.source_integral,
                        r.target_integral);
    if (f.round_trip)
      text +=
          fmt::format("  there and back: greatest difference {:.3g} {}\n", *f.round_trip, plain_unit(f.description));
    if (f.method == "project")
      text += fmt::format("  of the integral of the magnitude {:.1e} was spread; {} values clipped, {:.1e} unplaced\n",
                          r.spread, r.clipped, r.unplaced);
  }
  return text;
}

}  // namespace tenon
