// SPDX-License-Identifier: BSD-3-Clause
// The assembled conductivity matrix: rows of the nodes that this rank owns.
#pragma once

#include <span>
#include <vector>

#include "components/thermal/conductivity.hpp"
#include "components/thermal/element_conduction.hpp"
#include "framework/comm/directory.hpp"
#include "framework/mesh/mesh.hpp"

namespace tenon::thermal {

/// K_ij = integral of k grad N_i . grad N_j over the current configuration, W/K, in compressed rows. Row r belongs to
/// mesh.owned_nodes[r]; its columns ascend by global id, and the elements add to it in ascending order: the same bits
/// on any number of ranks, also for K_ij and K_ji on different ranks. The diagonal is minus the sum of the rest of its
/// row. Columns are local nodes and, behind them, nodes of other ranks that contact brings in.
class ConductionMatrix {
 public:
  /// Collective only in that every rank makes its own. The mesh must outlive this.
  ConductionMatrix(const Mesh& mesh, std::vector<Conductivity> conductivity_of_block);

  /// An element whose Jacobian is not positive somewhere, or none.
  struct BadElement {
    GlobalId id = no_id;
    LocalIndex block = no_index, element = no_index;
  };
  /// Local. Computes all links at these node positions and temperatures (of all local nodes, K; an element conducts as
  /// at the mean of its nodes; may be empty if no conductivity depends on it); `finish` must follow. Stops at the first
  /// bad element.
  BadElement assemble(std::span<const Vec3> coordinates, std::span<const double> temperature);
  const Conductivity& conductivity(std::size_t block) const { return conductivity_[block]; }

  /// An entry beside those between nodes of one element: row of an owned node, column.
  struct ExtraEntry {
    LocalIndex node, column;
    auto operator<=>(const ExtraEntry&) const = default;
  };
  /// Collective. Makes columns nodes() ... of the nodes `beyond` (ascending, none of them local) and room for `extra`
  /// (column as numbered then), in place of those of the last call. `owners` knows the owned nodes of all ranks.
  void extend(const Directory& owners, std::vector<GlobalId> beyond, std::span<const ExtraEntry> extra);
  /// Length of the vectors that are multiplied: local nodes and nodes beyond.
  std::size_t width() const { return static_cast<std::size_t>(mesh_.nodes()) + beyond_.size(); }
  std::span<const GlobalId> beyond() const { return beyond_; }
  /// Refreshes everything in such a vector that is not owned.
  const ExchangePlan& halo() const { return halo_; }
  /// The columns that it brings in, in the order of arrival; of an extended matrix only.
  std::span<const LocalIndex> arrivals() const { return arrivals_; }
  /// Position of an entry among the values; no_index if another rank has that row. The entry must exist.
  LocalIndex place(LocalIndex i, LocalIndex j) const;
  /// Local. Adds to one value, W/K, between `assemble` and `finish`.
  void add_at(LocalIndex place, double value) { values_[static_cast<std::size_t>(place)] += value; }

  /// Local. Adds to K_ij and K_ji (W/K), between `assemble` and `finish`; nodes of one element only.
  void add_link(LocalIndex i, LocalIndex j, double value);
  /// Local. Computes the diagonal.
  void finish();

  /// Greatest bound of an element's eigenvalues of C^-1 K (1/s) among the elements assembled last, and the least id
  /// that has it. Known only if `bound_with` was called before assembling.
  struct Stiffest {
    double eigenvalue = 0;
    LocalIndex block = no_index, element = no_index;
  };
  const Stiffest& stiffest() const { return stiffest_; }
  /// Lumped capacity of each element at its nodes, J/K: [element of all blocks][max_linear_nodes].
  void bound_with(std::vector<std::array<double, max_linear_nodes>> capacity) { capacity_ = std::move(capacity); }

  const ElementTable& table(std::size_t block) const { return tables_[block]; }
  /// Row of each local node; no_index for ghosts.
  std::span<const LocalIndex> row_of_node() const { return row_of_node_; }
  LocalIndex rows() const { return static_cast<LocalIndex>(diagonal_.size()); }
  std::span<const double> diagonal() const { return diagonal_; }
  /// The rest: entries of row r stand in offsets()[r] .. offsets()[r + 1]; columns as above.
  std::span<const LocalIndex> offsets() const { return offsets_; }
  std::span<const LocalIndex> columns() const { return columns_; }
  std::span<const double> values() const { return values_; }

  /// Local. out_r = -(K x)_r, as a sum of differences: exactly 0 where x is constant. x: width(); out: rows.
  void conducted(std::span<const double> x, std::span<double> out) const;
  /// Local. out_r = d_r x_r + factor * (sum over the off-diagonal of row r). x: width(); d, out: rows.
  void multiply(std::span<const double> d, double factor, std::span<const double> x, std::span<double> out) const;

  std::int64_t memory() const;

 private:
  void make_pattern(std::span<const ExtraEntry> extra);
  void place_elements();
  GlobalId id_of(LocalIndex column) const;
  BadElement assemble_block(LocalIndex block, LocalIndex first_element, std::span<const Vec3> coordinates,
                            std::span<const double> temperature);
  void conduct(std::size_t block, const CornerBatch& corners, const double (&temperature)[lanes],
               ConductionBatch& links) const;
  void scatter(std::size_t place, const ConductionBatch& links, int lane, const ElementTable& table);
  void note_eigenvalues(const ElementTable& table, const ConductionBatch& links, LocalIndex block, LocalIndex first,
                        LocalIndex count, std::size_t first_of_all);

  const Mesh& mesh_;
  std::vector<Conductivity> conductivity_;  // of blocks
  std::vector<ElementTable> tables_;        // of blocks
  std::vector<GlobalId> beyond_;
  ExchangePlan halo_;
  std::vector<LocalIndex> arrivals_;
  std::vector<LocalIndex> offsets_, columns_;
  std::vector<double> values_, diagonal_;
  std::vector<LocalIndex> row_of_node_;                         // no_index for ghosts
  std::vector<LocalIndex> places_;                              // of K_ab, then K_ba, for each pair of each element
  std::vector<std::size_t> first_place_;                        // of blocks
  std::vector<std::array<double, max_linear_nodes>> capacity_;  // of elements
  Stiffest stiffest_;
};

}  // namespace tenon::thermal
