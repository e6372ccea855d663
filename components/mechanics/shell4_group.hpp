// SPDX-License-Identifier: BSD-3-Clause
// Shells of four and three nodes: the loop over the batches of a group.
#pragma once

#include "components/materials/layer_law.hpp"
#include "components/mechanics/element_group.hpp"
#include "components/mechanics/shell4_section.hpp"
#include "components/mechanics/shell4_step.hpp"

namespace tenon {

/// One integration point in the plane of the element, several through its thickness; S: QuadShell or TriShell. Stress
/// and history stand in the element's own axes. What varies over the element is resisted by the elastic energy of the
/// assumed strains (no coefficient to choose), relaxed as the mean layer flows.
///
/// The spin about the normal gets a weak spring against the turn of the surface (`drilling`), so that it has neither a
/// mode of no energy nor a say in the bending of folds.
template <typename S>
class ShellGroup final : public ElementGroup {
 public:
  /// `coordinates` are those of the reference configuration. Throws Error(usage) if the material has no plane stress.
  ShellGroup(std::size_t block, const ElementBlock& elements, std::span<const Vec3> coordinates,
             const MaterialDescription& material, const ShellSection& section, int points,
             const BulkViscosity& viscosity);

  std::string_view formulation() const override {
    return S::nodes == 4 ? "quad4 shell, one point in the plane" : "tri3 shell, one point in the plane";
  }
  bool has_rotations() const override { return true; }
  void add_masses(const NodalMasses& masses) const override;
  GroupStep advance(const NodeArrays& nodes, double dt) override;
  double volume(LocalIndex element, std::span<const Vec3> positions) const override;
  double stress(LocalIndex element, int component) const override;
  double face_stress(LocalIndex element, int component, bool top) const override;
  double thickness(LocalIndex element) const override { return value_of(thickness_, element); }
  void erode(const ErosionOptions& options) override;
  std::vector<StateArray> state() override;
  std::int64_t memory() const override;

 private:
  static constexpr int halves = lanes / pack_width;
  static constexpr int varying = S::hourglasses + S::drills;
  /// Of the bending stiffness E t^3/12.
  static constexpr double drilling = 1e-3;
  /// What is left of the varying shear strain of a triangle: enough for its rank.
  static constexpr double triangle_shear = 0.01;

  struct alignas(64) Connectivity {
    std::int32_t node[S::nodes][lanes];
  };
  /// What a batch needs besides its own state, in the course of an update.
  struct Work {
    Batch<9> place;            ///< modes xi, eta, hourglass of the positions, m
    Batch<8> strain;           ///< over the step, as in LayerInput
    Batch<varying> variation;  ///< over the step: hourglass, drill
    Batch<8> resultant;        ///< Pa: means of xx yy xy, of these times place (-1..1), of zx yz
    LayerOutput flow;
  };
  using Rows = double (*)[S::nodes][pack_width];

  static ShellModes<Pack> gather(const double* values, const Connectivity& c, int lane);
  static void place(const double* position, const Connectivity& c, int lane, Work& work);
  static ShellModes<Pack> placed(const Work& work, int lane);
  static void store_rows(const ShellModes<Pack>& f, const Tensor<Pack>& axes, Rows rows);
  static void scatter(const double (*force)[S::nodes][pack_width], const double (*moment)[S::nodes][pack_width],
                      const Connectivity& c, int count, const NodeArrays& nodes);

  void set_reference(LocalIndex element, std::span<const Vec3> coordinates, const ShellSection& section);
  void advance_batch(std::size_t b, const NodeArrays& nodes, double dt, Batch<1>& least, Batch<1>& where);
  void fetch(std::size_t b) const;
  void deform(std::size_t b, int lane, const NodeArrays& nodes, double dt, Work& work, Batch<1>& temperature_increment);
  void update_material(std::size_t b, double dt, const Batch<1>& temperature_increment, Work& work);
  void update_layers(std::size_t b, double dt, const Batch<1>& temperature_increment, Work& work);
  void layer_strain(int lane, int point, const Work& work, Batch<6>& strain) const;
  void add_layers(std::size_t b, int lane, Work& work) const;
  void add_flow(int lane, int point, const Batch<1>& thinning, const Batch<1>& plastic, const Batch<1>& relaxation,
                Work& work) const;
  void add_energy(std::size_t b, int point, const Batch<6>& before, const Batch<6>& strain);
  Pack resist(std::size_t b, int lane, double dt, const Work& work, Rows force, Rows moment);
  Pack vary(std::size_t b, int lane, const ShellGeometry<Pack>& g, const ShellStiffness<Pack>& k, double dt,
            const Work& work, ShellResultants<Pack>& q);
  Pack check(const Pack& step, const Pack& thickness, const Work& work, int lane) const;
  void add_energies(std::size_t b, int lane, const Pack& volume, const Pack& hourglass, const Pack& viscous,
                    const Work& work);
  void drop_failed_layers(std::size_t b, int point);
  void bury(std::size_t b, Rows force, Rows moment, Batch<1>& step);

  ShellReference<Pack> reference(std::size_t b, int lane) const {
    const Batch<4>& r = reference_[b];
    return {load(r[0] + lane), load(r[1] + lane), load(r[2] + lane), load(r[3] + lane)};
  }
  Pack offset(const Pack& thickness) const { return offset_share_ * thickness + offset_; }
  double in_body_axes(LocalIndex element, const double (&stress)[6], int component) const;
  ShellStiffness<Pack> stiffness(std::size_t b, int lane, const Pack& thickness) const;

  ThroughThickness rule_;
  std::vector<double> bending_;          // shares of the layers in the bending stiffness
  std::unique_ptr<const LayerLaw> law_;  // null: layer by layer through the material
  double second_moment_;                 // of the rule, over t^2
  double offset_share_, offset_;         // of the middle surface from the nodes: share of t, m
  BulkViscosity viscosity_;
  std::vector<Connectivity> connectivity_;
  std::vector<Batch<4>> reference_;  // a1, a2 at the start in the element's axes, m
  ElementValues slowness_;           // mass of a node over its inertia, 1/m^2
  ElementValues shear_share_;        // 5/6 and less in thin triangles
  ElementValues thickness_;          // m, now
  ElementValues reference_volume_;   // m^3; only if elements can fail
  ElementValues stretching_;         // rate of area of the middle surface over the last step, 1/s: for the viscosity
  std::vector<Batch<varying>> varying_;  // stresses of the varying strains, Pa and Pa/m; drilling moments, N m
  const Vec3* position_;                 // of the last advance, at first of the reference
  std::vector<Batch<2>> moduli_;         // of the last update; only if they vary
  Batch<2> constant_moduli_;
  PlaneModuli<double> plane_moduli_;  // of these
};

std::unique_ptr<ElementGroup> make_shell_group(std::size_t block, const ElementBlock& elements,
                                               std::span<const Vec3> coordinates, const MaterialDescription& material,
                                               const ShellSection& section, const BulkViscosity& viscosity);

}  // namespace tenon
