// SPDX-License-Identifier: BSD-3-Clause
// Fully integrated hexahedra, wedges and pyramids with mean dilatation; tetrahedra with nodal averages of it.
#pragma once

#include "components/mechanics/element_group.hpp"
#include "components/mechanics/solid_kernel.hpp"
#include "components/mechanics/stable_step.hpp"

namespace tenon {

/// The mean-dilatation (B-bar) element [Hug80]: every point has the volume strain of the whole element, so nothing
/// locks when the material is, or flows, incompressible. With one point of a tetrahedron that would still lock:
/// `averaged` elements take the mean, at their nodes, of the volume strain of all elements of the group around each
/// node, weighted by volume, and the pressures return by the transpose ([BB98], [DPHS00] in rate form), so their power
/// is exact. What averaging leaves without stiffness, the bulk viscosity of the single elements damps.
template <int N, int P>
class SolidGroup final : public ElementGroup {
 public:
  SolidGroup(std::size_t block, const ElementBlock& elements, std::span<const Vec3> coordinates,
             const MaterialDescription& material, const BulkViscosity& viscosity, bool averaged);

  std::string_view formulation() const override;
  int passes() const override { return averaged_ ? 3 : 1; }
  void prepare(int pass, const NodeArrays& nodes, double dt) override;
  std::span<Vec3> nodal_values() override { return nodal_; }
  GroupStep advance(const NodeArrays& nodes, double dt) override;
  bool has_product() const override { return true; }
  void add_product(const NodeArrays& nodes, const double* u, double stiffness, double damping,
                   ForceRow* out) const override;
  double volume(LocalIndex element, std::span<const Vec3> positions) const override;
  void erode(const ErosionOptions& options) override;
  std::vector<StateArray> state() override;
  std::int64_t memory() const override;

 private:
  using Geometry = SolidGeometry<Pack, N, P>;
  using Vectors = NodeVectors<Pack, N>;
  static constexpr int halves = lanes / pack_width;

  /// One batch in the course of an update.
  struct Work {
    Batch<6> strain[P], before[P];
    Batch<1> temperature_increment, volume_ratio, added_heat, plastic_work;
    Batch<9> gradient[P];
  };

  void deform(std::size_t b, int lane, const NodeArrays& nodes, double dt, Work& work);
  void measure(std::size_t b, int lane, const NodeArrays& nodes, Work& work);
  void update(std::size_t b, const NodeArrays& nodes, double dt);
  void resist(std::size_t b, int lane, const NodeArrays& nodes, double dt, double (*rows)[N][pack_width],
              Batch<1>& step, Batch<1>& wave_step);
  void bury(std::size_t b, const Work& work, const Batch<1>* shares);
  void silence(std::size_t b, double (*rows)[N][pack_width], Batch<1>& step);
  void store_rows(const Vectors& f, double (*rows)[N][pack_width]) const;
  void scatter(const double (*rows)[N][pack_width], std::size_t b, double* force) const;
  // Of averaged elements.
  void sum_dilatation(const NodeArrays& nodes, double dt);
  void sum_pressure(const NodeArrays& nodes);
  Pack nodal_mean(std::size_t b, int lane) const;
  void add_to_nodes(std::size_t b, const Batch<3>& values);

  SolidTable<N, P> table_;
  BulkViscosity viscosity_;
  bool averaged_, needs_measures_;
  std::vector<SolidConnectivity<N>> connectivity_;
  ElementValues reference_volume_;  // m^3
  ElementValues viscosity_used_;    // J, that the material has received; only if it asks for it
  std::vector<Batch<2>> moduli_;    // of the last update; only if they vary
  Batch<2> constant_moduli_;
  // Of averaged elements. Nodal sums over quarters of living elements: first {volume at mid-step, that times the volume
  // strain, 0}, then {volume, that times the mean stress, 0}.
  std::vector<Vec3> nodal_;
  // V/V0 by the averaged volume strains since the start, if the material asks for it: what did the work on it, and what
  // the death of a neighbour leaves as it is.
  ElementValues volume_ratio_;
  // Where elements can die: change of the element's own volume in the step, m^3, and the averaged mean stress, Pa.
  ElementValues expansion_, mean_;
};

/// Chooses N and P by the kind of the elements, not quad4 or tri3.
std::unique_ptr<ElementGroup> make_solid_group(std::size_t block, const ElementBlock& elements,
                                               std::span<const Vec3> coordinates, const MaterialDescription& material,
                                               const BulkViscosity& viscosity, bool averaged);

}  // namespace tenon
