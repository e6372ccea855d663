// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>

#include "transfer/balance.hpp"
#include "transfer/element_points.hpp"
#include "transfer/rows.hpp"
#include "transfer/spreading.hpp"

namespace tenon::transfer {

namespace {

/// A term on its way to the owner of its row.
struct Entry {
  GlobalId source;
  double weight;
  LocalIndex row;  ///< target item at its owner
  int owner;
  LocalIndex at_owner;
};

/// What the points of one group reach: its targets, ascending and each once, and what each point gives to which.
class Group {
 public:
  struct Part {
    std::size_t point;   ///< within the group
    std::size_t target;  ///< place in `targets`
    double weight;
  };
  std::vector<Piece> targets;  ///< without weights
  std::vector<Part> parts;     ///< in order of points

  void read(std::span<const Placement> places, const PlacedNodes& nodes, std::size_t first, bool to_nodes) {
    targets.clear(), parts.clear();
    for (std::size_t p = 0; p < places.size(); ++p) {
      const Placement& place = places[p];
      if (!to_nodes) {
        add(p, 1.0, {place.element, 0.0, place.item, place.owner});
        continue;
      }
      const PlacedNodes::Nodes at = nodes.of(first + p);
      const std::span<double> weights = std::span(shape_).first(place.nodes());
      shape_weights(place, weights);
      for (std::size_t a = 0; a < weights.size(); ++a)
        if (weights[a] != 0) add(p, weights[a], {at.id[a], 0.0, at.at_owner[a], at.owner[a]});
    }
    order_targets();
  }

