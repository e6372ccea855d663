// SPDX-License-Identifier: BSD-3-Clause
// Heat that passes between surfaces whose meshes need not match.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "components/thermal/conduction_matrix.hpp"
#include "components/thermal/surface_projection.hpp"
#include "components/thermal/thermal_options.hpp"
#include "framework/comm/directory.hpp"

namespace tenon::thermal {

/// Conductance of an interface, W/(m^2 K). `pressure` (Pa) counts where `pressed`: somebody says what it is.
double conductance(const ThermalContact& contact, double time, double gap, bool touches, double pressure, bool pressed);

/// A node b with the entries of its g_b, b itself among them.
struct ContactPatch {
  LocalIndex node;  ///< column of b
  std::span<const LocalIndex> columns;
  std::span<const double> coefficients;
  double weight;  ///< H_b, W/K
};

/// Each node b of the finer of two surfaces exchanges heat with the nodes a of the other one that lie opposite,
///   Q_b = H_b (T_b - sum of m_ba T_a),   H_b = integral of h N_b,   m_ba = integral of psi_b N_a / integral of psi_b,
/// where psi are the shape functions dual to N on the sides of b [Woh00], integrated by points that are projected to
/// the other surface (N_b in place of psi_b on sides that lie opposite to something only in part). The sum of m_ba
/// is 1. So a uniform jump brings the other surface the loads of a uniform flux, linear temperatures have no jump where
/// the surfaces touch, and h may grow without bounds: b then takes the temperature of the other surface. The matrix,
/// the sum of H_b g_b g_b^T with g_b = (1, -m_ba), is symmetric and positive semi-definite, and what one node gets the
/// others lose.
class ContactConductance {
 public:
  /// Collective. Throws Error(usage) if the mesh lacks a side set, or a side lies on both sides of a contact.
  ContactConductance(const Mesh& mesh, std::vector<ThermalContact> contacts);

  /// Collective. Finds what lies opposite at these places (all local nodes, m) and makes room in the matrix; true if
  /// that has changed its pattern on any rank.
  bool find(std::span<const Vec3> coordinates, ConductionMatrix& matrix);
  /// Collective. Conductances at a time. `pressure`: Pa, width of the matrix; empty if nobody says.
  void weigh(double time, std::span<const double> pressure);
  /// Local. Adds the links between `assemble` and `finish`, in ascending order of b.
  void add_to(ConductionMatrix& matrix) const;

  /// Whether conductances may change while the surfaces stay where they are.
  bool varies() const;
  bool needs_pressure() const;
  /// Local. Bound of the greatest eigenvalue of C^-1 K on these rows (capacity in J/K), 1/s: the greatest sum of
  /// the sizes of a row (Gershgorin).
  double greatest_eigenvalue(std::span<const double> capacity, const ConductionMatrix& matrix) const;
  /// Collective. Heat that passes from `first` to `second` of a contact, W. Temperatures of the width of the matrix.
  double power(std::size_t contact, std::span<const double> temperature) const;
  /// Local. Adds time (s) times the heat that passes from `first` to `second` surfaces at these temperatures to the
  /// rows of the nodes b, J.
  void add_passed(double time, std::span<const double> temperature, const ConductionMatrix& matrix,
                  std::span<double> heat) const;
  std::int64_t memory() const;

  /// Those whose b is owned come first, then those that owners of b have sent, by `plan`, to the owners of nodes
  /// across.
  std::size_t patches() const { return patches_.patch.size(); }
  std::size_t owned_patches() const { return owned_patches_; }
  ContactPatch patch(std::size_t p) const;
  /// By contact, then b.
  std::span<const std::size_t> order() const { return order_; }
  const ExchangePlan& plan() const { return plan_; }
  /// Collective.
  bool any_of_all_ranks(bool mine) const { return mesh_.comm.any(mine); }

 private:
  struct Pair {
    const SideSet *finer, *other;
    bool first_is_finer;
    double touch;  ///< m; 0: a share of the size of each side
  };
  /// Integration point of a side of the finer surface.
  struct Point {
    Opposite opposite;
    bool touches = false;
    double weight = 0;                                       ///< m^2
    std::array<double, max_side_nodes> shape{};              ///< N of its own side
    std::array<LocalIndex, max_side_nodes> own{}, across{};  ///< columns, for the pressure
    std::size_t contact = 0;
  };
  /// Share of a point in H_b.
  struct Share {
    std::size_t point;
    double area;  ///< m^2
  };
  struct Entry {
    GlobalId id;
    double coefficient;  ///< of g_b
  };
  /// A node b with its g_b.
  struct Patch {
    std::int64_t contact;
    GlobalId node;
  };
  struct Patches {
    std::vector<Patch> patch;
    std::vector<LocalIndex> counts;  // entries of each
    std::vector<Entry> entries;
  };
  /// What the sides around one node b add up to, in their order.
  struct Gathered {
    double area = 0;  // integral of psi_b, m^2
    std::map<GlobalId, double> across;
    std::vector<Share> shares;
  };

  Pair make_pair(const ThermalContact& contact) const;
  std::size_t add_points(std::size_t contact, std::span<const Vec3> coordinates, std::vector<SideCorners>& sides);
  void gather(std::size_t first_point, std::span<const SideCorners> sides, std::map<LocalIndex, Gathered>& nodes) const;
  void make_patches(std::span<const Vec3> coordinates);
  void send_patches();
  bool extend(ConductionMatrix& matrix);
  void place(const ConductionMatrix& matrix);
  double out_of_finer(std::size_t owned_patch, std::span<const double> temperature) const;
  template <typename Use>
  void each_link(const Use& use) const;

  const Mesh& mesh_;
  std::vector<ThermalContact> contacts_;
  std::vector<Pair> pairs_;
  Directory owners_;
  std::vector<Point> points_;

  // Patches whose b is owned here come first, then those that others have sent.
  Patches patches_;
  std::size_t owned_patches_ = 0;
  std::vector<std::size_t> first_share_;  // of owned patches
  std::vector<Share> shares_;
  std::vector<std::size_t> first_entry_;
  std::vector<std::size_t> order_;   // by contact, then node
  std::vector<double> weight_;       // H_b, W/K
  std::vector<LocalIndex> column_;   // of each entry
  std::vector<double> coefficient_;  // of each entry
  std::vector<LocalIndex> node_;     // column of b
  std::vector<LocalIndex> places_;   // in the matrix, of each ordered pair of entries of each patch
  std::vector<std::size_t> first_place_;
  ExchangePlan plan_;  // of patches to the ranks that own a node across
  std::vector<ConductionMatrix::ExtraEntry> pattern_;
  std::vector<double> point_conductance_;  // W/(m^2 K)
  mutable std::vector<double> row_size_;   // memory
};

}  // namespace tenon::thermal
