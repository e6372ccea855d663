// SPDX-License-Identifier: BSD-3-Clause
// Contact conductance in the step: found when the surfaces move, weighed when time or pressure change it.
#include "components/thermal/thermal.hpp"

namespace tenon {

// Collective. The surfaces are where `coordinates_` says.
void Thermal::find_contacts() {
  if (contact_->find(coordinates_, matrix_)) {
    multigrid_.reset();  // its pattern has changed
    for (std::vector<double>* v : {&temperature_, &increment_}) v->resize(matrix_.width(), 0.0);
    if (!pressure_.empty()) pressure_.resize(matrix_.width(), 0.0);
    matrix_.halo().forward(std::span<const double>(temperature_), std::span(temperature_));
    matrix_.halo().forward(std::span<const double>(increment_), std::span(increment_));
  }
  weigh_contacts(time());
}

// Collective.
void Thermal::weigh_contacts(double at) {
  if (pressed_) matrix_.halo().forward(std::span<const double>(pressure_), std::span(pressure_));
  contact_->weigh(at, pressed_ ? std::span<const double>(pressure_) : std::span<const double>());
}

// Conductances of a step, frozen in it. Multigrid is built anew without asking whether anything has changed, which a
// run that was restarted could not know. Collective.
void Thermal::follow_contacts(double at) {
  if (!contact_ || !contact_->varies()) return;
  const ScopedTimer timer(*assemble_time_);
  weigh_contacts(at);
  assemble_matrix();
  multigrid_stale_ = true;
  find_stiffest();
}

// Heat that passes at the present temperatures in a time of `weight`; only to be shown.
void Thermal::book_contacts(double weight, std::vector<double>& heat) const {
  if (contact_) contact_->add_passed(weight, temperature_, matrix_, heat);
}

// Ghost nodes are refreshed from their owners when conductances are weighed.
void Thermal::receive_pressure(std::span<const double> values) {
  pressed_ = true;
  for (const LocalIndex n : mesh_->owned_nodes)
    pressure_[static_cast<std::size_t>(n)] = values[static_cast<std::size_t>(n)];
}

}  // namespace tenon
