// SPDX-License-Identifier: BSD-3-Clause
// Who exchanges heat with whom: projection, dual shape functions, and the entries of the matrix that they need.
#include <algorithm>
#include <cmath>

#include "components/thermal/contact_conductance.hpp"
#include "framework/mesh/shape_functions.hpp"

namespace tenon::thermal {
namespace {

using Shapes = std::array<double, max_side_nodes>;
using Square = std::array<Shapes, max_side_nodes>;

/// Solves m x = b for a symmetric, positive definite m by elimination; both are lost.
Shapes solve(Square& m, Shapes& b, std::size_t n) {
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t i = k + 1; i < n; ++i) {
      const double factor = m[i][k] / m[k][k];
      for (std::size_t j = k; j < n; ++j) m[i][j] -= factor * m[k][j];
      b[i] -= factor * b[k];
    }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t j = k + 1; j < n; ++j) b[k] -= m[k][j] * b[j];
    b[k] /= m[k][k];
  }
  return b;
}

/// Row b: psi_b = sum over c of dual[b][c] N_c, so that the integral of psi_b N_c over the side is 0 unless b = c, and
/// that of N_b then [Woh00].
Square dual_functions(std::span<const double> weights, std::span<const Shapes> shapes, std::size_t n) {
  Square mass{}, dual{};
  Shapes area{};
  for (std::size_t q = 0; q < weights.size(); ++q)
    for (std::size_t a = 0; a < n; ++a) {
      area[a] += weights[q] * shapes[q][a];
      for (std::size_t b = 0; b < n; ++b) mass[a][b] += weights[q] * shapes[q][a] * shapes[q][b];
    }
  for (std::size_t b = 0; b < n; ++b) {
    Square m = mass;
    Shapes unit{};
    unit[b] = area[b];
    dual[b] = solve(m, unit, n);
  }
  return dual;
}

double area_element(ElementKind kind, std::span<const Vec3> corners, const Vec3& xi) {
  std::array<Vec3, max_side_nodes> gradients{};
  shape_gradients(kind, xi, std::span(gradients).first(corners.size()));
  Vec3 along{}, across{};
  for (std::size_t a = 0; a < corners.size(); ++a) {
    along = along + gradients[a][0] * corners[a];
    across = across + gradients[a][1] * corners[a];
  }
  return norm(cross(along, across));
}

}  // namespace

// Points of all sides that touch an owned node, and what they see. Returns the number of the first; collective.
std::size_t ContactConductance::add_points(std::size_t contact, std::span<const Vec3> coordinates,
                                           std::vector<SideCorners>& sides) {
  constexpr double share_of_size = 0.1;
  const std::size_t first = points_.size();
  const ThermalContact& law = contacts_[contact];
  const Pair& pair = pairs_[contact];
  std::vector<Looker> lookers;
  double greatest = 0;
  for (const Side& side : pair.finer->sides) {
    const SideCorners corners = side_corners(mesh_, side);
    const auto nodes = std::span(corners.nodes).first(corners.count);
    if (std::ranges::none_of(nodes, [this](LocalIndex n) { return mesh_.owns_node(n); })) continue;
    sides.push_back(corners);
    std::array<Vec3, max_side_nodes> place{};
    for (std::size_t a = 0; a < corners.count; ++a) place[a] = coordinates[static_cast<std::size_t>(nodes[a])];
    const auto corner = std::span<const Vec3>(place).first(corners.count);
    const ElementKind kind = corners.kind();
    const double touch = pair.touch > 0 ? pair.touch : share_of_size * std::sqrt(element_measure(kind, corner));
    const double reach = std::max(touch, law.gap_conductivity > 0 ? law.greatest_gap : 0.0);
    greatest = std::max(greatest, reach);
    for (const QuadraturePoint& q : quadrature(kind)) {
      Point& p = points_.emplace_back();
      p.contact = contact;
      p.weight = q.weight * area_element(kind, corner, q.xi);
      p.own.fill(no_index);
      std::copy(nodes.begin(), nodes.end(), p.own.begin());
      shape_values(kind, q.xi, std::span(p.shape).first(corners.count));
      lookers.push_back({map_to_space(kind, corner, q.xi), side_normal(corner), touch, reach});
    }
  }
  const auto seen =
      opposite_points(mesh_, *pair.other, coordinates, lookers, mesh_.comm.max(greatest), "thermal contact search");
  for (std::size_t i = 0; i < seen.size(); ++i) {
    points_[first + i].opposite = seen[i];
    points_[first + i].touches = seen[i].count > 0 && seen[i].gap <= lookers[i].touch;
  }
  return first;
}

