// SPDX-License-Identifier: BSD-3-Clause
#include "components/sph/fluid_walls.hpp"

#include <algorithm>

#include "components/sph/fluid_pairs.hpp"
#include "components/sph/kernel_choice.hpp"

namespace tenon {

namespace {

/// Sums over the fluid near one wall particle, each weighted by volume and kernel.
struct FluidNearby {
  double weight = 0, pressure = 0, viscosity = 0;
  Vec3 velocity{}, lever{};  // lever: density times x_wall - x_fluid
};

template <typename K, int d>
FluidNearby look(const WallPass& pass, std::size_t i) {
  WidePack weight{}, pressure{}, viscosity{}, vx{}, vy{}, vz{}, lx{}, ly{}, lz{};
  const PairHits& hits = pass.hits;
  for (std::size_t k = 0; k < hits.padded(); k += wide_pack_width) {
    WidePack ux, uy, uz, density, p, volume, mu, kind;
    gather(pass.states.data(), FluidRecord::size, &hits.j[k], ux, uy, uz, density);
    gather(pass.states.data() + 4, FluidRecord::size, &hits.j[k], p, volume, mu, kind);
    const WidePack q = square_root(load_wide(&hits.squared[k])) / load_wide(&hits.h[k]);
    const WidePack w = load_wide(&hits.inside[k]) * volume * K::template w<d>(q);
    const WidePack fluid = kind < 0.0 ? WidePack{} : w;
    weight += fluid, pressure += fluid * p, viscosity += fluid * mu;
    vx += fluid * ux, vy += fluid * uy, vz += fluid * uz;
    const WidePack arm = fluid * density;
    lx += arm * load_wide(&hits.dx[k]), ly += arm * load_wide(&hits.dy[k]), lz += arm * load_wide(&hits.dz[k]);
  }
  return {sum_of(weight),
          sum_of(pressure),
          sum_of(viscosity),
          {sum_of(vx), sum_of(vy), sum_of(vz)},
          {sum_of(lx), sum_of(ly), sum_of(lz)}};
}

}  // namespace

void extrapolate_to_walls(const SphOptions& options, const WallPass& pass) {
  with_kernel(options.kernel, options.dimension, [&]<typename K, int d>() {
    const ParticleData& p = pass.particles;
    for (std::size_t i = 0; i < p.owned(); ++i) {
      const auto body = static_cast<std::size_t>(p.body[i]);
      if (!options.bodies[body].wall) continue;
      pass.hits.find<false>(i, pass.lists.of(i), pass.places.data(), K::support);
      const FluidNearby fluid = look<K, d>(pass, i);
      double* const record = pass.states.data() + FluidRecord::size * i;
      const double over = fluid.weight > 1e-12 ? 1 / fluid.weight : 0;
      record[4] =
          over > 0 ? std::max(over * (fluid.pressure + dot(pass.pull[body], fluid.lever)), pass.least_pressure) : 0;
      record[6] = over * fluid.viscosity;
      if (!pass.slip) {
        record[6] = 0;
        continue;
      }
      for (std::size_t c = 0; c < 3; ++c)
        (*pass.slip)[4 * i + c] = over > 0 ? 2 * record[c] - over * fluid.velocity[c] : record[c];
    }
  });
}

}  // namespace tenon
