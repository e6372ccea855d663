// SPDX-License-Identifier: BSD-3-Clause
// What a study varies and what it measures, from its file or from the command line.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "framework/base/space_time_function.hpp"
#include "framework/comm/communicator.hpp"
#include "framework/scene/expression.hpp"
#include "framework/scene/schema.hpp"

namespace tenon {

struct StudyArguments {
  std::string file;                     ///< a study, or a scene if `vary` is given
  std::string folder;                   ///< empty: the file's name with `.results`
  std::vector<std::string> vary;        ///< key.path=value,value,...
  std::vector<std::string> quantities;  ///< column[:take], or component.field.part if `exact` is given
  std::string reference, exact, size;   ///< expressions; empty: none
  std::vector<std::string> settings;    ///< key.path=value
  bool grid = false, picture = true;
};

struct StudyVariation {
  std::string key, name;
  std::vector<std::string> values;
};

/// A number of a run, and how its error is found.
struct StudyQuantity {
  enum class Take { last, maximum, minimum, at };
  std::string name;
  bool is_field = false;
  // A column of history.csv. Without a reference its error is against the extrapolation of the finest runs.
  std::string column;
  Take take = Take::last;
  double time = 0;                             ///< of Take::at, s
  std::optional<scene::Expression> reference;  ///< of t and the names of the variations
  // A field at the end against its exact solution.
  std::string component, field, part;
  std::optional<SpaceTimeFunction> exact;
};

/// One scene with settings.
struct StudyRun {
  std::vector<std::string> values;    ///< of each variation
  std::vector<std::string> settings;  ///< key.path=value, those of the whole study first
  std::string folder;                 ///< below that of the study
  std::vector<double> numbers = {};   ///< the values as formulas see them, in SI; NaN where one is no number
};

struct StudyPlan {
  std::string title, scene, folder;
  std::vector<StudyVariation> vary;
  bool grid = false, frames = false, picture = true;
  std::optional<scene::Expression> size;  ///< of the names of the variations; empty: mean element size
  std::vector<StudyQuantity> quantities;
  std::vector<StudyRun> runs;
};

scene::Schema study_schema();

/// Collective. Reads and checks the study, and every one of its scenes. Throws Error(usage) with all complaints,
/// Error(file).
StudyPlan load_study(const Communicator& comm, const StudyArguments& arguments);

}  // namespace tenon
