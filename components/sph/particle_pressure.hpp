// SPDX-License-Identifier: BSD-3-Clause
// Pressure and speed of sound of particles from their equations of state.
#pragma once

#include <cstddef>
#include <string>

#include "components/sph/particle_data.hpp"
#include "components/sph/sph_options.hpp"

namespace tenon {

/// Throws Error(usage) naming the body (and the component) whose material has no equation of state.
void require_equations_of_state(const std::string& component, const SphOptions& options);

/// Throws Error(usage) if a material is not stiff at rest (ideal gas without energy): pressure from density alone needs
/// it.
void require_stiffness(const std::string& component, const SphOptions& options);

/// Of owned particles, from their densities (kg/m^3) and, if not null, specific internal energies (J/kg; else those of
/// the start): pressure (Pa), not below the least that the material bears, and speed of sound (m/s), not below zero.
void find_pressures(const SphOptions& options, const ParticleData& particles, const Column* energy, Column& pressure,
                    Column& sound);

/// Specific energy (J/kg) at which the body has that pressure (Pa) at that density (kg/m^3); that of the start if the
/// pressure does not depend on it.
double energy_of(double pressure, double density, const SphBody& body);

/// Speed of sound of the undeformed material of each body, m/s.
double undeformed_sound(const SphBody& body);

}  // namespace tenon
