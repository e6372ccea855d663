// SPDX-License-Identifier: BSD-3-Clause
// A file descriptor whose every failure is an Error(file) with the system's reason; writing a text aside and renaming
// it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace tenon {

class PosixFile {
 public:
  /// Throws Error(file) as all functions here. `flags` as of open(2).
  PosixFile(std::string path, int flags);
  ~PosixFile();
  PosixFile(const PosixFile&) = delete;
  PosixFile& operator=(const PosixFile&) = delete;

  std::uint64_t size() const;
  /// Exactly `bytes` bytes from `offset`.
  void read_at(void* to, std::size_t bytes, std::uint64_t offset) const;
  void write_at(const void* from, std::size_t bytes, std::uint64_t offset) const;
  /// Takes the room for these bytes on the disk, where the file system can do so without writing.
  void reserve(std::uint64_t offset, std::uint64_t bytes) const;
  /// Waits until the disk has it.
  void sync() const;

 private:
  [[noreturn]] void fail(const char* what) const;
  std::string path_;
  int descriptor_ = -1;
};

/// Renames, replacing `to`. Throws Error(file).
void rename_file(const std::string& from, const std::string& to);
/// Writes `path`.part and renames it, so that a reader sees the old text or the new. Throws Error(file).
void write_and_rename(const std::string& path, std::string_view text, bool sync = false);
/// The whole file. Throws Error(file).
std::string read_text(const std::string& path);
/// Folder and its parents, if they are not there. Throws Error(file).
void make_folder(const std::string& path);

}  // namespace tenon
