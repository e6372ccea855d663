// SPDX-License-Identifier: BSD-3-Clause
// The element loops of all hourglass forms. One of the few files that are compiled with contraction to fused
// multiply-adds; nothing that other files compute as well belongs here.
#include "components/mechanics/hex8_group.hpp"

#include <cmath>

#include "components/mechanics/hex8_volume.hpp"
#include "components/mechanics/physical_hourglass.hpp"
#include "components/mechanics/stress_power.hpp"

namespace tenon {

namespace {

void clear(double (&rows)[8][pack_width]) {
  for (auto& row : rows)
    for (double& f : row) f = 0;
}

}  // namespace

template <HourglassForm H>
Hex8Group<H>::Hex8Group(std::size_t block, const ElementBlock& elements, std::span<const Vec3> coordinates,
                        const MaterialDescription& description, const H& hourglass, const BulkViscosity& viscosity)
    : ElementGroup(block, elements, description, 1),
      parameters_{viscosity, hourglass},
      connectivity_(batches()),
      reference_size_(batches()),
      hourglass_state_(H::state_size > 0 ? batches() : 0),
      viscosity_used_(model().needs_added_heat() ? batches() : 0),
      moduli_(model().variable_stiffness() ? batches() : 0),
      needs_measures_(model().needs_deformation_gradient() || model().needs_volume_ratio() ||
                      model().needs_added_heat()),
      relaxes_(H::uses_relaxation && model().flows()) {
  const Elasticity& elasticity = model().elasticity();
  for (int l = 0; l < lanes; ++l)
    constant_moduli_[0][l] = elasticity.lame_lambda(), constant_moduli_[1][l] = elasticity.shear_modulus();
  for (LocalIndex e = 0; e < static_cast<LocalIndex>(batches()) * lanes; ++e) {
    for (int i = 0; i < 8; ++i) connectivity_[static_cast<std::size_t>(e / lanes)].node[i][e % lanes] = node(e, i);
    const double size = hex8_volume(elements.nodes(std::min(e, this->size() - 1)), coordinates);
    value_of(mass, e) = description.density * size;
    value_of(reference_size_, e) = std::cbrt(size);
  }
  for (Batch<2>& moduli : moduli_) moduli = constant_moduli_;
}

template <HourglassForm H>
GroupStep Hex8Group<H>::advance(const NodeArrays& nodes, double dt) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Batch<1> least, where;
  for (int l = 0; l < lanes; ++l) least[0][l] = infinity, where[0][l] = 0;
  GroupStep result{infinity, no_index};
  for (std::size_t b = 0; b < batches(); ++b) advance_batch(b, nodes, dt, least, where, result.shrink);
  for (int l = 0; l < lanes && batches() > 0; ++l) {
    const LocalIndex element = std::min(static_cast<LocalIndex>(where[0][l]) * lanes + l, size() - 1);
    const bool first = least[0][l] < result.step || (least[0][l] == result.step && element < result.element);
    if (first) result = {least[0][l], element, result.shrink};
  }
  return result;
}

template <HourglassForm H>
void Hex8Group<H>::advance_batch(std::size_t b, const NodeArrays& nodes, double dt, Batch<1>& least, Batch<1>& where,
                                 double& shrink) {
  if (dt > 0 && !doomed.empty()) settle(b);
  HexModes<Pack> x[halves], v[halves];
  for (int h = 0; h < halves; ++h) {
    x[h] = gather(nodes.position, connectivity_[b], h * pack_width);
    v[h] = gather(nodes.velocity, connectivity_[b], h * pack_width);
  }
  Work work;
  if (dt > 0) update_material(b, nodes, x, v, dt, work);
  work.moduli = moduli_.empty() ? constant_moduli_ : moduli_[b];
  alignas(64) double rows[lanes][8][pack_width];
  Batch<1> step, wave_step;
  for (int h = 0; h < halves; ++h)
    store(step[0] + h * pack_width, resist(b, h * pack_width, x[h], v[h], dt, work, rows + h * pack_width, wave_step));
  if (!dead.empty()) bury(b, rows, step);
  for (int h = 0; h < halves; ++h) {
    const int lane = h * pack_width;
    const Pack now = load(step[0] + lane), before = load(least[0] + lane);
    store(least[0] + lane, now < before ? now : before);
    store(where[0] + lane, now < before ? broadcast<Pack>(static_cast<double>(b)) : load(where[0] + lane));
  }
  if (!steps.empty()) steps[b] = step;
  if (follows()) follow(b, step, wave_step, shrink);
  scatter(rows, connectivity_[b], count(b), nodes.force);
}

