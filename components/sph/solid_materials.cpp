// SPDX-License-Identifier: BSD-3-Clause
#include "components/sph/solid_materials.hpp"

#include <algorithm>

#include "components/materials/step_deformation.hpp"
#include "components/sph/matrix3.hpp"
#include "framework/base/wide_pack.hpp"

namespace tenon {

namespace {

std::vector<std::shared_ptr<const MaterialModel>> models_of(const SphOptions& options) {
  std::vector<std::shared_ptr<const MaterialModel>> models;
  for (const SphBody& body : options.bodies) models.push_back(make_material_model(body.material));
  return models;
}

static_assert(lanes == wide_pack_width);

SymmetricTensor<WidePack> load_tensor(Batch<1>* rows) {
  return {load_wide(rows[0][0]), load_wide(rows[1][0]), load_wide(rows[2][0]),
          load_wide(rows[3][0]), load_wide(rows[4][0]), load_wide(rows[5][0])};
}
void store_tensor(const SymmetricTensor<WidePack>& t, Batch<1>* rows) {
  store(rows[0][0], t.xx), store(rows[1][0], t.yy), store(rows[2][0], t.zz);
  store(rows[3][0], t.xy), store(rows[4][0], t.yz), store(rows[5][0], t.zx);
}

void turn(const MaterialModel& model, const Tensor<WidePack>& rotation, Batch<6>& stress, Batch<1>* state) {
  auto* const rows = reinterpret_cast<Batch<1>*>(&stress);
  store_tensor(rotated(rotation, load_tensor(rows)), rows);
  for (const int first : model.rotating_tensors())
    store_tensor(rotated(rotation, load_tensor(state + first)), state + first);
  for (const int first : model.rotating_vectors()) {
    Batch<1>* const v = state + first;
    const Vector<WidePack> now =
        rotation * Vector<WidePack>{load_wide(v[0][0]), load_wide(v[1][0]), load_wide(v[2][0])};
    store(v[0][0], now.x), store(v[1][0], now.y), store(v[2][0], now.z);
  }
}

/// `components` numbers of each member, value by value; short batches are filled up with their last member.
void gather(const Column& column, const LocalIndex* members, std::size_t count, Batch<1>* rows) {
  const auto components = static_cast<std::size_t>(column.components);
  for (std::size_t l = 0; l < lanes; ++l) {
    const auto i = static_cast<std::size_t>(members[std::min(l, count - 1)]);
    for (std::size_t c = 0; c < components; ++c) rows[c][0][l] = column[components * i + c];
  }
}
template <int N>
void gather(const Column& column, const LocalIndex* members, std::size_t count, Batch<N>& batch) {
  gather(column, members, count, reinterpret_cast<Batch<1>*>(&batch));
}

}  // namespace

int SolidMaterials::rows() const {
  int most = 1;
  for (const auto& model : models_) most = std::max(most, model->state_size());
  return most;
}

SolidMaterials::SolidMaterials(const std::string& component, const SphOptions& options, ParticleData& particles)
    : options_(options),
      particles_(particles),
      models_(models_of(options)),
      stress(particles.add("stress", ColumnKind::tensor, 6, true)),
      history(particles.add("history", ColumnKind::scalar, rows(), true)),
      modulus(particles.add("modulus", ColumnKind::scalar, 1, true)),
      plastic_work(particles.add("plastic_work", ColumnKind::scalar, 1, true)),
      plastic_heat(particles.add("plastic_heat", ColumnKind::scalar, 1, false)),
      temperature_used_(particles.add("temperature_used", ColumnKind::scalar, 1, true)),
      failed_(particles.add("failed", ColumnKind::scalar, 1, true)),
      state_(static_cast<std::size_t>(rows())) {
  for (std::size_t b = 0; b < models_.size(); ++b) {
    can_fail_ = can_fail_ || models_[b]->damage() >= 0;
    any_plastic_ = any_plastic_ || models_[b]->plastic();
    if (options.formulation == SphFormulation::solid && models_[b]->needs_deformation_gradient())
      throw Error(ExitCode::usage, component + ": the law of '" + options.bodies[b].material.name +
                                       "' follows from the deformation since the start, which is not known with the "
                                       "formulation `solid`; take `total_lagrangian`");
  }
}

void SolidMaterials::start(const Column& temperature) {
  for (std::size_t i = 0; i < particles_.owned(); ++i) start(i, temperature[i]);
}

void SolidMaterials::start(std::size_t i, double temperature) {
  const auto rows_kept = static_cast<std::size_t>(history.components);
  const MaterialModel& law = model(i);
  for (std::size_t r = 0; r < rows_kept; ++r)
    history[rows_kept * i + r] =
        r < static_cast<std::size_t>(law.state_size()) ? law.initial_state(static_cast<int>(r)) : 0;
  modulus[i] = law.elasticity().p_wave_modulus();
  temperature_used_[i] = temperature;
}

double SolidMaterials::eqps(std::size_t i) const {
  return model(i).plastic() ? history[static_cast<std::size_t>(history.components) * i] : 0;
}

double SolidMaterials::damage(std::size_t i) const {
  const int row = model(i).damage();
  return row < 0 ? 0 : history[static_cast<std::size_t>(history.components) * i + static_cast<std::size_t>(row)];
}

void SolidMaterials::find_members(std::int64_t version) {
  if (version == version_) return;
  version_ = version;
  members_.resize(options_.bodies.size());
  for (std::vector<LocalIndex>& of : members_) of.clear();
  for (std::size_t i = 0; i < particles_.owned(); ++i)
    members_[static_cast<std::size_t>(particles_.body[i])].push_back(static_cast<LocalIndex>(i));
}

void SolidMaterials::update(const Step& step, std::int64_t version) {
  find_members(version);
  for (std::size_t b = 0; b < members_.size(); ++b)
    for (std::size_t first = 0; first < members_[b].size(); first += lanes)
      update_batch(step, b, &members_[b][first], std::min<std::size_t>(lanes, members_[b].size() - first));
}

void SolidMaterials::update_batch(const Step& step, std::size_t body, const LocalIndex* members, std::size_t count) {
  const MaterialModel& law = *models_[body];
  Batch<9> gradient, deformation;
  Batch<6> stresses, strain;
  Batch<1> now, used, increment, work{}, volume, heat;
  gather(step.gradient, members, count, gradient);
  gather(stress, members, count, stresses);
  gather(history, members, count, state_.data());
  gather(step.temperature, members, count, now);
  gather(temperature_used_, members, count, used);
  const auto row = [&](int r) { return load_wide(gradient[r]); };
  const Tensor<WidePack> l{{row(0), row(1), row(2)}, {row(3), row(4), row(5)}, {row(6), row(7), row(8)}};
  const StepDeformation<WidePack> deformed = step_deformation(l, 1.0);
  store_tensor(deformed.strain_increment, reinterpret_cast<Batch<1>*>(&strain));
  turn(law, deformed.rotation, stresses, state_.data());
  store(increment[0], load_wide(now[0]) - load_wide(used[0]));

  UpdateInput input{strain, now, increment, step.dt};
  if (step.deformation_gradient) {
    gather(*step.deformation_gradient, members, count, deformation);
    input.deformation_gradient = &deformation;
  }
  if (law.needs_volume_ratio() || law.needs_added_heat()) {
    const double density = options_.bodies[body].material.density;
    for (std::size_t k = 0; k < lanes; ++k) {
      const auto i = static_cast<std::size_t>(members[std::min(k, count - 1)]);
      volume[0][k] = density / particles_.density[i];
      heat[0][k] = density * step.dt * step.viscous_heating[i];
    }
    input.volume_ratio = &volume, input.added_heat = &heat;
  }
  law.update(input, stresses, state_.data(), work);
  Batch<2> moduli;
  law.stiffness(input, stresses, state_.data(), moduli);
  scatter(step, body, members, count, stresses, work, moduli);
}

void SolidMaterials::scatter(const Step& step, std::size_t body, const LocalIndex* members, std::size_t count,
                             const Batch<6>& stresses, const Batch<1>& work, const Batch<2>& moduli) {
  const MaterialModel& law = *models_[body];
  const auto& thermal = options_.bodies[body].material.thermal;
  const double share = thermal ? thermal->taylor_quinney : 0;
  const auto rows_kept = static_cast<std::size_t>(history.components);
  for (std::size_t l = 0; l < count; ++l) {
    const auto i = static_cast<std::size_t>(members[l]);
    for (std::size_t c = 0; c < 6; ++c) stress[6 * i + c] = stresses[static_cast<int>(c)][l];
    for (std::size_t r = 0; r < static_cast<std::size_t>(law.state_size()); ++r)
      history[rows_kept * i + r] = state_[r][0][l];
    modulus[i] = moduli[0][l] + 2 * moduli[1][l];
    temperature_used_[i] = step.temperature[i];
    const double done = failed(i) ? 0 : particles_.mass[i] / particles_.density[i] * work[0][l];
    plastic_work[i] += done;
    plastic_heat[i] = share * done;
    if (law.damage() < 0 || damage(i) < 1) continue;
    failed_[i] = 1;
    const double mean = std::min((stress[6 * i] + stress[6 * i + 1] + stress[6 * i + 2]) / 3, 0.0);
    for (std::size_t c = 0; c < 6; ++c) stress[6 * i + c] = c < 3 ? mean : 0;
  }
}

}  // namespace tenon
