// SPDX-License-Identifier: BSD-3-Clause
// Weakly compressible fluids.
#include <algorithm>
#include <cmath>
#include <limits>

#include "components/sph/fluid_pairs.hpp"
#include "components/sph/fluid_walls.hpp"
#include "components/sph/formulation.hpp"
#include "components/sph/particle_pressure.hpp"
#include "framework/base/error.hpp"

namespace tenon {

namespace {

/// One pass over the pairs a step, at x(n), with velocities and densities carried on from the half step behind by the
/// rates of the step before [Mon94]; walls take a pass of their own. Sums: FluidPass.
class Fluid final : public Formulation {
 public:
  explicit Fluid(const SphContext& context)
      : c_(context),
        p_(context.particles),
        density_half_(p_.add("density_half", ColumnKind::scalar, 1, true)),
        density_rate_(p_.add("density_rate", ColumnKind::scalar, 1, true)),
        pressure_(p_.add("pressure", ColumnKind::scalar, 1, true)),
        sound_(p_.add("sound_speed", ColumnKind::scalar, 1, true)),
        places_(p_.add("places", ColumnKind::position, 4, false)),
        states_(p_.add("states", ColumnKind::vector, FluidRecord::size, false)),
        pressure_acceleration_(p_.add("pressure_acceleration", ColumnKind::vector, 3, true)),
        viscous_acceleration_(p_.add("viscous_acceleration", ColumnKind::vector, 3, true)),
        internal_(p_.add("internal_energy", ColumnKind::scalar, 1, true)),
        viscosity_(p_.add("viscosity_energy", ColumnKind::scalar, 1, true)) {
    require_equations_of_state(context.name, context.options);
    require_stiffness(context.name, context.options);
    for (const SphBody& body : context.options.bodies) walls_ = walls_ || body.wall;
    const FluidOptions& fluid = c_.options.fluid;
    if (walls_ && !fluid.slip) slip_ = &p_.add("slip_velocity", ColumnKind::vector, 4, false);
    if (fluid.shifting != FluidOptions::Shifting::none) {
      crowding_ = &p_.add("crowding", ColumnKind::scalar, 4, true);
      transport_ = &p_.add("transport_velocity", ColumnKind::vector, 3, false);
    }
    for (const SphBody& body : context.options.bodies) describe(body);
  }

  void start() override {
    for (std::size_t i = 0; i < p_.owned(); ++i) {
      const SphBody& body = body_of(i);
      if (body.initial_pressure) {
        const double volume = p_.mass[i] / p_.density[i];
        p_.density[i] = density_of((*body.initial_pressure)(0, p_.position.vec(i)), body);
        if (!body.wall) p_.mass[i] = p_.density[i] * volume;
      }
      density_half_[i] = p_.density[i];
    }
  }

  double wake(std::size_t particle, double) override {
    density_half_[particle] = p_.density[particle];
    return 0;
  }

  void settle(double kick) override {
    for (std::size_t i = 0; i < p_.owned(); ++i) density_half_[i] += kick * density_rate_[i];
    if (transport_) find_transport(kick);
  }

  void compute(double time, double dt) override {
    if (!lengths_known_) compare_lengths();
    for (std::size_t i = 0; i < p_.owned(); ++i) p_.density[i] = density_half_[i] + 0.5 * dt * density_rate_[i];
    find_pressures(c_.options, p_, nullptr, pressure_, sound_);
    pack(0, p_.owned(), dt);
    const std::array<Column*, 2> records{&places_, &states_};
    c_.decomposition.refresh(records);
    find_gravity(time, dt);
    if (walls_) {
      extrapolate_to_walls(c_.options, {p_, c_.decomposition.lists(), places_, states_, slip_, pull_,
                                        -c_.options.fluid.background_pressure, hits_});
      const std::array<Column*, 2> walls{&states_, slip_};
      c_.decomposition.refresh(std::span(walls).first(slip_ ? 2 : 1));
      for (std::size_t i = 0; i < p_.owned(); ++i)
        if (body_of(i).wall) pressure_[i] = states_[FluidRecord::size * i + 4] - c_.options.fluid.background_pressure;
    }
    sum_fluid_pairs(c_.options, {p_, c_.decomposition.lists(), places_, states_, slip_, laws_,
                                 c_.options.fluid.viscosity == FluidOptions::Viscosity::morris,
                                 lengths_equal_ && c_.options.bodies.size() == 1 && !crowding_, density_rate_,
                                 pressure_acceleration_, viscous_acceleration_, p_.acceleration, crowding_, hits_});
  }

