// SPDX-License-Identifier: BSD-3-Clause
// Projections between meshes for the tests, and the errors of functions given by nodal or element values.
#pragma once

#include <string>
#include <vector>

#include "transfer/projection.hpp"
#include "transfer_testing.hpp"

namespace tenon::transfer::testing {

/// A pair with all that a Projection refers to.
class ProjectionPair {
 public:
  explicit ProjectionPair(const Pair& pair, const ProjectionOptions& options = {});
  ProjectionPair(const ProjectionPair&) = delete;
  ProjectionPair& operator=(const ProjectionPair&) = delete;

  std::vector<double> operator()(const std::vector<double>& values, int components = 1) const;
  Side source() const { return {*pair_.source, pair_.source->coordinates, pair_.from, source_nodes_, source_items_}; }
  Side target() const { return {*pair_.target, pair_.target->coordinates, pair_.to, target_nodes_, target_items_}; }
  const Projection& projection() const { return projection_; }
  const Sought& sought() const { return sought_; }

 private:
  Pair pair_;
  Items source_nodes_, source_items_, target_nodes_, target_items_;
  Sought sought_;
  Projection projection_;
};

/// The same mesh of elements of second order: hex8 as hex20, tet4 as tet10, with middle nodes halfway.
MeshData with_middle_nodes(MeshData mesh);

/// Collective. Integral of one component over the mesh.
double integral(const Mesh& mesh, Location location, const std::vector<double>& values, int components = 1,
                int component = 0);
/// Collective. Integral of |f| of the component.
double integral_of_magnitude(const Mesh& mesh, Location location, std::vector<double> values, int components = 1,
                             int component = 0);
/// Collective. Error of the finite-element function in the mean square, over that of f, with quadrature of 27 points.
double relative_l2_error(const Mesh& mesh, Location location, const std::vector<double>& values, const Function& f);

}  // namespace tenon::transfer::testing
