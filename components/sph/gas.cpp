// SPDX-License-Identifier: BSD-3-Clause
// Compressible gases, and shocks in whatever has an equation of state.
#include <algorithm>
#include <cmath>
#include <limits>

#include "components/sph/formulation.hpp"
#include "components/sph/kernel_choice.hpp"
#include "components/sph/pair_hits.hpp"
#include "components/sph/particle_pressure.hpp"

namespace tenon {

namespace {

/// Densities by summation, with smoothing lengths that may follow them [SH02, Pri12], and an energy equation:
///   rho_i = sum_j m_j W(h_i)
///   a_i   = - sum_j m_j (A_i grad W(h_i) + A_j grad W(h_j)) + viscosity,   A = p/(Omega rho^2)
///   du_i  = sum_j m_j (A_i grad W(h_i) + viscosity/2) . (v_i - v_j) dt
/// with the mean of the velocities before and after the kick in the last line, so that the thermal energy gains what
/// the kinetic energy loses to round-off [Owe14]. Artificial viscosity and conduction with signal speeds [Mon97,
/// Pri08].
class Gas final : public Formulation {
 public:
  explicit Gas(const SphContext& context)
      : c_(context),
        p_(context.particles),
        energy_(p_.add("energy_half", ColumnKind::scalar, 1, true)),
        energy_rate_(p_.add("energy_rate", ColumnKind::scalar, 1, true)),
        present_energy_(p_.add("specific_energy", ColumnKind::scalar, 1, true)),
        pressure_(p_.add("pressure", ColumnKind::scalar, 1, true)),
        sound_(p_.add("sound_speed", ColumnKind::scalar, 1, true)),
        push_(p_.add("pressure_term", ColumnKind::scalar, 1, true)),
        limiter_(p_.add("viscosity_limiter", ColumnKind::scalar, 1, true)),
        stretch_(p_.add("kernel_stretch", ColumnKind::scalar, 1, true)),
        predicted_(p_.add("predicted_velocity", ColumnKind::vector, 3, true)),
        mean_(p_.add("mean_velocity", ColumnKind::vector, 3, false)),
        signal_(p_.add("signal_speed", ColumnKind::scalar, 1, true)) {
    require_equations_of_state(context.name, context.options);
  }

  void start() override {
    for (std::size_t i = 0; i < p_.owned(); ++i) {
      const SphBody& body = c_.options.bodies[static_cast<std::size_t>(p_.body[i])];
      energy_[i] = body.initial_energy ? (*body.initial_energy)(0, p_.position.vec(i))
                                       : body.material.equation_of_state->initial_energy() / body.material.density;
      limiter_[i] = 1;
    }
  }

  /// What the kick did to the thermal energies, pair by pair; and the smoothing lengths of the next step.
  void settle(double kick) override {
    for (std::size_t k = 0; k < 3 * p_.owned(); ++k) mean_[k] = 0.5 * (p_.former_velocity[k] + p_.velocity[k]);
    const std::array<Column*, 1> columns{&mean_};
    c_.decomposition.refresh(columns);
    with_kernel(c_.options.kernel, c_.options.dimension, [&]<typename K, int d>() { pairs<K, d, true>(mean_); });
    for (std::size_t i = 0; i < p_.owned(); ++i) {
      energy_[i] += kick * energy_rate_[i];
      if (!c_.options.variable_smoothing) continue;
      const double wanted = c_.options.smoothing * std::pow(p_.mass[i] / p_.density[i], 1.0 / c_.options.dimension);
      p_.length[i] = std::clamp(wanted, 0.9 * p_.length[i], 1.1 * p_.length[i]);
    }
  }

  void compute(double, double dt) override {
    for (std::size_t i = 0; i < p_.owned(); ++i) {
      for (std::size_t k = 3 * i; k < 3 * i + 3; ++k) predicted_[k] = p_.velocity[k] + 0.5 * dt * p_.acceleration[k];
      present_energy_[i] = energy_[i] + 0.5 * dt * energy_rate_[i];
      if (!(present_energy_[i] > 0.5 * energy_[i])) present_energy_[i] = 0.5 * energy_[i];  // of a gas that cools fast
    }
    const std::array<Column*, 4> first{&p_.position, &predicted_, &p_.length, &present_energy_};
    c_.decomposition.refresh(first);
    with_kernel(c_.options.kernel, c_.options.dimension, [&]<typename K, int d>() { densities<K, d>(); });
    find_pressures(c_.options, p_, &present_energy_, pressure_, sound_);
    for (std::size_t i = 0; i < p_.owned(); ++i)
      push_[i] = pressure_[i] / (stretch_[i] * p_.density[i] * p_.density[i]);
    const std::array<Column*, 5> second{&p_.density, &pressure_, &sound_, &push_, &limiter_};
    c_.decomposition.refresh(second);
    with_kernel(c_.options.kernel, c_.options.dimension, [&]<typename K, int d>() { pairs<K, d, false>(predicted_); });
  }

