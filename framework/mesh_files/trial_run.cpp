// SPDX-License-Identifier: BSD-3-Clause
// Runs a reader in a child process first, for libraries that can crash or hang on corrupt files.
#include "framework/mesh_files/trial_run.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>

#include "framework/base/error.hpp"
#include "framework/mesh_files/read_support.hpp"

namespace tenon::mesh_file {
namespace {

constexpr rlim_t base_seconds = 2;                    ///< processor time any file may take; usual are 0.02 s
constexpr std::uint64_t bytes_per_second = 2u << 20;  ///< a slow reader's speed, of compressed data
constexpr char passed = '+', refused = '-';

void send(int pipe, char verdict, const std::string& text) {
  const std::string all = verdict + text;
  for (std::size_t done = 0; done < all.size();) {
    const ssize_t n = ::write(pipe, all.data() + done, all.size() - done);
    if (n < 0 && errno != EINTR) return;
    done += static_cast<std::size_t>(std::max<ssize_t>(n, 0));
  }
}

[[noreturn]] void run_child(int pipe, std::uint64_t bytes, const std::function<void()>& read) {
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTERM, SIGXCPU}) ::signal(signal, SIG_DFL);
  const rlim_t seconds = base_seconds + bytes / bytes_per_second;
  const rlimit time{seconds, seconds}, core{0, 0};
  ::setrlimit(RLIMIT_CPU, &time);
  ::setrlimit(RLIMIT_CORE, &core);
  const int null = ::open("/dev/null", O_WRONLY);
  ::dup2(null, STDOUT_FILENO);
  ::dup2(null, STDERR_FILENO);
  try {
    read();
    send(pipe, passed, "");
  } catch (const std::exception& error) {
    send(pipe, refused, error.what());
  }
  ::_exit(0);
}

std::string receive(int pipe) {
  std::string all;
  std::array<char, 4096> buffer;
  for (;;) {
    const ssize_t n = ::read(pipe, buffer.data(), buffer.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return all;
    all.append(buffer.data(), static_cast<std::size_t>(n));
  }
}

}  // namespace

void trial_run(const std::string& path, std::uint64_t bytes, const std::function<void()>& read) {
  const std::string way_out = "; 'nccopy -k 64-bit-offset IN OUT' makes a classic file, which needs no such check";
  std::array<int, 2> pipe;
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0)
    refuse(path, std::string("no pipe to check the file with: ") + std::strerror(errno) + way_out);
  const pid_t child = ::fork();
  if (child == 0) run_child(pipe[1], bytes, read);
  const int fork_error = errno;
  ::close(pipe[1]);
  const std::string answer = child > 0 ? receive(pipe[0]) : "";
  ::close(pipe[0]);
  if (child < 0) refuse(path, std::string("no process to check the file with: ") + std::strerror(fork_error) + way_out);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!answer.empty() && answer.front() == passed) return;
  if (!answer.empty()) throw Error(ExitCode::file, answer.substr(1));
  if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL))
    refuse(path, "is corrupt: the HDF5 library did not come to an end with it");
  refuse(path, "is corrupt: the HDF5 library crashed on it");
}

}  // namespace tenon::mesh_file
