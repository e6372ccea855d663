// SPDX-License-Identifier: BSD-3-Clause
// VTK's own way to sample a mesh at points: its static cell locator with the weights kept, and its probe filter.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "framework/mesh/mesh.hpp"

namespace tenon::bench {

/// What a program that wants VTK's locator without its filter would keep.
struct VtkMap {
  std::vector<std::array<LocalIndex, 8>> nodes;
  std::vector<std::array<double, 8>> weights;
  std::size_t lost = 0;  ///< points in no cell; their weights are 0
  VtkMap() = default;
  explicit VtkMap(std::size_t points) : nodes(points), weights(points) {}
  void apply(std::span<const double> source, std::span<double> target) const;
};

/// A mesh of hex8, tet4 and quad4 as VTK has it. One thread, one rank.
class VtkRival {
 public:
  VtkRival(const Mesh& mesh, std::span<const Vec3> coordinates);
  ~VtkRival();
  /// Builds a vtkStaticCellLocator and asks it for each point.
  VtkMap locate(std::span<const Vec3> points) const;
  /// The same on a surface: the nearest point of it to each.
  VtkMap project(std::span<const Vec3> points) const;
  /// vtkProbeFilter with a vtkStaticCellLocator as prototype, the whole of it as at each call. Returns how many were
  /// lost.
  std::size_t probe(std::span<const Vec3> points, std::span<const double> source, std::span<double> target) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tenon::bench
