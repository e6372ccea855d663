// SPDX-License-Identifier: BSD-3-Clause
// A material as element and particle loops see it: one virtual call per batch, chosen once per block.
#pragma once

#include <concepts>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "components/materials/failure.hpp"
#include "components/materials/material_concept.hpp"
#include "components/materials/plane_stress.hpp"

namespace tenon {

struct MaterialDescription;

/// History of a batch of points: `state_size()` consecutive rows of `lanes` values. With a failure criterion the last
/// row is `damage`: the point has failed where it reaches 1.
using StateRows = Batch<1>*;

class MaterialModel {
 public:
  virtual ~MaterialModel() = default;

  virtual int state_size() const = 0;
  virtual std::string state_name(int i) const = 0;
  virtual double initial_state(int i) const = 0;
  /// State 0 is the equivalent plastic strain.
  virtual bool plastic() const = 0;
  /// Row of the damage, or -1: nothing can fail.
  virtual int damage() const = 0;

  /// What must be given in UpdateInput.
  virtual bool needs_deformation_gradient() const = 0;
  virtual bool needs_volume_ratio() const = 0;
  virtual bool needs_added_heat() const = 0;
  /// First rows of the symmetric tensors (six rows each) and of the vectors (three rows each) in the state, which the
  /// caller rotates along with the stress before each update.
  virtual std::span<const int> rotating_tensors() const = 0;
  virtual std::span<const int> rotating_vectors() const = 0;

  /// Moduli of small strains from the undeformed state: of an isotropic material that is never softer anywhere.
  virtual const Elasticity& elasticity() const = 0;
  /// Whether the moduli of the next increment can differ from those; then `stiffness` gives them.
  virtual bool variable_stiffness() const = 0;
  /// Bounds from above of the present Lame constants (row 0: lambda, row 1: shear modulus, Pa), for the stable step.
  virtual void stiffness(const UpdateInput& input, const Batch<6>& stress, const Batch<1>* state,
                         Batch<2>& moduli) const = 0;

  /// Whether an update can leave less stress than its elastic trial would have, stress before + 2 mu strain increment
  /// in the deviator; `trial_shear` gives that mu of the last update (row 0, Pa).
  virtual bool flows() const = 0;
  virtual void trial_shear(const UpdateInput& input, Batch<1>& shear) const = 0;

  /// As Material::update, with the failure criterion after it.
  virtual void update(const UpdateInput& input, Batch<6>& stress, StateRows state, Batch<1>& plastic_work) const = 0;
  /// Whether there is such a law for shells: not where the stress follows from a deformation gradient or a volume that
  /// the strain through the thickness would change.
  virtual bool supports_plane_stress() const = 0;
  /// The same under the condition that the stress normal to the z direction of the given frame stays zero: the strain
  /// increment zz of `input` is not read, and the one that results is given (row 0: strain over the step).
  virtual void update_plane_stress(const UpdateInput& input, Batch<6>& stress, StateRows state, Batch<1>& plastic_work,
                                   Batch<1>& thickness_increment) const = 0;
};

/// Throws Error(usage) if the description gives nothing from which mechanics could find stresses.
std::shared_ptr<const MaterialModel> make_material_model(const MaterialDescription& description);

/// MaterialModel of a struct that satisfies Material. Such a struct may also have
///   static constexpr bool needs_deformation_gradient, needs_volume_ratio, needs_added_heat;   (false)
///   static constexpr std::array<int, n> rotating_tensors, rotating_vectors;                   (none)
///   double initial_state(int i) const;                                                       (0)
///   void stiffness(const UpdateInput&, const Batch<6>& stress, const StateBatch<M>&, Batch<2>& moduli) const;
///   static constexpr bool flows;                               (whether state 0 is the equivalent plastic strain)
///   void trial_shear(const UpdateInput&, Batch<1>& shear) const;                          (the one of `elasticity`)
///   void update_plane_stress(const UpdateInput&, Batch<6>&, StateBatch<M>&, Batch<1>& work, Batch<1>& thickness)
///   const;
template <Material M>
class MaterialModelOf final : public MaterialModel {
 public:
  MaterialModelOf(const M& material, const std::optional<FailureCriterion>& failure)
      : material_(material), failure_(failure), elasticity_(material.elasticity) {}

