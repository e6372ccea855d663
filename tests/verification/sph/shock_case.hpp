// SPDX-License-Identifier: BSD-3-Clause
// Shock tubes and blasts of particles, with the exact solutions that they are compared with.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "fluid_case.hpp"

namespace tenon::testing {

inline MaterialDescription ideal_gas(double density, double gamma) {
  MaterialDescription material;
  material.name = "gas", material.density = density;
  EquationOfState equation;
  equation.law = IdealGas{gamma, 0};
  material.equation_of_state = equation;
  return material;
}

/// Particles `spacing` apart in a box; 1: along x, 2: without z.
inline MeshData box_of_particles(const Vec3& low, const Vec3& high, double spacing, int dimension) {
  ParticleBox box;
  box.low = low, box.high = high, box.dimension = dimension;
  for (std::size_t c = 0; c < static_cast<std::size_t>(dimension); ++c)
    box.particles[c] = std::max(1, static_cast<int>(std::lround((high[c] - low[c]) / spacing)));
  return generate(box);
}

inline SphScene gas_scene(int dimension) {
  SphScene scene;
  scene.options.dimension = dimension;
  scene.options.formulation = SphFormulation::gas;
  scene.options.variable_smoothing = true;
  scene.options.artificial_conduction = 1;
  return scene;
}

/// Sod's tube [Sod78]: the Riemann problem of (1, 0, 1) and (1/8, 0, 1/10), gamma = 1.4, at time t after the
/// diaphragm at x = 0 broke. Star values from the exact solver of Riemann problems.
struct SodSolution {
  static constexpr double gamma = 1.4;
  static constexpr double p_star = 0.3031301780506468, u_star = 0.9274526200489499;
  static constexpr double left_star = 0.4263194281784952, right_star = 0.2655737117053071;
  static constexpr double shock_speed = 1.7521557320301779;

  struct State {
    double density, velocity, pressure;
  };
  static State at(double x, double t) {
    const double c = std::sqrt(gamma), tail = u_star - std::sqrt(gamma * p_star / left_star), s = x / t;
    if (s < -c) return {1, 0, 1};
    if (s < tail) {
      const double u = 2 / (gamma + 1) * (c + s), ratio = 1 - 0.5 * (gamma - 1) * u / c;
      return {std::pow(ratio, 2 / (gamma - 1)), u, std::pow(ratio, 2 * gamma / (gamma - 1))};
    }
    if (s < u_star) return {left_star, u_star, p_star};
    if (s < shock_speed) return {right_star, u_star, p_star};
    return {0.125, 0, 0.1};
  }
};

/// Equal masses, `dense` particles a unit length at density 1. Mirrors at both ends; in three dimensions periodic
/// across, `across` of the dense ones wide, and half as many of the others, each of them `shaken` in all directions by
/// up to that share of the spacing: of a lattice that is stretched along the tube only planes are left, which lie
/// farther apart than a smoothing length and never mix, as nothing pushes them aside.
/// With the usual spline.
inline SphScene sod_tube(int dense, int dimension, double shaken = 0, int across = 6) {
  SphScene scene = gas_scene(dimension);
  const double spacing = 1.0 / dense, width = across * spacing;
  const double thin = dimension == 1 ? 8 * spacing : 2 * spacing;
  const Vec3 side = dimension == 3 ? Vec3{0, width, width} : Vec3{};
  scene.mesh = particle_bodies({{"left", box_of_particles({-0.5, 0, 0}, Vec3{0, 0, 0} + side, spacing, dimension)},
                                {"right", box_of_particles({0, 0, 0}, Vec3{0.5, 0, 0} + side, thin, dimension)}});
  SphBody left = body_of("left", ideal_gas(1, SodSolution::gamma)),
          right = body_of("right", ideal_gas(0.125, SodSolution::gamma));
  left.initial_energy = SpaceTimeFunction::constant(2.5);
  right.initial_energy = SpaceTimeFunction::constant(2);
  scene.options.bodies = {left, right};
  scene.options.domain.axes[0].low = -0.5, scene.options.domain.axes[0].high = 0.5;
  for (std::size_t c = 1; c < static_cast<std::size_t>(dimension); ++c) {
    scene.options.domain.axes[c].periodic = true;
    scene.options.domain.axes[c].low = 0, scene.options.domain.axes[c].high = width;
  }
  scene.options.kernel = SphKernelKind::cubic_spline;
  scene.options.smoothing = dimension == 1 ? 1.0 : 1.2;
  if (shaken > 0)
    scene.options.displaced = [=](const Vec3& x) {
      const double way = shaken * (x[0] < 0 ? spacing : thin);
      return Vec3{way * noise(x, 1), dimension > 1 ? way * noise(x, 2) : 0, dimension > 2 ? way * noise(x, 3) : 0};
    };
  scene.end = 0.2;
  return scene;
}

/// What a tube looks like at the end, on rank 0.
struct TubeEnd {
  double pressure = 0, velocity = 0, left = 0, right = 0;  ///< means over the plateaus
  double shock = 0;                                        ///< where the pressure is half way up
  double spacing_behind = 0;                               ///< smoothing length behind the shock
  double density_error = 0;                                ///< integral of |rho - exact| over that of rho
  double blip = 0;                                         ///< greatest |p/p* - 1| at the contact
};

inline TubeEnd end_of_tube(const SphRun& run) {
  const std::vector<double> x = run.gathered("position"), rho = run.gathered("density"), p = run.gathered("pressure"),
                            v = run.gathered("velocity"), m = run.gathered("mass"),
                            h = run.gathered("smoothing_length");
  const double t = run.time();
  TubeEnd end;
  double stars = 0, lefts = 0, rights = 0, mass = 0;
  end.shock = -1;
  for (std::size_t i = 0; i < rho.size(); ++i) {
    const double at = x[3 * i], volume = m[i] / rho[i];
    const SodSolution::State exact = SodSolution::at(at, t);
    end.density_error += volume * std::abs(rho[i] - exact.density), mass += volume * exact.density;
    const bool is_left = at > 0.0 && at<0.15, is_right = at> 0.22 && at < 0.32;
    if (is_left) end.left += rho[i], ++lefts;
    if (is_right) end.right += rho[i], end.spacing_behind += h[i], ++rights;
    if (is_left || is_right) end.pressure += p[i], end.velocity += v[3 * i], ++stars;
    if (std::abs(at - SodSolution::u_star * t) < 0.03)
      end.blip = std::max(end.blip, std::abs(p[i] / SodSolution::p_star - 1));
    if (p[i] > 0.5 * (SodSolution::p_star + 0.1)) end.shock = std::max(end.shock, at);
  }
  end.density_error /= mass;
  end.left /= lefts, end.right /= rights, end.spacing_behind /= rights;
  end.pressure /= stars, end.velocity /= stars;
  return end;
}

}  // namespace tenon::testing
