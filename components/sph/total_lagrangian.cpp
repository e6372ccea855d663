// SPDX-License-Identifier: BSD-3-Clause
// Solids, total Lagrangian: what happens in a step. The sums are in total_lagrangian_sums.cpp.
#include "components/sph/total_lagrangian.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "components/sph/matrix3.hpp"
#include "components/sph/particle_heat.hpp"

namespace tenon {

namespace {

Column& scalar(ParticleData& data, const char* name, bool kept = true) {
  return data.add(name, ColumnKind::scalar, 1, kept);
}
Column& vector(ParticleData& data, const char* name, bool kept = true) {
  return data.add(name, ColumnKind::vector, 3, kept);
}
Column& matrix(ParticleData& data, const char* name, bool kept) {
  return data.add(name, ColumnKind::matrix, 9, kept);
}

}  // namespace

TotalLagrangian::TotalLagrangian(const SphContext& context)
    : c_(context),
      p_(context.particles),
      origin_(p_.add("origin", ColumnKind::position, 3, true)),
      volume_(scalar(p_, "reference_volume")),
      pushed_(vector(p_, "internal_acceleration")),
      hourglass_pushed_(vector(p_, "hourglass_acceleration")),
      dragged_(vector(p_, "viscous_acceleration")),
      internal_(scalar(p_, "internal_energy")),
      hourglass_(scalar(p_, "hourglass_energy")),
      viscosity_(scalar(p_, "viscosity_energy")),
      shown_stress_(p_.add("stress", ColumnKind::tensor, 6, true)),
      shown_eqps_(scalar(p_, "eqps")),
      shown_damage_(scalar(p_, "damage")),
      failed_(scalar(p_, "failed")),
      step_(scalar(p_, "stable_step")),
      predicted_(vector(p_, "predicted_velocity", false)),
      heat_made_(scalar(p_, "plastic_heat", false)),
      contact_(std::make_unique<PairContact>(context, origin_)),
      displacement_(vector(rest_, "displacement")),
      arrived_(vector(rest_, "present_place", false)),
      arrived_temperature_(scalar(rest_, "temperature", false)),
      deformation_(matrix(rest_, "deformation_gradient", true)),
      deformed_(matrix(rest_, "next_deformation_gradient", false)),
      gradient_(matrix(rest_, "velocity_gradient", false)),
      correction_(matrix(rest_, "correction", false)),
      bonds_(scalar(rest_, "bonded_volume")),
      push_(matrix(rest_, "corrected_stress", false)),
      heating_(scalar(rest_, "viscous_heating")),
      a_(vector(rest_, "internal_acceleration", false)),
      a_hourglass_(vector(rest_, "hourglass_acceleration", false)),
      a_viscous_(vector(rest_, "viscous_acceleration", false)),
      sound_(scalar(rest_, "sound_speed", false)),
      rest_step_(scalar(rest_, "stable_step", false)),
      eqps_(scalar(rest_, "eqps", false)),
      damage_(scalar(rest_, "damage", false)),
      gone_(scalar(rest_, "gone", false)),
      speed_(scalar(rest_, "reference_sound_speed", false)),
      secant_(scalar(rest_, "secant_modulus", false)),
      strength_(scalar(rest_, "greatest_von_mises", true)) {
  for (const SphBody& body : c_.options.bodies)
    if (body.waits)
      throw Error(ExitCode::usage,
                  c_.name + ": '" + body.name +
                      "' waits for elements that fail, which have no neighbours of the start; take the "
                      "formulation `solid`");
  materials_ = std::make_unique<SolidMaterials>(c_.name, c_.options, rest_);
  for (const SphBody& body : c_.options.bodies) elasticity_.push_back(make_material_model(body.material)->elasticity());
}

void TotalLagrangian::start() {
  for (std::size_t i = 0; i < p_.owned(); ++i) {
    origin_.set(i, p_.position.vec(i));
    volume_[i] = p_.mass[i] / p_.density[i];
  }
}

// The particles of this rank, by their places at the start, into a decomposition of their own.
void TotalLagrangian::build() {
  const std::size_t owned = p_.owned();
  rest_.resize(owned, 0);
  std::copy_n(p_.ids.begin(), owned, rest_.ids.begin());
  std::copy_n(p_.body.begin(), owned, rest_.body.begin());
  std::copy_n(p_.home_rank.begin(), owned, rest_.home_rank.begin());
  std::copy_n(p_.home_node.begin(), owned, rest_.home_node.begin());
  for (std::size_t i = 0; i < owned; ++i) {
    rest_.position.set(i, origin_.vec(i));
    rest_.mass[i] = p_.mass[i], rest_.length[i] = p_.length[i];
    rest_.density[i] = p_.mass[i] / volume_[i];
    bonds_[i] = volume_[i];
    arrived_temperature_[i] = c_.heat->temperature()[i];
    set_matrix(deformation_, i, identity3);
  }
  materials_->start(arrived_temperature_);
  const double support = c_.options.kernel == SphKernelKind::quintic_spline ? 3 : 2;
  const std::int64_t most =
      c_.options.most_neighbours.value_or(most_neighbours_of(support, c_.options.smoothing, 0, c_.options.dimension));
  rest_order_ = std::make_unique<ParticleDecomposition>(c_.comm, c_.name + " at rest", rest_, c_.options.domain,
                                                        DecompositionOptions{support, 0, false, false, most});
  rest_order_->renew();
  std::vector<LocalIndex> index(rest_.owned());
  std::iota(index.begin(), index.end(), LocalIndex{0});
  directory_ = std::make_unique<Directory>(c_.comm, std::span(rest_.ids).first(rest_.owned()), index);
  find_bonds();
}

void TotalLagrangian::find_bonds() {
  begin_.assign(1, 0);
  neighbours_.clear();
  for (std::size_t i = 0; i < rest_.owned(); ++i) {
    for (const LocalIndex j : rest_order_->lists().of(i))
      if (contact_->bonded(rest_.body[i], rest_.body[static_cast<std::size_t>(j)])) neighbours_.push_back(j);
    neighbours_.resize(padded_to_pack(neighbours_.size()), static_cast<LocalIndex>(i));
    begin_.push_back(neighbours_.size());
  }
}

void TotalLagrangian::follow() {
  if (version_ == c_.decomposition.version()) return;
  version_ = c_.decomposition.version();
  const std::size_t owned = p_.owned();
  const std::vector<DirectoryEntry> entries = directory_->find(std::span(p_.ids).first(owned));
  std::vector<int> owner(owned);
  std::vector<LocalIndex> index(owned), into(owned);
  for (std::size_t i = 0; i < owned; ++i)
    owner[i] = entries[i].rank, index[i] = entries[i].index, into[i] = static_cast<LocalIndex>(i);
  plan_ = ExchangePlan::from_owners(c_.comm, owner, index, into, c_.name + " to rest");
}

namespace {

ExchangeItem item(const Column& from, Column& to) {
  return {reinterpret_cast<const std::byte*>(from.data()), reinterpret_cast<std::byte*>(to.data()),
          static_cast<std::size_t>(from.components) * sizeof(double)};
}

}  // namespace

void TotalLagrangian::send_there(double dt) {
  for (std::size_t k = 0; k < 3 * p_.owned(); ++k) predicted_[k] = p_.velocity[k] + 0.5 * dt * p_.acceleration[k];
  const std::array<ExchangeItem, 3> items{item(p_.position, arrived_), item(predicted_, rest_.velocity),
                                          item(c_.heat->temperature(), arrived_temperature_)};
  plan_.reverse(items);
}

void TotalLagrangian::bring_back() {
  const std::array<ExchangeItem, 10> items{item(a_, pushed_),
                                           item(a_hourglass_, hourglass_pushed_),
                                           item(a_viscous_, dragged_),
                                           item(materials_->stress, shown_stress_),
                                           item(rest_.density, p_.density),
                                           item(rest_step_, step_),
                                           item(materials_->plastic_heat, heat_made_),
                                           item(eqps_, shown_eqps_),
                                           item(damage_, shown_damage_),
                                           item(gone_, failed_)};
  plan_.forward(items);
}

// Across periodic planes present places jump by periods, which displacements do not.
void TotalLagrangian::displace() {
  for (std::size_t i = 0; i < rest_.owned(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      double u = arrived_[3 * i + c] - rest_.position[3 * i + c];
      const ParticleDomain::Axis& axis = c_.options.domain.axes[c];
      if (axis.periodic) u -= axis.period() * std::round((u - displacement_[3 * i + c]) / axis.period());
      displacement_[3 * i + c] = u;
    }
}

void TotalLagrangian::compute(double, double dt) {
  const bool first = !rest_order_;
  if (first) build();
  follow();
  if (first) find_moments();
  send_there(dt);
  displace();
  const std::array<Column*, 2> places{&displacement_, &rest_.velocity};
  rest_order_->refresh(places);
  sum_deformation();
  deform(dt);
  push_back_stress();
  const std::array<Column*, 4> pushes{&push_, &deformation_, &sound_, &secant_};
  rest_order_->refresh(pushes);
  sum_forces();
  bring_back();

  const bool any_failed = materials_->can_fail() && c_.comm.any(lost_ > 0);
  std::array<Column*, 2> there{&p_.position, &failed_};
  c_.decomposition.refresh(std::span(there).first(any_failed ? 2 : 1));
  contact_->compute(&failed_, any_failed);
  for (std::size_t i = 0; i < p_.owned(); ++i) {
    p_.acceleration.set(
        i, ((pushed_.vec(i) + hourglass_pushed_.vec(i)) + dragged_.vec(i)) + contact_->acceleration().vec(i));
    if (dt > 0) c_.heat->add_plastic(i, heat_made_[i]);
  }
}

// dt grad v of mid-step from the two deformation gradients, dF (F_middle)^-1, and the stress from it. A particle that
// is turned inside out makes the run stop.
void TotalLagrangian::deform(double dt) {
  if (dt == 0) {
    std::fill_n(materials_->plastic_heat.data(), rest_.owned(), 0.0);
    return;
  }
  for (std::size_t i = 0; i < rest_.owned(); ++i) {
    const Matrix3 before = matrix_of(deformation_, i), after = matrix_of(deformed_, i);
    const Matrix3 middle = 0.5 * (before + after);
    const double ratio = determinant(after), det = determinant(middle);
    const bool upright = ratio > 0 && det > 0;
    set_matrix(gradient_, i, upright ? product(after - before, inverse(middle, det)) : 0.0 * identity3);
    set_matrix(deformation_, i, after);
    const double volume = bonds_[i] > 0 ? bonds_[i] * ratio : rest_.mass[i] / rest_.density[i];
    rest_.density[i] = upright ? rest_.mass[i] / volume : std::numeric_limits<double>::quiet_NaN();
  }
  materials_->update({dt, gradient_, arrived_temperature_, heating_, &deformation_}, rest_order_->version());
  if (!materials_->can_fail()) return;
  // What fails lets go of all its neighbours, and they of it.
  bool more = false;
  for (std::size_t i = 0; i < rest_.owned(); ++i) {
    if (!materials_->failed(i)) continue;
    for (std::size_t c = 0; c < 6; ++c) materials_->stress[6 * i + c] = 0;
    if (bonds_[i] == 0) continue;
    bonds_[i] = 0, more = true;
    ++lost_;
  }
  if (c_.comm.any(more)) find_moments();
}

void TotalLagrangian::find_moments() {
  lost_ = 0;
  for (std::size_t i = 0; i < rest_.owned(); ++i) lost_ += bonds_[i] == 0 ? 1 : 0;
  const std::array<Column*, 1> columns{&bonds_};
  rest_order_->refresh(columns);
  sum_moments();
}

// Young's modulus as a line from the undeformed state sees it, E q/(q + 3 G eqps) with the greatest von Mises stress q
// so far: what resists modes without strain must give way where the material flows.
double TotalLagrangian::secant_modulus(std::size_t i) {
  const Elasticity& elastic = elasticity_[static_cast<std::size_t>(rest_.body[i])];
  if (eqps_[i] == 0) return elastic.youngs_modulus;
  const double* const s = materials_->stress.data() + 6 * i;
  const double mean = (s[0] + s[1] + s[2]) / 3, x = s[0] - mean, y = s[1] - mean, z = s[2] - mean;
  const double q = std::sqrt(1.5 * (x * x + y * y + z * z + 2 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5])));
  strength_[i] = std::max(strength_[i], q);
  return elastic.youngs_modulus * strength_[i] / (strength_[i] + 3 * elastic.shear_modulus() * eqps_[i]);
}

