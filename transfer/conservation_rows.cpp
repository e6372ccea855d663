// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "transfer/element_points.hpp"
#include "transfer/rows.hpp"
#include "transfer/spreading.hpp"

namespace tenon::transfer {

namespace {

/// Part of an amount that goes to one target item.
struct Piece {
  GlobalId target;
  double weight;
  LocalIndex at_owner;
  int owner;
  int order;  // keeps equal targets in the order of the points
};

/// A term on its way to the owner of its row.
struct Entry {
  GlobalId source;
  double weight;
  LocalIndex row;  ///< target item at its owner
  int owner;
  LocalIndex at_owner;
};

/// Adds up pieces for the same target, in ascending order of targets, and makes their sum 1 to within an ulp, so that
/// no amount is lost.
void merge(std::vector<Piece>& pieces) {
  std::sort(pieces.begin(), pieces.end(),
            [](const Piece& a, const Piece& b) { return std::tie(a.target, a.order) < std::tie(b.target, b.order); });
  std::size_t merged = 0;
  for (const Piece& piece : pieces) {
    if (merged > 0 && pieces[merged - 1].target == piece.target)
      pieces[merged - 1].weight += piece.weight;
    else
      pieces[merged++] = piece;
  }
  pieces.resize(merged);
  const auto largest = std::max_element(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) {
    return std::abs(a.weight) < std::abs(b.weight);
  });
  for (int repeat = 0; repeat < 2; ++repeat) {
    double sum = 0;
    for (const Piece& piece : pieces) sum += piece.weight;
    largest->weight += 1 - sum;
  }
}

struct Outgoing {
  std::vector<Entry> entries;
  std::vector<int> to;
};

Outgoing entries_of(const SpreadingPoints& spreading, std::span<const Placement> places, const PlacedNodes& nodes,
                    bool to_nodes) {
  Outgoing outgoing;
  std::vector<Piece> pieces;
  for (std::size_t g = 0; g < spreading.groups(); ++g) {
    for (std::size_t s = spreading.first_share[g]; s < spreading.first_share[g + 1]; ++s) {
      const SpreadingPoints::Share& share = spreading.shares[s];
      pieces.clear();
      for (std::size_t p = spreading.begin[g]; p < spreading.begin[g + 1]; ++p) {
        const Placement& place = places[p];
        const double part = spreading.weights[share.first_weight + p - spreading.begin[g]];
        const auto add = [&](GlobalId target, double weight, LocalIndex at_owner, int owner) {
          pieces.push_back({target, part * weight, at_owner, owner, static_cast<int>(pieces.size())});
        };
        if (!to_nodes) {
          add(place.element, 1.0, place.item, place.owner);
          continue;
        }
        const ElementNodes& at = nodes.of(p);
        for (std::size_t a = 0; a < static_cast<std::size_t>(topology(place.kind).nodes); ++a)
          if (place.weights[a] != 0) add(at.id[a], place.weights[a], at.at_owner[a], at.owner[a]);
      }
      merge(pieces);
      for (const Piece& piece : pieces) {
        outgoing.entries.push_back(
            {share.source, piece.weight * share.amount, piece.at_owner, share.owner, share.at_owner});
        outgoing.to.push_back(piece.owner);
      }
    }
  }
  return outgoing;
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
  const Communicator& comm = target.mesh.comm;
  const Containers containers = containers_of(target.mesh, target.coordinates, rules.tolerance, name);
  SpreadingPoints spreading = spreading_points(source, target, density);
  sought.skipped = containers.skipped;
  sought.points = std::move(spreading.points);
  sought.ids = std::move(spreading.ids);
  sought.places = locate(comm, containers, sought.points, rules, name + ".locate");

  const bool to_nodes = target.location == Location::node;
  std::vector<Entry> arrived;
  {
    const PlacedNodes nodes(target.mesh, target.nodes,
                            to_nodes ? std::span<const Placement>(sought.places) : std::span<const Placement>{},
                            name + ".nodes");
    const Outgoing outgoing = entries_of(spreading, sought.places, nodes, to_nodes);
    const ExchangePlan plan = ExchangePlan::to_ranks(comm, outgoing.to, name + ".rows");
    arrived.resize(static_cast<std::size_t>(plan.received()));
    plan.forward(std::span<const Entry>(outgoing.entries), std::span<Entry>(arrived));
  }
  Rows rows = assemble(target.items, arrived);
  if (density) {
    const std::vector<double> volumes = item_volumes(target.mesh, target.coordinates, target.location);
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (auto k = static_cast<std::size_t>(rows.begin[i]); k < static_cast<std::size_t>(rows.begin[i + 1]); ++k)
        rows.terms[k].weight /= volumes[static_cast<std::size_t>(target.items.owned[i])];
  }
  return rows;
}

}  // namespace tenon::transfer
