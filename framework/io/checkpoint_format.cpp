// SPDX-License-Identifier: BSD-3-Clause
#include "framework/io/checkpoint_format.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <vector>

#include "framework/io/posix_file.hpp"

namespace tenon::checkpoint_format {

static_assert(std::endian::native == std::endian::little, "the preamble is written as it stands in memory");

std::uint64_t checksum(std::uint64_t first_value, std::span<const double> values) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < values.size(); ++i) sum += mix(first_value + i, std::bit_cast<std::uint64_t>(values[i]));
  return sum;
}

std::uint64_t own_checksum(const Preamble& p) {
  return mix(0, static_cast<std::uint64_t>(p.version)) + mix(1, p.file_bytes) + mix(2, p.file_checksum);
}

namespace {

/// Words [first, last) after the user block; the last word of the file may be cut short and is filled with zeros.
std::uint64_t checksum_of_words(const std::string& path, std::uint64_t first, std::uint64_t last, std::uint64_t bytes) {
  const PosixFile file(path, O_RDONLY);
  std::vector<std::uint64_t> chunk(std::min<std::uint64_t>(last - first, std::uint64_t{1} << 19));
  std::uint64_t sum = 0;
  for (std::uint64_t word = first; word < last; word += chunk.size()) {
    const std::uint64_t words = std::min<std::uint64_t>(chunk.size(), last - word);
    chunk[words - 1] = 0;
    file.read_at(chunk.data(), std::min(8 * words, bytes - 8 * word), user_block + 8 * word);
    for (std::uint64_t i = 0; i < words; ++i) sum += mix(word + i, chunk[i]);
  }
  return sum;
}

Preamble read_preamble(const std::string& path) {
  const PosixFile file(path, O_RDONLY);
  const std::uint64_t size = file.size();
  Preamble p{}, expected{};
  if (size >= user_block) file.read_at(&p, sizeof p, 0);
  if (size < user_block || std::memcmp(p.magic, expected.magic, sizeof p.magic) != 0)
    throw Error(ExitCode::file, fmt::format("{}: not a Tenon checkpoint", path));
  if (p.own_checksum != own_checksum(p))
    throw Error(ExitCode::file, fmt::format("{}: damaged checkpoint (its first bytes); use an older one", path));
  if (p.version != version)
    throw Error(ExitCode::file,
                fmt::format("{}: checkpoint of format {}, this program reads format {}", path, p.version, version));
  if (p.file_bytes != size)
    throw Error(ExitCode::file,
                fmt::format("{}: truncated or grown checkpoint: {} bytes instead of {}; use an older one", path, size,
                            p.file_bytes));
  return p;
}

}  // namespace

std::uint64_t file_checksum(const Communicator& comm, const std::string& path, std::uint64_t file_bytes) {
  const std::uint64_t bytes = file_bytes - user_block, words = (bytes + 7) / 8;
  const auto ranks = static_cast<std::uint64_t>(comm.size()), rank = static_cast<std::uint64_t>(comm.rank());
  std::uint64_t mine = 0;
  comm.vote([&] { mine = checksum_of_words(path, words * rank / ranks, words * (rank + 1) / ranks, bytes); });
  return static_cast<std::uint64_t>(comm.sum(static_cast<std::int64_t>(mine)));
}

void verify(const Communicator& comm, const std::string& path) {
  std::vector<std::uint64_t> said(2);
  comm.vote_on_root([&] {
    const Preamble p = read_preamble(path);
    said = {p.file_bytes, p.file_checksum};
  });
  comm.broadcast(said);
  const std::uint64_t found = file_checksum(comm, path, said[0]);
  if (found != said[1])
    throw Error(ExitCode::file,
                fmt::format("{}: damaged checkpoint (checksum {:016x} instead of {:016x}); use an older one", path,
                            found, said[1]));
}

void sync_folder(const std::string& path) {
  const std::string parent = std::filesystem::path(path).parent_path().string();
  PosixFile(parent.empty() ? "." : parent, O_RDONLY | O_DIRECTORY).sync();
}

}  // namespace tenon::checkpoint_format