// P M^-1 with P = J sigma F^-T, and speeds of sound: of the present, and seen from the reference configuration.
void TotalLagrangian::push_back_stress() {
  for (std::size_t i = 0; i < rest_.owned(); ++i) {
    gone_[i] = bonds_[i] == 0 ? 1 : 0;
    eqps_[i] = materials_->eqps(i), damage_[i] = materials_->damage(i);
    secant_[i] = secant_modulus(i);
    sound_[i] = std::sqrt(std::max(materials_->modulus[i], 0.0) / rest_.density[i]);
    if (bonds_[i] == 0) {
      set_matrix(push_, i, 0.0 * identity3);
      speed_[i] = sound_[i];
      continue;
    }
    const Matrix3 F = matrix_of(deformation_, i);
    const double ratio = determinant(F);
    const Matrix3 back = inverse(F, ratio);
    const Matrix3 P = product(ratio * matrix_of_tensor(materials_->stress, i), transposed(back));
    set_matrix(push_, i, product(P, matrix_of(correction_, i)));
    speed_[i] = sound_[i] * std::max(1.0, greatest_stretch_bound(back));
  }
}

Formulation::Limit TotalLagrangian::stable_step() const {
  Limit limit{std::numeric_limits<double>::infinity(), 0};
  for (std::size_t i = 0; i < p_.owned(); ++i)
    if (step_[i] < limit.dt) limit = {step_[i], i};
  return limit;
}

