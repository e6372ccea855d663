// SPDX-License-Identifier: BSD-3-Clause
#include "framework/io/posix_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "framework/base/error.hpp"

namespace tenon {

namespace {
[[noreturn]] void fail_with(const std::string& path, const char* what, int error) {
  throw Error(ExitCode::file, fmt::format("{}: {}: {}", path, what, std::strerror(error)));
}
}  // namespace

PosixFile::PosixFile(std::string path, int flags) : path_(std::move(path)) {
  do descriptor_ = ::open(path_.c_str(), flags | O_CLOEXEC, 0666);
  while (descriptor_ < 0 && errno == EINTR);
  if (descriptor_ < 0) fail((flags & (O_WRONLY | O_RDWR)) != 0 ? "cannot be written" : "cannot be opened");
}

PosixFile::~PosixFile() {
  ::close(descriptor_);
}

void PosixFile::fail(const char* what) const {
  fail_with(path_, what, errno);
}

std::uint64_t PosixFile::size() const {
  struct stat info {};
  if (::fstat(descriptor_, &info) != 0) fail("cannot be read");
  if (S_ISDIR(info.st_mode)) fail_with(path_, "cannot be read", EISDIR);
  return static_cast<std::uint64_t>(info.st_size);
}

void PosixFile::read_at(void* to, std::size_t bytes, std::uint64_t offset) const {
  auto* at = static_cast<char*>(to);
  while (bytes > 0) {
    const ssize_t n = ::pread(descriptor_, at, bytes, static_cast<off_t>(offset));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail("cannot be read");
    if (n == 0) throw Error(ExitCode::file, fmt::format("{}: ends at byte {}, more was expected", path_, offset));
    at += n, bytes -= static_cast<std::size_t>(n), offset += static_cast<std::uint64_t>(n);
  }
}

void PosixFile::write_at(const void* from, std::size_t bytes, std::uint64_t offset) const {
  const auto* at = static_cast<const char*>(from);
  while (bytes > 0) {
    const ssize_t n = ::pwrite(descriptor_, at, bytes, static_cast<off_t>(offset));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail("cannot be written");
    at += n, bytes -= static_cast<std::size_t>(n), offset += static_cast<std::uint64_t>(n);
  }
}

void PosixFile::reserve(std::uint64_t offset, std::uint64_t bytes) const {
  int result = 0;
  do result = ::fallocate(descriptor_, 0, static_cast<off_t>(offset), static_cast<off_t>(bytes));
  while (result != 0 && errno == EINTR);
  if (result != 0 && errno != EOPNOTSUPP && errno != ENOSYS) fail("cannot be written");
}

void PosixFile::sync() const {
  // A file system that cannot sync this kind of file (EINVAL, EROFS on folders) has nothing to make safe.
  if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) fail("cannot be brought to the disk");
}

void rename_file(const std::string& from, const std::string& to) {
  if (std::rename(from.c_str(), to.c_str()) != 0) fail_with(to, "cannot be replaced", errno);
}

void write_and_rename(const std::string& path, std::string_view text, bool sync) {
  const std::string part = path + ".part";
  {
    const PosixFile file(part, O_WRONLY | O_CREAT | O_TRUNC);
    file.write_at(text.data(), text.size(), 0);
    if (sync) file.sync();
  }
  rename_file(part, path);
}

std::string read_text(const std::string& path) {
  const PosixFile file(path, O_RDONLY);
  std::string text(file.size(), '\0');
  file.read_at(text.data(), text.size(), 0);
  return text;
}

void make_folder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) throw Error(ExitCode::file, fmt::format("{}: folder cannot be made: {}", path, error.message()));
}

}  // namespace tenon
