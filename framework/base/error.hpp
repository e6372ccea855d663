// SPDX-License-Identifier: BSD-3-Clause
// The one exception type, which carries the exit code of the program.
#pragma once

#include <stdexcept>
#include <string>

namespace tenon {

/// Exit codes of every Tenon program.
enum class ExitCode : int {
  done = 0,
  usage = 2,     ///< command line or scene
  file = 3,      ///< mesh, checkpoint or other file
  unstable = 4,  ///< NaN, energy growth, collapse of the time step
  geometry = 5,  ///< inverted or degenerate element
  stopped = 6    ///< stopped on request, with a valid checkpoint
};

/// A failure that the user can act on. The message says what is wrong, where, and what to do next.
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

}  // namespace tenon
