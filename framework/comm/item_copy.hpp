// SPDX-License-Identifier: BSD-3-Clause
// Packing and unpacking of items of any length. For the sources of this room only.
#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>

#include "framework/base/types.hpp"
#include "framework/comm/exchange_plan.hpp"

namespace tenon {

template <std::size_t bytes>
void gather_items(const std::byte* from, std::span<const LocalIndex> items, std::byte* to) {
  for (const LocalIndex item : items) {
    std::memcpy(to, from + static_cast<std::size_t>(item) * bytes, bytes);
    to += bytes;
  }
}

template <std::size_t bytes>
void scatter_items(const std::byte* from, std::span<const LocalIndex> items, std::byte* to) {
  for (const LocalIndex item : items) {
    std::memcpy(to + static_cast<std::size_t>(item) * bytes, from, bytes);
    from += bytes;
  }
}

template <std::size_t bytes>
void copy_items(const std::byte* from, std::span<const LocalIndex> items, std::byte* to,
                std::span<const LocalIndex> places) {
  for (std::size_t i = 0; i < items.size(); ++i)
    std::memmove(to + static_cast<std::size_t>(places[i]) * bytes, from + static_cast<std::size_t>(items[i]) * bytes,
                 bytes);
}

// Copies of a length known to the compiler are several times faster. Calls `work` with that length (an integral
// constant), or returns false: one and two words, a vector, a tensor.
template <typename Work>
bool with_fixed_length(std::size_t bytes, const Work& work) {
  switch (bytes) {
    case 4:
      work(std::integral_constant<std::size_t, 4>());
      return true;
    case 8:
      work(std::integral_constant<std::size_t, 8>());
      return true;
    case 16:
      work(std::integral_constant<std::size_t, 16>());
      return true;
    case 24:
      work(std::integral_constant<std::size_t, 24>());
      return true;
    case 48:
      work(std::integral_constant<std::size_t, 48>());
      return true;
    default:
      return false;
  }
}

inline void gather_items(const std::byte* from, std::span<const LocalIndex> items, std::byte* to, std::size_t bytes) {
  if (with_fixed_length(bytes, [&](auto length) { gather_items<length()>(from, items, to); })) return;
  for (std::size_t i = 0; i < items.size(); ++i)
    std::memcpy(to + i * bytes, from + static_cast<std::size_t>(items[i]) * bytes, bytes);
}

inline void scatter_items(const std::byte* from, std::span<const LocalIndex> items, std::byte* to, std::size_t bytes) {
  if (with_fixed_length(bytes, [&](auto length) { scatter_items<length()>(from, items, to); })) return;
  for (std::size_t i = 0; i < items.size(); ++i)
    std::memcpy(to + static_cast<std::size_t>(items[i]) * bytes, from + i * bytes, bytes);
}

inline void copy_items(const ExchangeItem& array, std::span<const LocalIndex> items,
                       std::span<const LocalIndex> places) {
  if (with_fixed_length(array.bytes, [&](auto length) { copy_items<length()>(array.from, items, array.to, places); }))
    return;
  for (std::size_t i = 0; i < items.size(); ++i)
    std::memmove(array.to + static_cast<std::size_t>(places[i]) * array.bytes,
                 array.from + static_cast<std::size_t>(items[i]) * array.bytes, array.bytes);
}

}  // namespace tenon
