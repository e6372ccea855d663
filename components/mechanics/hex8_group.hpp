// SPDX-License-Identifier: BSD-3-Clause
// One-point hexahedra: the loop over the batches of a group.
#pragma once

#include <limits>

#include "components/mechanics/element_group.hpp"
#include "components/mechanics/hex8_kernel.hpp"

namespace tenon {

/// [FB81]: volume-averaged gradient, one integration point, hourglass control of the form H.
template <HourglassForm H>
class Hex8Group final : public ElementGroup {
 public:
  /// `coordinates` are those of the reference configuration.
  Hex8Group(std::size_t block, const ElementBlock& elements, std::span<const Vec3> coordinates,
            const MaterialDescription& material, const H& hourglass, const BulkViscosity& viscosity);

  std::string_view formulation() const override { return "hex8, one point"; }
  GroupStep advance(const NodeArrays& nodes, double dt) override;
  bool has_product() const override { return true; }
  void add_product(const NodeArrays& nodes, const double* u, double stiffness, double damping,
                   ForceRow* out) const override;
  double volume(LocalIndex element, std::span<const Vec3> positions) const override;
  std::vector<StateArray> state() override;
  std::int64_t memory() const override;

 private:
  using HourglassBatch = Batch<(H::state_size > 0 ? H::state_size : 1)>;
  static constexpr int halves = lanes / pack_width;

  /// What a batch needs besides its own state, in the course of an update.
  struct Work {
    Batch<1> plastic_work_density, relaxation;
    Batch<2> moduli;
  };

  void advance_batch(std::size_t b, const NodeArrays& nodes, double dt, Batch<1>& least, Batch<1>& where,
                     double& shrink);
  void update_material(std::size_t b, const NodeArrays& nodes, const HexModes<Pack> (&x)[halves],
                       const HexModes<Pack> (&v)[halves], double dt, Work& work);
  void deform(std::size_t b, int lane, const HexModes<Pack>& x, const HexModes<Pack>& v, double dt,
              Batch<6>& strain_increment, Batch<1>& temperature_increment);
  void measure(std::size_t b, int lane, const HexModes<Pack>& x, const NodeArrays& nodes, Batch<9>& gradient,
               Batch<1>& volume_ratio, Batch<1>& added_heat);
  Pack resist(std::size_t b, int lane, const HexModes<Pack>& x, const HexModes<Pack>& v, double dt, const Work& work,
              double (*rows)[8][pack_width], Batch<1>& wave_step);
  void add_energies(std::size_t b, int lane, const ElementForces<Pack>& f, const Work& work);
  void bury(std::size_t b, double (*rows)[8][pack_width], Batch<1>& step);
  ElementReference<Pack> reference(std::size_t b, int lane, const Pack& relaxation) const {
    return {load(mass[b][0] + lane), load(reference_size_[b][0] + lane), relaxation};
  }

  HexParameters<H> parameters_;
  std::vector<HexConnectivity> connectivity_;
  ElementValues reference_size_;  // cube root of the undeformed volume, m
  std::vector<HourglassBatch> hourglass_state_;
  ElementValues viscosity_used_;  // J, that the material has received; only if it asks for it
  std::vector<Batch<2>> moduli_;  // of the last update; only if they vary
  Batch<2> constant_moduli_;
  bool needs_measures_, relaxes_;
};

std::unique_ptr<ElementGroup> make_hex8_group(std::size_t block, const ElementBlock& elements,
                                              std::span<const Vec3> coordinates, const MaterialDescription& material,
                                              const HourglassOptions& hourglass, const BulkViscosity& viscosity);

}  // namespace tenon
