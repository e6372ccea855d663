// SPDX-License-Identifier: BSD-3-Clause
// Meshes of simple shapes, with graded spacing. Every one has node sets and side sets on its faces, and positive
// Jacobians; shapes that make no sense throw Error(usage), distortions that invert an element Error(geometry).
#pragma once

#include <array>
#include <string>

#include "framework/mesh/mesh_data.hpp"

namespace tenon {

/// Grading g: ratio of the last to the first interval along an axis (geometric); 1 = uniform.
struct BoxShape {
  Vec3 low{0, 0, 0}, high{1, 1, 1};  ///< m
  std::array<int, 3> elements{1, 1, 1};
  Vec3 grading{1, 1, 1};
  bool tetrahedra = false;  ///< six tet4 per cell, conforming
  /// Random shift of interior nodes in each direction, up to this fraction of the smaller interval beside them, < 0.5:
  /// u = (m(m(seed) + 4 id + direction) >> 11) 2^-53, m = splitmix64 [SLF14], shift (2u - 1) distortion interval.
  double distortion = 0;
  std::uint64_t seed = 1;
};
/// Block "box"; sets "x_min" ... "z_max" (nodes and sides).
MeshData generate(const BoxShape& shape);

/// Solid cylinder about z from z = 0 to `length`: a butterfly of five hex blocks. `fraction` 1 = full, 0.25 = quarter
/// (x, y >= 0, sets "x_min" and "y_min" on the cut faces).
struct CylinderShape {
  double radius = 1, length = 1;  ///< m
  int core = 4;                   ///< elements across the core square (full), half of it in a quarter
  int shell = 4;                  ///< elements from core to surface
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

/// Half of a closed can (y >= 0) that stands on z = 0: a tube and two lids of the same thickness, mitred where they
/// meet; each lid has a hole in its middle. Elements count (axial + 2 lid) around through.
struct CanShape {
  double radius = 1, length = 1, thickness = 0.1, hole = 0.2;  ///< m; `radius` and `length` outside, `hole` a radius
  int circumferential = 20;                                    ///< elements around half a turn
  int axial = 20, lid = 5;                                     ///< elements along the tube, and from a hole to the rim
  int through = 3;                                             ///< elements through the thickness
};
/// Block "can"; sets "bottom" (z = 0), "top", "outer" (the tube), "symmetry" (y = 0).
MeshData generate(const CanShape& shape);

/// Projectile with an ogival nose, about z, flying along -z: the tail at z = length, the tip of the ogive at z = 0, but
/// blunted where the ogive is `tip` times the radius wide. With `wall` > 0 it is a case around a filling, which has
/// nodes of its own, so that the two touch and part.
struct ProjectileShape {
  double radius = 1, length = 10;  ///< m
  double caliber = 3;              ///< radius of the ogive over the diameter, at least 0.5
  double tip = 0.35;               ///< of the radius, above 0 and below 1
  int core = 4, shell = 2;         ///< elements across the core square, and from it to the surface
  int axial = 16, nose = 8;        ///< layers of the shaft and of the nose
  double wall = 0;                 ///< m; thickness of the case, 0: solid
  int wall_elements = 1;           ///< of the `shell` elements, those of the case
  int base_layers = 2;             ///< layers of the shaft that close the case behind
  int filled_nose = 0;             ///< layers of the nose that are filled
};
/// Block "projectile", or "case" and "filling"; sets "tip", "tail", "outer".
MeshData generate(const ProjectileShape& shape);

/// Open-cell foam: struts along the edges of Kelvin's cells (truncated octahedra on a body-centred cubic lattice) made
/// of bricks whose surface nodes are drawn to the round strut. What hangs on nothing is left out.
struct FoamShape {
  double cell = 1;                    ///< m; edge of the cubic cell of the lattice, which holds two of Kelvin's
  double strut_radius = 0.1;          ///< m
  std::array<int, 3> cells{2, 2, 2};  ///< along x, y, z, from the origin
  int elements = 12;                  ///< bricks along the edge of a cubic cell
  /// Random shift of the places of the lattice, up to this fraction of a cell, < 0.3; as BoxShape::distortion, by the
  /// number of the corner of the cubic cells, linear between them; none across the outer faces.
  double irregularity = 0;
  std::uint64_t seed = 1;
};
/// Block "foam"; sets "bottom" (z = 0), "top".
MeshData generate(const FoamShape& shape);

/// Particles on a lattice that fill a shape: one block "particles" of them, one node each, and Mesh::volumes.
struct ParticleBox {
  Vec3 low{0, 0, 0}, high{1, 1, 1};       ///< m; along the axes that a run leaves out, both are the place
  std::array<int, 3> particles{1, 1, 1};  ///< each in the middle of a cell of its own
  int dimension = 3;                      ///< what volumes are of
};
MeshData generate(const ParticleBox& shape);

/// The same mesh of simplices: every hex8 into six tet4, wedge6 into three, pyramid5 into two, quad4 into two tri3.
/// Conforming for any mesh: a quadrilateral is cut by the diagonal at its least node number, and a solid into the
/// cone from its least node number over the triangles of the sides that do not touch it (pulling triangulation, as in
/// [DLVC99]). Sets go along. New elements of a block stand in the order of the old ones, labelled from 1.
MeshData tetrahedralise(const MeshData& mesh);

}  // namespace tenon
