// SPDX-License-Identifier: BSD-3-Clause
// Makes the integral of projected values that of the source, and keeps values within bounds.
#pragma once

#include <span>
#include <vector>

#include "framework/comm/exact_sum.hpp"
#include "transfer/projection.hpp"
#include "transfer/rows.hpp"
#include "transfer/sparse_rows.hpp"

namespace tenon::transfer {

/// Works on the target's rows: its owned nodes, or all its local elements. Bounds are rows x components.
class IntegralKeeper {
 public:
  IntegralKeeper() = default;
  /// Collective. `volumes` of all local target items, m^3.
  IntegralKeeper(const Side& source, const Side& target, std::span<const double> volumes);

  /// Collective. Adds what the integral lacks in proportion to |u|; evenly, should that more than double any value.
  void keep(std::span<const double> source, std::span<double> target, int components, ProjectionOutcome& outcome) const;
  /// Collective. Brings values within their bounds.
  void clip(std::span<double> target, int components, std::span<const double> low, std::span<const double> high,
            ProjectionOutcome& outcome) const;
  /// Collective, for a target on nodes. Gives what the last `clip` took from a node to its neighbours, the columns of
  /// its row, in proportion to the room that they have within their bounds; as much as they can take.
  void give_to_neighbours(const SparseRows<float>& neighbours, const ExchangePlan& halo, std::span<double> target,
                          int components, std::span<const double> low, std::span<const double> high) const;
  /// Collective. Adds what the integral lacks in proportion to the room that values have within their bounds.
  void keep_within(std::span<const double> source, std::span<double> target, int components,
                   std::span<const double> low, std::span<const double> high, ProjectionOutcome& outcome) const;
  std::int64_t memory() const;

 private:
  struct Row {
    LocalIndex item;
    bool owned;
    double volume;
  };
  enum Sum : std::size_t { of_source, of_target, magnitude, room_above, room_below, sums };
  ExactSum& sum(Sum which, std::size_t component) const { return local_[component * sums + which]; }
  double total(Sum which, std::size_t component) const { return global_[component * sums + which]; }
  void begin(std::span<const double> source, std::size_t components) const;

  Communicator comm_ = Communicator::self();
  std::vector<LocalIndex> source_owned_;
  std::vector<double> source_volumes_;  ///< of the owned items
  std::vector<Row> rows_;
  double volume_ = 0;  ///< of the whole target
  mutable std::vector<ExactSum> local_;
  mutable std::vector<double> global_;
  mutable std::vector<double> taken_;        ///< by the last clip, m^3; rows x components
  mutable std::vector<double> room_, part_;  ///< above and below, m^3, and of it to be taken up; by local node
};

}  // namespace tenon::transfer
