// SPDX-License-Identifier: BSD-3-Clause
// Communication between ranks that know by themselves what goes between them: no message agrees on it.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <type_traits>

#include "framework/base/types.hpp"
#include "framework/comm/communicator.hpp"

namespace tenon {

/// A pattern that changes as often as in every step. What both ends of a message must know alike is how many items it
/// has, and in which order; then only ranks with something to say send. Allocates nothing once its buffers have grown.
class AgreedExchange {
 public:
  /// Collective. Messages are counted under `name`.
  AgreedExchange(const Communicator& comm, const std::string& name);
  ~AgreedExchange();
  AgreedExchange(AgreedExchange&&) noexcept;

  struct Item {
    int rank;          ///< to which, or from which; not this one
    LocalIndex index;  ///< in the array that travels
    auto operator<=>(const Item&) const = default;
  };
  /// Local. Items of each rank stand in the order of this list; the other end has as many of this rank, in the same
  /// order.
  void agree(std::span<const Item> send, std::span<const Item> receive);
  /// Not collective: between the ranks that have agreed on something. In place.
  template <typename T>
  void forward(std::span<T> values) const {
    static_assert(std::is_trivially_copyable_v<T>);
    run(reinterpret_cast<std::byte*>(values.data()), sizeof(T));
  }

 private:
  void run(std::byte* values, std::size_t bytes) const;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tenon
