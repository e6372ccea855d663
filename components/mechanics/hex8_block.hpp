// SPDX-License-Identifier: BSD-3-Clause
// State and step of all hexahedra of one block, in batches.
#pragma once

#include <memory>
#include <vector>

#include "components/materials/material.hpp"
#include "components/mechanics/hex8_kernel.hpp"
#include "components/mechanics/mechanics_options.hpp"
#include "framework/mesh/mesh.hpp"

namespace tenon {

/// Least stable step of a block, or a code, and the first element that has it.
struct BlockStep {
  double step;
  LocalIndex element;
};

/// One value per element.
using ElementValues = std::vector<Batch<1>>;
inline double& value_of(ElementValues& values, LocalIndex element) {
  return values[static_cast<std::size_t>(element / lanes)][0][element % lanes];
}
inline double value_of(const ElementValues& values, LocalIndex element) {
  return values[static_cast<std::size_t>(element / lanes)][0][element % lanes];
}

/// Elements stand in ascending global order, owned and ghost; the last batch is filled up with copies of the last
/// element, whose forces are not added. Material and hourglass form are chosen once, when the block is made.
class Hex8Block {
 public:
  /// `coordinates` are those of the reference configuration.
  Hex8Block(const ElementBlock& block, std::span<const Vec3> coordinates, const MaterialDescription& material);
  virtual ~Hex8Block() = default;

  /// Advances stress, history, temperature and energies over a step of length dt that ends at the present positions
  /// (not at all if dt is 0), and adds the internal forces there to the nodes.
  virtual BlockStep advance(const NodeArrays& nodes, double dt) = 0;

  virtual int history_size() const = 0;
  virtual double history(LocalIndex element, int i) const = 0;
  virtual void set_history(LocalIndex element, int i, double value) = 0;
  virtual int hourglass_state_size() const = 0;
  virtual double hourglass_state(LocalIndex element, int i) const = 0;
  virtual void set_hourglass_state(LocalIndex element, int i, double value) = 0;
  virtual bool plastic() const = 0;
  virtual std::int64_t memory() const;

  LocalIndex size() const { return size_; }
  const MaterialDescription& material() const { return material_; }

  double& stress(LocalIndex element, int component) {
    return stresses[static_cast<std::size_t>(element / lanes)][component][element % lanes];
  }
  /// Makes the padding equal to the last element, after values were set one by one.
  virtual void fill_padding();

  std::vector<HexConnectivity> connectivity;
  std::vector<Batch<6>> stresses;                    ///< Cauchy, Pa
  ElementValues mass;                                ///< kg
  ElementValues reference_size;                      ///< cube root of the undeformed volume, m
  ElementValues temperature;                         ///< K
  ElementValues temperature_used;                    ///< K, at the last update of the stress
  ElementValues plastic_work;                        ///< J, since the start
  ElementValues hourglass_energy, viscosity_energy;  ///< J, since the start
  /// K per J/m^3 of plastic work and m^3/kg: Taylor-Quinney share over specific heat if heated adiabatically, or 0.
  double heating = 0;

 protected:
  std::size_t batches() const { return connectivity.size(); }
  /// Real elements of a batch.
  int count(std::size_t batch) const {
    return batch + 1 < connectivity.size() ? lanes : size_ - lanes * (static_cast<int>(connectivity.size()) - 1);
  }

 private:
  LocalIndex size_;
  MaterialDescription material_;
};

std::unique_ptr<Hex8Block> make_hex8_block(const ElementBlock& block, std::span<const Vec3> coordinates,
                                           const MaterialDescription& material, const HourglassOptions& hourglass,
                                           const BulkViscosity& viscosity);

}  // namespace tenon
