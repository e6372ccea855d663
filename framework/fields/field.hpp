// SPDX-License-Identifier: BSD-3-Clause
// What a field is: its place, its kind, its unit. The kind decides how it may be transferred.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tenon {

enum class Location : std::uint8_t { node, element, particle, face };

/// point_value: a value at a place, interpolated (temperature, displacement). density: an amount per volume, whose
/// integral is kept. total: an amount that belongs to a node or element, whose sum is kept (heat, force). flux: an
/// amount per area.
enum class FieldKind : std::uint8_t { point_value, density, total, flux };

std::string_view to_string(Location location);
std::string_view to_string(FieldKind kind);

/// A field by its name, under the field's standard term, in SI units.
struct FieldDescription {
  std::string name;
  Location location = Location::node;
  FieldKind kind = FieldKind::point_value;
  int components = 1;  ///< 1 scalar, 3 vector, 6 symmetric tensor (xx yy zz xy yz zx)
  std::string unit;    ///< SI, as UDUNITS writes it: "m", "K", "J"; "1" for none
};

}  // namespace tenon
