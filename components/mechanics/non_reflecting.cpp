// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/non_reflecting.hpp"

#include <cmath>

#include "components/mechanics/surface_load.hpp"

namespace tenon {

void add_non_reflecting(const Mesh& mesh, const NonReflecting& boundary, const ElementGroups& groups,
                        std::span<SymmetricTensor<double>> absorbing) {
  for (const LoadedSide& side : faces_of_sets(mesh, boundary.side_sets, boundary.label)) {
    const ElementGroup& group = groups.group_of(static_cast<std::size_t>(side.block), side.element);
    const Elasticity& elastic = group.model().elasticity();
    const double density = group.material().density, shear = elastic.shear_modulus();
    const double along = std::sqrt(density * (elastic.lame_lambda() + 2 * shear)), across = std::sqrt(density * shear);
    for_quadrature(side, mesh.coordinates, [&](const auto& shape, const Vec3&, const Vec3& area) {
      const double size = norm(area);
      if (!(size > 0)) return;
      for (std::size_t a = 0; a < static_cast<std::size_t>(side.nodes); ++a) {
        SymmetricTensor<double>& c = absorbing[static_cast<std::size_t>(side.node[a])];
        c = c + transverse_isotropic(shape[a] * size * along, shape[a] * size * across, (1 / size) * area);
      }
    });
  }
}

}  // namespace tenon
