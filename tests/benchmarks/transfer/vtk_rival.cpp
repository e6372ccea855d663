// SPDX-License-Identifier: BSD-3-Clause
#include "vtk_rival.hpp"

#include <vtkCharArray.h>
#include <vtkDoubleArray.h>
#include <vtkGenericCell.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkProbeFilter.h>
#include <vtkStaticCellLocator.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cstdlib>

namespace tenon::bench {

namespace {

void set_points(vtkPoints& to, std::span<const Vec3> from) {
  to.SetDataTypeToDouble();
  to.SetNumberOfPoints(static_cast<vtkIdType>(from.size()));
  for (std::size_t i = 0; i < from.size(); ++i) to.SetPoint(static_cast<vtkIdType>(i), from[i].data());
}

void keep(vtkGenericCell& cell, const std::array<double, 8>& weights, VtkMap& map, std::size_t i) {
  for (int a = 0; a < cell.GetNumberOfPoints(); ++a) {
    map.nodes[i][static_cast<std::size_t>(a)] = static_cast<LocalIndex>(cell.GetPointId(a));
    map.weights[i][static_cast<std::size_t>(a)] = weights[static_cast<std::size_t>(a)];
  }
}

}  // namespace

struct VtkRival::Impl {
  vtkNew<vtkUnstructuredGrid> grid;
};

void VtkMap::apply(std::span<const double> source, std::span<double> target) const {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    double sum = 0;
    for (std::size_t a = 0; a < 8; ++a) sum += weights[i][a] * source[static_cast<std::size_t>(nodes[i][a])];
    target[i] = sum;
  }
}

VtkRival::VtkRival(const Mesh& mesh, std::span<const Vec3> coordinates) : impl_(std::make_unique<Impl>()) {
  setenv("VTK_SMP_BACKEND_IN_USE", "Sequential", 0);  // its header vtkSMPTools.h is not C++20
  vtkNew<vtkPoints> points;
  set_points(*points, coordinates);
  impl_->grid->SetPoints(points);
  impl_->grid->AllocateEstimate(mesh.elements(), 8);
  for (const ElementBlock& block : mesh.blocks)
    for (LocalIndex e = 0; e < block.size(); ++e) {
      std::array<vtkIdType, 8> ids{};
      const std::span<const LocalIndex> nodes = block.nodes(e);
      std::ranges::copy(nodes, ids.begin());
      impl_->grid->InsertNextCell(topology(block.kind).vtk_type, static_cast<vtkIdType>(nodes.size()), ids.data());
    }
}

VtkRival::~VtkRival() = default;

VtkMap VtkRival::locate(std::span<const Vec3> points) const {
  vtkNew<vtkStaticCellLocator> locator;
  locator->SetDataSet(impl_->grid);
  locator->BuildLocator();
  VtkMap map(points.size());
  vtkNew<vtkGenericCell> cell;
  std::array<double, 3> local{};
  std::array<double, 8> weights{};
  for (std::size_t i = 0; i < points.size(); ++i) {
    Vec3 x = points[i];
    if (locator->FindCell(x.data(), 0, cell, local.data(), weights.data()) < 0)
      ++map.lost;
    else
      keep(*cell, weights, map, i);
  }
  return map;
}

VtkMap VtkRival::project(std::span<const Vec3> points) const {
  vtkNew<vtkStaticCellLocator> locator;
  locator->SetDataSet(impl_->grid);
  locator->BuildLocator();
  VtkMap map(points.size());
  vtkNew<vtkGenericCell> cell;
  std::array<double, 3> nearest{}, local{};
  std::array<double, 8> weights{};
  vtkIdType id = 0;
  int part = 0;
  double distance = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    locator->FindClosestPoint(points[i].data(), nearest.data(), cell, id, part, distance);
    const std::array<double, 3> foot = nearest;
    cell->EvaluatePosition(foot.data(), nearest.data(), part, local.data(), distance, weights.data());
    keep(*cell, weights, map, i);
  }
  return map;
}

std::size_t VtkRival::probe(std::span<const Vec3> points, std::span<const double> source,
                            std::span<double> target) const {
  vtkNew<vtkDoubleArray> field;
  field->SetName("field");
  field->SetNumberOfTuples(static_cast<vtkIdType>(source.size()));
  std::ranges::copy(source, field->GetPointer(0));
  impl_->grid->GetPointData()->AddArray(field);
  vtkNew<vtkPoints> places;
  set_points(*places, points);
  vtkNew<vtkPolyData> input;
  input->SetPoints(places);
  vtkNew<vtkStaticCellLocator> prototype;
  vtkNew<vtkProbeFilter> filter;
  filter->SetCellLocatorPrototype(prototype);
  filter->SetInputData(input);
  filter->SetSourceData(impl_->grid);
  filter->Update();
  vtkPointData& data = *filter->GetOutput()->GetPointData();
  const auto& values = *vtkDoubleArray::SafeDownCast(data.GetArray("field"));
  auto& valid = *vtkCharArray::SafeDownCast(data.GetArray(filter->GetValidPointMaskArrayName()));
  std::size_t lost = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    target[i] = values.GetValue(static_cast<vtkIdType>(i));
    if (valid.GetValue(static_cast<vtkIdType>(i)) == 0) ++lost;
  }
  return lost;
}

}  // namespace tenon::bench
