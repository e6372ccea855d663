// SPDX-License-Identifier: BSD-3-Clause
// Colours of values: perceptually uniform maps, and names and units fit to be read.
#pragma once

#include <string>

#include <vtkLookupTable.h>
#include <vtkSmartPointer.h>

namespace tenon {

/// Values from `low` (dark) to `high` (bright); no hue carries a meaning of its own, and equal steps of value look
/// equal. Temperatures are shown from dark to glowing, all else from blue to yellow.
vtkSmartPointer<vtkLookupTable> make_color_map(const std::string& field, double low, double high);

/// A unit in which numbers up to `greatest` are short: Pa -> MPa, s -> us.
struct ShownUnit {
  std::string name;  ///< "MPa"; empty if there is none
  double scale = 1;  ///< shown value = value x scale
};
ShownUnit shown_unit(const std::string& unit, double greatest);

/// "eqps [1]", "temperature [K]".
std::string title_of(const std::string& quantity, const std::string& unit);

}  // namespace tenon
