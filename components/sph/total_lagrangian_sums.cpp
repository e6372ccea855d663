// SPDX-License-Identifier: BSD-3-Clause
// The sums over the neighbours of the start.
#include <algorithm>

#include "components/sph/kernel_choice.hpp"
#include "components/sph/matrix3.hpp"
#include "components/sph/total_lagrangian.hpp"

namespace tenon {

namespace {

// One record a particle, so that eight neighbours are read by a few gathers:
//   X, h | u, V | v, m | c, E, Q0, Q1 | Q2 .. Q5 | Q6 .. Q8, F0 | F1 .. F4 | F5 .. F8
constexpr std::size_t record_size = 32, place = 0, moved = 4, moving = 8, stresses = 12;

/// Eight neighbours of one particle in the reference configuration.
struct RestPairs {
  WidePack D[3];        // X_i - X_j, m
  WidePack squared, h;  // m^2, m
  WidePack u[3];        // u_j, m
  WidePack volume;      // V_j, m^3; 0 where it holds on to nothing

  RestPairs(const double* records, std::size_t i, const LocalIndex* js) {
    const double* const mine = records + record_size * i;
    WidePack X[3];
    gather(records + place, record_size, js, X[0], X[1], X[2], h);
    gather(records + moved, record_size, js, u[0], u[1], u[2], volume);
    for (int c = 0; c < 3; ++c) D[c] = mine[c] - X[c];
    h = 0.5 * (mine[3] + h);
    squared = D[0] * D[0] + D[1] * D[1] + D[2] * D[2];
  }
};

/// (1/r dW/dr): grad W = slope D.
template <typename K, int d>
TENON_KERNEL WidePack slope_of(const RestPairs& p) {
  WidePack scale = K::sigma(d) / (p.h * p.h);
  for (int n = 0; n < d; ++n) scale = scale / p.h;
  return scale * K::template slope<d>(square_root(p.squared) / p.h);
}

}  // namespace

template <typename K, int d>
void TotalLagrangian::moments() {
  for (std::size_t i = 0; i < rest_.owned(); ++i) {
    WidePack sums[9]{};
    for (std::size_t k = begin_[i]; k < begin_[i + 1]; k += wide_pack_width) {
      const RestPairs p(records_.data(), i, &neighbours_[k]);
      const WidePack s = p.volume * slope_of<K, d>(p);
      for (int r = 0; r < d; ++r)
        for (int c = 0; c < d; ++c) sums[3 * r + c] -= s * (p.D[r] * p.D[c]);
    }
    Matrix3 moment = identity3;
    for (std::size_t r = 0; r < d; ++r)
      for (std::size_t c = 0; c < d; ++c) moment[3 * r + c] = sum_of(sums[3 * r + c]);
    set_matrix(correction_, i, gradient_correction(moment, d));
  }
}

template <typename K, int d>
void TotalLagrangian::deformation_gradients() {
  for (std::size_t i = 0; i < rest_.owned(); ++i) {
    if (bonds_[i] == 0) {
      set_matrix(deformed_, i, matrix_of(deformation_, i));
      continue;
    }
    const Vec3 u = displacement_.vec(i);
    WidePack sums[9]{};
    for (std::size_t k = begin_[i]; k < begin_[i + 1]; k += wide_pack_width) {
      const RestPairs p(records_.data(), i, &neighbours_[k]);
      const WidePack s = p.volume * slope_of<K, d>(p);
      for (std::size_t r = 0; r < d; ++r) {
        const WidePack change = s * (p.u[r] - u[r]);
        for (std::size_t c = 0; c < d; ++c) sums[3 * r + c] += change * p.D[c];
      }
    }
    Matrix3 sum{};
    for (std::size_t r = 0; r < d; ++r)
      for (std::size_t c = 0; c < d; ++c) sum[3 * r + c] = sum_of(sums[3 * r + c]);
    set_matrix(deformed_, i, identity3 + product(sum, transposed(matrix_of(correction_, i))));
  }
}

// Forces of stress, against modes without strain, and of artificial viscosity. The second one resists the part of the
// distance of a pair that the two deformation gradients do not explain [Gan15],
//   f = - alpha/2 E V_i V_j W/|D|^2 (delta_i + delta_j) x/|x|,   delta_i = (F_i D - x) . x/|x|,
// the third its approach [Mon92]; both along the line of the pair.
template <typename K, int d>
void TotalLagrangian::forces_of_pairs() {
  const double alpha = c_.options.artificial_viscosity.alpha.value_or(solid_alpha),
               beta = c_.options.artificial_viscosity.beta.value_or(solid_beta);
  const double hourglass = c_.options.solid.hourglass;
  for (std::size_t i = 0; i < rest_.owned(); ++i) {
    const Vec3 u = displacement_.vec(i), v = rest_.velocity.vec(i);
    const Matrix3 Q = matrix_of(push_, i), F = matrix_of(deformation_, i);
    const double E = secant_[i], c_i = sound_[i], mass = rest_.mass[i], rho = mass / std::max(bonds_[i], 1e-300);
    WidePack f[3]{}, g[3]{}, a[3]{}, heating{}, fastest{};
    for (std::size_t k = begin_[i]; bonds_[i] > 0 && k < begin_[i + 1]; k += wide_pack_width) {
      const LocalIndex* const js = &neighbours_[k];
      const RestPairs p(records_.data(), i, js);
      const double* const records = records_.data();
      WidePack vj[3], m_j, c_j, E_j, Qj[9], Fj[9];
      gather(records + moving, record_size, js, vj[0], vj[1], vj[2], m_j);
      gather(records + stresses, record_size, js, c_j, E_j, Qj[0], Qj[1]);
      gather(records + stresses + 4, record_size, js, Qj[2], Qj[3], Qj[4], Qj[5]);
      gather(records + stresses + 8, record_size, js, Qj[6], Qj[7], Qj[8], Fj[0]);
      gather(records + stresses + 12, record_size, js, Fj[1], Fj[2], Fj[3], Fj[4]);
      gather(records + stresses + 16, record_size, js, Fj[5], Fj[6], Fj[7], Fj[8]);
      const WidePack slope = slope_of<K, d>(p), s = p.volume * slope;
      WidePack x[3], between{}, approach{};
      for (std::size_t r = 0; r < d; ++r) {
        x[r] = p.D[r] + (u[r] - p.u[r]);
        between += x[r] * x[r], approach += x[r] * (v[r] - vj[r]);
        WidePack pushed{};
        for (std::size_t c = 0; c < d; ++c) pushed += (Q[3 * r + c] + Qj[3 * r + c]) * p.D[c];
        f[r] += s * pushed;
      }
      // Padding and a particle on top of itself: neither has a direction.
      const WidePack tiny = 1e-12 * p.h * p.h;
      const WidePack length = square_root(between), inverse = between > tiny ? 1.0 / length : WidePack{};
      WidePack explained{};
      for (std::size_t r = 0; r < d; ++r) {
        WidePack sum{};
        for (std::size_t c = 0; c < d; ++c) sum += (F[3 * r + c] + Fj[3 * r + c]) * p.D[c];
        explained += sum * x[r];
      }
      WidePack scale = broadcast<WidePack>(K::sigma(d));
      for (int n = 0; n < d; ++n) scale = scale / p.h;
      const WidePack W = scale * K::template w<d>(square_root(p.squared) / p.h);
      const WidePack delta = explained * inverse - 2.0 * length;
      const WidePack resisting =
          p.squared > tiny ? p.volume * (0.25 * hourglass) * (E + E_j) * W / p.squared * delta : WidePack{};
      const WidePack closing = lesser_of<WidePack>(approach, WidePack{}) * inverse;
      const WidePack holds = p.volume > 0.0 ? p.h / p.h : WidePack{};
      const WidePack rho_j = m_j / greater_of<WidePack>(p.volume, broadcast<WidePack>(1e-300));
      const WidePack viscosity = (beta * closing - 0.5 * alpha * (c_i + c_j)) * closing / (0.5 * (rho + rho_j));
      const WidePack dragging = -holds * m_j * viscosity * slope * square_root(p.squared) * inverse;
      for (std::size_t r = 0; r < d; ++r) g[r] += resisting * inverse * x[r], a[r] += dragging * x[r];
      heating -= 0.5 * dragging * approach;
      fastest = greater_of<WidePack>(fastest, -closing);
    }
    const double share = bonds_[i] / mass;
    a_.set(i, share * Vec3{sum_of(f[0]), sum_of(f[1]), sum_of(f[2])});
    a_hourglass_.set(i, share * Vec3{sum_of(g[0]), sum_of(g[1]), sum_of(g[2])});
    a_viscous_.set(i, {sum_of(a[0]), sum_of(a[1]), sum_of(a[2])});
    heating_[i] = sum_of(heating);
    double most = 0;
    for (int l = 0; l < wide_pack_width; ++l) most = std::max(most, fastest[l]);
    rest_step_[i] = c_.options.time_step.cfl * rest_.length[i] /
                    (speed_[i] * (1 + 0.6 * alpha) + 1.2 * beta * most + norm(v) + 1e-300);
  }
}

// What neighbours are asked for: places and volumes; then what moves them, and what they push with.
void TotalLagrangian::record_places() {
  records_.resize(record_size * rest_.size());
  for (std::size_t i = 0; i < rest_.size(); ++i) {
    double* const to = &records_[record_size * i];
    for (std::size_t c = 0; c < 3; ++c) {
      to[place + c] = rest_.position[3 * i + c], to[moved + c] = displacement_[3 * i + c];
      to[moving + c] = rest_.velocity[3 * i + c];
    }
    to[place + 3] = rest_.length[i], to[moved + 3] = bonds_[i], to[moving + 3] = rest_.mass[i];
  }
}
void TotalLagrangian::record_pushes() {
  for (std::size_t i = 0; i < rest_.size(); ++i) {
    double* const to = &records_[record_size * i + stresses];
    to[0] = sound_[i], to[1] = secant_[i];
    std::copy_n(push_.data() + 9 * i, 9, to + 2);
    std::copy_n(deformation_.data() + 9 * i, 9, to + 11);
  }
}

void TotalLagrangian::sum_moments() {
  record_places();
  with_kernel(c_.options.kernel, c_.options.dimension, [&]<typename K, int d>() { moments<K, d>(); });
}
void TotalLagrangian::sum_deformation() {
  record_places();
  with_kernel(c_.options.kernel, c_.options.dimension, [&]<typename K, int d>() { deformation_gradients<K, d>(); });
}
void TotalLagrangian::sum_forces() {
  record_pushes();
  with_kernel(c_.options.kernel, c_.options.dimension, [&]<typename K, int d>() { forces_of_pairs<K, d>(); });
}

}  // namespace tenon
