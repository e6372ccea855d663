// SPDX-License-Identifier: BSD-3-Clause
// Compressible gases, and shocks in whatever has an equation of state.
#include <algorithm>
#include <cmath>
#include <limits>

#include "components/sph/formulation.hpp"
#include "components/sph/gas_pairs.hpp"
#include "components/sph/particle_pressure.hpp"

namespace tenon {

namespace {

using Switch = ArtificialViscosity::Switch;

/// Densities by summation or continuity, with smoothing lengths that may follow them [SH02, Pri12], and an energy
/// equation:
///   rho_i = sum_j m_j W(h_i)     or     dln rho_i/dt = - div v, exact for uniform expansion
///   a_i   = - sum_j m_j (A_i grad W(h_i) + A_j grad W(h_j)) + viscosity,   A = p/(Omega rho^2)
///   du_i  = sum_j m_j (A_i grad W(h_i) + viscosity/2) . (v_i - v_j) dt
/// with the mean of the velocities before and after the kick in the last line, so that the thermal energy gains what
/// the kinetic energy loses to round-off [Owe14]. Artificial viscosity and conduction with signal speeds [Mon97,
/// Pri08]. The pairs of x(n), and what they do per approach, are kept from the forces to the kick.
class Gas final : public Formulation {
 public:
  explicit Gas(const SphContext& context)
      : c_(context),
        p_(context.particles),
        continuity_(context.options.gas.density == GasOptions::Density::continuity),
        limiter_kind_(context.options.artificial_viscosity.limiter),
        energy_(scalar("energy_half")),
        energy_rate_(scalar("energy_rate")),
        present_energy_(scalar("specific_energy")),
        conduction_(scalar("artificial_conduction")),
        growth_(scalar("density_growth")),
        pressure_(scalar("pressure")),
        sound_(scalar("sound_speed")),
        push_(scalar("pressure_term")),
        limiter_(scalar("viscosity_limiter")),
        stretch_(scalar("kernel_stretch")),
        signal_(scalar("signal_speed")),
        predicted_(p_.add("predicted_velocity", ColumnKind::vector, 3, true)),
        mean_(p_.add("mean_velocity", ColumnKind::vector, 3, false)) {
    require_equations_of_state(context.name, context.options);
    if (continuity_) density_half_ = &scalar("density_half");
    if (limiter_kind_ == Switch::cullen_dehnen) divergence_ = &scalar("divergence");
  }

  void start() override {
    double longest = 0;
    for (std::size_t i = 0; i < p_.owned(); ++i) {
      const SphBody& body = c_.options.bodies[static_cast<std::size_t>(p_.body[i])];
      energy_[i] = body.initial_energy ? (*body.initial_energy)(0, p_.position.vec(i))
                                       : body.material.equation_of_state->initial_energy() / body.material.density;
      limiter_[i] = 1;
      if (continuity_) (*density_half_)[i] = p_.density[i];
      longest = std::max(longest, p_.length[i]);
    }
    longest_at_start_ = c_.comm.max(longest);
    starting_ = true;
  }

  /// What the kick did to the thermal energies, pair by pair; and the smoothing lengths of the next step.
  void settle(double kick) override {
    if (pairs_of_ != c_.decomposition.version()) find_pairs_again();
    for (std::size_t k = 0; k < 3 * p_.owned(); ++k) mean_[k] = 0.5 * (p_.former_velocity[k] + p_.velocity[k]);
    const std::array<Column*, 1> columns{&mean_};
    c_.decomposition.refresh(columns);
    pack(mean_, nullptr, records_.means);
    find_gas_work(pass(), energy_rate_);
    const double dt = 2 * kick - previous_dt_;
    for (std::size_t i = 0; i < p_.owned(); ++i) {
      energy_rate_[i] += conduction_[i];
      energy_[i] += kick * energy_rate_[i];
      if (continuity_) (*density_half_)[i] *= std::exp(kick * growth_[i]);
      if (c_.options.variable_smoothing) p_.length[i] = next_length(i, dt);
    }
  }

