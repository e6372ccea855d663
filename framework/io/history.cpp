// SPDX-License-Identifier: BSD-3-Clause
#include "framework/io/history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "framework/io/posix_file.hpp"

namespace tenon {

namespace {

std::string header_of(const std::vector<std::string>& columns) {
  std::set<std::string_view> known;
  for (const std::string& c : columns) {
    if (!known.insert(c).second) throw Error(ExitCode::file, fmt::format("history: column '{}' stands twice", c));
    if (c.empty() || c.find_first_of(",\"\n\r") != std::string::npos)
      throw Error(ExitCode::file, fmt::format("history: '{}' cannot be the name of a column", c));
  }
  return fmt::format("{}\n", fmt::join(columns, ","));
}

/// Step of a whole row of `columns` numbers; empty for anything else (a row torn by a kill).
std::optional<double> step_of_row(std::string_view row, std::size_t columns, std::size_t step_column) {
  std::optional<double> step;
  for (std::size_t c = 0; c < columns; ++c) {
    const std::size_t comma = row.find(',');
    if ((comma == std::string_view::npos) != (c + 1 == columns)) return {};
    const std::string_view cell = row.substr(0, comma);
    double value = 0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error == std::errc::invalid_argument || end != cell.data() + cell.size()) return {};
    if (c == step_column) step = value;
    if (comma != std::string_view::npos) row.remove_prefix(comma + 1);
  }
  return step;
}

/// What stays of an earlier file: the header and all whole rows up to the first that is later than `resume_step` or
/// torn.
std::string kept_text(const std::string& path, const std::vector<std::string>& columns, const std::string& header,
                      std::int64_t resume_step) {
  const std::string text = read_text(path);
  if (!text.starts_with(header)) {
    if (text.find('\n') == std::string::npos) return header;  // killed while the header was written
    throw Error(
        ExitCode::file,
        fmt::format("{}: its columns are not those of this run, which cannot continue it; expected the first line "
                    "to be '{}'. Restart into another folder, or move the file away",
                    path, header.substr(0, header.size() - 1)));
  }
  const auto step = std::ranges::find(columns, "step");
  if (step == columns.end()) throw Error(ExitCode::file, fmt::format("{}: has no column 'step' to restart at", path));
  const auto step_column = static_cast<std::size_t>(step - columns.begin());
  std::size_t end = header.size();
  for (std::size_t next; (next = text.find('\n', end)) != std::string::npos; end = next + 1) {
    const auto at = step_of_row(std::string_view(text).substr(end, next - end), columns.size(), step_column);
    if (!at || *at > static_cast<double>(resume_step)) break;
  }
  return text.substr(0, end);
}

}  // namespace

struct History::Impl {
  struct Closer {
    void operator()(std::FILE* f) const { std::fclose(f); }
  };
  Impl(const Communicator& c, std::string file_path, std::size_t n) : comm(c), path(std::move(file_path)), columns(n) {}

  Communicator comm;
  std::string path;
  std::size_t columns;
  std::unique_ptr<std::FILE, Closer> file;  // rank 0 only
  fmt::memory_buffer line;
  int error = 0;  // of the first failed write

  void open(const std::vector<std::string>& names, std::int64_t resume_step);
};

void History::Impl::open(const std::vector<std::string>& names, std::int64_t resume_step) {
  const std::string header = header_of(names);
  const bool continues = resume_step >= 0 && std::filesystem::exists(path);
  write_and_rename(path, continues ? kept_text(path, names, header, resume_step) : header);
  file.reset(std::fopen(path.c_str(), "a"));
  if (!file) throw Error(ExitCode::file, fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
}

History::History(const Communicator& comm, std::string path, std::vector<std::string> columns, std::int64_t resume_step)
    : impl_(new Impl(comm, std::move(path), columns.size())) {
  comm.vote_on_root([&] { impl_->open(columns, resume_step); });
}

History::~History() = default;

void History::row(std::span<const double> values) {
  Impl& my = *impl_;
  if (!my.file) return;
  my.line.clear();
  for (std::size_t i = 0; i < my.columns; ++i) {
    if (i > 0) my.line.push_back(',');
    // A row that is too short shows as nan, not as a shifted table.
    const double value = i < values.size() ? values[i] : std::numeric_limits<double>::quiet_NaN();
    fmt::format_to(std::back_inserter(my.line), "{:.17g}", value);
  }
  my.line.push_back('\n');
  // At once to the system, so that a kill loses no row that a later checkpoint takes for written.
  std::FILE* const file = my.file.get();
  const bool written = std::fwrite(my.line.data(), 1, my.line.size(), file) == my.line.size() && std::fflush(file) == 0;
  if (!written && my.error == 0) my.error = errno;
}

void History::flush() {
  impl_->comm.vote_on_root([&] {
    const int error = std::exchange(impl_->error, 0);
    if (error != 0)
      throw Error(ExitCode::file, fmt::format("{}: cannot be written: {}", impl_->path, std::strerror(error)));
  });
}

}  // namespace tenon