  Limit stable_step() const override {
    Limit limit{std::numeric_limits<double>::infinity(), 0};
    for (std::size_t i = 0; i < p_.owned(); ++i) {
      const double dt = c_.options.time_step.cfl * p_.length[i] / std::max(signal_[i], 1e-300);
      if (dt < limit.dt) limit = {dt, i};
    }
    return limit;
  }

  std::vector<ForcePart> forces() override { return {{"internal_energy", &p_.acceleration, nullptr}}; }

  std::vector<ParticleField> fields() override {
    const auto scalar = [](std::string name, std::string unit, const Column& column) {
      return ParticleField{{std::move(name), Location::node, FieldKind::point_value, 1, std::move(unit)},
                           [&column](std::size_t i, double* value) { *value = column[i]; }};
    };
    return {scalar("pressure", "Pa", pressure_), scalar("specific_energy", "J/kg", present_energy_),
            scalar("sound_speed", "m/s", sound_)};
  }

  void energies(std::vector<EnergyTerm>& terms) override {
    EnergyTerm& term = terms.emplace_back(EnergyTerm{"internal_energy", EnergyTerm::Role::stored, {}});
    for (std::size_t i = 0; i < p_.owned(); ++i) term.local.add_product(p_.mass[i], energy_[i]);
  }

 private:
  /// Densities, Omega_i = 1 + h_i/(d rho_i) sum_j m_j dW/dh_i, and Balsara's switch [Bal95].
  template <typename K, int d>
  void densities() {
    constexpr double sigma = K::sigma(d);
    for (std::size_t i = 0; i < p_.owned(); ++i) {
      hits_.find(i, c_.decomposition.lists().of(i), p_.position.data(), p_.length.data(), K::support);
      const double h = p_.length[i];
      double scale = sigma;
      for (int n = 0; n < d; ++n) scale /= h;
      const Vec3 v = predicted_.vec(i);
      WidePack rho{}, change{}, div{}, cx{}, cy{}, cz{};
      for (std::size_t k = 0; k < hits_.padded(); k += wide_pack_width) {
        WidePack m, ux, uy, uz;
        for (int l = 0; l < wide_pack_width; ++l) {
          const auto j = static_cast<std::size_t>(hits_.j[k + static_cast<std::size_t>(l)]);
          m[l] = p_.mass[j];
          ux[l] = v[0] - predicted_[3 * j], uy[l] = v[1] - predicted_[3 * j + 1], uz[l] = v[2] - predicted_[3 * j + 2];
        }
        const WidePack dx = load_wide(&hits_.dx[k]), dy = load_wide(&hits_.dy[k]), dz = load_wide(&hits_.dz[k]);
        const WidePack r2 = load_wide(&hits_.squared[k]), q = square_root(r2) / h;
        m *= load_wide(&hits_.inside[k]);
        const WidePack w = K::template w<d>(q), slope = K::template slope<d>(q);
        rho += m * w;
        change -= m * (d * w + q * q * slope);
        const WidePack g = m * slope;
        div -= g * (ux * dx + uy * dy + uz * dz);
        cx += g * (uz * dy - uy * dz), cy += g * (ux * dz - uz * dx), cz += g * (uy * dx - ux * dy);
      }
      const double self = p_.mass[i] * K::template w<d>(0.0);
      p_.density[i] = scale * (sum_of(rho) + self);
      stretch_[i] = c_.options.variable_smoothing ? 1 + scale * (sum_of(change) - d * self) / (d * p_.density[i]) : 1;
      if (c_.options.artificial_viscosity.limiter == ArtificialViscosity::Switch::none) continue;
      const double rate = scale / (h * h * p_.density[i]);
      const double compression = std::abs(rate * sum_of(div));
      const double curl = rate * norm({sum_of(cx), sum_of(cy), sum_of(cz)});
      limiter_[i] = compression / (compression + curl + 1e-4 * sound_[i] / h + 1e-300);
    }
  }