  void compute(double, double dt) override {
    if (starting_) agree_at_start();
    starting_ = false;
    for (std::size_t i = 0; i < p_.owned(); ++i) {
      const double half = c_.options.bodies[static_cast<std::size_t>(p_.body[i])].wall ? 0 : 0.5 * dt;
      for (std::size_t k = 3 * i; k < 3 * i + 3; ++k) predicted_[k] = p_.velocity[k] + half * p_.acceleration[k];
      present_energy_[i] = energy_[i] + 0.5 * dt * energy_rate_[i];
      // Of a gas that cools fast.
      if (energy_[i] > 0) present_energy_[i] = std::max(present_energy_[i], 0.5 * energy_[i]);
    }
    const std::array<Column*, 4> first{&p_.position, &predicted_, &p_.length, &present_energy_};
    c_.decomposition.refresh(first);
    find_densities(dt);
    find_pressures(c_.options, p_, &present_energy_, pressure_, sound_);
    for (std::size_t i = 0; i < p_.owned(); ++i)
      push_[i] = pressure_[i] / (stretch_[i] * p_.density[i] * p_.density[i]);
    const std::array<Column*, 5> second{&p_.density, &pressure_, &sound_, &push_, &limiter_};
    c_.decomposition.refresh(second);
    find_forces();
    for (std::size_t i = 0; i < p_.owned(); ++i) {
      p_.acceleration.set(i, forces_[i].acceleration);
      conduction_[i] = forces_[i].conduction;
      growth_[i] = forces_[i].growth;
      signal_[i] = forces_[i].signal;
    }
    previous_dt_ = dt;
  }

  Limit stable_step() const override {
    Limit limit{std::numeric_limits<double>::infinity(), 0};
    const double cfl = c_.options.time_step.cfl;
    for (std::size_t i = 0; i < p_.owned(); ++i) {
      const double h = p_.length[i], a = norm(p_.acceleration.vec(i));
      const double dt = cfl * std::min(h / std::max(signal_[i], 1e-300), std::sqrt(h / std::max(a, 1e-300)));
      if (dt < limit.dt) limit = {dt, i};
    }
    return limit;
  }

  std::vector<ForcePart> forces() override { return {{"internal_energy", &p_.acceleration, nullptr}}; }

  std::vector<ParticleField> fields() override {
    const auto shown = [](std::string name, std::string unit, const Column& column) {
      return ParticleField{{std::move(name), Location::node, FieldKind::point_value, 1, std::move(unit)},
                           [&column](std::size_t i, double* value) { *value = column[i]; }};
    };
    return {shown("pressure", "Pa", pressure_), shown("specific_energy", "J/kg", present_energy_),
            shown("sound_speed", "m/s", sound_)};
  }

  void energies(std::vector<EnergyTerm>& terms) override {
    EnergyTerm& term = terms.emplace_back(EnergyTerm{"internal_energy", EnergyTerm::Role::stored, {}});
    for (std::size_t i = 0; i < p_.owned(); ++i) term.local.add_product(p_.mass[i], energy_[i]);
  }

  void save(CheckpointWriter& file) override {
    file.scalar(c_.name + ".gas_previous_dt", previous_dt_);
    file.scalar(c_.name + ".gas_longest_at_start", longest_at_start_);
  }
  void load(const CheckpointReader& file) override {
    previous_dt_ = file.scalar(c_.name + ".gas_previous_dt");
    longest_at_start_ = file.scalar(c_.name + ".gas_longest_at_start");
  }

  std::int64_t memory() const override {
    std::size_t doubles = 0;
    for (const std::vector<double>* const r : {&records_.places, &records_.motion, &records_.states, &records_.means})
      doubles += r->capacity();
    return pairs_.memory() +
           static_cast<std::int64_t>(doubles * sizeof(double) + densities_.capacity() * sizeof(GasDensity) +
                                     forces_.capacity() * sizeof(GasForce));
  }

 private:
  Column& scalar(const std::string& name) { return p_.add(name, ColumnKind::scalar, 1, true); }
  GasPass pass() { return {c_.options, p_, c_.decomposition.lists(), records_, pairs_, hits_}; }

  /// Three components of one column and one of another, of all particles.
  void pack(const Column& vectors, const Column* scalars, std::vector<double>& records) const {
    records.resize(4 * p_.size());
    for (std::size_t i = 0; i < p_.size(); ++i) {
      for (std::size_t c = 0; c < 3; ++c) records[4 * i + c] = vectors[3 * i + c];
      records[4 * i + 3] = scalars ? (*scalars)[i] : 0;
    }
  }

  void pack_states() {
    records_.states.resize(GasRecord::size * p_.size());
    for (std::size_t i = 0; i < p_.size(); ++i) {
      const std::array<double, GasRecord::size> state{p_.density[i],      sound_[i],   push_[i], pressure_[i],
                                                      present_energy_[i], limiter_[i], 0,        0};
      std::copy(state.begin(), state.end(), records_.states.begin() + static_cast<std::ptrdiff_t>(state.size() * i));
    }
  }

  void sum_densities() {
    pack(p_.position, &p_.length, records_.places);
    pack(predicted_, &p_.mass, records_.motion);
    densities_.resize(p_.owned());
    find_gas_densities(pass(), densities_);
    pairs_of_ = c_.decomposition.version();
  }

