// SPDX-License-Identifier: BSD-3-Clause
// What is measured at the end of one run of a study.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "apps/tenon/study_plan.hpp"
#include "framework/simulation/simulation.hpp"

namespace tenon {

inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// One quantity of one run.
struct Measured {
  double value = unknown;           ///< of a column; the L2 norm of a field's error
  double error = unknown;           ///< relative to the reference; of a field: relative L2
  double greatest_error = unknown;  ///< of a field: greatest, relative to the greatest exact value
};

/// Local. Throws Error(usage) with suggestions if a field of the study does not exist.
void check_fields(const StudyPlan& plan, const Simulation& simulation);
/// Collective. Reads the header of history.csv; throws Error(usage) with suggestions if a column does not exist.
void check_columns(const Communicator& comm, const StudyPlan& plan, const std::string& csv);

/// Collective. Mean element size of the first component, m: (volume / elements)^(1/3), of surfaces (area /
/// elements)^(1/2).
double mean_element_size(const Simulation& simulation);

/// Collective. Relative L2 and greatest error of a field over the mesh, nodes weighted by their share of the volume
/// around them, elements by their volume, all undeformed. The same bits on any number of ranks.
Measured measure_field(const Simulation& simulation, const StudyQuantity& quantity);

/// Collective. From history.csv; `values` are those of the variations, for the reference.
Measured measure_history(const Communicator& comm, const std::string& csv, const StudyQuantity& quantity,
                         const std::vector<double>& values);

}  // namespace tenon
