// SPDX-License-Identifier: BSD-3-Clause
// The Lame mode of a free cube (case A04): exact for any Poisson ratio, since it changes no volume.
#pragma once

#include <numbers>

#include "solid_meshes.hpp"

namespace tenon::testing {

struct LameMode {
  double edge = 0.1;
  MaterialDescription material = steel();
  MechanicsOptions::Formulation formulation = MechanicsOptions::Formulation::automatic;
  HourglassOptions hourglass{HourglassOptions::Form::viscous, 0.01};
  BulkViscosity viscosity{0, 0};
  double periods = 1;

  double omega() const {
    return std::sqrt(2.0) * std::numbers::pi / edge * std::sqrt(material.elastic->shear_modulus() / material.density);
  }
  Vec3 shape(const Vec3& x) const {
    const double a = std::numbers::pi / edge;
    return {std::cos(a * x[0]) * std::sin(a * x[1]), -std::sin(a * x[0]) * std::cos(a * x[1]), 0};
  }

  /// Relative error of the Rayleigh quotient of the exact shape, as a frequency: what the elements make of the mode.
  double quotient_error(MeshData&& mesh) const {
    const auto m = make(std::move(mesh));
    const double dt = 1e-9;
    m->advance(dt);
    double work = 0, mass = 0;
    const std::vector<double> v = field(*m, "velocity");
    for (std::size_t i = 0; i < m->mesh().coordinates.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c) {
        work += m->internal_force()[i].v[c] * v[3 * i + c] / dt;
        mass += m->nodal_mass()[i] * v[3 * i + c] * v[3 * i + c];
      }
    return std::sqrt(work / mass) / omega() - 1;
  }

  /// Relative error of the frequency, from the greatest displacement that the mode reaches from its initial velocity:
  /// velocity over frequency. An element that locks hardly moves.
  double frequency_error(MeshData&& mesh) const {
    const auto m = make(std::move(mesh));
    double most = 0;
    while (m->time() < periods * 2 * std::numbers::pi / omega()) {
      m->advance(m->time_step());
      const std::vector<double> u = field(*m, "displacement");
      double amplitude = 0, size = 0;
      for (std::size_t i = 0; i < m->mesh().coordinates.size(); ++i) {
        const Vec3 s = shape(m->mesh().coordinates[i]);
        for (std::size_t c = 0; c < 3; ++c) {
          amplitude += m->nodal_mass()[i] * u[3 * i + c] * s[c];
          size += m->nodal_mass()[i] * s[c] * s[c];
        }
      }
      most = std::max(most, amplitude / size);
    }
    return 0.01 / (omega() * most) - 1;
  }

 private:
  std::unique_ptr<Mechanics> make(MeshData&& mesh) const {
    MechanicsOptions options;
    options.viscosity = viscosity;
    options.hourglass = hourglass;
    options.initial_velocity_function = [this](const Vec3& x) { return 0.01 * shape(x); };
    auto m = solid_body(shared_mesh(std::move(mesh)), material, formulation, options);
    m->initialize();
    return m;
  }
};

inline BoxShape lame_cube(int n, double distortion) {
  BoxShape box;
  box.high = {0.1, 0.1, 0.1};
  box.elements = {n, n, n};
  box.distortion = distortion;
  return box;
}

}  // namespace tenon::testing
