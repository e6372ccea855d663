// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "framework/base/error.hpp"
#include "framework/io/pictures.hpp"

namespace tenon {

namespace {

constexpr const char* guard = "TENON_UNDER_XVFB";
constexpr const char* remedy =
    "pictures are drawn through an X display, and there is none. Install a virtual one (apt-get install xvfb xauth "
    "libgl1-mesa-dri), or set DISPLAY";

bool on_path(const char* program) {
  const char* const path = std::getenv("PATH");
  std::string_view rest = path != nullptr ? path : "";
  while (!rest.empty()) {
    const std::size_t colon = rest.find(':');
    const std::filesystem::path candidate = std::filesystem::path(rest.substr(0, colon)) / program;
    if (::access(candidate.c_str(), X_OK) == 0) return true;
    rest = colon == std::string_view::npos ? "" : rest.substr(colon + 1);
  }
  return false;
}

}  // namespace

bool has_display() {
  const char* const display = std::getenv("DISPLAY");
  return display != nullptr && *display != '\0';
}

void ensure_display(int argc, char** argv) {
  if (has_display()) return;
  // The guard: a display that xvfb-run itself did not provide is not tried for again.
  if (std::getenv(guard) != nullptr || !on_path("xvfb-run") || !on_path("xauth")) throw Error(ExitCode::file, remedy);
  ::setenv(guard, "1", 1);
  std::error_code error;
  std::string self = std::filesystem::read_symlink("/proc/self/exe", error).string();
  if (error) self = argv[0];
  std::string words[] = {"xvfb-run", "-a", "-s", "-screen 0 1600x1200x24"};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(self.data());
  for (int i = 1; i < argc; ++i) arguments.push_back(argv[i]);
  arguments.push_back(nullptr);
  ::execvp(arguments[0], arguments.data());
  throw Error(ExitCode::file, fmt::format("xvfb-run cannot be started: {}", std::strerror(errno)));
}

}  // namespace tenon