template <HourglassForm H>
void Hex8Group<H>::update_material(std::size_t b, const NodeArrays& nodes, const HexModes<Pack> (&x)[halves],
                                   const HexModes<Pack> (&v)[halves], double dt, Work& work) {
  Batch<6> strain_increment;
  Batch<1> temperature_increment;
  for (int h = 0; h < halves; ++h) deform(b, h * pack_width, x[h], v[h], dt, strain_increment, temperature_increment);
  UpdateInput input{strain_increment, temperature[b], temperature_increment, dt};
  Batch<9> gradient;
  Batch<1> volume_ratio, added_heat;
  if (needs_measures_) {
    for (int h = 0; h < halves; ++h) measure(b, h * pack_width, x[h], nodes, gradient, volume_ratio, added_heat);
    input.deformation_gradient = &gradient, input.volume_ratio = &volume_ratio, input.added_heat = &added_heat;
  }
  Batch<6> before;
  if (relaxes_ || !dead.empty()) before = points.stress(b, 0);
  model().update(input, points.stress(b, 0), points.history(b, 0), work.plastic_work_density);
  if (!moduli_.empty()) model().stiffness(input, points.stress(b, 0), points.history(b, 0), moduli_[b]);
  if (relaxes_) {
    Batch<1> trial;
    if (!moduli_.empty()) model().trial_shear(input, trial);
    relaxation_of(before, strain_increment, points.stress(b, 0), moduli_.empty() ? constant_moduli_.v[1] : trial.v[0],
                  work.relaxation);
  }
  if (dead.empty()) return;
  Batch<1> volume, failed;
  find_gone(b, failed);
  for (int l = 0; l < lanes; ++l)  // what dies in this step does no more work
    for (int i = 0; i < 6 && failed[0][l] != 0; ++i) points.stress(b, 0)[i][l] = 0;
  for (int h = 0; h < halves; ++h) store(volume[0] + h * pack_width, (1.0 / 192.0) * mean_gradient(x[h]).volume_192);
  add_stress_power(before, points.stress(b, 0), strain_increment, volume, dead[b], internal_energy[b]);
}

// The two halves of a batch must run through the same instructions: this file is compiled with contraction to fused
// multiply-adds, and another copy of the code (inlined, unrolled, specialised) might contract otherwise.
template <HourglassForm H>
[[gnu::noinline, gnu::noclone]] void Hex8Group<H>::deform(std::size_t b, int lane, const HexModes<Pack>& x,
                                                          const HexModes<Pack>& v, double dt,
                                                          Batch<6>& strain_increment, Batch<1>& temperature_increment) {
  const StepDeformation<Pack> step = step_deformation(velocity_gradient(v, mean_gradient(mid_step(x, v, dt))), dt);
  store_tensor(step.strain_increment, strain_increment, lane);
  points.rotate(b, 0, step.rotation, lane);
  if constexpr (H::state_size > 0) parameters_.hourglass.rotate(step.rotation, hourglass_state_[b], lane);
  const Pack now = load(temperature[b][0] + lane);
  store(temperature_increment[0] + lane, now - load(temperature_used[b][0] + lane));
  store(temperature_used[b][0] + lane, now);
}

