// SPDX-License-Identifier: BSD-3-Clause
// Bodies of particles: regions of space, lattices that fill them, walls around boxes.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "framework/base/box.hpp"
#include "framework/mesh/mesh_data.hpp"

namespace tenon {

/// A part of space to be filled.
struct ParticleRegion {
  std::string name;  ///< for messages
  Box bounds;        ///< m
  double measure;    ///< m^3, or of two dimensions m^2
  std::function<bool(const Vec3&)> inside;
  struct Surface {
    double distance;  ///< m, negative inside
    Vec3 outward;     ///< unit vector; where the surface is nearest
  };
  std::function<Surface(const Vec3&)> surface;
};

/// Between two concentric spheres, or circles in a plane z = constant; `inner` 0: all of it. Throws Error(usage), as
/// all of these do, for numbers that make no region.
ParticleRegion ball_region(const Vec3& centre, double inner, double outer, int dimension);
/// Straight, from the middle of its foot along `axis` (of any length).
ParticleRegion cylinder_region(const Vec3& foot, const Vec3& axis, double inner, double outer, double length);
/// What a mesh encloses: the solid elements, or the surface of its surface elements, which must be closed; in two
/// dimensions its surface elements themselves, in a plane z = constant. Which points are inside follows from crossings
/// of lines, where those through edges and corners count exactly once: no point leaks. Throws Error(geometry) naming an
/// edge of a surface that is not closed, Error(usage) for a mesh with neither.
ParticleRegion mesh_region(const MeshData& mesh, int dimension);

enum class ParticleLattice {
  cubic,     ///< in the middle of square cells
  hexagonal  ///< hexagonal close packed: as dense, but with 12 nearest neighbours (6 in a plane)
};

struct ParticleFill {
  double spacing = 0;  ///< m: edge of a cube (square) of the volume of a particle
  ParticleLattice lattice = ParticleLattice::cubic;
  int dimension = 3;
  bool relaxed = false;  ///< pushed apart until they are evenly spread, also along the surface
};

/// One block "particles". Lattices are fitted to a box, so that cells fill it exactly; of one dimension, and of two at
/// z = low[2].
MeshData fill_box(const Vec3& low, const Vec3& high, const ParticleFill& fill);
/// The lattice is centred on the bounds. All particles have the same volume, and together that of the region. Throws
/// Error(geometry) if the spacing is so wide that none is inside.
MeshData fill_region(const ParticleRegion& region, const ParticleFill& fill);

/// Layers of particles outside of a box, as its walls; `open`: sides x_min, x_max, y_min ... without. The spacing is
/// fitted as fill_box does, so that the lattice goes on from what fills the box.
struct TankShape {
  Vec3 low{}, high{};  ///< m, of the space inside
  double spacing = 0;  ///< m
  int layers = 3, dimension = 3;
  std::array<bool, 6> open{};
};
MeshData tank_walls(const TankShape& shape);

/// One particle for each solid element of a block, in their order: in the mean of its corners, with its volume. Throws
/// Error(usage) if there is no such block, or it has no solids.
MeshData particles_of_elements(const MeshData& mesh, const std::string& block);

/// One mesh of all, each a block of the given name; numbered from 1.
MeshData join_particles(std::vector<std::pair<std::string, MeshData>> bodies);

/// Moves particles of equal volume apart, with mirror images beyond the surface, until the way of all is below a
/// hundredth of the spacing or `sweeps` are done; returns the sweeps. They stay inside by half a spacing.
int relax_particles(const ParticleRegion& region, double spacing, int dimension, int sweeps, std::vector<Vec3>& places);

}  // namespace tenon
