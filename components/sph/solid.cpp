// SPDX-License-Identifier: BSD-3-Clause
// Solids, updated Lagrangian.
#include <algorithm>
#include <cmath>
#include <limits>

#include "components/sph/formulation.hpp"
#include "components/sph/kernel_choice.hpp"
#include "components/sph/matrix3.hpp"
#include "components/sph/pair_hits.hpp"
#include "components/sph/particle_heat.hpp"
#include "components/sph/solid_materials.hpp"

namespace tenon {

namespace {

/// On the present neighbours, with corrected gradients [RL96, BL99]:
///   dt grad v = sum_j V_j (v_j - v_i) (M_i^-1 grad W), in the geometry half way through the step [HW80]
///   rho       follows from it: exactly for motions that are linear in space
///   a_i       = V_i/m_i sum_j V_j (sigma_i M_i^-1 + sigma_j M_j^-1) grad W + viscosity + artificial stress.
/// The forces do the work sum V sigma : grad v of the same gradients, which see no strain in a rotation: linear and
/// angular momentum are kept. Volumes in sums are those of the start of the step.
class Solid final : public Formulation {
 public:
  explicit Solid(const SphContext& context)
      : c_(context),
        p_(context.particles),
        pushed_(p_.add("internal_acceleration", ColumnKind::vector, 3, true)),
        dragged_(p_.add("viscous_acceleration", ColumnKind::vector, 3, true)),
        parted_(p_.add("artificial_stress_acceleration", ColumnKind::vector, 3, true)),
        internal_(p_.add("internal_energy", ColumnKind::scalar, 1, true)),
        viscosity_(p_.add("viscosity_energy", ColumnKind::scalar, 1, true)),
        artificial_(p_.add("artificial_stress_energy", ColumnKind::scalar, 1, true)),
        heating_(p_.add("viscous_heating", ColumnKind::scalar, 1, true)),
        step_(p_.add("stable_step", ColumnKind::scalar, 1, true)),
        predicted_(p_.add("predicted_velocity", ColumnKind::vector, 3, false)),
        gradient_(p_.add("velocity_gradient", ColumnKind::matrix, 9, false)),
        correction_(p_.add("correction", ColumnKind::matrix, 9, false)),
        push_(p_.add("corrected_stress", ColumnKind::matrix, 9, false)),
        volume_(p_.add("volume", ColumnKind::scalar, 1, false)),
        sound_(p_.add("sound_speed", ColumnKind::scalar, 1, false)),
        materials_(context.name, context.options, p_) {}

  void start() override {
    materials_.start(c_.heat->temperature());
    for (std::size_t i = 0; i < p_.owned(); ++i)
      if (const auto& pressure = body(i).initial_pressure) {
        const double p = (*pressure)(0, p_.position.vec(i));
        for (std::size_t c = 0; c < 3; ++c) materials_.stress[6 * i + c] = -p;
      }
  }

  /// Its element left neither stress nor history; the heat stays with what it brought.
  double wake(std::size_t particle, double) override {
    c_.heat->wake(0, particle);
    materials_.start(particle, c_.heat->temperature()[particle]);
    return 0;
  }

  void compute(double, double dt) override {
    for (std::size_t k = 0; k < 3 * p_.owned(); ++k) predicted_[k] = p_.velocity[k] + 0.5 * dt * p_.acceleration[k];
    const std::array<Column*, 4> places{&p_.position, &p_.velocity, &predicted_, &p_.density};
    c_.decomposition.refresh(places);
    for (std::size_t i = 0; i < p_.size(); ++i) volume_[i] = p_.mass[i] / p_.density[i];
    with_kernel(c_.options.kernel, c_.options.dimension, [&]<typename K, int d>() { gradients<K, d>(dt); });
    deform(dt);
    const std::array<Column*, 4> pushes{&push_, &sound_, &p_.density, &materials_.stress};
    c_.decomposition.refresh(std::span(pushes).first(c_.options.solid.artificial_stress > 0 ? 4 : 3));
    with_kernel(c_.options.kernel, c_.options.dimension, [&]<typename K, int d>() { pairs<K, d>(); });
    for (std::size_t i = 0; dt > 0 && i < p_.owned(); ++i) c_.heat->add_plastic(i, materials_.plastic_heat[i]);
  }