// Deformation gradient from the undeformed element, by its own mean gradient.
template <HourglassForm H>
[[gnu::noinline, gnu::noclone]] void Hex8Group<H>::measure(std::size_t b, int lane, const HexModes<Pack>& x,
                                                           const NodeArrays& nodes, Batch<9>& gradient,
                                                           Batch<1>& volume_ratio, Batch<1>& added_heat) {
  const Pack size = load(reference_size_[b][0] + lane), inverse_volume = 1.0 / (size * size * size);
  const MeanGradient<Pack> now = mean_gradient(x);
  store(volume_ratio[0] + lane, (1.0 / 192.0) * now.volume_192 * inverse_volume);
  if (nodes.reference) {
    const HexModes<Pack> start = gather(nodes.reference, connectivity_[b], lane);
    const Tensor<Pack> f = velocity_gradient(x, mean_gradient(start));
    const Pack values[9] = {f.x.x, f.x.y, f.x.z, f.y.x, f.y.y, f.y.z, f.z.x, f.z.y, f.z.z};
    for (int i = 0; i < 9; ++i) store(gradient[i] + lane, values[i]);
  }
  if (viscosity_used_.empty()) return;
  const Pack all = load(viscosity_energy[b][0] + lane);
  store(added_heat[0] + lane, (all - load(viscosity_used_[b][0] + lane)) * inverse_volume);
  store(viscosity_used_[b][0] + lane, all);
}

template <HourglassForm H>
[[gnu::noinline, gnu::noclone]] Pack Hex8Group<H>::resist(std::size_t b, int lane, const HexModes<Pack>& x,
                                                          const HexModes<Pack>& v, double dt, const Work& work,
                                                          double (*rows)[8][pack_width], Batch<1>& wave_step) {
  HourglassBatch none;
  HourglassBatch& hourglass = H::state_size > 0 ? hourglass_state_[b] : none;
  Pack relaxation = broadcast<Pack>(1.0);
  if (relaxes_ && dt > 0) relaxation = load(work.relaxation[0] + lane);
  const Moduli<Pack> moduli{load(work.moduli[0] + lane), load(work.moduli[1] + lane)};
  const ElementForces<Pack> f =
      element_forces(x, v, load_tensor(points.stress(b, 0), lane), reference(b, lane, relaxation), moduli, parameters_,
                     hourglass, lane, dt);
  store_rows(f, rows);
  if (follows()) {
    const Pack wave = wave_frequency_squared(f.greatest, moduli, load(mass[b][0] + lane), f.volume);
    store(wave_step[0] + lane, damped_step(wave, f.damping, Pack{}));
  }
  if (dt > 0) add_energies(b, lane, f, work);
  return f.step;
}

template <HourglassForm H>
void Hex8Group<H>::add_energies(std::size_t b, int lane, const ElementForces<Pack>& f, const Work& work) {
  const Pack alive = dead.empty() ? broadcast<Pack>(0.0) : load(dead[b][0] + lane);
  const auto add = [&](ElementValues& to, const Pack& value) {
    const Pack acting = f.volume > 0.0 ? value : Pack{};  // inside out, it stops the run or has no forces
    store(to[b][0] + lane, load(to[b][0] + lane) + (alive == 0.0 ? acting : Pack{}));
  };
  add(hourglass_energy, f.hourglass_energy);
  add(viscosity_energy, f.viscosity_energy);
  if (!model().plastic()) return;
  const Pack done = load(work.plastic_work_density[0] + lane) * f.volume;
  add(plastic_work, done);
  add(temperature, heating * done / load(mass[b][0] + lane));
}

// Elements that have failed carry nothing from this step on.
template <HourglassForm H>
void Hex8Group<H>::bury(std::size_t b, double (*rows)[8][pack_width], Batch<1>& step) {
  Batch<1> failed;
  find_gone(b, failed);
  for (int l = 0; l < lanes; ++l) {
    if (failed[0][l] == 0) continue;
    die(b, l);
    for (int i = 0; i < 6; ++i) points.stress(b, 0)[i][l] = 0;
    if constexpr (H::state_size > 0)
      for (int i = 0; i < H::state_size; ++i) hourglass_state_[b][i][l] = 0;
    clear(rows[l]);
    step[0][l] = std::numeric_limits<double>::infinity();
  }
  if (doomed.empty()) return;
  Batch<1> inverted;
  doom(b, step, inverted);
  for (int l = 0; l < lanes; ++l)
    if (inverted[0][l] != 0) clear(rows[l]);
}

