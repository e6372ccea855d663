// SPDX-License-Identifier: BSD-3-Clause
// Elements of one kind, material and formulation: state in batches, and their share in a step.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "components/materials/material.hpp"
#include "components/mechanics/material_points.hpp"
#include "components/mechanics/mechanics_options.hpp"
#include "components/mechanics/nodal_state.hpp"
#include "framework/mesh/mesh.hpp"

namespace tenon {

/// Codes in place of a stable step.
inline constexpr double inverted_element = -1;   ///< volume not positive
inline constexpr double exploding_element = -2;  ///< not a number, or strained beyond `greatest_strain` in one step
/// Far above what the step before an inversion shows (about 1), so that an inversion is called one.
inline constexpr double greatest_strain = 100;

/// Least stable step of a group, or a code, and the first element that has it. `shrink`: by how much the limit of a
/// mesh that was verified (ElementGroup::verify) may have fallen since, from 1 downwards.
struct GroupStep {
  double step;
  LocalIndex element;
  double shrink = 1;
};

/// One value per element.
using ElementValues = std::vector<Batch<1>>;
inline double& value_of(ElementValues& values, LocalIndex element) {
  return values[static_cast<std::size_t>(element / lanes)][0][element % lanes];
}
inline double value_of(const ElementValues& values, LocalIndex element) {
  return values[static_cast<std::size_t>(element / lanes)][0][element % lanes];
}

/// What a checkpoint keeps of every element: `rows` values, of batch b in data[b * rows ...].
struct StateArray {
  std::string name;
  int rows;
  Batch<1>* data;
  double& at(LocalIndex element, int row) const {
    return data[static_cast<std::ptrdiff_t>(element / lanes) * rows + row][0][element % lanes];
  }
};

/// Masses of the nodes of an element.
struct NodalMasses {
  std::span<double> mass;     ///< kg
  std::span<double> inertia;  ///< kg m^2, rotation of the node; empty unless some group has rotations
};

/// Elements stand in ascending global order, owned and ghost; the last batch is filled up with copies of the last
/// element, whose forces are not added. Material and formulation are chosen once, when the group is made.
class ElementGroup {
 public:
  ElementGroup(std::size_t block, const ElementBlock& elements, const MaterialDescription& material, int points);
  virtual ~ElementGroup() = default;
  ElementGroup(const ElementGroup&) = delete;
  ElementGroup& operator=(const ElementGroup&) = delete;

  /// As a user knows it: "hex8 one point".
  virtual std::string_view formulation() const = 0;
  virtual bool has_rotations() const { return false; }

  /// Adds the shares of all elements to their nodes, in ascending order.
  virtual void add_masses(const NodalMasses& masses) const;

  /// Groups whose elements need averages over the elements around a node work in passes: `prepare` is called for each
  /// pass but the last, which is `advance`; after each `prepare` the nodal values are refreshed on ghost nodes.
  virtual int passes() const { return 1; }
  virtual void prepare(int pass, const NodeArrays& nodes, double dt);
  virtual std::span<Vec3> nodal_values() { return {}; }

  /// Advances stress, history, temperature and energies over a step of length dt that ends at the present positions
  /// (not at all if dt is 0), and adds the internal forces there to the nodes.
  virtual GroupStep advance(const NodeArrays& nodes, double dt) = 0;

  /// Adds (stiffness K + damping C) u to `out` for the geometry and moduli of the last `advance`; u and `out` are nodal
  /// vectors, u as NodeArrays hold positions. Formulations without such a product bound the stable step element by
  /// element.
  virtual bool has_product() const { return false; }
  virtual void add_product(const NodeArrays& nodes, const double* u, double stiffness, double damping,
                           ForceRow* out) const;

  /// From now on `advance` finds how the limit of the mesh may have changed since the last `verify`. Before a restart.
  void follow_limit();
  /// Says that the mesh allows `step` (s) in the state of the last `advance`.
  void verify(double step);

  /// Present volume of one element, m^3.
  virtual double volume(LocalIndex element, std::span<const Vec3> positions) const = 0;