std::vector<ForcePart> TotalLagrangian::forces() {
  return {{"internal_energy", &pushed_, &internal_},
          {"hourglass_energy", &hourglass_pushed_, &hourglass_},
          {"viscosity_energy", &dragged_, &viscosity_},
          {"pair_contact_energy", &contact_->acceleration(), &contact_->energy()}};
}

std::vector<ParticleField> TotalLagrangian::fields() {
  std::vector<ParticleField> fields;
  const auto add = [&](const char* name, int components, const char* unit, const Column& column) {
    fields.push_back(
        {{name, Location::node, FieldKind::point_value, components, unit}, [&column](std::size_t i, double* value) {
           const auto n = static_cast<std::size_t>(column.components);
           for (std::size_t c = 0; c < n; ++c) value[c] = column[n * i + c];
         }});
  };
  add("stress", 6, "Pa", shown_stress_);
  if (materials_->any_plastic()) add("eqps", 1, "1", shown_eqps_);
  if (materials_->can_fail()) add("damage", 1, "1", shown_damage_);
  return fields;
}

void TotalLagrangian::energies(std::vector<EnergyTerm>& terms) {
  if (!materials_->any_plastic()) return;
  EnergyTerm& term = terms.emplace_back(EnergyTerm{"plastic_work", EnergyTerm::Role::memo, {}});
  term.local.add(std::span(materials_->plastic_work.values).first(rest_.owned()));
}

