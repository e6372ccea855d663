// SPDX-License-Identifier: BSD-3-Clause
// Compiled with fused multiplications: each pair goes through the same instructions wherever it is worked on.
#include "components/sph/gas_pairs.hpp"

#include <algorithm>
#include <cmath>

#include "components/sph/kernel_choice.hpp"

namespace tenon {

namespace {

template <int d>
TENON_KERNEL double power(double h) {
  double value = 1;
  for (int n = 0; n < d; ++n) value *= h;
  return value;
}

/// 1 in the lanes before `left`, 0 in those that only fill the pack.
TENON_KERNEL WidePack lanes_before(std::size_t left) {
  const WidePack lane{0, 1, 2, 3, 4, 5, 6, 7};
  return lane < static_cast<double>(left) ? broadcast<WidePack>(1) : WidePack{};
}

/// Eight pairs seen from particle i.
struct Separation {
  WidePack dx, dy, dz, h, squared;

  TENON_KERNEL Separation(const double* places, std::size_t i, const LocalIndex* other) {
    WidePack x, y, z;
    gather(places, 4, other, x, y, z, h);
    dx = places[4 * i] - x, dy = places[4 * i + 1] - y, dz = places[4 * i + 2] - z;
    squared = dx * dx + dy * dy + dz * dz;
  }
};

/// Velocities of eight others, seen from particle i, and what stands behind them.
struct Motion {
  WidePack ux, uy, uz, mass;

  TENON_KERNEL Motion(const double* records, std::size_t i, const LocalIndex* other) {
    WidePack x, y, z;
    gather(records, 4, other, x, y, z, mass);
    ux = records[4 * i] - x, uy = records[4 * i + 1] - y, uz = records[4 * i + 2] - z;
  }
};

/// Sums of m u (x) dx F and m dx (x) dx F: the velocity gradient that is exact for linear fields is the one times the
/// inverse of the other.
template <int d>
struct GradientSums {
  WidePack of_velocity[d][d] = {}, of_place[d][d] = {};

  TENON_KERNEL void add(const WidePack& f, const WidePack (&u)[3], const WidePack (&x)[3]) {
    for (int a = 0; a < d; ++a)
      for (int b = 0; b < d; ++b) {
        of_velocity[a][b] += f * u[a] * x[b];
        if (b >= a) of_place[a][b] += f * x[a] * x[b];
      }
  }

  /// Divergence and size of the curl.
  void finish(GasDensity& found) const {
    double D[3][3] = {}, T[3][3] = {}, inverse[3][3] = {}, trace = 0;
    for (int a = 0; a < d; ++a)
      for (int b = 0; b < d; ++b) {
        D[a][b] = sum_of(of_velocity[a][b]);
        T[a][b] = sum_of(of_place[std::min(a, b)][std::max(a, b)]);
      }
    for (int a = 0; a < d; ++a) trace += T[a][a] / d;
    for (int a = d; a < 3; ++a) T[a][a] = trace;
    double determinant = 0;
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) {
        const int r = (b + 1) % 3, s = (b + 2) % 3, u = (a + 1) % 3, v = (a + 2) % 3;
        inverse[a][b] = T[r][u] * T[s][v] - T[r][v] * T[s][u];
        if (a == 0) determinant += T[b][0] * inverse[0][b];
      }
    // In a line or a plane, or alone: what the neighbours that there are would say if they stood all around.
    const bool enough = std::abs(determinant) > 1e-4 * std::abs(trace * trace * trace);
    double G[3][3] = {};
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) {
        for (int c = 0; c < 3 && enough; ++c) G[a][b] += D[a][c] * inverse[c][b] / determinant;
        if (!enough) G[a][b] = trace != 0 ? D[a][b] / trace : 0;
      }
    found.divergence = G[0][0] + G[1][1] + G[2][2];
    found.curl = norm({G[2][1] - G[1][2], G[0][2] - G[2][0], G[1][0] - G[0][1]});
  }
};