  /// Everything that a restart needs.
  virtual std::vector<StateArray> state();
  virtual std::int64_t memory() const;
  /// Makes the padding equal to the last element, after values were set one by one.
  void fill_padding();
  void fill_padding_of(ElementValues& values) const;

  LocalIndex size() const { return size_; }
  std::size_t block() const { return block_; }
  const ElementBlock& elements() const { return elements_; }
  const MaterialDescription& material() const { return material_; }
  const MaterialModel& model() const { return points.model(); }
  /// Mean over the integration points, Pa.
  virtual double stress(LocalIndex element, int component) const;
  /// Mean over the integration points of a row of the material's history.
  virtual double history(LocalIndex element, int row) const;
  /// Of shells: stress at the outermost integration point of a face (top: where the normal points), Pa, and thickness,
  /// m; of solids the mean stress and 0.
  virtual double face_stress(LocalIndex element, int component, bool top) const;
  virtual double thickness(LocalIndex) const { return 0; }
  bool alive(LocalIndex element) const {
    return dead.empty() || (value_of(dead, element) == 0 && (doomed.empty() || value_of(doomed, element) == 0));
  }
  /// Before the first step: elements may be taken out by their step or shape.
  virtual void erode(const ErosionOptions& options);

  /// Part of a rigid body: never advanced, and its mass is the body's.
  bool rigid = false;
  /// Elements of this group may fail and be taken out; `deaths` grows whenever one is, or is doomed.
  bool can_die = false;
  std::int64_t deaths = 0;
  MaterialPoints points;
  ElementValues mass;                                ///< kg
  ElementValues temperature;                         ///< K
  ElementValues temperature_used;                    ///< K, at the last update of the stress
  ElementValues plastic_work;                        ///< J, since the start
  ElementValues hourglass_energy, viscosity_energy;  ///< J, since the start
  ElementValues heat_given;                          ///< J, taken from here by another component; empty unless exported
  /// Only where elements can die: 1 from the step on in which it did, and the energy within, J (of a dead element
  /// that at its death).
  ElementValues dead, internal_energy;
  /// Only where their step or shape can take elements out: 1 if it has done so at the present positions. Their stress
  /// still acts there (not if they are inside out); they are dead from the next step on.
  ElementValues doomed;
  /// K per J/m^3 of plastic work and m^3/kg: Taylor-Quinney share over specific heat if heated adiabatically, or 0.
  double heating = 0;
  /// Stable step of each element as of the last `advance`, s; filled only while it is not empty.
  ElementValues steps;
  /// While the limit is followed: the step of each element among its like, s, by now and when a step was verified.
  ElementValues wave_steps, verified_wave_steps;
  double verified_step = 0;  ///< s; 0: none yet

 protected:
  std::size_t batches() const { return mass.size(); }
  /// Real elements of a batch.
  int count(std::size_t batch) const {
    return batch + 1 < batches() ? lanes : size_ - lanes * (static_cast<int>(batches()) - 1);
  }
  /// Local node of corner i of an element; of the last element in the padding.
  LocalIndex node(LocalIndex element, int corner) const;
  bool follows() const { return !wave_steps.empty(); }
  /// At the start of a step: what was doomed dies.
  void settle(std::size_t batch);
  /// 1 in each lane whose element is dead or has failed.
  void find_gone(std::size_t batch, Batch<1>& gone) const;
  void die(std::size_t batch, int lane);
  /// Dooms the living whose step is too short, or a code that options allow; none of them limits the step. 1 in
  /// `inverted` for those that are inside out.
  void doom(std::size_t batch, Batch<1>& step, Batch<1>& inverted);
  /// Takes the steps of a batch, by its elements alone and among their like, into the least shrink.
  void follow(std::size_t batch, const Batch<1>& step, const Batch<1>& wave_step, double& shrink);

 private:
  std::size_t block_;
  const ElementBlock& elements_;
  LocalIndex size_;
  MaterialDescription material_;
  double least_step_ = 0;  // s
  bool takes_inverted_ = false;
};

}  // namespace tenon
