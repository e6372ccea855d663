// SPDX-License-Identifier: BSD-3-Clause
// Lines for the user: to the terminal and, once opened, to a log file. Rank 0 writes, others are silent.
#pragma once

#include <fmt/core.h>

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

namespace tenon {

class Log {
 public:
  /// A log that writes only where `speaks` is true (rank 0); to its file alone if not `to_terminal`.
  explicit Log(bool speaks, bool to_terminal = true) : speaks_(speaks), to_terminal_(to_terminal) {}

  /// Also write to this file from now on; appends when `append`. Throws Error(file).
  void open(const std::string& path, bool append);
  void line(std::string_view text);
  void warning(std::string_view text);
  template <typename... Args>
  void print(fmt::format_string<Args...> format, Args&&... args) {
    if (speaks_) line(fmt::vformat(format, fmt::make_format_args(args...)));
  }
  bool speaks() const { return speaks_; }

 private:
  struct Closer {
    void operator()(std::FILE* f) const { std::fclose(f); }
  };
  bool speaks_, to_terminal_;
  std::unique_ptr<std::FILE, Closer> file_;
};

}  // namespace tenon
