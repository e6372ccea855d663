// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <optional>

#include "framework/io/checkpoint.hpp"
#include "framework/io/checkpoint_format.hpp"

namespace tenon {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view prefix = "checkpoint-", suffix = ".h5";
constexpr std::size_t kept = 2;

/// The step in "checkpoint-<step>.h5", written without leading zeros.
std::optional<std::int64_t> step_of(const std::string& file) {
  if (!file.starts_with(prefix) || !file.ends_with(suffix)) return {};
  const char* const first = file.data() + prefix.size();
  const char* const last = file.data() + file.size() - suffix.size();
  std::int64_t step = -1;
  const auto [end, error] = std::from_chars(first, last, step);
  if (error != std::errc{} || end != last || step < 0 || (*first == '0' && last - first > 1)) return {};
  return step;
}

std::vector<std::int64_t> steps_in(const std::string& folder) {
  std::vector<std::int64_t> steps;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (const auto step = step_of(it->path().filename().string())) steps.push_back(*step);
  std::ranges::sort(steps, std::greater{});
  return steps;
}

void remove_files(const std::string& folder, std::span<const std::int64_t> steps) {
  std::error_code ignored;
  for (const std::int64_t step : steps) fs::remove(CheckpointFiles::name(folder, step), ignored);
}

}  // namespace

std::string CheckpointFiles::name(const std::string& folder, std::int64_t step) {
  return (fs::path(folder) / fmt::format("{}{}{}", prefix, step, suffix)).string();
}

std::vector<std::string> CheckpointFiles::list(const std::string& folder) {
  std::vector<std::string> files;
  for (const std::int64_t step : steps_in(folder)) files.push_back(name(folder, step));
  return files;
}

void CheckpointFiles::prune(const std::string& folder) {
  const std::vector<std::int64_t> steps = steps_in(folder);
  remove_files(folder, std::span(steps).subspan(std::min(kept, steps.size())));
}

void CheckpointFiles::remove_later_than(const std::string& folder, std::int64_t step) {
  const std::vector<std::int64_t> steps = steps_in(folder);
  const auto first_kept = std::ranges::find_if(steps, [&](std::int64_t s) { return s <= step; });
  remove_files(folder, std::span(steps.begin(), first_kept));
}

std::string CheckpointFiles::newest_valid(const Communicator& comm, const std::string& folder,
                                          std::vector<std::string>* damaged) {
  std::vector<std::int64_t> steps;
  if (comm.rank() == 0) steps = steps_in(folder);
  comm.broadcast(steps);
  for (const std::int64_t step : steps) {
    const std::string file = name(folder, step);
    try {
      checkpoint_format::verify(comm, file);
      return file;
    } catch (const Error& error) {
      if (damaged != nullptr) damaged->emplace_back(error.what());
    }
  }
  return {};
}

}  // namespace tenon