// Adds what each side means to its owned nodes.
void ContactConductance::gather(std::size_t point, std::span<const SideCorners> sides,
                                std::map<LocalIndex, Gathered>& nodes) const {
  std::vector<double> weights;
  std::vector<Shapes> shapes;
  for (const SideCorners& side : sides) {
    const std::size_t count = quadrature(side.kind()).size(), n = side.count;
    const auto mine = std::span(points_).subspan(point, count);
    weights.clear(), shapes.clear();
    for (const Point& p : mine) {
      weights.push_back(p.weight);
      shapes.push_back(p.shape);
    }
    const bool whole = std::ranges::all_of(mine, [](const Point& p) { return p.opposite.count > 0; });
    const Square dual = whole ? dual_functions(weights, shapes, n) : Square{};
    for (std::size_t b = 0; b < n; ++b) {
      if (!mesh_.owns_node(side.nodes[b])) continue;
      Gathered& node = nodes[side.nodes[b]];
      for (std::size_t q = 0; q < count; ++q) {
        const Point& p = mine[q];
        if (p.opposite.count == 0) continue;
        double psi = whole ? 0 : p.shape[b];
        for (std::size_t c = 0; whole && c < n; ++c) psi += dual[b][c] * p.shape[c];
        node.area += p.weight * psi;
        node.shares.push_back({point + q, p.weight * p.shape[b]});
        for (std::size_t a = 0; a < static_cast<std::size_t>(p.opposite.count); ++a)
          node.across[p.opposite.nodes[a]] += p.weight * psi * p.opposite.weights[a];
      }
    }
    point += count;
  }
}

void ContactConductance::make_patches(std::span<const Vec3> coordinates) {
  constexpr double round_off = 1e-12;  // of weights that are 0 where the meshes match
  points_.clear();
  patches_ = {};
  shares_.clear();
  first_share_.assign(1, 0);
  for (std::size_t contact = 0; contact < contacts_.size(); ++contact) {
    std::vector<SideCorners> sides;
    const std::size_t first = add_points(contact, coordinates, sides);
    std::map<LocalIndex, Gathered> nodes;
    gather(first, sides, nodes);
    for (const auto& [n, gathered] : nodes) {
      if (!(gathered.area > 0)) continue;
      const GlobalId id = mesh_.node_ids[static_cast<std::size_t>(n)];
      std::map<GlobalId, double> coefficients;
      for (const auto& [a, weight] : gathered.across)
        if (std::abs(weight) > round_off * gathered.area) coefficients[a] = -weight / gathered.area;
      coefficients[id] += 1;
      patches_.patch.push_back({static_cast<std::int64_t>(contact), id});
      patches_.counts.push_back(static_cast<LocalIndex>(coefficients.size()));
      for (const auto& [a, coefficient] : coefficients) patches_.entries.push_back({a, coefficient});
      shares_.insert(shares_.end(), gathered.shares.begin(), gathered.shares.end());
      first_share_.push_back(shares_.size());
    }
  }
  owned_patches_ = patches_.patch.size();
}

// Each patch to the ranks that own another of its nodes; collective.
void ContactConductance::send_patches() {
  std::vector<GlobalId> ids;
  for (const Entry& entry : patches_.entries) ids.push_back(entry.id);
  const std::vector<DirectoryEntry> owner = owners_.find(ids);
  std::vector<int> to;
  std::vector<LocalIndex> item;
  std::size_t e = 0;
  for (std::size_t b = 0; b < owned_patches_; ++b) {
    const std::size_t first = to.size();
    for (const std::size_t end = e + static_cast<std::size_t>(patches_.counts[b]); e < end; ++e) {
      const int rank = owner[e].rank;
      if (rank == mesh_.comm.rank() ||
          std::find(to.begin() + static_cast<std::ptrdiff_t>(first), to.end(), rank) != to.end())
        continue;
      to.push_back(rank);
      item.push_back(static_cast<LocalIndex>(b));
    }
  }
  plan_ = ExchangePlan::to_ranks(mesh_.comm, to, item, "thermal contact");
  std::vector<Patch> patch(static_cast<std::size_t>(plan_.received()));
  plan_.forward(std::span<const Patch>(patches_.patch), std::span(patch));
  const auto theirs =
      plan_.forward_varying(std::span<const LocalIndex>(patches_.counts), std::span<const Entry>(patches_.entries));
  patches_.patch.insert(patches_.patch.end(), patch.begin(), patch.end());
  patches_.counts.insert(patches_.counts.end(), theirs.counts.begin(), theirs.counts.end());
  patches_.entries.insert(patches_.entries.end(), theirs.values.begin(), theirs.values.end());
  first_entry_.assign(1, 0);
  order_.clear();
  for (std::size_t b = 0; b < patches_.patch.size(); ++b) {
    first_entry_.push_back(first_entry_.back() + static_cast<std::size_t>(patches_.counts[b]));
    order_.push_back(b);
  }
  std::ranges::sort(order_, {},
                    [this](std::size_t b) { return std::pair(patches_.patch[b].contact, patches_.patch[b].node); });
}

