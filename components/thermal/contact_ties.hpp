// SPDX-License-Identifier: BSD-3-Clause
// What multigrid must know of bodies that are all but tied to each other by contact.
#pragma once

#include <span>
#include <vector>

#include "components/thermal/contact_conductance.hpp"
#include "components/thermal/heat_system.hpp"

namespace tenon::thermal {

/// Where a contact conducts better than the elements beside it, its nodes b follow the nodes a across: changes of both
/// at once, T_b = sum of m_ba T_a, cost nothing in the contact, but the diagonal of the matrix, full of the contact,
/// would hardly move them. So they are a space of their own (P) with a Jacobi step of its own, whose diagonal is that
/// of the elements; and the grid of multigrid interpolates to a only, b follows.
class ContactTies {
 public:
  /// Collective. For the present weights; a node is tied by its strongest contact, if by any.
  void build(const HeatSystem& system, const ContactConductance& contact);
  /// Whether any node of any rank is tied.
  bool any() const { return any_; }
  /// Collective. z += P D^-1 P^T rest / bound, where `bound` is that of the spectrum of the matrix over its diagonal.
  /// `rest`: rows, 0 where held; z: width of the matrix, left refreshed. Allocates nothing.
  void smooth(double bound, std::span<const double> rest, std::span<double> z);
  /// Local. Calls use(b, a, m_ba) for the tied nodes that this rank owns, b by b.
  template <typename Use>
  void each_tie(const Use& use) const {
    for (const Tie& tie : ties_)
      if (row(tie.node) != no_index)
        for (std::size_t i = tie.first; i < tie.last; ++i) use(tie.node, nodes_[i], weights_[i]);
  }
  std::int64_t memory() const;
  /// Bound of the sums of |m_ba| over a: that of dual functions of bilinear shapes is (5/3)^2.
  static constexpr double greatest_weight = 3;

 private:
  struct Tie {
    LocalIndex node;          // column of b
    std::size_t first, last;  // in nodes_ and weights_
  };
  /// What the owner of b says about its patch.
  struct Role {
    bool tied = false;     // b follows this patch
    bool follows = false;  // b follows this patch or another one
    double other = 0;      // conductance of the other patches of b, W/K
  };
  void find_base(const HeatSystem& system, const ContactConductance& contact);
  std::vector<Role> find_roles(const HeatSystem& system, const ContactConductance& contact) const;
  void add_diagonal(double factor, const ContactPatch& patch, const Role& role);
  void add_tie(const ContactPatch& patch);
  LocalIndex row(LocalIndex column) const;

  bool any_ = false;
  const ConductionMatrix* matrix_ = nullptr;
  std::vector<double> base_;           // width of the matrix: diagonal without contact; 0 where held
  std::vector<double> across_;         // width of the matrix: 1 where another node may follow
  std::vector<double> diagonal_;       // rows: of P^T A P, for nodes across; 0 elsewhere
  std::vector<Tie> ties_;              // with an end on this rank, in ascending order
  std::vector<LocalIndex> nodes_;      // across, columns
  std::vector<double> weights_;        // m_ba
  std::vector<double> work_, change_;  // width of the matrix
};

}  // namespace tenon::thermal
