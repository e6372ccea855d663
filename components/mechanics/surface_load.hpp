// SPDX-License-Identifier: BSD-3-Clause
// Pressure and traction on element sides.
#pragma once

#include "components/mechanics/load.hpp"
#include "components/mechanics/load_options.hpp"

namespace tenon {

/// Face of an element: three or four nodes, right-hand normal outwards.
struct LoadedSide {
  LocalIndex block, element;
  int side;  ///< of the element
  int nodes;
  std::array<LocalIndex, max_side_nodes> node;
};

/// Sides of several sets, ascending, each once. Collective. Throws Error(usage) for unknown sets, edges of shells, and
/// sets without area.
std::vector<LoadedSide> faces_of_sets(const Mesh& mesh, const std::vector<std::string>& sets, const std::string& label);

/// Visits the quadrature points of a face: visit(shape values, place, area vector x,xi x x,eta times weight). Exact for
/// the area vector of any (also warped) quadrilateral times a shape function, so resultants are exact too: closed
/// surfaces carry no force or moment under uniform pressure.
template <typename Visit>
void for_quadrature(const LoadedSide& side, std::span<const Vec3> positions, Visit visit);

/// Nodal forces int N_a p n dA or int N_a t dA. Sides of elements that have failed carry nothing.
class SurfaceForce final : public Load {
 public:
  /// Collective.
  SurfaceForce(const Mesh& mesh, const SurfaceLoad& load);
  std::vector<LocalIndex> nodes() const override;
  void add_forces(const LoadState& state, std::span<ForceRow> force) const override;

 private:
  std::span<const Vec3> reference_;
  SurfaceLoad load_;
  std::vector<LoadedSide> sides_;
};

/// Shape functions of a face at its quadrature points.
struct FaceRule {
  int points;
  std::array<double, 4> weight;
  std::array<std::array<double, max_side_nodes>, 4> value;
  std::array<std::array<Vec3, max_side_nodes>, 4> gradient;
};
const FaceRule& face_rule(int nodes);

template <typename Visit>
void for_quadrature(const LoadedSide& side, std::span<const Vec3> positions, Visit visit) {
  const FaceRule& rule = face_rule(side.nodes);
  for (std::size_t q = 0; q < static_cast<std::size_t>(rule.points); ++q) {
    Vec3 place{}, along{}, across{};
    for (std::size_t a = 0; a < static_cast<std::size_t>(side.nodes); ++a) {
      const Vec3& x = positions[static_cast<std::size_t>(side.node[a])];
      place = place + rule.value[q][a] * x;
      along = along + rule.gradient[q][a][0] * x;
      across = across + rule.gradient[q][a][1] * x;
    }
    visit(rule.value[q], place, rule.weight[q] * cross(along, across));
  }
}

}  // namespace tenon