  Limit stable_step() const override {
    Limit limit{std::numeric_limits<double>::infinity(), 0};
    for (std::size_t i = 0; i < p_.owned(); ++i)
      if (step_[i] < limit.dt) limit = {step_[i], i};
    return limit;
  }

  std::vector<ForcePart> forces() override {
    std::vector<ForcePart> parts{{"internal_energy", &pushed_, &internal_},
                                 {"viscosity_energy", &dragged_, &viscosity_}};
    if (c_.options.solid.artificial_stress > 0) parts.push_back({"artificial_stress_energy", &parted_, &artificial_});
    return parts;
  }

  std::vector<ParticleField> fields() override {
    std::vector<ParticleField> fields{
        {{"stress", Location::node, FieldKind::point_value, 6, "Pa"},
         [this](std::size_t i, double* value) { std::copy_n(materials_.stress.data() + 6 * i, 6, value); }}};
    const auto scalar = [&](const char* name, auto read) {
      fields.push_back({{name, Location::node, FieldKind::point_value, 1, "1"},
                        [this, read](std::size_t i, double* value) { *value = read(materials_, i); }});
    };
    if (materials_.any_plastic()) scalar("eqps", [](const SolidMaterials& m, std::size_t i) { return m.eqps(i); });
    if (materials_.can_fail()) scalar("damage", [](const SolidMaterials& m, std::size_t i) { return m.damage(i); });
    return fields;
  }

  void energies(std::vector<EnergyTerm>& terms) override {
    if (!materials_.any_plastic()) return;
    EnergyTerm& term = terms.emplace_back(EnergyTerm{"plastic_work", EnergyTerm::Role::memo, {}});
    term.local.add(std::span(materials_.plastic_work.values).first(p_.owned()));
  }
  std::vector<HistoryValue> history_values() override {
    if (!materials_.any_plastic()) return {};
    double most = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < p_.owned(); ++i) most = std::max(most, materials_.eqps(i));
    return {{"max_eqps", HistoryValue::Reduce::max, most}};
  }

 private:
  const SphBody& body(std::size_t i) const { return c_.options.bodies[static_cast<std::size_t>(p_.body[i])]; }

  /// Eight pairs: what the kernel makes of them.
  template <typename K, int d>
  static WidePack slope_of(const WidePack& squared, const WidePack& h) {
    WidePack scale = K::sigma(d) / (h * h);
    for (int n = 0; n < d; ++n) scale = scale / h;
    return scale * K::template slope<d>(square_root(squared) / h);
  }

  /// dt grad v half way through the step, and the correction of gradients at its end.
  template <typename K, int d>
  void gradients(double dt) {
    for (std::size_t i = 0; i < p_.owned(); ++i) {
      hits_.find(i, c_.decomposition.lists().of(i), p_.position.data(), p_.length.data(), K::support);
      const Vec3 v = p_.velocity.vec(i);
      WidePack now[9]{}, middle[9]{}, change[9]{};
      for (std::size_t k = 0; k < hits_.padded(); k += wide_pack_width) {
        WidePack V, w[3];
        for (int l = 0; l < wide_pack_width; ++l) {
          const auto j = static_cast<std::size_t>(hits_.j[k + static_cast<std::size_t>(l)]);
          V[l] = volume_[j];
          for (std::size_t c = 0; c < 3; ++c) w[c][l] = p_.velocity[3 * j + c] - v[c];
        }
        const WidePack D[3] = {load_wide(&hits_.dx[k]), load_wide(&hits_.dy[k]), load_wide(&hits_.dz[k])};
        const WidePack h = load_wide(&hits_.h[k]);
        V *= load_wide(&hits_.inside[k]);
        const WidePack s = V * slope_of<K, d>(load_wide(&hits_.squared[k]), h);
        WidePack M[3], squared{};
        for (int c = 0; c < d; ++c) M[c] = D[c] + (0.5 * dt) * w[c], squared += M[c] * M[c];
        const WidePack t = V * slope_of<K, d>(squared, h);
        for (int r = 0; r < d; ++r)
          for (int c = 0; c < d; ++c) {
            now[3 * r + c] -= s * (D[r] * D[c]);
            middle[3 * r + c] -= t * (M[r] * M[c]);
            change[3 * r + c] += t * (w[r] * M[c]);
          }
      }
      Matrix3 moment = identity3, moment_middle = identity3, moved{};
      for (std::size_t r = 0; r < d; ++r)
        for (std::size_t c = 0; c < d; ++c) {
          const std::size_t n = 3 * r + c;
          moment[n] = sum_of(now[n]), moment_middle[n] = sum_of(middle[n]), moved[n] = dt * sum_of(change[n]);
        }
      set_matrix(correction_, i, gradient_correction(moment, d));
      if (dt > 0) set_matrix(gradient_, i, product(moved, transposed(gradient_correction(moment_middle, d))));
    }
  }

