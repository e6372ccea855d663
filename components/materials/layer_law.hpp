// SPDX-License-Identifier: BSD-3-Clause
// Laws that update all layers of a batch of shell elements in one call.
#pragma once

#include <memory>
#include <span>

#include "components/materials/batch.hpp"

namespace tenon {

struct MaterialDescription;

/// Strain over a step, linear through the thickness, and the layers. Shear strains as angles.
struct LayerInput {
  /// Of the middle surface: xx yy xy; of the top face less that: xx yy xy; constant: zx yz.
  const Batch<8>& strain;
  const Batch<1>& temperature_increment;  ///< K
  std::span<const double> place;          ///< of the layers, -1 (bottom) .. 1 (top)
  std::span<const double> weight;         ///< sum 1
  std::span<const double> bending;        ///< shares in the bending stiffness, sum 1, or all 0
};

/// Means through the thickness.
struct LayerOutput {
  Batch<1> thinning;      ///< strain zz over the step
  Batch<1> plastic_work;  ///< J/m^3 of the step
  /// What flow left of the deviator of the elastic trial, 1 if it was elastic: by `weight` and by `bending`.
  Batch<1> squash, bend;
};

/// As MaterialModel::update_plane_stress layer by layer, for laws in which that pays: the strain is formed and used in
/// registers, and a layer in which nothing flows costs no more than an elastic one. The normal stress is not touched,
/// it is zero.
class LayerLaw {
 public:
  virtual ~LayerLaw() = default;
  /// `stress` and `history`: one batch for each layer; the history of these laws is at most one row, eqps.
  virtual void update(const LayerInput& input, Batch<6>* stress, Batch<1>* history, LayerOutput& output) const = 0;
};

/// Linear elasticity and J2 with linear hardening, without failure; null for other materials.
std::unique_ptr<const LayerLaw> make_layer_law(const MaterialDescription& description);

}  // namespace tenon
