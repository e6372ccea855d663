// SPDX-License-Identifier: BSD-3-Clause
// Solids of particles that keep the neighbours of the start.
#pragma once

#include <memory>
#include <vector>

#include "components/sph/formulation.hpp"
#include "components/sph/pair_contact.hpp"
#include "components/sph/solid_materials.hpp"
#include "framework/comm/directory.hpp"
#include "framework/comm/exchange_plan.hpp"

namespace tenon {

/// [RL96, BK01, Gan15]. Sums run over the neighbours of the start, so nothing parts because it is stretched:
///   F_i = 1 + sum_j V_j (u_j - u_i) (M_i^-1 grad W),   a_i = V_i/m_i sum_j V_j (P_i M_i^-1 + P_j M_j^-1) grad W
/// with reference volumes V, first Piola-Kirchhoff stress P = J sigma F^-T and the moment matrix M of
/// gradient_correction. Forces are the derivatives of sum V w(F), and F turns with the body: linear and angular
/// momentum are kept.
///
/// All of this lives in the reference configuration, which has a decomposition of its own that never changes: particles
/// there, `rest_`, stand where they started and never migrate, so the neighbours of the start are near however far they
/// went. Each step present places and velocities go there, and accelerations and results come back, by one plan.
class TotalLagrangian final : public Formulation {
 public:
  explicit TotalLagrangian(const SphContext& context);

  void start() override;
  void compute(double time, double dt) override;
  Limit stable_step() const override;
  std::vector<ForcePart> forces() override;
  std::vector<ParticleField> fields() override;
  void energies(std::vector<EnergyTerm>& terms) override;
  std::vector<HistoryValue> history_values() override;
  void save(CheckpointWriter& file) override;
  void load(const CheckpointReader& file) override;
  std::int64_t memory() const override;

 private:
  void build();
  void find_bonds();
  void follow();
  void send_there(double dt);
  void bring_back();
  void displace();
  void deform(double dt);
  void find_moments();
  void push_back_stress();
  double secant_modulus(std::size_t i);
  template <typename K, int d>
  void moments();
  template <typename K, int d>
  void deformation_gradients();
  template <typename K, int d>
  void forces_of_pairs();
  void record_places();
  void record_pushes();
  void sum_moments();
  void sum_deformation();
  void sum_forces();

  SphContext c_;
  ParticleData& p_;

  // Of the component's particles.
  Column &origin_, &volume_, &pushed_, &hourglass_pushed_, &dragged_;  // at the start; accelerations
  Column &internal_, &hourglass_, &viscosity_;                         // energies, J
  Column &shown_stress_, &shown_eqps_, &shown_damage_, &failed_, &step_, &predicted_,
      &heat_made_;  // the last two: scratch
  std::unique_ptr<PairContact> contact_;

  // In the reference configuration.
  ParticleData rest_;
  Column &displacement_, &arrived_, &arrived_temperature_, &deformation_, &deformed_, &gradient_, &correction_, &bonds_,
      &push_, &heating_, &a_, &a_hourglass_, &a_viscous_, &sound_, &rest_step_, &eqps_, &damage_, &gone_, &speed_,
      &secant_, &strength_;
  std::unique_ptr<SolidMaterials> materials_;
  std::unique_ptr<ParticleDecomposition> rest_order_;
  std::unique_ptr<Directory> directory_;
  std::vector<std::size_t> begin_;
  std::vector<LocalIndex> neighbours_;  // in canonical order, padded to packs by the particle itself
  std::vector<double> records_;         // of all that stand there: what sums read of neighbours
  std::vector<Elasticity> elasticity_;  // of bodies
  ExchangePlan plan_;                   // forward: from there; reverse: to there
  std::int64_t version_ = -1;
  std::int64_t lost_ = 0;
};

}  // namespace tenon
