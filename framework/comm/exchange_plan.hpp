// SPDX-License-Identifier: BSD-3-Clause
// Irregular communication that is worked out once and run often.
#pragma once

#include <cstddef>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "framework/base/types.hpp"
#include "framework/comm/communicator.hpp"

namespace tenon {

/// One array that travels: `bytes` per item, read from `from` and written to `to`.
struct ExchangeItem {
  const std::byte* from;
  std::byte* to;
  std::size_t bytes;
};

/// Who sends what to whom. Building is collective and finds the neighbours without a loop over all ranks;
/// running sends one message per neighbour however many arrays travel, allocates nothing once its buffers
/// have grown, and copies what stays on the rank. Items arrive ordered by (source rank, order of sending).
/// Copies of a plan share everything. A plan may be run by one caller at a time.
class ExchangePlan {
 public:
  ExchangePlan() = default;

  /// Collective. Item i of this rank goes to rank `destination[i]`; -1 goes nowhere. Throws nothing.
  static ExchangePlan to_ranks(const Communicator& comm, std::span<const int> destination, std::string name);

  /// Collective. Rank r sends its items `send[i]` (local indices) to `send_rank[i]`, where they are stored in
  /// order of arrival (source rank, order of sending).
  static ExchangePlan to_ranks(const Communicator& comm, std::span<const int> send_rank,
                               std::span<const LocalIndex> send, std::string name);

  /// Collective. The pull form, for ghosts and for gathers: this rank wants, in place `into[i]` of its own
  /// array, item `index[i]` of rank `owner[i]`. `index` counts in the owner's array. Where `owner[i]` is -1, nothing
  /// is asked for and the place is left alone.
  static ExchangePlan from_owners(const Communicator& comm, std::span<const int> owner,
                                  std::span<const LocalIndex> index, std::span<const LocalIndex> into,
                                  std::string name);

  /// Items that arrive on this rank (from all ranks, itself included).
  LocalIndex received() const;
  /// Source rank of each arriving item, in order of arrival.
  std::vector<int> received_from() const;
  /// Ranks that this one sends to or receives from, without itself.
  int neighbours() const;

  /// Collective. Moves `components` values of T per item. `to` is indexed by `into` (pull form) or by order
  /// of arrival. `from` and `to` may be the same array in the pull form.
  template <typename T>
  void forward(std::span<const T> from, std::span<T> to, int components = 1) const {
    static_assert(std::is_trivially_copyable_v<T>);
    const ExchangeItem item{reinterpret_cast<const std::byte*>(from.data()), reinterpret_cast<std::byte*>(to.data()),
                            sizeof(T) * static_cast<std::size_t>(components)};
    forward(std::span(&item, 1));
  }
  /// Collective. The way back: what arrived returns to where it came from. Where several ranks pulled the
  /// same item, the last in rank order wins: use only for results of which there is one.
  template <typename T>
  void reverse(std::span<const T> from, std::span<T> to, int components = 1) const {
    static_assert(std::is_trivially_copyable_v<T>);
    const ExchangeItem item{reinterpret_cast<const std::byte*>(from.data()), reinterpret_cast<std::byte*>(to.data()),
                            sizeof(T) * static_cast<std::size_t>(components)};
    reverse(std::span(&item, 1));
  }
  /// Collective. Several arrays in one message per neighbour.
  void forward(std::span<const ExchangeItem> arrays) const;
  void reverse(std::span<const ExchangeItem> arrays) const;

  /// Collective. `forward` in two halves, for work between them: the first posts the messages, the second waits for
  /// them and stores what arrived. Between the two, `from` may be read and the places that nothing arrives in may be
  /// written (the values have left already), and no other run of this plan may begin.
  template <typename T>
  void begin_forward(std::span<const T> from, std::span<T> to, int components = 1) const {
    static_assert(std::is_trivially_copyable_v<T>);
    const ExchangeItem item{reinterpret_cast<const std::byte*>(from.data()), reinterpret_cast<std::byte*>(to.data()),
                            sizeof(T) * static_cast<std::size_t>(components)};
    begin_forward(std::span(&item, 1));
  }
  void begin_forward(std::span<const ExchangeItem> arrays) const;
  void end_forward() const;

  /// Collective, set-up only: items of varying length. `counts[i]` values belong to item i of this rank and
  /// stand one after the other in `values`; returns the same of the arriving items, in order of arrival: by source
  /// rank, then by order of sending (in the pull form: of asking).
  template <typename T>
  struct Varying {
    std::vector<LocalIndex> counts;
    std::vector<T> values;
  };
  template <typename T>
  Varying<T> forward_varying(std::span<const LocalIndex> counts, std::span<const T> values) const {
    static_assert(std::is_trivially_copyable_v<T>);
    Varying<T> result;
    const std::vector<std::byte> bytes = forward_varying_bytes(counts, std::as_bytes(values), sizeof(T), result.counts);
    result.values.resize(bytes.size() / sizeof(T));
    if (!bytes.empty()) std::memcpy(result.values.data(), bytes.data(), bytes.size());
    return result;
  }

  bool empty() const { return impl_ == nullptr; }

 private:
  struct Impl;
  explicit ExchangePlan(std::shared_ptr<Impl> impl) : impl_(std::move(impl)) {}
  std::vector<std::byte> forward_varying_bytes(std::span<const LocalIndex> counts, std::span<const std::byte> values,
                                               std::size_t bytes_per_value, std::vector<LocalIndex>& received) const;
  std::shared_ptr<Impl> impl_;
};

}  // namespace tenon