  /// Forces and rates of thermal energy; or, with the mean velocities of a kick, the rates alone.
  template <typename K, int d, bool rates_alone>
  void pairs(const Column& velocity) {
    constexpr double sigma = K::sigma(d);
    const double alpha = c_.options.artificial_viscosity.alpha.value_or(1),
                 beta = c_.options.artificial_viscosity.beta.value_or(2);
    const double conduction = c_.options.artificial_conduction;
    for (std::size_t i = 0; i < p_.owned(); ++i) {
      hits_.find(i, c_.decomposition.lists().of(i), p_.position.data(), p_.length.data(), K::support);
      const double hi = p_.length[i], rho = p_.density[i], ci = sound_[i], push = push_[i], pressure = pressure_[i];
      const double ui = present_energy_[i], limiter = limiter_[i];
      const Vec3 v = velocity.vec(i), at = predicted_.vec(i);
      WidePack ax{}, ay{}, az{}, rate{}, fastest{};
      for (std::size_t k = 0; k < hits_.padded(); k += wide_pack_width) {
        WidePack m, hj, rho_j, cj, push_j, p_j, u_j, limit_j, ux, uy, uz, sx, sy, sz;
        for (int l = 0; l < wide_pack_width; ++l) {
          const auto j = static_cast<std::size_t>(hits_.j[k + static_cast<std::size_t>(l)]);
          m[l] = p_.mass[j], hj[l] = p_.length[j], rho_j[l] = p_.density[j], cj[l] = sound_[j], push_j[l] = push_[j];
          p_j[l] = pressure_[j], u_j[l] = present_energy_[j], limit_j[l] = limiter_[j];
          ux[l] = v[0] - velocity[3 * j], uy[l] = v[1] - velocity[3 * j + 1], uz[l] = v[2] - velocity[3 * j + 2];
          sx[l] = at[0] - predicted_[3 * j], sy[l] = at[1] - predicted_[3 * j + 1],
          sz[l] = at[2] - predicted_[3 * j + 2];
        }
        const WidePack dx = load_wide(&hits_.dx[k]), dy = load_wide(&hits_.dy[k]), dz = load_wide(&hits_.dz[k]);
        const WidePack r2 = load_wide(&hits_.squared[k]), r = square_root(r2);
        m *= load_wide(&hits_.inside[k]);
        WidePack scale_i = broadcast<WidePack>(sigma / (hi * hi)), scale_j = sigma / (hj * hj);
        for (int n = 0; n < d; ++n) scale_i /= hi, scale_j /= hj;
        const WidePack gi = scale_i * K::template slope<d>(r / hi), gj = scale_j * K::template slope<d>(r / hj);
        const WidePack mean = 0.5 * (gi + gj);
        // Viscosity by what the pair was predicted to do when the kick was made.
        const WidePack along = sx * dx + sy * dy + sz * dz, inverse = 1.0 / (r + 1e-12 * hi);
        const WidePack closing = lesser_of<WidePack>(along * inverse, WidePack{});
        const WidePack signal = 0.5 * alpha * (ci + cj) - beta * closing;
        const WidePack density = 0.5 * (rho + rho_j);
        const WidePack viscous = -0.5 * (limiter + limit_j) * signal * closing * inverse / density;
        // Acceleration along dx is -(m) * (...) * dx, and viscous > 0 pushes apart: -m (-viscous) |slope|.
        const WidePack sticky = viscous * r * mean;
        const WidePack total = -m * (push * gi + push_j * gj + sticky);
        if constexpr (!rates_alone) {
          ax += total * dx, ay += total * dy, az += total * dz;
          fastest = greater_of<WidePack>(fastest, load_wide(&hits_.inside[k]) * (ci + cj - 2 * beta * closing));
        }
        const WidePack work = ux * dx + uy * dy + uz * dz;
        rate += m * (push * gi + 0.5 * sticky) * work;
        const WidePack speed = square_root(greater_of<WidePack>(pressure - p_j, p_j - pressure) / density);
        rate += m * conduction * speed / density * (ui - u_j) * mean * r;
      }
      energy_rate_[i] = sum_of(rate);
      if constexpr (!rates_alone) {
        p_.acceleration.set(i, {sum_of(ax), sum_of(ay), sum_of(az)});
        double most = ci;
        for (int l = 0; l < wide_pack_width; ++l) most = std::max(most, fastest[l]);
        signal_[i] = most;
      }
    }
  }

  SphContext c_;
  ParticleData& p_;
  Column &energy_, &energy_rate_, &present_energy_, &pressure_, &sound_, &push_, &limiter_, &stretch_, &predicted_,
      &mean_, &signal_;
  PairHits hits_;
};

}  // namespace

std::unique_ptr<Formulation> make_gas(const SphContext& context) {
  return std::make_unique<Gas>(context);
}

}  // namespace tenon