  const Column* transport() const override { return transport_; }

  /// Sound over the smoothing length, acceleration, and viscosity [MFZ97].
  Limit stable_step() const override {
    Limit limit{std::numeric_limits<double>::infinity(), 0};
    const double cfl = c_.options.time_step.cfl;
    for (std::size_t i = 0; i < p_.owned(); ++i) {
      const auto body = static_cast<std::size_t>(p_.body[i]);
      const double h = p_.length[i];
      double dt = cfl * h / (sound_[i] + norm(p_.velocity.vec(i)));
      if (!laws_[body].wall) {
        const Vec3 a = p_.acceleration.vec(i);
        const double squared = dot(a, a);
        if (squared * dt * dt * dt * dt > cfl * cfl * cfl * cfl * h * h) dt = cfl * std::sqrt(h / std::sqrt(squared));
        dt = std::min(dt, 0.5 * cfl * h * h * p_.density[i] / viscous_[body]);
      }
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
  const SphBody& body_of(std::size_t i) const { return c_.options.bodies[static_cast<std::size_t>(p_.body[i])]; }

  void describe(const SphBody& body) {
    const FluidOptions& fluid = c_.options.fluid;
    const double sound = undeformed_sound(body), density = body.material.density;
    laws_.push_back({2 * fluid.density_diffusion * sound, {}, body.wall, sound, density});
    // The force of [Mon92] has alpha h c rho in the place of 2 (d + 2) times the viscosity [Mon05].
    const double of_material = body.material.viscosity.value_or(0);
    viscous_.push_back(body.wall ? 0 : of_material);
    const double alpha = c_.options.artificial_viscosity.alpha.value_or(0.02);
    using Form = FluidOptions::Viscosity;
    factor_.push_back(fluid.viscosity == Form::artificial ? alpha * sound * density
                      : fluid.viscosity == Form::monaghan ? 2 * (c_.options.dimension + 2) * of_material
                                                          : of_material);
    pull_.push_back({});
  }

  /// Density at which the pressure is that, between a third and three times that of the material.
  double density_of(double pressure, const SphBody& body) const {
    const auto at = [&](double density) {
      PressureLaw law;
      LaneValues volume;
      for (double& v : volume) v = body.material.density / density;
      const EquationOfState& state = *body.material.equation_of_state;
      state.evaluate(volume, law);
      return law.A[0] + law.B[0] * state.initial_energy();
    };
    double low = body.material.density / 3, high = 3 * body.material.density;
    for (int halving = 0; halving < 60; ++halving) {
      const double middle = 0.5 * (low + high);
      (at(middle) < pressure ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }

  void compare_lengths() {
    std::array<double, 2> ends{0, -std::numeric_limits<double>::infinity()};
    for (std::size_t i = 0; i < p_.owned(); ++i)
      ends = {std::max(ends[0], p_.length[i]), std::max(ends[1], -p_.length[i])};
    c_.comm.max(std::span<double>(ends));
    lengths_equal_ = ends[0] == -ends[1];
    lengths_known_ = true;
  }

  /// Records of particles at x(n), with v(n) and rho(n).
  void pack(std::size_t first, std::size_t last, double dt) {
    const bool artificial = c_.options.fluid.viscosity == FluidOptions::Viscosity::artificial;
    for (std::size_t i = first; i < last; ++i) {
      const auto body = static_cast<std::size_t>(p_.body[i]);
      const bool wall = laws_[body].wall;
      double* const place = places_.data() + 4 * i;
      double* const state = states_.data() + FluidRecord::size * i;
      for (std::size_t c = 0; c < 3; ++c) {
        place[c] = p_.position[3 * i + c];
        state[c] = p_.velocity[3 * i + c] + (wall ? 0 : 0.5 * dt * p_.acceleration[3 * i + c]);
      }
      place[3] = p_.length[i];
      state[3] = p_.density[i];
      state[4] = pressure_[i] + c_.options.fluid.background_pressure;
      state[5] = p_.mass[i] / p_.density[i];
      state[6] = artificial ? factor_[body] * p_.length[i] : factor_[body];
      state[7] = wall ? -1.0 - static_cast<double>(body) : static_cast<double>(body);
    }
  }

  /// Of this time: what it does to walls, and the density that it makes.
  void find_gravity(double time, double dt) {
    Vec3 g{};
    for (std::size_t c = 0; c < 3; ++c) g[c] = c_.options.gravity[c](time);
    for (std::size_t b = 0; b < laws_.size(); ++b) {
      const SphBody& body = c_.options.bodies[b];
      const double density = body.material.density, modulus = body.material.equation_of_state->bulk_modulus();
      if (c_.options.fluid.hydrostatic_diffusion) laws_[b].hydrostatic = density * density / modulus * g;
      pull_[b] = g;
      if (body.wall && dt > 0)
        for (std::size_t c = 0; c < 3; ++c)
          pull_[b][c] -= (body.velocity[c](time + 0.5 * dt) - body.velocity[c](time - 0.5 * dt)) / dt;
    }
  }

  void find_transport(double kick);

  SphContext c_;
  ParticleData& p_;
  Column &density_half_, &density_rate_, &pressure_, &sound_, &places_, &states_, &pressure_acceleration_,
      &viscous_acceleration_, &internal_, &viscosity_;
  Column *slip_ = nullptr, *crowding_ = nullptr, *transport_ = nullptr;
  bool walls_ = false, lengths_known_ = false, lengths_equal_ = false;
  // Of bodies.
  std::vector<FluidBody> laws_;
  std::vector<double> viscous_, factor_;  // Pa s; factor of the viscous force, over h where it is artificial
  std::vector<Vec3> pull_;                // m/s^2
  PairHits hits_;
};

// Shifting [LXSR12, SLSR13]: 2 h |v| against the gradient of the concentration, at most a fifth of the speed; less near
// a free surface, where the divergence of the places falls from d to d/2 [LMX08], and none at it. Transport velocity
// [AHA13]: the background pressure rho c^2 would do it in half a step.
void Fluid::find_transport(double kick) {
  const FluidOptions& fluid = c_.options.fluid;
  const bool by_pressure = fluid.shifting == FluidOptions::Shifting::transport_velocity;
  const double d = c_.options.dimension;
  for (std::size_t i = 0; i < p_.owned(); ++i) {
    const Vec3 v = p_.velocity.vec(i);
    transport_->set(i, v);
    if (body_of(i).wall) continue;
    const double* const crowd = crowding_->data() + 4 * i;
    Vec3 shift{crowd[0], crowd[1], crowd[2]};
    const double h = p_.length[i], c = sound_[i];
    if (by_pressure) {
      shift = -fluid.shifting_strength * kick * c * c * shift;
    } else {
      const double speed = norm(v), depth = std::clamp((crowd[3] - 0.75 * d) / (0.15 * d), 0.0, 1.0);
      shift = -2 * fluid.shifting_strength * h * speed * depth * shift;
      const double size = norm(shift), most = 0.2 * speed;
      if (size > most) shift = most / size * shift;
    }
    transport_->set(i, v + shift);
  }
}

}  // namespace

std::unique_ptr<Formulation> make_fluid(const SphContext& context) {
  return std::make_unique<Fluid>(context);
}

}  // namespace tenon
