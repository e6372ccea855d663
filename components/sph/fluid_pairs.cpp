// SPDX-License-Identifier: BSD-3-Clause
// Compiled with fused multiplications: each pair goes through the same instructions wherever it is worked on.
#include "components/sph/fluid_pairs.hpp"

#include <numbers>

#include "components/sph/kernel_choice.hpp"

namespace tenon {

namespace {

/// Eight at a time of what FluidRecords hold.
struct Others {
  WidePack vx, vy, vz, density, pressure, volume, viscosity, kind;

  TENON_KERNEL Others(const double* records, const LocalIndex* at) {
    gather(records, FluidRecord::size, at, vx, vy, vz, density);
    gather(records + 4, FluidRecord::size, at, pressure, volume, viscosity, kind);
  }
};

struct Sums {
  WidePack rate{}, px{}, py{}, pz{}, vx{}, vy{}, vz{}, nx{}, ny{}, nz{}, spread{};
};

/// The particle whose sums they are.
struct Self {
  double velocity[3], density, pressure, viscosity, kind, diffusion;
  double felt[3];  ///< velocity that viscosity feels
  Vec3 hydrostatic;
};

template <typename K, int d, bool plain>
class FluidSums {
 public:
  explicit FluidSums(const FluidPass& pass)
      : pass_(pass), records_(pass.states.data()), h_(plain && pass.places.values.size() > 3 ? pass.places[3] : 1) {}

  void run() {
    for (const NeighbourLists::Run& run : pass_.lists.runs())
      for (std::size_t i = run.first; i < run.last; ++i) sum_of(i);
  }

 private:
  TENON_KERNEL void sum_of(std::size_t i) {
    pass_.hits.find<plain>(i, pass_.lists.of(i), pass_.places.data(), K::support);
    const Self self = self_of(i);
    Sums sums;
    if (pass_.morris)
      add<true>(self, sums);
    else
      add<false>(self, sums);
    finish(i, self, sums);
  }

  TENON_KERNEL Self self_of(std::size_t i) const {
    const double* const r = records_ + FluidRecord::size * i;
    const FluidBody& body = pass_.bodies[static_cast<std::size_t>(pass_.particles.body[i])];
    Self self{{r[0], r[1], r[2]}, r[3], r[4], r[6], r[7], body.diffusion, {r[0], r[1], r[2]}, body.hydrostatic};
    if (!plain && pass_.slip && body.wall)
      for (std::size_t c = 0; c < 3; ++c) self.felt[c] = (*pass_.slip)[4 * i + c];
    return self;
  }

  template <bool morris>
  TENON_KERNEL void add(const Self& self, Sums& sums) const {
    const PairHits& hits = pass_.hits;
    for (std::size_t k = 0; k < hits.padded(); k += wide_pack_width) {
      const Others other(records_, &hits.j[k]);
      const WidePack dx = load_wide(&hits.dx[k]), dy = load_wide(&hits.dy[k]), dz = load_wide(&hits.dz[k]);
      const WidePack r2 = load_wide(&hits.squared[k]);
      WidePack h, slope;
      if constexpr (plain) {
        h = broadcast<WidePack>(h_);
        slope = K::template slope<d>(square_root(r2) * (1 / h_));
      } else {
        h = load_wide(&hits.h[k]);
        const WidePack inverse = 1.0 / h;
        slope = K::template slope<d>(square_root(r2) * inverse) * (inverse * inverse);
        for (int n = 0; n < d; ++n) slope *= inverse;
        if (self.kind < 0) slope = other.kind < 0.0 ? WidePack{} : slope;
      }
      const WidePack f = other.volume * slope;
      const WidePack ux = self.velocity[0] - other.vx, uy = self.velocity[1] - other.vy,
                     uz = self.velocity[2] - other.vz;
      const WidePack approach = ux * dx + uy * dy + uz * dz;
      WidePack excess = self.density - other.density -
                        (self.hydrostatic[0] * dx + self.hydrostatic[1] * dy + self.hydrostatic[2] * dz);
      if constexpr (!plain) excess = other.kind == broadcast<WidePack>(self.kind) ? excess : WidePack{};
      sums.rate += f * (self.density * approach + self.diffusion * h * excess);
      const WidePack push = f * (self.pressure + other.pressure);
      sums.px -= push * dx, sums.py -= push * dy, sums.pz -= push * dz;
      viscous<morris>(self, other, hits, k, {f, h, r2, dx, dy, dz, ux, uy, uz, approach}, sums);
      if constexpr (!plain) {
        sums.nx += f * dx, sums.ny += f * dy, sums.nz += f * dz;
        sums.spread -= f * r2;
      }
    }
  }

