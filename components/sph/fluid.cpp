// SPDX-License-Identifier: BSD-3-Clause
// Weakly compressible fluids.
#include <algorithm>
#include <cmath>
#include <limits>

#include "components/sph/formulation.hpp"
#include "components/sph/kernel_choice.hpp"
#include "components/sph/pair_hits.hpp"
#include "components/sph/particle_pressure.hpp"

namespace tenon {

namespace {

/// One pass over the pairs a step, at x(n), with velocities and densities carried on from the half step behind by the
/// rates of the step before [Mon94]:
///   drho_i/dt = rho_i sum_j V_j (v_i - v_j) . grad W + delta h c sum_j V_j psi_ij . grad W
///   a_i       = - sum_j m_j (p_i + p_j)/(rho_i rho_j) grad W + viscosity.
class Fluid final : public Formulation {
 public:
  explicit Fluid(const SphContext& context)
      : c_(context),
        p_(context.particles),
        density_half_(p_.add("density_half", ColumnKind::scalar, 1, true)),
        density_rate_(p_.add("density_rate", ColumnKind::scalar, 1, true)),
        pressure_(p_.add("pressure", ColumnKind::scalar, 1, true)),
        predicted_(p_.add("predicted_velocity", ColumnKind::vector, 3, false)),
        pressure_acceleration_(p_.add("pressure_acceleration", ColumnKind::vector, 3, true)),
        viscous_acceleration_(p_.add("viscous_acceleration", ColumnKind::vector, 3, true)),
        internal_(p_.add("internal_energy", ColumnKind::scalar, 1, true)),
        viscosity_(p_.add("viscosity_energy", ColumnKind::scalar, 1, true)) {
    require_equations_of_state(context.name, context.options);
    for (const SphBody& body : context.options.bodies) sound_.push_back(undeformed_sound(body));
  }

  void start() override {
    for (std::size_t i = 0; i < p_.owned(); ++i) density_half_[i] = p_.density[i];
  }

  void settle(double kick) override {
    for (std::size_t i = 0; i < p_.owned(); ++i) density_half_[i] += kick * density_rate_[i];
  }

  void compute(double, double dt) override {
    for (std::size_t i = 0; i < p_.owned(); ++i) {
      p_.density[i] = density_half_[i] + 0.5 * dt * density_rate_[i];
      for (std::size_t k = 3 * i; k < 3 * i + 3; ++k) predicted_[k] = p_.velocity[k] + 0.5 * dt * p_.acceleration[k];
      pressure_[i] = pressure(p_.body[i], p_.density[i]);
    }
    const std::array<Column*, 4> columns{&p_.position, &predicted_, &p_.density, &pressure_};
    c_.decomposition.refresh(columns);
    with_kernel(c_.options.kernel, c_.options.dimension, [&]<typename K, int d>() { sum<K, d>(); });
  }

  Limit stable_step() const override {
    Limit limit{std::numeric_limits<double>::infinity(), 0};
    for (std::size_t i = 0; i < p_.owned(); ++i) {
      const double dt = c_.options.time_step.cfl * p_.length[i] /
                        (sound_[static_cast<std::size_t>(p_.body[i])] + norm(p_.velocity.vec(i)));
      if (dt < limit.dt) limit = {dt, i};
    }
    return limit;
  }

  std::vector<ForcePart> forces() override {
    return {{"internal_energy", &pressure_acceleration_, &internal_},
            {"viscosity_energy", &viscous_acceleration_, &viscosity_}};
  }
  std::vector<ParticleField> fields() override {
    return {{{"pressure", Location::node, FieldKind::point_value, 1, "Pa"},
             [this](std::size_t i, double* value) { *value = pressure_[i]; }}};
  }

 private:
  double pressure(std::int32_t body, double density) const {
    const double c = sound_[static_cast<std::size_t>(body)];
    return c * c * (density - c_.options.bodies[static_cast<std::size_t>(body)].material.density);
  }

  template <typename K, int d>
  void sum() {
    constexpr double sigma = K::sigma(d);
    const double alpha = c_.options.artificial_viscosity.alpha.value_or(0.02),
                 delta = c_.options.fluid.density_diffusion;
    for (std::size_t i = 0; i < p_.owned(); ++i) {
      hits_.find(i, c_.decomposition.lists().of(i), p_.position.data(), p_.length.data(), K::support);
      const double rho = p_.density[i], pressure = pressure_[i], c = sound_[static_cast<std::size_t>(p_.body[i])];
      const Vec3 v = predicted_.vec(i);
      WidePack rate{}, px{}, py{}, pz{}, vx{}, vy{}, vz{};
      for (std::size_t k = 0; k < hits_.padded(); k += wide_pack_width) {
        WidePack m, rho_j, p_j, v_x, v_y, v_z;
        for (int l = 0; l < wide_pack_width; ++l) {
          const auto j = static_cast<std::size_t>(hits_.j[k + static_cast<std::size_t>(l)]);
          m[l] = p_.mass[j], rho_j[l] = p_.density[j], p_j[l] = pressure_[j];
          v_x[l] = v[0] - predicted_[3 * j], v_y[l] = v[1] - predicted_[3 * j + 1];
          v_z[l] = v[2] - predicted_[3 * j + 2];
        }
        const WidePack dx = load_wide(&hits_.dx[k]), dy = load_wide(&hits_.dy[k]), dz = load_wide(&hits_.dz[k]);
        const WidePack h = load_wide(&hits_.h[k]), r2 = load_wide(&hits_.squared[k]);
        const WidePack q = square_root(r2) / h;
        WidePack scale = sigma / (h * h);
        for (int n = 0; n < d; ++n) scale = scale / h;
        const WidePack slope = load_wide(&hits_.inside[k]) * scale * K::template slope<d>(q);
        const WidePack approach = v_x * dx + v_y * dy + v_z * dz;
        const WidePack volume = m / rho_j;
        const WidePack diffusion = 2 * delta * c * h * (rho - rho_j) * r2 / (r2 + 0.01 * h * h);
        rate += volume * slope * (rho * approach - 0.0 * h) + volume * slope * diffusion;
        const WidePack push = -(volume / rho) * (pressure + p_j) * slope;
        px += push * dx, py += push * dy, pz += push * dz;
        const WidePack drag = m * (alpha * c * h / (0.5 * (rho + rho_j))) * approach / (r2 + 0.01 * h * h) * slope;
        vx += drag * dx, vy += drag * dy, vz += drag * dz;
      }
      density_rate_[i] = sum_of(rate);
      pressure_acceleration_.set(i, {sum_of(px), sum_of(py), sum_of(pz)});
      viscous_acceleration_.set(i, {sum_of(vx), sum_of(vy), sum_of(vz)});
      p_.acceleration.set(i, pressure_acceleration_.vec(i) + viscous_acceleration_.vec(i));
    }
  }

  SphContext c_;
  ParticleData& p_;
  Column &density_half_, &density_rate_, &pressure_, &predicted_, &pressure_acceleration_, &viscous_acceleration_,
      &internal_, &viscosity_;
  std::vector<double> sound_;  // of bodies, m/s
  PairHits hits_;
};

}  // namespace

std::unique_ptr<Formulation> make_fluid(const SphContext& context) {
  return std::make_unique<Fluid>(context);
}

}  // namespace tenon
