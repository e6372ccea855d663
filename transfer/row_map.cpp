// SPDX-License-Identifier: BSD-3-Clause
#include "transfer/row_map.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <numeric>

#include "transfer/slot_table.hpp"

namespace tenon::transfer {

namespace {

/// A term of a row that travels from the row's owner to a ghost of the target item.
struct TravellingTerm {
  GlobalId row;
  Term term;
};

LocalIndex find_id(std::span<const GlobalId> ids, GlobalId id) {
  return static_cast<LocalIndex>(std::lower_bound(ids.begin(), ids.end(), id) - ids.begin());
}

/// Asks the owners of all ghosts for their rows. Terms of a row arrive together and in order.
std::vector<TravellingTerm> ghost_terms(const Communicator& comm, const Items& items, const Rows& owned,
                                        std::span<const LocalIndex> row_of_item, const std::string& name) {
  std::vector<int> destination;
  std::vector<GlobalId> ids;
  for (std::size_t i = 0; i < items.ids.size(); ++i) {
    if (items.owners[i] == comm.rank()) continue;
    destination.push_back(items.owners[i]);
    ids.push_back(items.ids[i]);
  }
  const ExchangePlan request = ExchangePlan::to_ranks(comm, destination, name);
  std::vector<GlobalId> asked(static_cast<std::size_t>(request.received()));
  request.forward(std::span<const GlobalId>(ids), std::span<GlobalId>(asked));
  const std::vector<int> asking = request.received_from();

  std::vector<TravellingTerm> sent;
  std::vector<int> to;
  for (std::size_t k = 0; k < asked.size(); ++k) {
    const LocalIndex item = find_id(items.ids, asked[k]);
    for (const Term& term : owned.row(static_cast<std::size_t>(row_of_item[static_cast<std::size_t>(item)]))) {
      sent.push_back({asked[k], term});
      to.push_back(asking[k]);
    }
  }
  const ExchangePlan answer = ExchangePlan::to_ranks(comm, to, name);
  std::vector<TravellingTerm> arrived(static_cast<std::size_t>(answer.received()));
  answer.forward(std::span<const TravellingTerm>(sent), std::span<TravellingTerm>(arrived));
  return arrived;
}

}  // namespace

void sort_by_source(std::span<Term> terms) {
  std::sort(terms.begin(), terms.end(), [](const Term& a, const Term& b) { return a.source < b.source; });
}

Rows share_rows(const Communicator& comm, const Items& items, Rows&& owned, const std::string& name) {
  if (comm.size() == 1) return std::move(owned);
  std::vector<LocalIndex> row_of_item(items.ids.size(), no_index);
  for (std::size_t k = 0; k < items.owned.size(); ++k)
    row_of_item[static_cast<std::size_t>(items.owned[k])] = static_cast<LocalIndex>(k);
  const std::vector<TravellingTerm> ghosts = ghost_terms(comm, items, owned, row_of_item, name);

  Rows all;
  all.begin.assign(items.ids.size() + 1, 0);
  for (std::size_t k = 0; k < items.owned.size(); ++k)
    all.begin[static_cast<std::size_t>(items.owned[k]) + 1] = owned.begin[k + 1] - owned.begin[k];
  for (const TravellingTerm& ghost : ghosts) ++all.begin[static_cast<std::size_t>(find_id(items.ids, ghost.row)) + 1];
  std::partial_sum(all.begin.begin(), all.begin.end(), all.begin.begin());
  all.terms.resize(static_cast<std::size_t>(all.begin.back()));
  for (std::size_t k = 0; k < items.owned.size(); ++k) {
    const auto row = owned.row(k);
    std::copy(row.begin(), row.end(), all.terms.begin() + all.begin[static_cast<std::size_t>(items.owned[k])]);
  }
  std::vector<std::int64_t> next(all.begin.begin(), all.begin.end() - 1);
  for (const TravellingTerm& ghost : ghosts)
    all.terms[static_cast<std::size_t>(next[static_cast<std::size_t>(find_id(items.ids, ghost.row))]++)] = ghost.term;
  return all;
}

void RowMap::take_gather(const Communicator& comm, const SlotTable& wanted, const std::string& name) {
  slots_ = wanted.owners().size();
  std::vector<LocalIndex> into(slots_);
  std::iota(into.begin(), into.end(), LocalIndex{0});
  gather_ = ExchangePlan::from_owners(comm, wanted.owners(), wanted.indices(), into, name);
}

RowMap::RowMap(const Communicator& comm, const Rows& rows, const std::string& name, double empty_value)
    : begin_(rows.begin), empty_value_(empty_value) {
  SlotTable wanted;
  for (const Term& term : rows.terms) wanted.mark(term.owner, term.at_owner);
  wanted.number();
  slot_.reserve(rows.terms.size());
  weight_.reserve(rows.terms.size());
  for (const Term& term : rows.terms) {
    slot_.push_back(wanted.slot(term.owner, term.at_owner));
    weight_.push_back(term.weight);
  }
  take_gather(comm, wanted, name);
}

RowMap::RowMap(const Communicator& comm, PointRows&& rows, double empty_value, const SlotTable& wanted,
               const std::string& name)
    : width_(rows.width()), points_(std::move(rows)), empty_value_(empty_value) {
  take_gather(comm, wanted, name);
}

RowMap::RowMap(PointRows&& rows, double empty_value, std::size_t slots)
    : slots_(slots), direct_(true), width_(rows.width()), points_(std::move(rows)), empty_value_(empty_value) {}

void RowMap::gather(std::span<const ExchangeItem> values) const {
  if (!direct_) return gather_.forward(values);
  for (const ExchangeItem& item : values) std::memcpy(item.to, item.from, item.bytes * slots_);
}

// Four sums side by side, for the latency of the additions.
template <int components>
void RowMap::multiply_fixed(const double* gathered, double* target) const {
  const LocalIndex* const slot = slot_.data();
  const double* const weight = weight_.data();
  for (std::size_t i = 0; i < rows(); ++i, target += components) {
    std::array<std::array<double, components>, 4> sum{};
    const auto add = [&](std::size_t part, std::int64_t k) {
      const double* const value = gathered + static_cast<std::size_t>(slot[k]) * components;
      for (std::size_t c = 0; c < components; ++c) sum[part][c] += weight[k] * value[c];
    };
    std::int64_t k = begin_[i];
    const std::int64_t end = begin_[i + 1];
    for (; k + 4 <= end; k += 4)
      for (std::size_t part = 0; part < 4; ++part) add(part, k + static_cast<std::int64_t>(part));
    for (std::size_t part = 0; k < end; ++k, ++part) add(part, k);
    for (std::size_t c = 0; c < components; ++c) target[c] = (sum[0][c] + sum[1][c]) + (sum[2][c] + sum[3][c]);
    if (begin_[i] == begin_[i + 1]) std::fill_n(target, components, empty_value_);
  }
}

// Two sums side by side, for the latency of the additions.
template <int components, int width>
void RowMap::interpolate_fixed(const double* gathered, double* target) const {
  const LocalIndex* slot = points_.slot_.data();
  const double* weight = points_.weight_.data();
  const std::size_t count = rows();
  for (std::size_t i = 0; i < count; ++i, target += components, slot += width, weight += width - 1) {
    if (slot[0] == no_index) {
      std::fill_n(target, components, empty_value_);
      continue;
    }
    const double* const base = gathered + static_cast<std::size_t>(slot[0]) * components;
    std::array<double, components> odd{}, even{};
    for (std::size_t k = 1; k < width; k += 2) {
      const double* const value = gathered + static_cast<std::size_t>(slot[k]) * components;
      for (std::size_t c = 0; c < components; ++c) odd[c] += weight[k - 1] * (value[c] - base[c]);
      if (k + 1 >= width) break;
      const double* const next = gathered + static_cast<std::size_t>(slot[k + 1]) * components;
      for (std::size_t c = 0; c < components; ++c) even[c] += weight[k] * (next[c] - base[c]);
    }
    for (std::size_t c = 0; c < components; ++c) target[c] = base[c] + (odd[c] + even[c]);
  }
}

// The same sums for any number of components and terms.
void RowMap::multiply_any(const double* gathered, double* target, std::size_t components) const {
  for (std::size_t i = 0; i < rows(); ++i)
    for (std::size_t c = 0; c < components; ++c) {
      const auto value = [&](LocalIndex slot) { return gathered[static_cast<std::size_t>(slot) * components + c]; };
      double& to = target[i * components + c];
      if (width_ == 0) {
        std::array<double, 4> part{};
        const auto begin = static_cast<std::size_t>(begin_[i]);
        for (std::size_t k = begin; k < static_cast<std::size_t>(begin_[i + 1]); ++k)
          part[(k - begin) % 4] += weight_[k] * value(slot_[k]);
        to = (part[0] + part[1]) + (part[2] + part[3]);
        if (begin_[i] == begin_[i + 1]) to = empty_value_;
        continue;
      }
      const LocalIndex* const slots = points_.slot_.data() + i * width_;
      const double* const weights = points_.weight_.data() + i * (width_ - 1);
      if (slots[0] == no_index) {
        to = empty_value_;
        continue;
      }
      const double base = value(slots[0]);
      std::array<double, 2> sum{};
      for (std::size_t k = 1; k < width_; ++k) sum[(k + 1) % 2] += weights[k - 1] * (value(slots[k]) - base);
      to = base + (sum[0] + sum[1]);
    }
}

void RowMap::multiply(std::span<const double> gathered, std::span<double> target, int components) const {
  assert(target.size() == rows() * static_cast<std::size_t>(components));
  const double* const from = gathered.data();
  const auto run = [&]<int n>() {
    switch (width_) {
      case 0:
        return multiply_fixed<n>(from, target.data());
      case 4:
        return interpolate_fixed<n, 4>(from, target.data());
      case 8:
        return interpolate_fixed<n, 8>(from, target.data());
      default:
        return multiply_any(from, target.data(), n);
    }
  };
  switch (components) {
    case 1:
      return run.operator()<1>();
    case 2:
      return run.operator()<2>();
    case 3:
      return run.operator()<3>();
    case 6:
      return run.operator()<6>();
    default:
      return multiply_any(from, target.data(), static_cast<std::size_t>(components));
  }
}

std::int64_t RowMap::memory() const {
  return static_cast<std::int64_t>(begin_.capacity() * sizeof(std::int64_t) + slot_.capacity() * sizeof(LocalIndex) +
                                   weight_.capacity() * sizeof(double) + points_.slot_.capacity() * sizeof(LocalIndex) +
                                   points_.weight_.capacity() * sizeof(double));
}

}  // namespace tenon::transfer
