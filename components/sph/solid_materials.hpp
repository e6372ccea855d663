// SPDX-License-Identifier: BSD-3-Clause
// Stress and history of the particles of solids.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "components/materials/material_model.hpp"
#include "components/sph/particle_data.hpp"
#include "components/sph/sph_options.hpp"

namespace tenon {

/// The laws of mechanics at particles, eight of one body at a time. Failed particles bear no shear and no tension.
class SolidMaterials {
  const SphOptions& options_;  // first: columns below follow from them
  ParticleData& particles_;
  std::vector<std::shared_ptr<const MaterialModel>> models_;  // of bodies

 public:
  /// Throws Error(usage) where a material gives nothing from which stresses could be found.
  SolidMaterials(const std::string& component, const SphOptions& options, ParticleData& particles);

  /// Local. The virgin state of owned particles, at these temperatures (K).
  void start(const Column& temperature);
  /// Local. The same of one particle.
  void start(std::size_t i, double temperature);

  /// What happened to owned particles in a step.
  struct Step {
    double dt;
    const Column& gradient;              ///< dt grad v of mid-step, 9
    const Column& temperature;           ///< K, at its end
    const Column& viscous_heating;       ///< W/kg
    const Column* deformation_gradient;  ///< 9, at its end; null: not known
  };
  /// Local. From `density` at the end of the step; `version` changes whenever particles change places.
  void update(const Step& step, std::int64_t version);

  bool can_fail() const { return can_fail_; }
  bool failed(std::size_t i) const { return can_fail_ && failed_[i] != 0; }

  Column &stress, &history;
  Column& modulus;       ///< rho c^2 of the fastest wave, Pa
  Column& plastic_work;  ///< J
  Column& plastic_heat;  ///< J in the last step; scratch

  /// Equivalent plastic strain, 0 where a material has none; damage likewise.
  double eqps(std::size_t i) const;
  double damage(std::size_t i) const;
  bool any_plastic() const { return any_plastic_; }
  const MaterialModel& model(std::size_t i) const { return *models_[static_cast<std::size_t>(particles_.body[i])]; }

 private:
  void find_members(std::int64_t version);
  void update_batch(const Step& step, std::size_t body, const LocalIndex* members, std::size_t count);
  void scatter(const Step& step, std::size_t body, const LocalIndex* members, std::size_t count, const Batch<6>& stress,
               const Batch<1>& work, const Batch<2>& moduli);
  int rows() const;

  Column &temperature_used_, &failed_;
  bool can_fail_ = false, any_plastic_ = false;
  std::vector<std::vector<LocalIndex>> members_;  // of bodies, owned
  std::int64_t version_ = -1;
  std::vector<Batch<1>> state_;
};

}  // namespace tenon
