// SPDX-License-Identifier: BSD-3-Clause
// Meshes of simple shapes, with graded spacing. Every one has node sets and side sets on its faces.
#pragma once

#include <array>
#include <string>

#include "framework/mesh/mesh_data.hpp"

namespace tenon {

/// Grading g: ratio of the last to the first interval along an axis (geometric); 1 = uniform.
struct BoxShape {
  Vec3 low{0, 0, 0}, high{1, 1, 1};     ///< m
  std::array<int, 3> elements{1, 1, 1};
  Vec3 grading{1, 1, 1};
  bool tetrahedra = false;              ///< six tet4 per cell, conforming
  double distortion = 0;                ///< random shift of interior nodes, fraction of the cell, keyed by node id
  std::uint64_t seed = 1;
};
/// Block "box"; sets "x_min" ... "z_max" (nodes and sides).
MeshData generate(const BoxShape& shape);

/// Solid cylinder about z from z = 0 to `length`: a butterfly of five hex blocks. `fraction` 1 = full, 0.25 = quarter
/// (x, y >= 0, sets "x_min" and "y_min" on the cut faces).
struct CylinderShape {
  double radius = 1, length = 1;        ///< m
  int core = 4;                         ///< elements across the core square (full), half of it in a quarter
  int shell = 4;                        ///< elements from core to surface
  int axial = 8;
  double axial_grading = 1;
  double fraction = 1;
  bool tetrahedra = false;
};
/// Block "cylinder"; sets "bottom" (z = 0), "top", "outer".
MeshData generate(const CylinderShape& shape);

/// Solid ball about the origin: a cube and six hex blocks around it. Block "sphere"; set "outer".
struct SphereShape {
  double radius = 1;  ///< m
  int core = 4, shell = 4;
  bool tetrahedra = false;
};
MeshData generate(const SphereShape& shape);

/// Hollow cylinder about z, full circle. Block "annulus"; sets "inner", "outer", "bottom", "top".
struct AnnulusShape {
  double inner_radius = 0.5, outer_radius = 1, length = 1;  ///< m
  int radial = 4, circumferential = 32, axial = 8;
  double radial_grading = 1, axial_grading = 1;
  bool tetrahedra = false;
};
MeshData generate(const AnnulusShape& shape);

/// Flat rectangle in the plane z = 0. Block "plate" of quad4 or tri3; sets "x_min", "x_max", "y_min", "y_max".
struct PlateShape {
  double length_x = 1, length_y = 1;  ///< m
  int elements_x = 1, elements_y = 1;
  double grading_x = 1, grading_y = 1;
  bool triangles = false;
};
MeshData generate(const PlateShape& shape);

}  // namespace tenon