// Columns of the nodes that are not here, and entries for all links; collective.
bool ContactConductance::extend(ConductionMatrix& matrix) {
  const auto local = [this](GlobalId id) {
    const auto found = std::ranges::lower_bound(mesh_.node_ids, id);
    return found != mesh_.node_ids.end() && *found == id ? static_cast<LocalIndex>(found - mesh_.node_ids.begin())
                                                         : no_index;
  };
  std::vector<GlobalId> beyond;
  for (const Entry& entry : patches_.entries)
    if (local(entry.id) == no_index) beyond.push_back(entry.id);
  const auto pressed = needs_pressure() ? std::span(points_) : std::span<Point>();
  for (const Point& p : pressed)
    for (const GlobalId id : std::span(p.opposite.nodes).first(static_cast<std::size_t>(p.opposite.count)))
      if (local(id) == no_index) beyond.push_back(id);
  std::ranges::sort(beyond);
  beyond.erase(std::unique(beyond.begin(), beyond.end()), beyond.end());
  const auto column = [&](GlobalId id) {
    const LocalIndex n = local(id);
    if (n != no_index) return n;
    return mesh_.nodes() + static_cast<LocalIndex>(std::ranges::lower_bound(beyond, id) - beyond.begin());
  };
  column_.clear(), coefficient_.clear(), node_.clear();
  for (const Entry& entry : patches_.entries) {
    column_.push_back(column(entry.id));
    coefficient_.push_back(entry.coefficient);
  }
  for (const Patch& patch : patches_.patch) node_.push_back(column(patch.node));
  for (Point& p : pressed)
    for (std::size_t a = 0; a < static_cast<std::size_t>(p.opposite.count); ++a)
      p.across[a] = column(p.opposite.nodes[a]);

  std::vector<ConductionMatrix::ExtraEntry> pattern;
  for (std::size_t b = 0; b < patches_.patch.size(); ++b)
    for (std::size_t i = first_entry_[b]; i < first_entry_[b + 1]; ++i)
      for (std::size_t j = first_entry_[b]; j < first_entry_[b + 1]; ++j)
        if (i != j && column_[i] < mesh_.nodes() && mesh_.owns_node(column_[i]))
          pattern.push_back({column_[i], column_[j]});
  std::ranges::sort(pattern);
  pattern.erase(std::unique(pattern.begin(), pattern.end()), pattern.end());
  const bool changed = mesh_.comm.any(pattern != pattern_ || !std::ranges::equal(beyond, matrix.beyond()));
  if (!changed) return false;
  pattern_ = std::move(pattern);
  matrix.extend(owners_, std::move(beyond), pattern_);
  return true;
}

void ContactConductance::place(const ConductionMatrix& matrix) {
  places_.clear();
  first_place_.clear();
  for (std::size_t b = 0; b < patches_.patch.size(); ++b) {
    first_place_.push_back(places_.size());
    for (std::size_t i = first_entry_[b]; i < first_entry_[b + 1]; ++i) {
      const bool mine = column_[i] < mesh_.nodes() && mesh_.owns_node(column_[i]);
      for (std::size_t j = first_entry_[b]; j < first_entry_[b + 1]; ++j)
        if (i != j) places_.push_back(mine ? matrix.place(column_[i], column_[j]) : no_index);
    }
  }
}

bool ContactConductance::find(std::span<const Vec3> coordinates, ConductionMatrix& matrix) {
  make_patches(coordinates);
  send_patches();
  const bool changed = extend(matrix);
  place(matrix);
  return changed;
}

}  // namespace tenon::thermal