  struct Geometry {
    WidePack f, h, r2, dx, dy, dz, ux, uy, uz, approach;
  };
  template <bool morris>
  TENON_KERNEL void viscous(const Self& self, const Others& other, const PairHits& hits, std::size_t k,
                            const Geometry& pair, Sums& sums) const {
    WidePack ux = pair.ux, uy = pair.uy, uz = pair.uz, approach = pair.approach;
    if constexpr (!plain)
      if (pass_.slip) {
        WidePack sx, sy, sz, none;
        gather(pass_.slip->data(), 4, &hits.j[k], sx, sy, sz, none);
        const auto wall = other.kind < 0.0;
        ux = self.felt[0] - (wall ? sx : other.vx), uy = self.felt[1] - (wall ? sy : other.vy);
        uz = self.felt[2] - (wall ? sz : other.vz);
        approach = ux * pair.dx + uy * pair.dy + uz * pair.dz;
      }
    if constexpr (plain && !morris) {
      // The mean of equals.
      const WidePack drag = pair.f * (self.viscosity * pair.approach) / (pair.r2 + 0.01 * h_ * h_);
      sums.vx += drag * pair.dx, sums.vy += drag * pair.dy, sums.vz += drag * pair.dz;
      return;
    }
    const WidePack both = self.viscosity * other.viscosity, sum = self.viscosity + other.viscosity + 1e-300;
    if constexpr (morris) {
      const WidePack drag = 4.0 * pair.f * both / sum;
      sums.vx += drag * ux, sums.vy += drag * uy, sums.vz += drag * uz;
    } else {
      const WidePack drag = 2.0 * pair.f * both * approach / (sum * (pair.r2 + 0.01 * pair.h * pair.h));
      sums.vx += drag * pair.dx, sums.vy += drag * pair.dy, sums.vz += drag * pair.dz;
    }
  }

  /// A particle that left its body has nobody whose motion would ever mend its density: where less of its support is
  /// full (itself counted) than in a right-angled corner of a body, 1/2^d, it tends to that at rest, 1/s.
  double relaxation(std::size_t i, const Self& self) const {
    constexpr double ball = d == 3 ? 4.0 / 3 * std::numbers::pi : d == 2 ? std::numbers::pi : 2;
    const FluidBody& body = pass_.bodies[static_cast<std::size_t>(pass_.particles.body[i])];
    const double h = pass_.places[4 * i + 3], volume = records_[FluidRecord::size * i + 5];
    double around = ball;
    for (int n = 0; n < d; ++n) around *= K::support * h;
    constexpr double corners = 1 << d;
    const double lonely = 1 - corners * static_cast<double>(pass_.hits.count + 1) * volume / around;
    return lonely > 0 ? lonely * body.sound / h * (body.density - self.density) : 0;
  }

  TENON_KERNEL void finish(std::size_t i, const Self& self, const Sums& sums) {
    double scale = K::sigma(d);
    if constexpr (plain) {
      scale /= h_ * h_;
      for (int n = 0; n < d; ++n) scale /= h_;
    }
    // Order of the sums: rate, vx, px, vy, py, vz, pz.
    const WidePack all = scale * sums_of(sums.rate, sums.px, sums.py, sums.pz, sums.vx, sums.vy, sums.vz, WidePack{});
    const double over = 1 / self.density;
    const Vec3 pressure{over * all[2], over * all[4], over * all[6]},
        viscous{over * all[1], over * all[3], over * all[5]};
    pass_.density_rate[i] = self.kind < 0 ? 0 : all[0] + relaxation(i, self);
    pass_.pressure_acceleration.set(i, pressure);
    pass_.viscous_acceleration.set(i, viscous);
    pass_.acceleration.set(i, pressure + viscous);
    if (!plain && pass_.crowding) {
      const WidePack crowd =
          scale * sums_of(sums.nx, sums.ny, sums.nz, sums.spread, WidePack{}, WidePack{}, WidePack{}, WidePack{});
      for (std::size_t c = 0; c < 4; ++c) (*pass_.crowding)[4 * i + c] = crowd[2 * static_cast<int>(c)];
    }
  }

  const FluidPass& pass_;
  const double* records_;
  double h_;  // of all, if plain
};

}  // namespace

void sum_fluid_pairs(const SphOptions& options, const FluidPass& pass) {
  with_kernel(options.kernel, options.dimension, [&]<typename K, int d>() {
    if (pass.plain)
      FluidSums<K, d, true>(pass).run();
    else
      FluidSums<K, d, false>(pass).run();
  });
}

}  // namespace tenon
