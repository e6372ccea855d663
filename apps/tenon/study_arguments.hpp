// SPDX-License-Identifier: BSD-3-Clause
// The command line of `tenon study` as the text of a study, so that both ways are checked alike.
#pragma once

#include <string>

#include "apps/tenon/study_plan.hpp"

namespace tenon {

struct StudyText {
  std::string text, file;
  bool from_command_line = false;
};

/// Collective. The text of the study file, or one made of --vary and --quantity for a scene. Throws Error(usage).
StudyText study_text(const Communicator& comm, const StudyArguments& arguments);

/// "a, [1, 2], b" -> three values: commas inside brackets, parentheses and quotes do not part.
std::vector<std::string> split_values(const std::string& text);

}  // namespace tenon
