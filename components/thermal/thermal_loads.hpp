// SPDX-License-Identifier: BSD-3-Clause
// The loads of heat conduction, one after the other; for the bodies of Thermal only.
#pragma once

#include "components/thermal/thermal.hpp"

namespace tenon {

namespace thermal {

inline constexpr double stefan_boltzmann = 5.670374419e-8;  // W/(m^2 K^4), exact to the digits given [SI19]

inline double fourth(double t) {
  return (t * t) * (t * t);
}

}  // namespace thermal

template <typename Use>
void Thermal::each_load(double time, const Use& use) const {
  const auto node = [this](LocalIndex row) {
    return static_cast<std::size_t>(mesh_->owned_nodes[static_cast<std::size_t>(row)]);
  };
  const auto on_surface = [&](Supply kind, const thermal::Surface& surface, const auto& power) {
    for (std::size_t i = 0; i < surface.rows().size(); ++i) {
      const LocalIndex row = surface.rows()[i];
      use(kind, row, surface.areas()[i] * power(temperature_[node(row)]));
    }
  };
  for (const FluxLoad& load : flux_loads_)
    on_surface(flux, load.surface, [value = load.flux(time)](double) { return value; });
  for (const ConvectionLoad& load : convection_loads_)
    on_surface(convection, load.surface,
               [&load, ambient = load.ambient(time)](double t) { return load.coefficient * (ambient - t); });
  for (const RadiationLoad& load : radiation_loads_)
    on_surface(radiation, load.surface, [&load, ambient = thermal::fourth(absolute_ambient(load, time))](double t) {
      return load.emissivity * thermal::stefan_boltzmann * (ambient - thermal::fourth(t));
    });
  for (const SourceLoad& load : source_loads_) {
    const double power = load.power(time);
    for (std::size_t i = 0; i < load.rows.size(); ++i) use(source, load.rows[i], power * load.volumes[i]);
  }
  if (!options_.source_function) return;
  for (std::size_t k = 0; k < volume_.size(); ++k) {
    const auto row = static_cast<LocalIndex>(k);
    use(source, row, volume_[k] * options_.source_function(mesh_->coordinates[node(row)], time));
  }
}

}  // namespace tenon
