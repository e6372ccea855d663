// SPDX-License-Identifier: BSD-3-Clause
// Meshes, points and fields of the transfer benchmarks. Every number comes from splitmix64, so any program can repeat
// them.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "framework/mesh/generators.hpp"
#include "framework/mesh/mesh.hpp"
#include "transfer/grid_transfer.hpp"

namespace tenon::bench {

/// Points that receive values: the nodes of a mesh, or points alone.
struct Targets {
  std::string name;
  std::vector<Vec3> points;       ///< of all local nodes, m
  std::vector<LocalIndex> owned;  ///< by this rank, of these
  GlobalId count = 0;             ///< over all ranks
  std::shared_ptr<const Mesh> mesh;
  std::shared_ptr<const transfer::PointCloud> cloud;  ///< instead

  transfer::Grid grid() const { return {mesh.get(), points, mesh ? Location::node : Location::particle, cloud.get()}; }
  const Communicator& comm() const { return mesh ? mesh->comm : cloud->comm; }
  /// Collective. Of the rank that owns most.
  double greatest_share() const { return static_cast<double>(comm().max(static_cast<std::int64_t>(owned.size()))); }
};

/// How the elements of a cube are spread over the ranks: in slabs of equal thickness along x or y.
enum class Slabs { x, y };

struct CubeShape {
  double grading = 1;                    ///< ratio of the last to the first interval along each axis
  ElementKind kind = ElementKind::hex8;  ///< hex8, tet4 (six in each cell) or hex20 with straight edges
  Slabs slabs = Slabs::x;
};
/// Collective. Unit cube of n^3 cells, interior nodes moved at random by up to 0.2 h in each direction.
std::shared_ptr<const Mesh> cube(int n, std::uint64_t seed, const CubeShape& shape = {});
/// Collective. The outside of a ball of radius 1, quadrilaterals, n of them along each edge of the cube inside.
std::shared_ptr<const Mesh> sphere_surface(int n);
Targets nodes_of(std::string name, std::shared_ptr<const Mesh> mesh);
/// Collective. Component c of point q is u(seed, q, c); in slabs along y.
Targets random_points(GlobalId count, std::uint64_t seed);

/// Collective. The map of point values.
std::unique_ptr<transfer::GridTransfer> interpolation(const Mesh& source, std::span<const Vec3> coordinates,
                                                      const Targets& targets,
                                                      const transfer::TransferOptions& options = {});

/// sin(2 pi x) cos(3 pi y) e^z, and 1 + 2 x - 3 y + z / 2.
double smooth_field(const Vec3& x);
double linear_field(const Vec3& x);
using Function = double (*)(const Vec3&);
std::vector<double> sampled(std::span<const Vec3> points, Function f);

/// Of values at owned nodes.
struct Errors {
  double greatest = 0, rms = 0;
};
/// Collective.
Errors errors_of(const Targets& targets, std::span<const double> values, Function f);

}  // namespace tenon::bench
