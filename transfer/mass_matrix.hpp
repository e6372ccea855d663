// SPDX-License-Identifier: BSD-3-Clause
// The consistent mass matrix of a mesh (without density), and its approximate inverse.
#pragma once

#include <string>
#include <vector>

#include "transfer/rows.hpp"
#include "transfer/sparse_rows.hpp"

namespace tenon::transfer {

/// For every local node the local elements around it, ascending, and which of their nodes it is.
struct NodeElements {
  struct Entry {
    LocalIndex element;  ///< item: counts through all blocks
    std::int32_t place;  ///< of the node in the element
  };
  std::vector<std::size_t> begin;
  std::vector<Entry> entries;
  std::span<const Entry> around(LocalIndex node) const {
    const auto n = static_cast<std::size_t>(node);
    return std::span(entries).subspan(begin[n], begin[n + 1] - begin[n]);
  }
};
NodeElements node_elements(const Mesh& mesh);
/// The same for some nodes only; the others have none.
NodeElements node_elements(const Mesh& mesh, std::span<const LocalIndex> nodes);

/// M_ij = integral of N_i N_j over the mesh, m^3, in rows of the owned nodes; kept in single precision, as only an
/// approximate inverse is asked of it.
class MassMatrix {
 public:
  MassMatrix() = default;
  /// Local. For elements whose shape functions are nowhere negative.
  MassMatrix(const Side& side, const NodeElements& around);

  /// Collective. d = M^-1 r, for the owned nodes (in order of `owned`, as r); d has room for all local nodes x
  /// components, in order of local index, and its ghosts are left alone. By a fixed number of Chebyshev iterations with
  /// the row sums D as preconditioner. The error in the worst mode is a hundredth; smooth modes are far better, since
  /// the last step is d += D^-1 (r - M d): as the sums over the columns of M are D, the sum of D d is that of r to
  /// round-off. No global reduction; no allocation after the first call with that many components.
  void solve(std::span<const double> r, std::span<double> d, int components) const;

  const SparseRows<float>& rows() const { return rows_; }
  int iterations() const { return iterations_; }
  std::int64_t memory() const;

 private:
  void fill(const Side& side);

  const Mesh* mesh_ = nullptr;
  SparseRows<float> rows_;
  std::vector<double> lumped_;  ///< sums of rows
  double least_ = 1;            ///< lower bound of the spectrum of D^-1 M; the upper one is 1
  int iterations_ = 0;
  mutable std::vector<double> residual_, step_, product_;
};

}  // namespace tenon::transfer
