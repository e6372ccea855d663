// SPDX-License-Identifier: BSD-3-Clause
#include "framework/fields/field.hpp"

namespace tenon {

std::string_view to_string(Location location) {
  switch (location) {
    case Location::node:
      return "node";
    case Location::element:
      return "element";
    case Location::particle:
      return "particle";
    case Location::face:
      return "face";
  }
  return "";
}

std::string_view to_string(FieldKind kind) {
  switch (kind) {
    case FieldKind::point_value:
      return "point value";
    case FieldKind::density:
      return "density";
    case FieldKind::total:
      return "total";
    case FieldKind::flux:
      return "flux";
  }
  return "";
}

}  // namespace tenon
