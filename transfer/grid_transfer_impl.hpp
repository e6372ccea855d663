// SPDX-License-Identifier: BSD-3-Clause
// What a GridTransfer holds; shared by the files that build, apply and report.
#pragma once

#include <string>
#include <vector>

#include "transfer/grid_transfer.hpp"
#include "transfer/rows.hpp"

namespace tenon::transfer {

/// One mesh of the pair, as it stood when the map was built.
struct Partner {
  const Mesh* mesh = nullptr;
  Location location = Location::node;
  Items nodes, elements;  ///< elements only where the field lives on them
  std::vector<Vec3> coordinates;
  mutable std::vector<double> volumes;  ///< of the items, m^3; worked out by the first report

  const Items& items() const { return location == Location::node ? nodes : elements; }
  Side side() const { return {*mesh, coordinates, location, nodes, items()}; }
};

/// Points outside, the same on every rank.
struct Misses {
  GlobalId targets = 0, outside = 0, skipped = 0;
  double greatest_distance = 0;
  Vec3 farthest{};
};

struct GridTransfer::Impl {
  std::string name;
  FieldDescription field;
  TransferOptions options;
  Method method = Method::interpolate;
  Partner source, target;
  RowMap map;
  Misses misses;
  std::int64_t built = 0;

  // Scratch and counter of apply; grow to what is needed once.
  mutable std::int64_t applied = 0;
  mutable std::vector<double> gathered;
  mutable std::vector<ExchangeItem> messages;

  const Communicator& comm() const { return target.mesh->comm; }
  void build();
  void apply(std::span<const TransferItem> fields) const;
};

/// Collective. Counts the points outside and finds the farthest (of equals, that of the smallest id).
Misses count_misses(const Communicator& comm, const Sought& sought);

/// Collective. Estimate of the greatest error of interpolated values, unit of the field.
double interpolation_error(const Partner& source, const Partner& target, const RowMap& map,
                           std::span<const double> values, int components);

}  // namespace tenon::transfer