  void find_densities(double dt) {
    sum_densities();
    const bool stretches = c_.options.variable_smoothing && !continuity_;
    for (std::size_t i = 0; i < p_.owned(); ++i) {
      p_.density[i] = continuity_ ? (*density_half_)[i] * std::exp(0.5 * dt * growth_[i]) : densities_[i].density;
      // Without a neighbour, or with one that moves away, Omega may come near zero.
      stretch_[i] = stretches ? std::max(densities_[i].stretch, 0.2) : 1;
      if (limiter_kind_ == Switch::balsara)
        limiter_[i] = balsara(i);
      else if (limiter_kind_ == Switch::cullen_dehnen)
        limiter_[i] = cullen_dehnen(i, dt);
    }
  }

  /// Smoothing lengths that agree with the densities they give, and energies with the pressures asked for.
  void agree_at_start() {
    constexpr int budget = 50;
    constexpr double close = 1e-8;
    for (std::size_t k = 0; k < 3 * p_.owned(); ++k) predicted_[k] = p_.velocity[k];
    double change = 1;
    for (int i = 0; i < budget && change > close; ++i) {
      const std::array<Column*, 3> columns{&p_.position, &predicted_, &p_.length};
      c_.decomposition.refresh(columns);
      find_densities(0);
      change = 0;
      for (std::size_t k = 0; k < p_.owned() && c_.options.variable_smoothing; ++k) {
        const double h = next_length(k, 0);
        change = std::max(change, std::abs(h / p_.length[k] - 1));
        p_.length[k] = h;
      }
      change = c_.comm.max(change);
      if (c_.decomposition.used_up()) c_.decomposition.renew();
    }
    for (std::size_t k = 0; k < p_.owned(); ++k) {
      const SphBody& body = c_.options.bodies[static_cast<std::size_t>(p_.body[k])];
      if (!body.initial_energy && body.initial_pressure)
        energy_[k] = energy_of((*body.initial_pressure)(0, p_.position.vec(k)), p_.density[k], body);
    }
  }

  void find_forces() {
    pack_states();
    forces_.resize(p_.owned());
    find_gas_forces(pass(), stretch_, forces_);
  }

  /// After a restart: all that the pairs depend on is in the checkpoint.
  void find_pairs_again() {
    sum_densities();
    find_forces();
  }

  /// [Bal95]: 1 in pure compression, 0 in pure shear.
  double balsara(std::size_t i) const {
    const double div = std::abs(densities_[i].divergence), curl = densities_[i].curl;
    return div / (div + curl + 1e-4 * sound_[i] / p_.length[i] + 1e-300);
  }

  /// [CD10] with the simpler limiter of [Pri18]: viscosity where a compression grows, which fades behind the shock.
  double cullen_dehnen(std::size_t i, double dt) {
    constexpr double decay = 0.05;
    const double div = densities_[i].divergence, curl = densities_[i].curl, h = p_.length[i];
    const double before = (*divergence_)[i];
    (*divergence_)[i] = div;
    if (dt == 0) return limiter_[i];
    const double shear = div * div / (div * div + curl * curl + 1e-300);
    const double growth = div < 0 ? shear * std::max((before - div) / dt, 0.0) : 0;  // 1/s^2
    const double speed = std::max(signal_[i], 1e-300);
    const double wanted = h * h * growth / (speed * speed + h * h * growth);
    if (wanted > limiter_[i]) return wanted;
    const double rate = 2 * decay * speed / h * dt;
    return (limiter_[i] + rate * wanted) / (1 + rate);
  }

  /// h of the density that is to be expected after the next step. A particle alone would grow without end.
  double next_length(std::size_t i, double dt) const {
    const double now = p_.density[i], coming = now * std::exp(std::clamp(dt * growth_[i], -0.7, 0.7));
    const double wanted = c_.options.smoothing * std::pow(p_.mass[i] / coming, 1.0 / c_.options.dimension);
    const double h = std::clamp(wanted, 0.8 * p_.length[i], 1.25 * p_.length[i]);
    return std::min(h, c_.options.gas.greatest_smoothing * longest_at_start_);
  }

  SphContext c_;
  ParticleData& p_;
  bool continuity_;
  Switch limiter_kind_;
  Column &energy_, &energy_rate_, &present_energy_, &conduction_, &growth_, &pressure_, &sound_, &push_, &limiter_,
      &stretch_, &signal_, &predicted_, &mean_;
  Column* density_half_ = nullptr;  // rho(n-1/2), by continuity
  Column* divergence_ = nullptr;    // of the step before
  double previous_dt_ = 0, longest_at_start_ = 0;
  bool starting_ = false;

  PairHits hits_;
  GasPairs pairs_;
  std::int64_t pairs_of_ = -1;  // arrangement that they belong to
  GasRecords records_;
  std::vector<GasDensity> densities_;
  std::vector<GasForce> forces_;
};

}  // namespace

std::unique_ptr<Formulation> make_gas(const SphContext& context) {
  return std::make_unique<Gas>(context);
}

}  // namespace tenon