  /// Densities, stresses, and stresses as pairs feel them. Where x1 - x0 = G (x1 + x0)/2, volumes grow by
  /// det(1 + G/2)/det(1 - G/2).
  void deform(double dt) {
    if (dt > 0) {
      for (std::size_t i = 0; i < p_.owned(); ++i) {
        const Matrix3 half = 0.5 * matrix_of(gradient_, i);
        p_.density[i] *= determinant(identity3 - half) / determinant(identity3 + half);
        if (!(p_.density[i] > 0)) p_.density[i] = std::numeric_limits<double>::quiet_NaN();
      }
      materials_.update({dt, gradient_, c_.heat->temperature(), heating_, nullptr}, c_.decomposition.version());
    }
    for (std::size_t i = 0; i < p_.owned(); ++i) {
      const double growth = p_.mass[i] / (p_.density[i] * volume_[i]);
      set_matrix(push_, i, product(growth * matrix_of_tensor(materials_.stress, i), matrix_of(correction_, i)));
      sound_[i] = std::sqrt(std::max(materials_.modulus[i], 0.0) / p_.density[i]);
    }
  }

  template <typename K, int d>
  void pairs() {
    const double alpha = c_.options.artificial_viscosity.alpha.value_or(solid_alpha),
                 beta = c_.options.artificial_viscosity.beta.value_or(solid_beta);
    const bool parting = c_.options.solid.artificial_stress > 0;
    for (std::size_t i = 0; i < p_.owned(); ++i) {
      hits_.find(i, c_.decomposition.lists().of(i), p_.position.data(), p_.length.data(), K::support);
      const Matrix3 Q = matrix_of(push_, i);
      const Vec3 v = predicted_.vec(i);
      const double rho = p_.density[i], c_i = sound_[i];
      WidePack f[3]{}, a[3]{}, heating{}, fastest{};
      for (std::size_t k = 0; k < hits_.padded(); k += wide_pack_width) {
        WidePack V, m, rho_j, c_j, Qj[9], w[3];
        for (int l = 0; l < wide_pack_width; ++l) {
          const auto j = static_cast<std::size_t>(hits_.j[k + static_cast<std::size_t>(l)]);
          V[l] = volume_[j], m[l] = p_.mass[j], rho_j[l] = p_.density[j], c_j[l] = sound_[j];
          for (std::size_t n = 0; n < 9; ++n) Qj[n][l] = push_[9 * j + n];
          for (std::size_t c = 0; c < 3; ++c) w[c][l] = v[c] - predicted_[3 * j + c];
        }
        const WidePack D[3] = {load_wide(&hits_.dx[k]), load_wide(&hits_.dy[k]), load_wide(&hits_.dz[k])};
        const WidePack h = load_wide(&hits_.h[k]), squared = load_wide(&hits_.squared[k]);
        const WidePack slope = load_wide(&hits_.inside[k]) * slope_of<K, d>(squared, h), s = V * slope;
        WidePack approach{};
        for (int r = 0; r < d; ++r) {
          WidePack pushed{};
          for (int c = 0; c < d; ++c) pushed += (Q[static_cast<std::size_t>(3 * r + c)] + Qj[3 * r + c]) * D[c];
          f[r] += s * pushed;
          approach += w[r] * D[r];
        }
        const WidePack inverse = 1.0 / (square_root(squared) + 1e-12 * h);
        const WidePack closing = load_wide(&hits_.inside[k]) * lesser_of<WidePack>(approach * inverse, WidePack{});
        const WidePack viscosity = (beta * closing - 0.5 * alpha * (c_i + c_j)) * closing / (0.5 * (rho + rho_j));
        const WidePack dragging = -m * viscosity * slope;
        for (int r = 0; r < d; ++r) a[r] += dragging * D[r];
        heating -= 0.5 * dragging * approach;
        fastest = greater_of<WidePack>(fastest, -closing);
      }
      const double share = volume_[i] / p_.mass[i];
      pushed_.set(i, share * Vec3{sum_of(f[0]), sum_of(f[1]), sum_of(f[2])});
      dragged_.set(i, {sum_of(a[0]), sum_of(a[1]), sum_of(a[2])});
      heating_[i] = sum_of(heating);
      if (parting) parted_.set(i, artificial_stress<K, d>(i));
      p_.acceleration.set(i, (pushed_.vec(i) + dragged_.vec(i)) + parted_.vec(i));
      double most = 0;
      for (int l = 0; l < wide_pack_width; ++l) most = std::max(most, fastest[l]);
      step_[i] = c_.options.time_step.cfl * p_.length[i] /
                 (sound_[i] * (1 + 0.6 * alpha) + 1.2 * beta * most + norm(v) + 1e-300);
    }
  }