template <typename K, int d, bool gradients>
void densities(const GasPass& pass, std::span<GasDensity> found) {
  constexpr double sigma = K::sigma(d);
  const double* const places = pass.records.places.data();
  const double* const motion = pass.records.motion.data();
  PairHits& hits = pass.hits;
  GasPairs& pairs = pass.pairs;
  pairs.begin.clear(), pairs.count.clear(), pairs.other.clear();
  for (std::size_t i = 0; i < pass.particles.owned(); ++i) {
    hits.find<false>(i, pass.lists.of(i), places, K::support);
    pairs.begin.push_back(pairs.other.size());
    pairs.count.push_back(hits.count);
    pairs.other.insert(pairs.other.end(), hits.j.begin(), hits.j.begin() + static_cast<std::ptrdiff_t>(hits.padded()));
    const double h = places[4 * i + 3], mass = motion[4 * i + 3], over = 1 / h;
    WidePack rho{}, change{};
    GradientSums<d> gradient;
    for (std::size_t k = 0; k < hits.padded(); k += wide_pack_width) {
      const Motion other(motion, i, &hits.j[k]);
      const WidePack q = square_root(load_wide(&hits.squared[k])) * over, m = other.mass * load_wide(&hits.inside[k]);
      const WidePack w = K::template w<d>(q), slope = K::template slope<d>(q);
      rho += m * w;
      change -= m * (d * w + q * q * slope);
      if constexpr (gradients)
        gradient.add(m * slope, {other.ux, other.uy, other.uz},
                     {load_wide(&hits.dx[k]), load_wide(&hits.dy[k]), load_wide(&hits.dz[k])});
    }
    const double self = mass * K::template w<d>(0.0), scale = sigma / power<d>(h);
    found[i].density = scale * (sum_of(rho) + self);
    found[i].stretch = 1 + scale * (sum_of(change) - d * self) / (d * found[i].density);
    if constexpr (gradients) gradient.finish(found[i]);
  }
  pairs.begin.push_back(pairs.other.size());
}

/// Constants of the pair forces.
struct GasConstants {
  double alpha, beta, conduction;
  bool linear;  ///< divergence exact for velocities along the distance from i, also at surfaces; not that of the sum
};

