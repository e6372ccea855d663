// SPDX-License-Identifier: BSD-3-Clause
// Ranks that work together: small collectives, votes and exact sums. Hides MPI from every other room.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "framework/base/error.hpp"
#include "framework/comm/exact_sum.hpp"

namespace tenon {

/// Starts and ends MPI; one per program, made first in main. Makes every rank's abort end the run.
class MpiEnvironment {
 public:
  MpiEnvironment(int& argc, char**& argv);
  ~MpiEnvironment();
  MpiEnvironment(const MpiEnvironment&) = delete;
  MpiEnvironment& operator=(const MpiEnvironment&) = delete;
  /// Name and version of the MPI library, for `tenon --version`.
  static std::string library_version();
};

/// Messages and bytes that one named exchange sent from this rank since the start.
struct ExchangeCount {
  std::string name;
  std::int64_t calls = 0;
  std::int64_t messages = 0;
  std::int64_t bytes = 0;
};

/// A duplicated MPI communicator (freed with the last copy). Copies share it. Every function marked
/// *collective* must be called by all ranks in the same order; on one rank none of them communicates.
class Communicator {
 public:
  static Communicator world();
  /// Local: this rank alone.
  static Communicator self();

  int rank() const;
  int size() const;

  /// Collective: a communicator of the same ranks whose messages cannot meet those of this one.
  Communicator duplicate() const;
  /// Collective: waits for all.
  void barrier() const;

  /// Collective: the greatest, least or added value. Sums of doubles are not offered: use `sum(ExactSum)`.
  int max(int value) const;
  std::int64_t max(std::int64_t value) const;
  double max(double value) const;
  std::int64_t min(std::int64_t value) const;
  double min(double value) const;
  std::int64_t sum(std::int64_t value) const;
  bool any(bool value) const;
  /// Collective: element-wise over arrays of equal length, in place.
  void max(std::span<double> values) const;
  void min(std::span<double> values) const;
  void max(std::span<std::int64_t> values) const;
  void sum(std::span<std::int64_t> values) const;
  /// Collective: sum of all items of lower ranks (0 on rank 0).
  std::int64_t exclusive_scan(std::int64_t value) const;

  /// Collective: correctly rounded sums over all ranks, the same bits for any number of ranks.
  double sum(const ExactSum& local) const;
  void sum(std::span<const ExactSum> local, std::span<double> result) const;

  /// Collective: the values of all ranks, in rank order. For set-up: memory grows with the ranks.
  template <typename T>
  std::vector<T> all_gather(const T& value) const {
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<T> all(static_cast<std::size_t>(size()));
    all_gather_bytes(&value, all.data(), sizeof(T));
    return all;
  }
  /// Collective: the concatenated values of all ranks on rank 0 (empty elsewhere). For set-up and reports.
  template <typename T>
  std::vector<T> gather(std::span<const T> values) const {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::vector<std::byte> bytes = gather_bytes(std::as_bytes(values));
    std::vector<T> all(bytes.size() / sizeof(T));
    copy_bytes(all.data(), bytes);
    return all;
  }
  /// Collective: makes `values` of every rank equal to those of `root`.
  template <typename T>
  void broadcast(std::vector<T>& values, int root = 0) const {
    static_assert(std::is_trivially_copyable_v<T>);
    std::int64_t count = static_cast<std::int64_t>(values.size());
    broadcast_bytes(&count, sizeof count, root);
    values.resize(static_cast<std::size_t>(count));
    broadcast_bytes(values.data(), values.size() * sizeof(T), root);
  }
  void broadcast(std::string& text, int root = 0) const;

  /// Collective vote: if any rank brings an error, all ranks throw that of the lowest such rank.
  void throw_if_any(const std::optional<Error>& mine) const;
  /// Collective: runs `work` on every rank (which must not communicate) and votes on what it threw, so
  /// that all ranks throw together. std::exception other than Error becomes Error(file).
  void vote(const std::function<void()>& work) const;
  /// Collective: runs `work` on rank 0 only and votes.
  void vote_on_root(const std::function<void()>& work) const;

  /// The counter of a named exchange; made on first use, shared by all copies. References stay valid.
  ExchangeCount& count(const std::string& exchange) const;
  /// All counters in order of first use.
  std::vector<ExchangeCount> counts() const;

  struct Impl;
  /// For the sources of this room.
  Impl& impl() const { return *impl_; }

 private:
  friend struct CommunicatorAccess;
  explicit Communicator(std::shared_ptr<Impl> impl) : impl_(std::move(impl)) {}
  void all_gather_bytes(const void* value, void* all, std::size_t bytes) const;
  std::vector<std::byte> gather_bytes(std::span<const std::byte> bytes) const;
  void broadcast_bytes(void* data, std::size_t bytes, int root) const;
  static void copy_bytes(void* to, const std::vector<std::byte>& from);

  std::shared_ptr<Impl> impl_;
};

}  // namespace tenon
