// SPDX-License-Identifier: BSD-3-Clause
// The order of nodes and the shape functions of hex20 and tet10 are those of VTK's cells, so files show what was meant.
#include <gtest/gtest.h>

#include <vtkCell.h>
#include <vtkGenericCell.h>
#include <vtkNew.h>
#include <vtkPoints.h>

#include "framework/mesh/shape_functions.hpp"

namespace tenon {
namespace {

TEST(SecondOrderCells, AreThoseOfVtk) {
  for (const ElementKind kind : {ElementKind::hex20, ElementKind::tet10}) {
    const bool hex = kind == ElementKind::hex20;
    const vtkNew<vtkGenericCell> cell;
    cell->SetCellType(topology(kind).vtk_type);
    ASSERT_EQ(cell->GetNumberOfPoints(), topology(kind).nodes);
    // VTK's parametric coordinates go from 0 to 1.
    const auto ours = [&](const double* p) {
      return hex ? Vec3{2 * p[0] - 1, 2 * p[1] - 1, 2 * p[2] - 1} : Vec3{p[0], p[1], p[2]};
    };
    const double* place = cell->GetParametricCoords();
    for (std::size_t a = 0; a < local_nodes(kind).size(); ++a)
      EXPECT_EQ(ours(place + 3 * a), local_nodes(kind)[a]) << topology(kind).name << " node " << a;
    std::array<double, max_element_nodes> theirs{}, values{};
    for (const Vec3& p : {Vec3{0.2, 0.3, 0.1}, Vec3{0.05, 0.6, 0.3}, Vec3{0.25, 0.25, 0.25}}) {
      cell->InterpolateFunctions(p.data(), theirs.data());
      shape_values(kind, ours(p.data()), values);
      for (std::size_t a = 0; a < local_nodes(kind).size(); ++a) EXPECT_NEAR(theirs[a], values[a], 1e-14);
    }
  }
}

}  // namespace
}  // namespace tenon
