// SPDX-License-Identifier: BSD-3-Clause
#include "apps/tenon/scaling_load.hpp"

#include <algorithm>

namespace tenon {

void Traffic::book(PhaseLoad& load, double times, double weight) const {
  const auto parts = static_cast<std::size_t>(parts_);
  struct Both {
    double sent = 0, received = 0;
  };
  std::vector<Both> messages(parts), bytes(parts);
  for (const auto& [key, message] : messages_) {
    const auto from = static_cast<std::size_t>(key / parts_), to = static_cast<std::size_t>(key % parts_);
    messages[from].sent += message.share, messages[to].received += message.share;
    bytes[from].sent += message.bytes, bytes[to].received += message.bytes;
  }
  load.messages.resize(parts), load.bytes.resize(parts);
  for (std::size_t p = 0; p < parts; ++p) {
    load.messages[p] += times * std::max(messages[p].sent, messages[p].received);
    load.bytes[p] += times * weight * std::max(bytes[p].sent, bytes[p].received);
  }
}

}  // namespace tenon
