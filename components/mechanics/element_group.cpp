// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/element_group.hpp"

#include <algorithm>
#include <limits>

namespace tenon {

ElementGroup::ElementGroup(std::size_t block, const ElementBlock& elements, const MaterialDescription& material,
                           int points_per_element)
    : points(make_material_model(material), static_cast<std::size_t>((elements.size() + lanes - 1) / lanes),
             points_per_element),
      block_(block),
      elements_(elements),
      size_(elements.size()),
      material_(material) {
  const auto n = static_cast<std::size_t>((size_ + lanes - 1) / lanes);
  for (ElementValues* values :
       {&mass, &temperature, &temperature_used, &plastic_work, &hourglass_energy, &viscosity_energy})
    values->resize(n);
  can_die = model().damage() >= 0;
  if (can_die) dead.resize(n), internal_energy.resize(n);
}

LocalIndex ElementGroup::node(LocalIndex element, int corner) const {
  return elements_.nodes(std::min(element, size_ - 1))[static_cast<std::size_t>(corner)];
}

// An equal share of the mass of each element for each node of it: [HUG87, 7.3.2].
void ElementGroup::add_masses(const NodalMasses& masses) const {
  for (LocalIndex e = 0; e < size_; ++e) {
    const std::span<const LocalIndex> nodes = elements_.nodes(e);
    const double share = value_of(mass, e) / static_cast<double>(nodes.size());
    for (const LocalIndex n : nodes) masses.mass[static_cast<std::size_t>(n)] += share;
  }
}

void ElementGroup::erode(const ErosionOptions& options) {
  least_step_ = options.minimum_step.value_or(0), takes_inverted_ = options.inverted;
  can_die = true;
  dead.resize(batches()), internal_energy.resize(batches()), doomed.resize(batches());
}

void ElementGroup::die(std::size_t batch, int lane) {
  if (dead[batch][0][lane] == 0) ++deaths;
  dead[batch][0][lane] = 1;
}

void ElementGroup::settle(std::size_t batch) {
  for (int l = 0; l < lanes; ++l)
    if (doomed[batch][0][l] != 0) die(batch, l), doomed[batch][0][l] = 0;
}

void ElementGroup::find_gone(std::size_t batch, Batch<1>& gone) const {
  points.failed(batch, gone);
  for (int l = 0; l < lanes; ++l)
    if (dead[batch][0][l] != 0) gone[0][l] = 1;
}

// By what the state and the positions tell, so that a restart finds the same.
void ElementGroup::doom(std::size_t batch, Batch<1>& step, Batch<1>& inverted) {
  for (int l = 0; l < lanes; ++l) {
    double& s = step[0][l];
    inverted[0][l] = takes_inverted_ && s == inverted_element ? 1 : 0;
    if (dead[batch][0][l] != 0 || (inverted[0][l] == 0 && !(s >= 0 && s < least_step_))) continue;
    if (doomed[batch][0][l] == 0) ++deaths;
    doomed[batch][0][l] = 1;
    s = std::numeric_limits<double>::infinity();
  }
}

void ElementGroup::prepare(int, const NodeArrays&, double) {}

void ElementGroup::add_product(const NodeArrays&, const double*, double, double, ForceRow*) const {}

std::vector<StateArray> ElementGroup::state() {
  std::vector<StateArray> arrays;
  points.add_state(arrays);
  const auto add = [&](const char* name, ElementValues& values) {
    if (!values.empty()) arrays.push_back({name, 1, values.data()});
  };
  add("temperature", temperature);
  add("temperature_used", temperature_used);
  add("plastic_work", plastic_work);
  add("hourglass_energy", hourglass_energy);
  add("viscosity_energy", viscosity_energy);
  add("heat_given", heat_given);
  add("dead", dead);
  add("internal_energy", internal_energy);
  add("verified_wave_steps", verified_wave_steps);
  return arrays;
}

void ElementGroup::fill_padding() {
  if (size_ == 0) return;
  for (const StateArray& array : state())
    for (LocalIndex e = size_; e < static_cast<LocalIndex>(batches()) * lanes; ++e)
      for (int row = 0; row < array.rows; ++row) array.at(e, row) = array.at(size_ - 1, row);
}

void ElementGroup::follow_limit() {
  wave_steps.resize(batches()), verified_wave_steps.resize(batches());
}

void ElementGroup::verify(double step) {
  verified_step = step;
  verified_wave_steps = wave_steps;
}

// An assembly is no faster than its verified state, times the factor by which the fastest growing part of it has become
// faster. Parts that alone allow the verified step cannot exceed it.
void ElementGroup::follow(std::size_t batch, const Batch<1>& step, const Batch<1>& wave_step, double& shrink) {
  wave_steps[batch] = wave_step;
  for (int l = 0; l < lanes && verified_step > 0; ++l) {
    const double ratio = wave_step[0][l] / verified_wave_steps[batch][0][l];
    if (step[0][l] < verified_step && ratio < shrink) shrink = ratio;
  }
}

void ElementGroup::fill_padding_of(ElementValues& values) const {
  for (LocalIndex e = size_; size_ > 0 && e < static_cast<LocalIndex>(batches()) * lanes; ++e)
    value_of(values, e) = value_of(static_cast<const ElementValues&>(values), size_ - 1);
}

double ElementGroup::stress(LocalIndex element, int component) const {
  return points.mean_stress(element, component);
}

double ElementGroup::face_stress(LocalIndex element, int component, bool) const {
  return stress(element, component);
}

double ElementGroup::history(LocalIndex element, int row) const {
  return points.mean_history(element, row);
}

std::int64_t ElementGroup::memory() const {
  const std::size_t values =
      mass.size() * 6 + heat_given.size() + dead.size() + internal_energy.size() + steps.size() + 2 * wave_steps.size();
  return points.memory() + static_cast<std::int64_t>(values * sizeof(Batch<1>));
}

}  // namespace tenon
