// SPDX-License-Identifier: BSD-3-Clause
// Cutting a body open where its outside hides what matters.
#pragma once

#include <string>

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include "framework/base/box.hpp"

namespace tenon {

/// From the body to the eye, of length 1: from the front, right and somewhat above; straight down on what is flat in z.
Vec3 eye_direction(const Box& box);

/// A plane through the middle of the body whose near side is taken away.
struct Cut {
  Vec3 point{}, normal{};  ///< the normal points to the eye
};
Cut middle_cut(const Box& box);

/// The polygons in which a plane meets the elements; empty for a body without volume.
vtkSmartPointer<vtkPolyData> section(vtkUnstructuredGrid* body, const Cut& cut);
/// The outside beyond the plane, closed by the section.
vtkSmartPointer<vtkPolyData> cut_open(vtkPolyData* outside, vtkPolyData* section, const Cut& cut);

/// Whether the faces that the eye sees lack the upper fifth of the values that the section shows.
bool outside_hides(vtkPolyData& outside, vtkPolyData& section, const std::string& field, const Vec3& eye);

}  // namespace tenon
