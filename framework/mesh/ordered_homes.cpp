// SPDX-License-Identifier: BSD-3-Clause
#include "framework/mesh/ordered_homes.hpp"

#include <array>
#include <utility>

#include "framework/comm/exchange_plan.hpp"
#include "framework/mesh/distinct.hpp"

namespace tenon {

namespace {

constexpr std::size_t samples = 32;
/// Quantiles of the keys of one rank.
struct Quantiles {
  std::int64_t count;
  std::array<std::int64_t, samples> keys;
};

/// Rows in lexicographic order; equal ones keep theirs.
std::vector<std::size_t> sorted_rows(const std::vector<std::int64_t>& rows, std::size_t width) {
  std::vector<std::int64_t> keys(rows.size() / width);
  for (std::size_t i = 0; i < keys.size(); ++i) keys[i] = rows[i * width];
  std::vector<std::size_t> order = sorted_positions(keys);
  const auto before = [&](std::size_t a, std::size_t b) {
    const std::int64_t *const x = rows.data() + a * width, *const y = rows.data() + b * width;
    return std::lexicographical_compare(x, x + width, y, y + width);
  };
  // Few rows share their first value.
  for (auto begin = order.begin(); width > 1 && begin != order.end();) {
    auto end = begin + 1;
    while (end != order.end() && keys[*end] == keys[*begin]) ++end;
    std::stable_sort(begin, end, before);
    begin = end;
  }
  return order;
}

}  // namespace

OrderedHomes::OrderedHomes(const Communicator& comm, std::span<const std::int64_t> keys) {
  if (comm.size() == 1) return;
  std::vector<std::int64_t> sorted(keys.begin(), keys.end());
  std::sort(sorted.begin(), sorted.end());
  Quantiles mine{static_cast<std::int64_t>(sorted.size()), {}};
  for (std::size_t i = 0; i < samples && !sorted.empty(); ++i) mine.keys[i] = sorted[i * sorted.size() / samples];

  std::vector<std::pair<std::int64_t, std::int64_t>> weighted;  // key, keys that it stands for times `samples`
  std::int64_t total = 0;
  for (const Quantiles& q : comm.all_gather(mine)) {
    for (std::size_t i = 0; i < samples && q.count > 0; ++i) weighted.emplace_back(q.keys[i], q.count);
    total += q.count * static_cast<std::int64_t>(samples);
  }
  std::sort(weighted.begin(), weighted.end());
  std::int64_t passed = 0;
  auto next = weighted.begin();
  for (int r = 1; r < comm.size(); ++r) {
    while (next != weighted.end() && passed < total / comm.size() * r) passed += (next++)->second;
    const bool any = !weighted.empty();
    splitters_.push_back(!any ? 0 : next == weighted.end() ? weighted.back().first : next->first);
  }
}

std::vector<int> OrderedHomes::homes(std::span<const std::int64_t> keys) const {
  std::vector<int> all;
  all.reserve(keys.size());
  for (const std::int64_t key : keys) all.push_back(home(key));
  return all;
}

RowNumbers number_rows(const Communicator& comm, std::span<const std::int64_t> rows, std::size_t width,
                       const std::string& name) {
  std::vector<std::int64_t> keys(rows.size() / width);
  for (std::size_t i = 0; i < keys.size(); ++i) keys[i] = rows[i * width];
  const ExchangePlan plan = ExchangePlan::to_ranks(comm, OrderedHomes(comm, keys).homes(keys), name);
  std::vector<std::int64_t> arrived(static_cast<std::size_t>(plan.received()) * width);
  plan.forward(rows, std::span(arrived), static_cast<int>(width));

  RowNumbers result;
  const std::vector<std::size_t> order = sorted_rows(arrived, width);
  const GlobalId first = comm.exclusive_scan(static_cast<std::int64_t>(order.size()));
  std::vector<GlobalId> answer(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    answer[order[i]] = first + static_cast<GlobalId>(i);
    const auto row = [&](std::size_t k) { return arrived.begin() + static_cast<std::ptrdiff_t>(order[k] * width); };
    if (i == 0 || !std::equal(row(i), row(i) + static_cast<std::ptrdiff_t>(width), row(i - 1))) continue;
    if (result.repeated++ == 0) result.first_repeated.assign(row(i), row(i) + static_cast<std::ptrdiff_t>(width));
  }
  // Homes ascend with the ranks, so the lowest rank that has one has the least.
  const bool any = result.repeated > 0;
  const std::int64_t root = comm.min(static_cast<std::int64_t>(any ? comm.rank() : comm.size()));
  if (root < comm.size()) comm.broadcast(result.first_repeated, static_cast<int>(root));
  result.repeated = comm.sum(result.repeated);
  result.count = comm.sum(static_cast<std::int64_t>(order.size()));
  result.numbers.resize(keys.size());
  plan.reverse(std::span<const GlobalId>(answer), std::span(result.numbers));
  return result;
}

}  // namespace tenon