  /// Against tensile instability [Mon00, GMS01]: pairs under tension repel by a share of it that grows fast as they
  /// come nearer than their spacing. The tension is that along the line of the pair, so that angular momentum is kept.
  template <typename K, int d>
  Vec3 artificial_stress(std::size_t i) const {
    constexpr double power = 4;
    const double at_spacing = K::template w<d>(1 / c_.options.smoothing);
    const auto tension = [&](std::size_t j, const Vec3& n) {
      const double* const s = materials_.stress.data() + 6 * j;
      const double along = s[0] * n[0] * n[0] + s[1] * n[1] * n[1] + s[2] * n[2] * n[2] +
                           2 * (s[3] * n[0] * n[1] + s[4] * n[1] * n[2] + s[5] * n[2] * n[0]);
      return std::max(along, 0.0) / (p_.density[j] * p_.density[j]);
    };
    Vec3 sum{};
    for (std::size_t k = 0; k < hits_.count; ++k) {
      const double h = hits_.h[k], r = std::sqrt(hits_.squared[k]);
      if (!(r > 1e-12 * h)) continue;
      const auto j = static_cast<std::size_t>(hits_.j[k]);
      const Vec3 D{hits_.dx[k], hits_.dy[k], hits_.dz[k]}, n = (1 / r) * D;
      const double near = std::pow(K::template w<d>(r / h) / at_spacing, power);
      const double slope = K::sigma(d) / std::pow(h, d + 2) * K::template slope<d>(r / h);
      const double both = c_.options.solid.artificial_stress * (tension(i, n) + tension(j, n));
      sum = sum + (-p_.mass[j] * both * near * slope) * D;
    }
    return sum;
  }

  SphContext c_;
  ParticleData& p_;
  Column &pushed_, &dragged_, &parted_, &internal_, &viscosity_, &artificial_, &heating_, &step_, &predicted_,
      &gradient_, &correction_, &push_, &volume_, &sound_;
  SolidMaterials materials_;
  PairHits hits_;
};

}  // namespace

std::unique_ptr<Formulation> make_solid(const SphContext& context) {
  return std::make_unique<Solid>(context);
}

}  // namespace tenon
