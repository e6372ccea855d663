// SPDX-License-Identifier: BSD-3-Clause
// The matrices of an L2 projection, from samples and from the interpolation at the target's nodes.
#pragma once

#include <string>

#include "transfer/mass_matrix.hpp"
#include "transfer/projection_samples.hpp"
#include "transfer/rows.hpp"

namespace tenon::transfer {

/// Columns are places in the array that `gather` fills. The terms of a row stand in the order in which the assembly
/// comes upon them, by elements, samples and nodes: the same on any ranks.
struct ProjectionRows {
  ExchangePlan gather;
  std::size_t columns = 0;
  /// P: values at the target's owned nodes by interpolation. For a target on elements: the whole projection, with rows
  /// for all local elements.
  SparseRows<double> values;
  /// R = B - C P, rows of the owned nodes, m^3: of sum_q w_q N_i (f - P f)(x_q). Empty for a target on elements.
  SparseRows<double> residual;
};

/// Collective. `interpolation`: at all local nodes of the target. `mass`: of a target on nodes. `volumes`: of a target
/// on elements.
ProjectionRows projection_rows(const Side& source, const Side& target, const RowMap& interpolation,
                               const TargetSamples& samples, SampleTables& tables, const NodeElements& around,
                               const MassMatrix& mass, std::span<const double> volumes, const std::string& name);

}  // namespace tenon::transfer