std::vector<HistoryValue> TotalLagrangian::history_values() {
  std::vector<HistoryValue> values;
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < p_.owned(); ++i) most = std::max(most, shown_eqps_[i]);
  if (materials_->any_plastic()) values.push_back({"max_eqps", HistoryValue::Reduce::max, most});
  if (materials_->can_fail())
    values.push_back({"failed_particles", HistoryValue::Reduce::sum, static_cast<double>(lost_)});
  return values;
}

void TotalLagrangian::save(CheckpointWriter& file) {
  const GlobalOrder order(c_.comm, std::span(rest_.ids).first(rest_.owned()),
                          c_.comm.sum(static_cast<std::int64_t>(rest_.owned())));
  for (const Column& column : rest_.columns())
    if (column.kept)
      file.array(c_.name + ".rest." + column.name, order,
                 std::span(column.values).first(rest_.owned() * static_cast<std::size_t>(column.components)),
                 column.components);
}

void TotalLagrangian::load(const CheckpointReader& file) {
  build();
  const GlobalOrder order(c_.comm, std::span(rest_.ids).first(rest_.owned()),
                          c_.comm.sum(static_cast<std::int64_t>(rest_.owned())));
  for (Column& column : rest_.columns())
    if (column.kept)
      file.array(c_.name + ".rest." + column.name, order,
                 std::span(column.values).first(rest_.owned() * static_cast<std::size_t>(column.components)),
                 column.components);
  find_moments();
}

std::int64_t TotalLagrangian::memory() const {
  return rest_order_ ? rest_order_->memory() + static_cast<std::int64_t>(neighbours_.capacity() * sizeof(LocalIndex) +
                                                                         begin_.capacity() * sizeof(std::size_t))
                     : 0;
}

std::unique_ptr<Formulation> make_total_lagrangian(const SphContext& context) {
  return std::make_unique<TotalLagrangian>(context);
}

}  // namespace tenon
