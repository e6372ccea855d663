// SPDX-License-Identifier: BSD-3-Clause
// A multigrid preconditioner for heat conduction on any mesh, whose every bit is the same on any number of ranks.
#pragma once

#include <span>
#include <vector>

#include "components/thermal/auxiliary_grid.hpp"
#include "components/thermal/coarse_levels.hpp"
#include "components/thermal/contact_ties.hpp"
#include "components/thermal/heat_system.hpp"

namespace tenon::thermal {

/// The auxiliary space method [Xu96]: the mesh smooths with Chebyshev polynomials, a rectilinear grid laid over it,
/// coarsened by twos, takes what is smooth. Symmetric and positive definite. Sums from the nodes of several ranks to
/// the grid are sums of integers (values in units of 2^-61 of a bound of the sum), so no order matters. The coarse
/// levels (about a twelfth of the nodes) stand whole on every rank. What is multiplied is kept in single precision.
class Multigrid {
 public:
  /// Collective. Lays the grid over the reference configuration.
  explicit Multigrid(const Mesh& mesh);
  /// Collective. Prepares for this system; must be repeated when the matrix has changed. Always of the same mesh,
  /// pattern and the same held nodes, so that all but the first time only numbers are filled in and nothing is
  /// allocated. A system with another factor, up to twice or half, may then be preconditioned too.
  /// With `contact`, what it ties together is smoothed together; then only the first time.
  void build(const HeatSystem& system, const ContactConductance* contact = nullptr);
  bool built() const { return built_; }
  /// Collective. z (width of the matrix; ghosts are not refreshed) = M^-1 r. Allocates nothing.
  void apply(const HeatSystem& system, std::span<const double> r, std::span<double> z);
  std::int64_t memory() const;

 private:
  void lay_out(const HeatSystem& system);
  void interpolate(std::span<const Vec3> places, std::span<const double> free, std::span<const LocalIndex> number);
  void follow_ties(const HeatSystem& system);
  void make_restriction();
  void lay_out_sums();
  double times_interpolation(const HeatSystem& system);
  int galerkin(const HeatSystem& system);
  void add_up(int exponent);
  double bound(const HeatSystem& system);
  void smooth_mesh(const HeatSystem& system, std::span<const double> r, std::span<double> z, bool from_zero);
  void find_rest(const HeatSystem& system, std::span<const double> r, std::span<const double> z);
  void correct(std::span<double> z);

  const Mesh& mesh_;
  RectilinearGrid grid_;
  bool built_ = false;
  std::int64_t most_nodes_ = 1;        // that one hat holds, over all ranks, each as often as its greatest weight says
  SparseMatrix<float> interpolation_;  // from the points in use to all columns
  SparseMatrix<float> restriction_;    // from the owned nodes (rows) to the points in use
  std::vector<float> links_;           // off-diagonal entries of K
  std::vector<LocalIndex> points_;

  // The Galerkin product: this rank's share of its upper half (in units of 2^-exponent), all ranks' and the whole.
  SparseMatrix<double> times_interpolation_;
  SparseMatrix<std::int64_t> upper_;
  std::vector<LocalIndex> place_;           // memory of products
  std::vector<LocalIndex> place_in_sums_;   // of the entries of upper_
  std::vector<LocalIndex> place_of_whole_;  // in sums_
  std::vector<std::int64_t> sums_;
  SparseMatrix<double> whole_;

  ContactTies ties_;
  CoarseLevels levels_;
  double bound_ = 1;  // of the spectrum of the matrix over its diagonal
  Chebyshev smoother_;
  std::vector<double> rest_, product_;  // rows
  std::vector<double> change_;          // of the width of the matrix
  std::vector<double> coarse_, coarse_solution_;
  std::vector<std::int64_t> exact_;
};

}  // namespace tenon::thermal