// With F = w'(q)/(q h^(d+2)), grad W = F x_ij, F <= 0. Viscosity [Mon97]: the acceleration of i is that of a pressure
// term -alpha_ij v_sig v.x/(r rho_ij) / 2, and never pulls.
template <typename K, int d>
void forces(const GasPass& pass, const GasConstants& constants, const Column& stretch, std::span<GasForce> found) {
  constexpr double sigma = K::sigma(d);
  const double* const places = pass.records.places.data();
  const double* const motion = pass.records.motion.data();
  const double* const states = pass.records.states.data();
  GasPairs& pairs = pass.pairs;
  pairs.work.resize(pairs.other.size());
  for (std::size_t i = 0; i < pass.particles.owned(); ++i) {
    const double hi = places[4 * i + 3], over_h = 1 / hi, scale_i = sigma * over_h * over_h / power<d>(hi);
    const double* const own = states + GasRecord::size * i;
    const double rho = own[0], ci = own[1], push = own[2], pressure = own[3], energy = own[4], limiter = own[5];
    WidePack ax{}, ay{}, az{}, heat{}, rate{}, spread{}, fastest = broadcast<WidePack>(ci);
    const std::size_t first = pairs.begin[i], end = pairs.begin[i + 1];
    for (std::size_t k = first; k < end; k += wide_pack_width) {
      const LocalIndex* const other = &pairs.other[k];
      const Separation apart(places, i, other);
      const Motion moving(motion, i, other);
      WidePack rho_j, cj, push_j, p_j, u_j, limit_j, none;
      gather(states, GasRecord::size, other, rho_j, cj, push_j, p_j);
      gather(states + 4, GasRecord::size, other, u_j, limit_j, none, none);
      const WidePack inside = lanes_before(pairs.count[i] - (k - first)), m = moving.mass * inside;
      const WidePack r = square_root(apart.squared), over_hj = 1.0 / apart.h;
      WidePack scale_j = sigma * over_hj * over_hj;
      for (int n = 0; n < d; ++n) scale_j *= over_hj;
      const WidePack gi = scale_i * K::template slope<d>(r * over_h), gj = scale_j * K::template slope<d>(r * over_hj);
      const WidePack mean = 0.5 * (gi + gj);
      const WidePack along = moving.ux * apart.dx + moving.uy * apart.dy + moving.uz * apart.dz;
      const WidePack apart_speed = along / (r + 1e-12 * hi), closing = lesser_of<WidePack>(apart_speed, WidePack{});
      const WidePack sound = 0.5 * (ci + cj), density = 0.5 * (rho + rho_j);
      const WidePack speed = constants.alpha * sound - constants.beta * closing;
      const WidePack viscous = -0.5 * (limiter + limit_j) * speed * closing / density * mean;
      const WidePack total = -m * (push * gi + push_j * gj + viscous);
      ax += total * apart.dx, ay += total * apart.dy, az += total * apart.dz;
      store(&pairs.work[k], m * (push * gi + 0.5 * viscous));
      rate += m * gi * along;
      spread -= m * gi * apart.squared;
      fastest = greater_of<WidePack>(fastest,
                                     inside * (sound + greater_of<WidePack>(apart_speed, -constants.beta * closing)));
      if (constants.conduction > 0) {
        const WidePack flow = square_root(greater_of<WidePack>(pressure - p_j, p_j - pressure) / density);
        heat += m * flow / density * (energy - u_j) * mean * r;
      }
    }
    const WidePack sums = sums_of(ax, ay, az, rate, heat, spread, WidePack{}, WidePack{});
    double signal = ci;
    for (int l = 0; l < wide_pack_width; ++l) signal = std::max(signal, fastest[l]);
    // Order of the sums: ax, heat, ay, spread, az, -, rate.
    const double of_sum = sums[6] / (stretch[i] * rho), linear = sums[3] > 0 ? d * sums[6] / sums[3] : 0;
    found[i] = {
        {sums[0], sums[2], sums[4]}, constants.conduction * sums[1], constants.linear ? linear : of_sum, signal};
  }
}

}  // namespace

void find_gas_densities(const GasPass& pass, std::span<GasDensity> found) {
  const bool gradients = pass.options.artificial_viscosity.limiter != ArtificialViscosity::Switch::none;
  with_kernel(pass.options.kernel, pass.options.dimension, [&]<typename K, int d>() {
    if (gradients)
      densities<K, d, true>(pass, found);
    else
      densities<K, d, false>(pass, found);
  });
}

void find_gas_forces(const GasPass& pass, const Column& stretch, std::span<GasForce> found) {
  const GasConstants constants{pass.options.artificial_viscosity.alpha.value_or(1),
                               pass.options.artificial_viscosity.beta.value_or(2), pass.options.artificial_conduction,
                               pass.options.gas.density == GasOptions::Density::continuity};
  with_kernel(pass.options.kernel, pass.options.dimension,
              [&]<typename K, int d>() { forces<K, d>(pass, constants, stretch, found); });
}

void find_gas_work(const GasPass& pass, Column& rate) {
  const double* const places = pass.records.places.data();
  const double* const means = pass.records.means.data();
  const GasPairs& pairs = pass.pairs;
  for (std::size_t i = 0; i < pass.particles.owned(); ++i) {
    WidePack sum{};
    for (std::size_t k = pairs.begin[i]; k < pairs.begin[i + 1]; k += wide_pack_width) {
      const Separation apart(places, i, &pairs.other[k]);
      const Motion moving(means, i, &pairs.other[k]);
      sum += load_wide(&pairs.work[k]) * (moving.ux * apart.dx + moving.uy * apart.dy + moving.uz * apart.dz);
    }
    rate[i] = sum_of(sum);
  }
}

}  // namespace tenon
