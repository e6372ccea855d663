// SPDX-License-Identifier: BSD-3-Clause
// Makes spread amounts consistent with volumes: what is uniform in the source arrives uniform.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "transfer/rows.hpp"
#include "transfer/spreading.hpp"

namespace tenon::transfer {

/// Part of an amount that goes to one target item.
struct Piece {
  GlobalId target;
  double weight;
  LocalIndex at_owner;
  int owner;
};

/// One column for each share of the spreading points: pieces begin[c] .. begin[c+1]), ascending by target, their
/// weights' sum 1.
struct Columns {
  std::vector<Piece> pieces;
  std::vector<std::size_t> begin{0};
  std::span<Piece> column(std::size_t c) { return std::span(pieces).subspan(begin[c], begin[c + 1] - begin[c]); }
};

/// Scales a column such that its sum is 1 to within an ulp, so that no amount is lost.
void normalise(std::span<Piece> column);

/// Collective. A quadrature with few points gives a target item not quite its volume's worth of a uniform source (a
/// tenth more or less, and a third less at a curved surface, where meshes leave gaps). Alternating scaling of rows to
/// the target volumes and of columns to 1 (iterative proportional fitting [Sin64], which keeps signs) mends that;
/// columns come last, so sums are kept to round-off. Items with less than half or more than twice their volume are left
/// alone: the source covers them only in part. Shares without volume (points at nodes) are left alone too.
void balance(const Side& target, const SpreadingPoints& spreading, Columns& columns, const std::string& name);

}  // namespace tenon::transfer