  int state_size() const override { return M::state_size + (failure_ ? 1 : 0); }
  std::string state_name(int i) const override {
    return i == damage() ? "damage" : std::string(M::state_names.at(static_cast<std::size_t>(i)));
  }
  double initial_state(int i) const override {
    if constexpr (requires { material_.initial_state(i); }) {
      if (i < M::state_size) return material_.initial_state(i);
    }
    return 0;
  }
  bool plastic() const override {
    if constexpr (M::state_size > 0) return M::state_names[0] == "eqps";
    return false;
  }
  int damage() const override { return failure_ ? M::state_size : -1; }
  bool flows() const override {
    if constexpr (requires { M::flows; }) return M::flows;
    return plastic();
  }
  void trial_shear(const UpdateInput& input, Batch<1>& shear) const override {
    if constexpr (requires { material_.trial_shear(input, shear); })
      material_.trial_shear(input, shear);
    else
      for (int l = 0; l < lanes; ++l) shear[0][l] = elasticity_.shear_modulus();
  }
  bool needs_deformation_gradient() const override {
    if constexpr (requires { M::needs_deformation_gradient; }) return M::needs_deformation_gradient;
    return false;
  }
  bool needs_volume_ratio() const override {
    if constexpr (requires { M::needs_volume_ratio; }) return M::needs_volume_ratio;
    return false;
  }
  bool needs_added_heat() const override {
    if constexpr (requires { M::needs_added_heat; }) return M::needs_added_heat;
    return false;
  }
  std::span<const int> rotating_tensors() const override {
    if constexpr (requires { M::rotating_tensors; }) return M::rotating_tensors;
    return {};
  }
  std::span<const int> rotating_vectors() const override {
    if constexpr (requires { M::rotating_vectors; }) return M::rotating_vectors;
    return {};
  }
  const Elasticity& elasticity() const override { return elasticity_; }
  bool variable_stiffness() const override { return has_stiffness; }
  bool supports_plane_stress() const override { return !needs_deformation_gradient() && !needs_volume_ratio(); }

  void stiffness(const UpdateInput& input, const Batch<6>& stress, const Batch<1>* state,
                 Batch<2>& moduli) const override {
    if constexpr (has_stiffness) {
      StateBatch<M> none;
      material_.stiffness(input, stress, M::state_size > 0 ? rows(const_cast<Batch<1>*>(state)) : none, moduli);
    } else {
      for (int l = 0; l < lanes; ++l)
        moduli[0][l] = elasticity_.lame_lambda(), moduli[1][l] = elasticity_.shear_modulus();
    }
  }

  void update(const UpdateInput& input, Batch<6>& stress, StateRows state, Batch<1>& plastic_work) const override {
    advance(input, stress, state,
            [&](StateBatch<M>& history) { material_.update(input, stress, history, plastic_work); });
  }

  void update_plane_stress(const UpdateInput& input, Batch<6>& stress, StateRows state, Batch<1>& plastic_work,
                           Batch<1>& thickness_increment) const override {
    advance(input, stress, state, [&](StateBatch<M>& history) {
      if constexpr (requires {
                      material_.update_plane_stress(input, stress, history, plastic_work, thickness_increment);
                    })
        material_.update_plane_stress(input, stress, history, plastic_work, thickness_increment);
      else if constexpr (
          requires { M::needs_deformation_gradient; } || requires { M::needs_volume_ratio; })
        throw std::logic_error("this material has no plane stress");
      else
        iterate_plane_stress(material_, input, stress, history, plastic_work, thickness_increment);
    });
  }

 private:
  static constexpr bool has_stiffness =
      requires(const M m, const UpdateInput& input, const Batch<6>& s, const StateBatch<M>& h, Batch<2>& moduli) {
    m.stiffness(input, s, h, moduli);
  };
  /// Rows of doubles, and a batch of as many rows, are the same memory.
  static StateBatch<M>& rows(Batch<1>* state) { return reinterpret_cast<StateBatch<M>&>(*state); }

  template <typename Update>
  void advance(const UpdateInput& input, const Batch<6>& stress, StateRows state, Update update) const {
    Batch<1> before{};
    if (failure_ && plastic()) before = state[0];
    StateBatch<M> none;
    update(M::state_size > 0 ? rows(state) : none);
    if (!failure_) return;
    const Batch<1> zero{};
    failure_->accumulate(
        {stress, before, plastic() ? state[0] : zero, input.temperature, input.strain_increment, input.dt},
        state[M::state_size]);
  }

  M material_;
  std::optional<FailureCriterion> failure_;
  Elasticity elasticity_;
};

}  // namespace tenon
