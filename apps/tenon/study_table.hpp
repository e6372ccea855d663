// SPDX-License-Identifier: BSD-3-Clause
// The results of a study: errors, observed orders, study.csv.
#pragma once

#include <string>
#include <vector>

#include "apps/tenon/study_measure.hpp"
#include "apps/tenon/study_plan.hpp"

namespace tenon {

/// What became of one run.
struct StudyRow {
  std::string status = "not run";  ///< "done", or what went wrong
  bool done = false;
  double size = unknown;         ///< h
  double set_up = unknown;       ///< s: from the scene to the first step
  double seconds = unknown;      ///< s of stepping, without output; greatest of the ranks
  double steps = 0, work = 0;    ///< work: element-steps of all components
  std::vector<Measured> values;  ///< by quantity
  std::vector<double> orders;    ///< by quantity: observed between this row and the one before; NaN if there is none
};

/// A note on how the errors of a quantity were found.
struct Extrapolation {
  double value = unknown, order = unknown;
  bool monotone = false;
};

/// Limit of q(h) = q* + C h^p through three runs of descending h. Not monotone if the differences change sign or do not
/// shrink with h: then there is no order and no limit.
Extrapolation richardson(const double (&size)[3], const double (&value)[3]);

/// Fills in errors against the finest runs, where there is no reference, and all orders. Returns notes for the user.
std::vector<std::string> analyse(const StudyPlan& plan, std::vector<StudyRow>& rows);

std::string study_csv(const StudyPlan& plan, const std::vector<StudyRow>& rows);

}  // namespace tenon
