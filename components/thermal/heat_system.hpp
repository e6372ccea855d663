// SPDX-License-Identifier: BSD-3-Clause
// The linear system of an implicit step.
#pragma once

#include <span>

#include "components/thermal/conduction_matrix.hpp"

namespace tenon::thermal {

/// (diag(d) + factor * off-diagonal of K) x = b, W or J. Rows whose `inverse_diagonal` is 0 are held: x stays what it
/// was.
struct HeatSystem {
  const ConductionMatrix& matrix;
  double factor;
  std::span<const double> diagonal;
  std::span<const double> inverse_diagonal;
};

}  // namespace tenon::thermal
