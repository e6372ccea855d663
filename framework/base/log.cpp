// SPDX-License-Identifier: BSD-3-Clause
#include "framework/base/log.hpp"

#include "framework/base/error.hpp"

namespace tenon {

void Log::open(const std::string& path, bool append) {
  if (!speaks_) return;
  file_.reset(std::fopen(path.c_str(), append ? "a" : "w"));
  if (!file_) throw Error(ExitCode::file, fmt::format("{}: cannot be written", path));
}

void Log::line(std::string_view text) {
  if (!speaks_) return;
  if (to_terminal_) {
    fmt::print("{}\n", text);
    std::fflush(stdout);
  }
  if (!file_) return;
  fmt::print(file_.get(), "{}\n", text);
  std::fflush(file_.get());
}

void Log::warning(std::string_view text) {
  line(fmt::format("warning: {}", text));
}

}  // namespace tenon
