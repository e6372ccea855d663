// SPDX-License-Identifier: BSD-3-Clause
#include "framework/io/body_section.hpp"

#include <algorithm>
#include <limits>

#include <vtkAppendPolyData.h>
#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkCellData.h>
#include <vtkClipPolyData.h>
#include <vtkCutter.h>
#include <vtkNew.h>
#include <vtkPlane.h>
#include <vtkPointData.h>

namespace tenon {

namespace {

vtkSmartPointer<vtkPlane> make_plane(const Cut& cut) {
  auto plane = vtkSmartPointer<vtkPlane>::New();
  plane->SetOrigin(cut.point.data());
  plane->SetNormal(cut.normal.data());
  return plane;
}

bool flat(const Box& box) {
  const Vec3 size = box.high - box.low;
  return size[2] <= 1e-9 * std::max(size[0], size[1]);
}

struct Extrema {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

/// Extrema of a field; with an eye, only over the faces that it sees.
Extrema extrema(vtkPolyData& surface, const std::string& field, const Vec3* eye) {
  vtkDataArray* const at_points = surface.GetPointData()->GetArray(field.c_str());
  vtkDataArray* const at_cells = surface.GetCellData()->GetArray(field.c_str());
  Extrema found;
  const auto cells = vtk::TakeSmartPointer(surface.GetPolys()->NewIterator());
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell()) {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    cells->GetCurrentCell(count, ids);
    if (eye != nullptr && count > 2) {
      Vec3 p[3];
      for (int i = 0; i < 3; ++i) surface.GetPoint(ids[i], p[i].data());
      const Vec3 normal = cross(p[1] - p[0], p[2] - p[0]);
      if (dot(normal, *eye) <= 0.15 * norm(normal)) continue;
    }
    if (at_cells != nullptr) found.add(at_cells->GetTuple1(cells->GetCurrentCellId()));
    for (vtkIdType i = 0; at_points != nullptr && i < count; ++i) found.add(at_points->GetTuple1(ids[i]));
  }
  return found;
}

}  // namespace

Vec3 eye_direction(const Box& box) {
  const Vec3 eye = flat(box) ? Vec3{0, 0, 1} : Vec3{0.62, -1, 0.42};
  return (1 / norm(eye)) * eye;
}

Cut middle_cut(const Box& box) {
  Cut cut{0.5 * (box.low + box.high), {0, -1, 0}};
  // Meshes like to have nodes in the middle, where a cut is ill-defined.
  cut.point[1] += 3.7e-3 * (box.high[1] - box.low[1]);
  return cut;
}

vtkSmartPointer<vtkPolyData> section(vtkUnstructuredGrid* body, const Cut& cut) {
  const vtkNew<vtkCutter> cutter;
  cutter->SetInputData(body);
  cutter->SetCutFunction(make_plane(cut));
  cutter->GenerateTrianglesOff();
  cutter->Update();
  return cutter->GetOutput();
}

vtkSmartPointer<vtkPolyData> cut_open(vtkPolyData* outside, vtkPolyData* section, const Cut& cut) {
  const vtkNew<vtkClipPolyData> far_side;
  far_side->SetInputData(outside);
  far_side->SetClipFunction(make_plane(cut));
  far_side->InsideOutOn();
  const vtkNew<vtkAppendPolyData> both;
  both->AddInputConnection(far_side->GetOutputPort());
  both->AddInputData(section);
  both->Update();
  return both->GetOutput();
}

bool outside_hides(vtkPolyData& outside, vtkPolyData& section, const std::string& field, const Vec3& eye) {
  if (section.GetNumberOfPolys() == 0) return false;
  const Extrema seen = extrema(outside, field, &eye), inside = extrema(section, field, nullptr);
  const double low = std::min(seen.low, inside.low);
  return inside.high > low && seen.high < low + 0.8 * (inside.high - low);
}

}  // namespace tenon
