// SPDX-License-Identifier: BSD-3-Clause
#include "transfer/balance.hpp"

#include <algorithm>
#include <cmath>

#include "transfer/element_points.hpp"
#include "transfer/slot_table.hpp"

namespace tenon::transfer {

namespace {

constexpr int sweeps = 12;
constexpr double least_coverage = 0.5, greatest_coverage = 2;
/// Coverages are added as integers of this many per unit, so that their sum does not depend on the order.
constexpr double fixed_point = 0x1p36;
constexpr double greatest_term = 0x1p14;

/// The target items that this rank's columns reach, with the way to their owners and back.
class Reached {
 public:
  Reached(const Side& target, const Columns& columns, const std::string& name) {
    SlotTable table;
    for (const Piece& piece : columns.pieces) table.mark(piece.owner, piece.at_owner);
    table.number();
    slots_ = table.owners().size();
    for (const Piece& piece : columns.pieces) slot_of_piece.push_back(table.slot(piece.owner, piece.at_owner));
    plan_ = ExchangePlan::to_ranks(target.mesh.comm, table.owners(), name);
    rows_.resize(static_cast<std::size_t>(plan_.received()));
    plan_.forward(std::span<const LocalIndex>(table.indices()), std::span<LocalIndex>(rows_));
    const std::vector<double> volumes = item_volumes(target.mesh, target.coordinates, target.location);
    std::vector<double> of_row;
    for (const LocalIndex row : rows_) of_row.push_back(volumes[static_cast<std::size_t>(row)]);
    volume.resize(slots_);
    plan_.reverse(std::span<const double>(of_row), std::span<double>(volume));
    total_.resize(volumes.size());
  }

  /// Collective. Replaces each slot's part by the sum over all ranks.
  void add_up(std::vector<std::int64_t>& parts) {
    arrived_.resize(rows_.size());
    plan_.forward(std::span<const std::int64_t>(parts), std::span<std::int64_t>(arrived_));
    std::fill(total_.begin(), total_.end(), 0);
    for (std::size_t k = 0; k < rows_.size(); ++k) total_[static_cast<std::size_t>(rows_[k])] += arrived_[k];
    for (std::size_t k = 0; k < rows_.size(); ++k) arrived_[k] = total_[static_cast<std::size_t>(rows_[k])];
    plan_.reverse(std::span<const std::int64_t>(arrived_), std::span<std::int64_t>(parts));
  }
  std::size_t slots() const { return slots_; }

  std::vector<LocalIndex> slot_of_piece;
  std::vector<double> volume;  ///< m^3

 private:
  std::size_t slots_ = 0;
  ExchangePlan plan_;
  std::vector<LocalIndex> rows_;
  std::vector<std::int64_t> total_, arrived_;
};

/// Volume that arrives at each slot over the slot's own.
void find_coverage(const SpreadingPoints& spreading, const Columns& columns, Reached& reached,
                   std::vector<std::int64_t>& parts, std::vector<double>& coverage) {
  std::fill(parts.begin(), parts.end(), 0);
  for (std::size_t c = 0; c < spreading.shares.size(); ++c)
    for (std::size_t k = columns.begin[c]; k < columns.begin[c + 1]; ++k) {
      const auto slot = static_cast<std::size_t>(reached.slot_of_piece[k]);
      if (!(reached.volume[slot] > 0)) continue;
      const double term = columns.pieces[k].weight * spreading.shares[c].volume / reached.volume[slot];
      parts[slot] += std::llround(fixed_point * std::clamp(term, -greatest_term, greatest_term));
    }
  reached.add_up(parts);
  for (std::size_t s = 0; s < parts.size(); ++s) coverage[s] = static_cast<double>(parts[s]) / fixed_point;
}

}  // namespace

void normalise(std::span<Piece> column) {
  if (column.empty()) return;
  const auto largest = std::max_element(column.begin(), column.end(), [](const Piece& a, const Piece& b) {
    return std::abs(a.weight) < std::abs(b.weight);
  });
  const auto sum = [&] {
    double s = 0;
    for (const Piece& piece : column) s += piece.weight;
    return s;
  };
  const double scale = sum();
  for (Piece& piece : column) piece.weight /= scale;
  for (int repeat = 0; repeat < 2; ++repeat) largest->weight += 1 - sum();
}

void balance(const Side& target, const SpreadingPoints& spreading, Columns& columns, const std::string& name) {
  const bool any_volume = std::any_of(spreading.shares.begin(), spreading.shares.end(),
                                      [](const SpreadingPoints::Share& share) { return share.volume > 0; });
  if (!target.mesh.comm.any(any_volume)) return;
  Reached reached(target, columns, name);
  std::vector<std::int64_t> parts(reached.slots());
  std::vector<double> coverage(reached.slots());
  std::vector<char> covered(reached.slots());
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    find_coverage(spreading, columns, reached, parts, coverage);
    if (sweep == 0)
      for (std::size_t s = 0; s < coverage.size(); ++s)
        covered[s] = coverage[s] >= least_coverage && coverage[s] <= greatest_coverage;
    for (std::size_t c = 0; c < spreading.shares.size(); ++c) {
      if (!(spreading.shares[c].volume > 0)) continue;
      for (std::size_t k = columns.begin[c]; k < columns.begin[c + 1]; ++k) {
        const auto slot = static_cast<std::size_t>(reached.slot_of_piece[k]);
        if (covered[slot]) columns.pieces[k].weight /= coverage[slot];
      }
      normalise(columns.column(c));
    }
  }
}

}  // namespace tenon::transfer
