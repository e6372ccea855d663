// SPDX-License-Identifier: BSD-3-Clause
#include "framework/comm/directory.hpp"

#include <algorithm>
#include <numeric>

#include "framework/comm/exchange_plan.hpp"

namespace tenon {

namespace {

// Ids are dense, so equal ranges of values are equal shares, and neighbouring ids share a home.
std::vector<int> homes(std::span<const GlobalId> ids, GlobalId share, int ranks) {
  std::vector<int> home(ids.size(), -1);
  for (std::size_t i = 0; i < ids.size(); ++i)
    if (ids[i] >= 0 && ids[i] / share < ranks) home[i] = static_cast<int>(ids[i] / share);
  return home;
}

}  // namespace

Directory::Directory(const Communicator& comm, std::span<const GlobalId> ids, std::span<const LocalIndex> index)
    : comm_(comm) {
  GlobalId greatest = 0;
  for (const GlobalId id : ids) greatest = std::max(greatest, id);
  share_ = comm_.max(greatest) / comm_.size() + 1;

  const ExchangePlan plan = ExchangePlan::to_ranks(comm_, homes(ids, share_, comm_.size()), "directory");
  const auto arrived = static_cast<std::size_t>(plan.received());
  std::vector<GlobalId> arrived_ids(arrived);
  std::vector<LocalIndex> arrived_index(arrived);
  const ExchangeItem items[] = {{reinterpret_cast<const std::byte*>(ids.data()),
                                 reinterpret_cast<std::byte*>(arrived_ids.data()), sizeof(GlobalId)},
                                {reinterpret_cast<const std::byte*>(index.data()),
                                 reinterpret_cast<std::byte*>(arrived_index.data()), sizeof(LocalIndex)}};
  plan.forward(items);
  const std::vector<int> from = plan.received_from();

  // Arrivals come in rank order, so the first of equal ids is that of the lowest rank.
  std::vector<std::size_t> order(arrived);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return arrived_ids[a] < arrived_ids[b]; });
  for (const std::size_t i : order) {
    if (!ids_.empty() && ids_.back() == arrived_ids[i]) continue;
    ids_.push_back(arrived_ids[i]);
    entries_.push_back({from[i], arrived_index[i]});
  }
}

std::vector<DirectoryEntry> Directory::find(std::span<const GlobalId> ids) const {
  const ExchangePlan plan = ExchangePlan::to_ranks(comm_, homes(ids, share_, comm_.size()), "directory");
  std::vector<GlobalId> asked(static_cast<std::size_t>(plan.received()));
  plan.forward(ids, std::span(asked));
  std::vector<DirectoryEntry> answers(asked.size());
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const auto found = std::lower_bound(ids_.begin(), ids_.end(), asked[i]);
    if (found != ids_.end() && *found == asked[i])
      answers[i] = entries_[static_cast<std::size_t>(found - ids_.begin())];
  }
  std::vector<DirectoryEntry> entries(ids.size());
  plan.reverse(std::span<const DirectoryEntry>(answers), std::span(entries));
  return entries;
}

}  // namespace tenon