 private:
  void add(std::size_t point, double weight, const Piece& target) {
    parts.push_back({point, targets.size(), weight});
    targets.push_back(target);
  }
  /// Leaves each target once and points the parts to it.
  void order_targets() {
    order_.resize(targets.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::sort(order_.begin(), order_.end(),
              [&](std::size_t a, std::size_t b) { return targets[a].target < targets[b].target; });
    distinct_.clear();
    for (const std::size_t i : order_) {
      if (distinct_.empty() || distinct_.back().target != targets[i].target) distinct_.push_back(targets[i]);
      parts[i].target = distinct_.size() - 1;
    }
    targets.swap(distinct_);
  }

  std::array<double, max_nodes> shape_;
  std::vector<std::size_t> order_;
  std::vector<Piece> distinct_;
};

/// A column for each share: what its points give to the same target is added in the order of the points.
Columns columns_of(const SpreadingPoints& spreading, std::span<const Placement> places, const PlacedNodes& nodes,
                   bool to_nodes) {
  Columns columns;
  Group group;
  std::vector<double> sum;
  for (std::size_t g = 0; g < spreading.groups(); ++g) {
    const std::size_t first = spreading.begin[g], count = spreading.begin[g + 1] - first;
    group.read(places.subspan(first, count), nodes, first, to_nodes);
    for (std::size_t s = spreading.first_share[g]; s < spreading.first_share[g + 1]; ++s) {
      const double* const part_of_point = spreading.weights.data() + spreading.shares[s].first_weight;
      sum.assign(group.targets.size(), 0.0);
      for (const Group::Part& part : group.parts) sum[part.target] += part_of_point[part.point] * part.weight;
      for (std::size_t t = 0; t < sum.size(); ++t) {
        columns.pieces.push_back(group.targets[t]);
        columns.pieces.back().weight = sum[t];
      }
      columns.begin.push_back(columns.pieces.size());
      normalise(columns.column(s));
    }
  }
  return columns;
}

/// Brings all terms to the owners of their rows.
std::vector<Entry> exchange(const Communicator& comm, const SpreadingPoints& spreading, const Columns& columns,
                            const std::string& name) {
  std::vector<Entry> entries;
  std::vector<int> to;
  entries.reserve(columns.pieces.size());
  to.reserve(columns.pieces.size());
  for (std::size_t c = 0; c < spreading.shares.size(); ++c) {
    const SpreadingPoints::Share& share = spreading.shares[c];
    for (std::size_t k = columns.begin[c]; k < columns.begin[c + 1]; ++k) {
      const Piece& piece = columns.pieces[k];
      entries.push_back({share.source, piece.weight * share.amount, piece.at_owner, share.owner, share.at_owner});
      to.push_back(piece.owner);
    }
  }
  const ExchangePlan plan = ExchangePlan::to_ranks(comm, to, name);
  std::vector<Entry> arrived(static_cast<std::size_t>(plan.received()));
  plan.forward(std::span<const Entry>(entries), std::span<Entry>(arrived));
  return arrived;
}

/// Rows of the owned items from entries in any order. Terms of the same source, which come from several elements
/// around a source node, are added in ascending order of value: the same sum wherever they come from.
Rows assemble(const Items& items, std::span<const Entry> entries) {
  std::vector<std::int64_t> begin(items.ids.size() + 1, 0);
  for (const Entry& entry : entries) ++begin[static_cast<std::size_t>(entry.row) + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<Term> by_row(entries.size());
  {
    std::vector<std::int64_t> next(begin.begin(), begin.end() - 1);
    for (const Entry& entry : entries)
      by_row[static_cast<std::size_t>(next[static_cast<std::size_t>(entry.row)]++)] = {entry.source, entry.weight,
                                                                                       entry.owner, entry.at_owner};
  }
  Rows rows;
  rows.begin.reserve(items.owned.size() + 1);
  for (const LocalIndex item : items.owned) {
    const auto first = by_row.begin() + begin[static_cast<std::size_t>(item)];
    const auto last = by_row.begin() + begin[static_cast<std::size_t>(item) + 1];
    std::sort(first, last,
              [](const Term& a, const Term& b) { return std::tie(a.source, a.weight) < std::tie(b.source, b.weight); });
    for (auto term = first; term != last; ++term) {
      const bool row_has_terms = static_cast<std::int64_t>(rows.terms.size()) > rows.begin.back();
      if (row_has_terms && rows.terms.back().source == term->source)
        rows.terms.back().weight += term->weight;
      else
        rows.terms.push_back(*term);
    }
    rows.begin.push_back(static_cast<std::int64_t>(rows.terms.size()));
  }
  return rows;
}

}  // namespace

Rows conservation_rows(const Side& source, const Side& target, const PlaceRules& rules, bool density,
                       const std::string& name, Sought& sought) {
  return spreading_rows(spreading_points(source, target, density), target, rules, density, name, sought);
}

Rows spreading_rows(SpreadingPoints&& spreading, const Side& target, const PlaceRules& rules, bool density,
                    const std::string& name, Sought& sought) {
  const Communicator& comm = target.mesh.comm;
  const Containers containers = containers_of(target.mesh, target.coordinates, {}, rules.tolerance, name);
  sought.skipped = containers.skipped;
  sought.points = std::move(spreading.points);
  sought.ids = std::move(spreading.ids);
  sought.places = Locator(comm, rules, false, name + ".locate").find(containers, sought.points);

  const bool to_nodes = target.location == Location::node;
  Columns columns;
  {
    const PlacedNodes nodes(comm, containers.set, target.nodes,
                            to_nodes ? std::span<const Placement>(sought.places) : std::span<const Placement>{},
                            name + ".nodes");
    columns = columns_of(spreading, sought.places, nodes, to_nodes);
  }
  balance(target, spreading, columns, name + ".balance");
  Rows rows = assemble(target.items, exchange(comm, spreading, columns, name + ".rows"));
  if (density) {
    const std::vector<double> volumes = item_volumes(target.mesh, target.coordinates, target.location);
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (auto k = static_cast<std::size_t>(rows.begin[i]); k < static_cast<std::size_t>(rows.begin[i + 1]); ++k)
        rows.terms[k].weight /= volumes[static_cast<std::size_t>(target.items.owned[i])];
  }
  return rows;
}

}  // namespace tenon::transfer