template <HourglassForm H>
void Hex8Group<H>::add_product(const NodeArrays& nodes, const double* u, double stiffness, double damping,
                               ForceRow* out) const {
  alignas(64) double rows[lanes][8][pack_width];
  for (std::size_t b = 0; b < batches(); ++b) {
    const Batch<2>& m = moduli_.empty() ? constant_moduli_ : moduli_[b];
    for (int h = 0; h < halves; ++h) {
      const int lane = h * pack_width;
      const HexModes<Pack> x = gather(nodes.position, connectivity_[b], lane);
      const HexModes<Pack> v = gather(nodes.velocity, connectivity_[b], lane);
      const HexModes<Pack> w = gather(u, connectivity_[b], lane);
      const ElementForces<Pack> f = tangent_forces(x, v, w, reference(b, lane, broadcast<Pack>(1.0)),
                                                   Moduli<Pack>{load(m[0] + lane), load(m[1] + lane)}, parameters_,
                                                   stiffness, broadcast<Pack>(damping));
      store_rows(f, rows + lane);
    }
    for (int l = 0; l < lanes && !dead.empty(); ++l)
      if (dead[b][0][l] != 0) clear(rows[l]);
    scatter(rows, connectivity_[b], count(b), out->v);
  }
}

template <HourglassForm H>
double Hex8Group<H>::volume(LocalIndex element, std::span<const Vec3> positions) const {
  return hex8_volume(elements().nodes(element), positions);
}

template <HourglassForm H>
std::vector<StateArray> Hex8Group<H>::state() {
  std::vector<StateArray> arrays = ElementGroup::state();
  if constexpr (H::state_size > 0)
    arrays.push_back({"hourglass_forces", H::state_size, reinterpret_cast<Batch<1>*>(hourglass_state_.data())});
  if (!viscosity_used_.empty()) arrays.push_back({"viscosity_used", 1, viscosity_used_.data()});
  if (!moduli_.empty()) arrays.push_back({"moduli", 2, reinterpret_cast<Batch<1>*>(moduli_.data())});
  return arrays;
}

template <HourglassForm H>
std::int64_t Hex8Group<H>::memory() const {
  return ElementGroup::memory() +
         static_cast<std::int64_t>(connectivity_.size() * (sizeof(HexConnectivity) + sizeof(Batch<1>)) +
                                   hourglass_state_.size() * sizeof(HourglassBatch) +
                                   viscosity_used_.size() * sizeof(Batch<1>) + moduli_.size() * sizeof(Batch<2>));
}

std::unique_ptr<ElementGroup> make_hex8_group(std::size_t block, const ElementBlock& elements,
                                              std::span<const Vec3> coordinates, const MaterialDescription& material,
                                              const HourglassOptions& hourglass, const BulkViscosity& viscosity) {
  const auto with = [&](const auto& form) -> std::unique_ptr<ElementGroup> {
    return std::make_unique<Hex8Group<std::decay_t<decltype(form)>>>(block, elements, coordinates, material, form,
                                                                     viscosity);
  };
  switch (hourglass.form) {
    case HourglassOptions::Form::physical:
      // Its bending stiffness would be that of the isotropic bound of the moduli, many times too great.
      if (std::holds_alternative<OrthotropicParameters>(material.whole_law))
        throw Error(ExitCode::usage, "material '" + material.name +
                                         "' is orthotropic, and the physical hourglass form knows isotropic bending "
                                         "only; use formulation: full, or another hourglass form");
      return with(PhysicalHourglass{});
    case HourglassOptions::Form::stiffness:
      return with(StiffnessHourglass{hourglass.coefficient});
    case HourglassOptions::Form::none:
      return with(NoHourglass{});
    case HourglassOptions::Form::viscous:
      break;
  }
  return with(ViscousHourglass{hourglass.coefficient});
}

}  // namespace tenon
