// SPDX-License-Identifier: BSD-3-Clause
// What stands around the HDF5 data of a checkpoint: a preamble in the user block, with a checksum of the whole file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "framework/comm/communicator.hpp"

namespace tenon::checkpoint_format {

inline constexpr std::size_t user_block = 512;  ///< bytes before HDF5's own; the least that HDF5 allows
inline constexpr std::int64_t version = 1;
inline constexpr const char* kind = "tenon checkpoint";

/// One term of a checksum: a bijection of `bits` for each position, so that a change of a single word always shows, and
/// any other change but for one case in 2^64. Terms are added (wrapping), so the sum does not depend on who adds what.
inline std::uint64_t mix(std::uint64_t position, std::uint64_t bits) {
  std::uint64_t h = bits ^ ((position + 1) * 0x9e3779b97f4a7c15u);
  h = (h ^ (h >> 32)) * 0xd6e8feb86659fd93u;
  h = (h ^ (h >> 32)) * 0xd6e8feb86659fd93u;
  return h ^ (h >> 32);
}

/// Checksum of rows `first_value` onwards of a dataset, where positions count values from the first row.
std::uint64_t checksum(std::uint64_t first_value, std::span<const double> values);

/// First bytes of the user block, little-endian; the rest of the block is zero.
struct Preamble {
  char magic[16] = {'T', 'e', 'n', 'o', 'n', ' ', 'c', 'h', 'e', 'c', 'k', 'p', 'o', 'i', 'n', 't'};
  std::int64_t version = checkpoint_format::version;
  std::uint64_t file_bytes = 0;     ///< of the whole file
  std::uint64_t file_checksum = 0;  ///< of all bytes after the user block
  std::uint64_t own_checksum = 0;   ///< of the three numbers above
};
static_assert(sizeof(Preamble) == 48 && sizeof(Preamble) <= user_block);
std::uint64_t own_checksum(const Preamble& preamble);

/// Collective. Checksum of the bytes from the user block to `file_bytes`; every rank reads its share of the file.
/// Throws Error(file) on all ranks if it cannot be read.
std::uint64_t file_checksum(const Communicator& comm, const std::string& path, std::uint64_t file_bytes);

/// Collective. Throws Error(file) on all ranks unless the file is a whole, undamaged checkpoint of this version. HDF5
/// does not see the file before: it may crash on damaged metadata.
void verify(const Communicator& comm, const std::string& path);

/// Makes the entry of a new or renamed file in its folder safe on the disk. Throws Error(file). Local.
void sync_folder(const std::string& path);

}  // namespace tenon::checkpoint_format
