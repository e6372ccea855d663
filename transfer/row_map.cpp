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

RowMap::RowMap(const Communicator& comm, const Rows& rows, bool interpolating, double empty_value,
               const std::string& name)
    : begin_(rows.begin), interpolating_(interpolating), empty_value_(empty_value) {
  SlotTable wanted;
  for (const Term& term : rows.terms) wanted.mark(term.owner, term.at_owner);
  wanted.number();
  slots_ = wanted.owners().size();
  slot_.reserve(rows.terms.size());
  weight_.reserve(rows.terms.size());
  for (const Term& term : rows.terms) {
    slot_.push_back(wanted.slot(term.owner, term.at_owner));
    weight_.push_back(term.weight);
  }
  std::vector<LocalIndex> into(slots_);
  std::iota(into.begin(), into.end(), LocalIndex{0});
  gather_ = ExchangePlan::from_owners(comm, wanted.owners(), wanted.indices(), into, name);
}

template <int components>
void RowMap::multiply_fixed(const double* gathered, double* target) const {
  const LocalIndex* const slot = slot_.data();
  const double* const weight = weight_.data();
  for (std::size_t i = 0; i < rows(); ++i, target += components) {
    std::array<double, components> sum{};
    for (std::int64_t k = begin_[i]; k < begin_[i + 1]; ++k) {
      const double* const value = gathered + static_cast<std::size_t>(slot[k]) * components;
      for (std::size_t c = 0; c < components; ++c) sum[c] += weight[k] * value[c];
    }
    std::copy(sum.begin(), sum.end(), target);
  }
}

template <int components>
void RowMap::interpolate_fixed(const double* gathered, double* target) const {
  const LocalIndex* const slot = slot_.data();
  const double* const weight = weight_.data();
  for (std::size_t i = 0; i < rows(); ++i, target += components) {
    const std::int64_t first = begin_[i], last = begin_[i + 1];
    std::array<double, components> base, sum{};
    if (first == last) {
      std::fill_n(target, components, empty_value_);
      continue;
    }
    std::copy_n(gathered + static_cast<std::size_t>(slot[first]) * components, components, base.begin());
    for (std::int64_t k = first + 1; k < last; ++k) {
      const double* const value = gathered + static_cast<std::size_t>(slot[k]) * components;
      for (std::size_t c = 0; c < components; ++c) sum[c] += weight[k] * (value[c] - base[c]);
    }
    for (std::size_t c = 0; c < components; ++c) target[c] = base[c] + sum[c];
  }
}

void RowMap::multiply(std::span<const double> gathered, std::span<double> target, int components) const {
  assert(target.size() == rows() * static_cast<std::size_t>(components));
  const auto run = [&]<int n>() {
    interpolating_ ? interpolate_fixed<n>(gathered.data(), target.data())
                   : multiply_fixed<n>(gathered.data(), target.data());
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
    case 9:
      return run.operator()<9>();
    default:
      break;
  }
  const auto width = static_cast<std::size_t>(components);
  for (std::size_t i = 0; i < rows(); ++i)
    for (std::size_t c = 0; c < width; ++c) {
      const auto first = static_cast<std::size_t>(begin_[i]), last = static_cast<std::size_t>(begin_[i + 1]);
      const auto value = [&](std::size_t k) { return gathered[static_cast<std::size_t>(slot_[k]) * width + c]; };
      const double base = interpolating_ && first < last ? value(first) : 0.0;
      double sum = interpolating_ && first == last ? empty_value_ : 0.0;
      for (std::size_t k = interpolating_ ? first + 1 : first; k < last; ++k) sum += weight_[k] * (value(k) - base);
      target[i * width + c] = base + sum;
    }
}

std::int64_t RowMap::memory() const {
  return static_cast<std::int64_t>(begin_.capacity() * sizeof(std::int64_t) + slot_.capacity() * sizeof(LocalIndex) +
                                   weight_.capacity() * sizeof(double));
}

}  // namespace tenon::transfer
