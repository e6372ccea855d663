// SPDX-License-Identifier: BSD-3-Clause
// What the phases of a step do on each of many ranks, counted in one process.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

namespace tenon {

/// One phase of a step on P ranks. Work is counted in units of its own; what one rank was measured to take for all of
/// it gives the cost of a unit.
struct PhaseLoad {
  std::string phase, group;             ///< "contact: search"; "contact"
  double seconds = 0;                   ///< s per step, measured on one rank
  double whole = 0;                     ///< work of that
  std::vector<double> work;             ///< of each rank, per step
  std::vector<double> messages, bytes;  ///< of each rank, per step: sent or received, whichever is more; empty: none
  double reductions = 0;                ///< over all ranks, per step
};

/// Messages between the ranks of one exchange, as they are counted item by item.
class Traffic {
 public:
  explicit Traffic(int parts) : parts_(parts) {}
  /// Of an item; what stays where it is costs nothing. Some messages go in a share of the exchanges only.
  void add(int from, int to, double bytes, double share = 1) {
    if (from == to) return;
    Message& message = messages_[static_cast<std::int64_t>(from) * parts_ + to];
    message.bytes += bytes, message.share = std::max(message.share, share);
  }
  /// Adds the messages and bytes of an exchange that happens so many times a step to those of a phase, with `weight`
  /// times the bytes.
  void book(PhaseLoad& load, double times, double weight = 1) const;

 private:
  int parts_;
  struct Message {
    double bytes = 0, share = 0;
  };
  std::unordered_map<std::int64_t, Message> messages_;
};

}  // namespace tenon
