// SPDX-License-Identifier: BSD-3-Clause
#include "apps/tenon/load_scene.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "apps/tenon/scene_schema.hpp"

namespace tenon {

namespace {

constexpr std::uintmax_t greatest_size = 10u << 20;

std::string read_text(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (!fs::exists(path, error)) throw Error(ExitCode::usage, path + ": there is no such scene file");
  if (!fs::is_regular_file(path, error))
    throw Error(ExitCode::usage, path + ": is not a file; give the path of a scene (.yaml)");
  if (fs::file_size(path, error) > greatest_size)
    throw Error(ExitCode::usage,
                path + ": is larger than 10 MB and so hardly a scene; give the path of a scene (.yaml)");
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  if (!file) throw Error(ExitCode::usage, path + ": cannot be read: " + std::strerror(errno));
  return text.str();
}

}  // namespace

std::string read_scene_text(const Communicator& comm, const std::string& path) {
  std::string text;
  comm.vote_on_root([&] { text = read_text(path); });
  comm.broadcast(text);
  return text;
}

bool is_study(const std::string& text) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (line.rfind("vary:", 0) == 0 || line.rfind("scene:", 0) == 0 || line.rfind("quantities:", 0) == 0) return true;
  return false;
}

LoadedScene load_scene(const Communicator& comm, const std::string& path,
                       const std::vector<scene::Override>& overrides) {
  const std::string text = read_scene_text(comm, path);
  if (is_study(text))
    throw Error(ExitCode::usage, path + ": is a study, not a scene; run it with `tenon study " + path + "`");
  scene::Diagnostics diagnostics;
  const scene::Value value = scene::parse_scene(text, path, overrides, scene_schema(), diagnostics);
  diagnostics.throw_if_any();
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  return {path, folder.empty() ? "." : folder.string(), value.has("title") ? value.text("title") : path, value};
}

std::vector<scene::Override> parse_overrides(const std::vector<std::string>& texts) {
  std::vector<scene::Override> overrides;
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
      throw Error(ExitCode::usage, "--set " + text + ": expected key.path=value, as end_time='5 us'");
    overrides.push_back({text.substr(0, equals), text.substr(equals + 1)});
  }
  return overrides;
}

}  // namespace tenon
