// SPDX-License-Identifier: BSD-3-Clause
#include "framework/comm/exchange_plan.hpp"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <iterator>
#include <memory>
#include <numeric>
#include <optional>
#include <type_traits>

#include "framework/comm/communicator_impl.hpp"
#include "framework/comm/item_copy.hpp"
#include "framework/comm/sparse_exchange.hpp"

namespace tenon {

namespace {

// The distinct ranks of a list (few) with the places where each stands, in order: a counting sort.
RankLists by_rank(std::span<const int> rank_of_item) {
  RankLists lists;
  std::vector<std::size_t> count;
  std::size_t last = 0;
  const auto slot_of = [&](int rank) {
    if (last < lists.ranks.size() && lists.ranks[last] == rank) return last;
    last =
        static_cast<std::size_t>(std::lower_bound(lists.ranks.begin(), lists.ranks.end(), rank) - lists.ranks.begin());
    return last;
  };
  for (const int rank : rank_of_item) {
    if (rank < 0) continue;
    const std::size_t slot = slot_of(rank);
    if (slot == lists.ranks.size() || lists.ranks[slot] != rank) {
      lists.ranks.insert(lists.ranks.begin() + static_cast<std::ptrdiff_t>(slot), rank);
      count.insert(count.begin() + static_cast<std::ptrdiff_t>(slot), 0);
    }
    ++count[slot];
  }
  lists.begin.resize(count.size() + 1);
  std::inclusive_scan(count.begin(), count.end(), lists.begin.begin() + 1);
  lists.values.resize(lists.begin.back());
  std::vector<std::size_t> next(lists.begin.begin(), lists.begin.end() - 1);
  for (std::size_t i = 0; i < rank_of_item.size(); ++i)
    if (rank_of_item[i] >= 0) lists.values[next[slot_of(rank_of_item[i])]++] = static_cast<LocalIndex>(i);
  return lists;
}

// Replaces every place i by item[i].
void look_up(RankLists& lists, std::span<const LocalIndex> item) {
  for (LocalIndex& value : lists.values) value = item[static_cast<std::size_t>(value)];
}

// Where the values of each rank begin, in bytes, if item i has count[i] values.
std::vector<std::size_t> bytes_by_rank(const RankLists& lists, std::span<const LocalIndex> count, std::size_t bytes) {
  std::vector<std::size_t> begin{0};
  for (std::size_t k = 0; k < lists.ranks.size(); ++k) {
    std::size_t values = 0;
    for (std::size_t i = lists.begin[k]; i < lists.begin[k + 1]; ++i) values += static_cast<std::size_t>(count[i]);
    begin.push_back(begin.back() + values * bytes);
  }
  return begin;
}

bool have_common_item(std::vector<LocalIndex> a, std::vector<LocalIndex> b) {
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  std::vector<LocalIndex> common;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
  return !common.empty();
}

/// Bytes on their way; not set to anything before they are written.
class Staging {
 public:
  /// Room for that many, at least; what was there is lost.
  void reserve(std::size_t size) {
    if (size > size_) bytes_ = std::make_unique_for_overwrite<std::byte[]>(size), size_ = size;
  }
  std::byte* data() const { return bytes_.get(); }

 private:
  std::unique_ptr<std::byte[]> bytes_;
  std::size_t size_ = 0;
};

}  // namespace

struct ExchangePlan::Impl {
  enum class Way { forward, reverse };

  Impl(const Communicator& comm_in, const std::string& name)
      : comm(comm_in), count(comm.count(name)), tag(comm.size() > 1 ? comm.impl().next_tag() : 0) {}

  const RankLists& from(Way way) const { return way == Way::forward ? send : receive; }
  const RankLists& to(Way way) const { return way == Way::forward ? receive : send; }
  std::span<const LocalIndex> own(const RankLists& lists) const;

  void finish_building();
  void begin(std::span<const ExchangeItem> arrays_in, Way way);
  void end(Way way);
  void run(std::span<const ExchangeItem> arrays_in, Way way) {
    begin(arrays_in, way);
    end(way);
  }
  /// Moves `out[out_begin[k] .. out_begin[k+1])` to the k-th rank of `send`; likewise what arrives.
  void move_bytes(std::span<const std::byte> out_bytes, std::span<const std::size_t> out_begin,
                  std::span<std::byte> in_bytes, std::span<const std::size_t> in_begin);

  Communicator comm;
  ExchangeCount& count;
  int tag;
  RankLists send;     // items by rank that they go to
  RankLists receive;  // places by rank that their content comes from
  /// Whether some place that is written is also read, which matters if both are in one array; found when it first does.
  bool chained() {
    if (!chained_) chained_ = have_common_item(send.values, receive.values);
    return *chained_;
  }

 private:
  void post_send(const std::byte* data, std::size_t bytes, int rank);
  void post_receive(std::byte* data, std::size_t bytes, int rank);
  void pack(std::span<const LocalIndex> items, std::byte* to) const;
  void unpack(const std::byte* from, std::span<const LocalIndex> items) const;
  void copy_own(Way way) const;
  void wait();

  // State of a run; kept so that a run allocates nothing once all have grown.
  std::vector<ExchangeItem> arrays_;
  std::size_t bytes_per_item_ = 0;
  bool own_staged_ = false;
  std::optional<bool> chained_;
  Staging out_, in_, own_;
  std::vector<MPI_Request> requests_;
};

void ExchangePlan::Impl::finish_building() {
  chained_.reset();
  requests_.reserve(send.ranks.size() + receive.ranks.size());
}

std::span<const LocalIndex> ExchangePlan::Impl::own(const RankLists& lists) const {
  const auto found = std::lower_bound(lists.ranks.begin(), lists.ranks.end(), comm.rank());
  if (found == lists.ranks.end() || *found != comm.rank()) return {};
  return lists.list(static_cast<std::size_t>(found - lists.ranks.begin()));
}

void ExchangePlan::Impl::post_send(const std::byte* data, std::size_t bytes, int rank) {
  const Communicator::Impl& mpi = comm.impl();
  for (std::size_t first = 0; first < bytes; first += mpi.largest_message) {
    const int length = static_cast<int>(std::min(mpi.largest_message, bytes - first));
    MPI_Isend(data + first, length, MPI_BYTE, rank, tag, mpi.mpi, &requests_.emplace_back());
    ++count.messages;
    count.bytes += length;
  }
}

void ExchangePlan::Impl::post_receive(std::byte* data, std::size_t bytes, int rank) {
  const Communicator::Impl& mpi = comm.impl();
  for (std::size_t first = 0; first < bytes; first += mpi.largest_message) {
    const int length = static_cast<int>(std::min(mpi.largest_message, bytes - first));
    MPI_Irecv(data + first, length, MPI_BYTE, rank, tag, mpi.mpi, &requests_.emplace_back());
  }
}

void ExchangePlan::Impl::wait() {
  if (!requests_.empty()) MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
  requests_.clear();
}

void ExchangePlan::Impl::pack(std::span<const LocalIndex> items, std::byte* to) const {
  for (const ExchangeItem& array : arrays_) {
    gather_items(array.from, items, to, array.bytes);
    to += items.size() * array.bytes;
  }
}

void ExchangePlan::Impl::unpack(const std::byte* from, std::span<const LocalIndex> items) const {
  for (const ExchangeItem& array : arrays_) {
    scatter_items(from, items, array.to, array.bytes);
    from += items.size() * array.bytes;
  }
}

void ExchangePlan::Impl::copy_own(Way way) const {
  if (own_staged_) return unpack(own_.data(), own(to(way)));
  for (const ExchangeItem& array : arrays_) copy_items(array, own(from(way)), own(to(way)));
}

void ExchangePlan::Impl::begin(std::span<const ExchangeItem> arrays_in, Way way) {
  assert(requests_.empty());
  arrays_.assign(arrays_in.begin(), arrays_in.end());
  bytes_per_item_ = 0;
  bool in_place = false;
  for (const ExchangeItem& array : arrays_) {
    bytes_per_item_ += array.bytes;
    in_place = in_place || array.from == array.to;
  }
  ++count.calls;
  const RankLists &outgoing = from(way), &incoming = to(way);
  if (comm.size() > 1) {
    in_.reserve(incoming.values.size() * bytes_per_item_);
    out_.reserve(outgoing.values.size() * bytes_per_item_);
  }
  for (std::size_t k = 0; k < incoming.ranks.size(); ++k)
    if (incoming.ranks[k] != comm.rank())
      post_receive(in_.data() + incoming.begin[k] * bytes_per_item_, incoming.list(k).size() * bytes_per_item_,
                   incoming.ranks[k]);
  for (std::size_t k = 0; k < outgoing.ranks.size(); ++k) {
    if (outgoing.ranks[k] == comm.rank()) continue;
    std::byte* const place = out_.data() + outgoing.begin[k] * bytes_per_item_;
    pack(outgoing.list(k), place);
    post_send(place, outgoing.list(k).size() * bytes_per_item_, outgoing.ranks[k]);
  }
  own_staged_ = in_place && chained();
  if (own_staged_) {
    own_.reserve(own(outgoing).size() * bytes_per_item_);
    pack(own(outgoing), own_.data());
  }
  if (way == Way::forward) copy_own(way);
}

void ExchangePlan::Impl::end(Way way) {
  wait();
  const RankLists& incoming = to(way);
  for (std::size_t k = 0; k < incoming.ranks.size(); ++k) {
    if (incoming.ranks[k] != comm.rank())
      unpack(in_.data() + incoming.begin[k] * bytes_per_item_, incoming.list(k));
    else if (way == Way::reverse)  // in its turn among the ranks: the last to write an item wins
      copy_own(way);
  }
}

void ExchangePlan::Impl::move_bytes(std::span<const std::byte> out_bytes, std::span<const std::size_t> out_begin,
                                    std::span<std::byte> in_bytes, std::span<const std::size_t> in_begin) {
  ++count.calls;
  std::span<std::byte> own_place;
  for (std::size_t k = 0; k < receive.ranks.size(); ++k) {
    const std::span<std::byte> place = in_bytes.subspan(in_begin[k], in_begin[k + 1] - in_begin[k]);
    if (receive.ranks[k] == comm.rank())
      own_place = place;
    else
      post_receive(place.data(), place.size(), receive.ranks[k]);
  }
  for (std::size_t k = 0; k < send.ranks.size(); ++k) {
    const std::span<const std::byte> content = out_bytes.subspan(out_begin[k], out_begin[k + 1] - out_begin[k]);
    if (send.ranks[k] == comm.rank())
      std::copy(content.begin(), content.end(), own_place.begin());
    else
      post_send(content.data(), content.size(), send.ranks[k]);
  }
  wait();
}

ExchangePlan ExchangePlan::to_ranks(const Communicator& comm, std::span<const int> destination, std::string name) {
  auto impl = std::make_shared<Impl>(comm, name);
  impl->send = by_rank(destination);
  RankLists announced;
  announced.ranks = impl->send.ranks;
  for (std::size_t k = 0; k < announced.ranks.size(); ++k) {
    announced.values.push_back(static_cast<LocalIndex>(impl->send.list(k).size()));
    announced.begin.push_back(k + 1);
  }
  const RankLists arriving = exchange_sparse(comm, announced);
  impl->receive.ranks = arriving.ranks;
  for (const LocalIndex count : arriving.values)
    impl->receive.begin.push_back(impl->receive.begin.back() + static_cast<std::size_t>(count));
  impl->receive.values.resize(impl->receive.begin.back());
  std::iota(impl->receive.values.begin(), impl->receive.values.end(), LocalIndex{0});
  impl->finish_building();
  return ExchangePlan(std::move(impl));
}

ExchangePlan ExchangePlan::to_ranks(const Communicator& comm, std::span<const int> send_rank,
                                    std::span<const LocalIndex> send, std::string name) {
  ExchangePlan plan = to_ranks(comm, send_rank, std::move(name));
  look_up(plan.impl_->send, send);
  plan.impl_->finish_building();
  return plan;
}

ExchangePlan ExchangePlan::from_owners(const Communicator& comm, std::span<const int> owner,
                                       std::span<const LocalIndex> index, std::span<const LocalIndex> into,
                                       std::string name) {
  auto impl = std::make_shared<Impl>(comm, name);
  impl->receive = by_rank(owner);
  RankLists wanted = impl->receive;
  look_up(wanted, index);
  look_up(impl->receive, into);
  impl->send = exchange_sparse(comm, wanted);
  impl->finish_building();
  return ExchangePlan(std::move(impl));
}

LocalIndex ExchangePlan::received() const {
  return impl_ ? static_cast<LocalIndex>(impl_->receive.values.size()) : 0;
}

std::vector<int> ExchangePlan::received_from() const {
  std::vector<int> from;
  if (!impl_) return from;
  from.reserve(impl_->receive.values.size());
  for (std::size_t k = 0; k < impl_->receive.ranks.size(); ++k)
    from.insert(from.end(), impl_->receive.list(k).size(), impl_->receive.ranks[k]);
  return from;
}

int ExchangePlan::neighbours() const {
  if (!impl_) return 0;
  std::vector<int> all;
  std::set_union(impl_->send.ranks.begin(), impl_->send.ranks.end(), impl_->receive.ranks.begin(),
                 impl_->receive.ranks.end(), std::back_inserter(all));
  return static_cast<int>(all.size() -
                          static_cast<std::size_t>(std::count(all.begin(), all.end(), impl_->comm.rank())));
}

void ExchangePlan::forward(std::span<const ExchangeItem> arrays) const {
  if (impl_) impl_->run(arrays, Impl::Way::forward);
}

void ExchangePlan::reverse(std::span<const ExchangeItem> arrays) const {
  if (impl_) impl_->run(arrays, Impl::Way::reverse);
}

void ExchangePlan::begin_forward(std::span<const ExchangeItem> arrays) const {
  if (impl_) impl_->begin(arrays, Impl::Way::forward);
}

void ExchangePlan::end_forward() const {
  if (impl_) impl_->end(Impl::Way::forward);
}

std::vector<std::byte> ExchangePlan::forward_varying_bytes(std::span<const LocalIndex> counts,
                                                           std::span<const std::byte> values,
                                                           std::size_t bytes_per_value,
                                                           std::vector<LocalIndex>& received) const {
  received.clear();
  if (!impl_) return {};
  const RankLists &send = impl_->send, &receive = impl_->receive;
  std::vector<LocalIndex> sent_counts(send.values.size());
  for (std::size_t i = 0; i < sent_counts.size(); ++i)
    sent_counts[i] = counts[static_cast<std::size_t>(send.values[i])];
  received.resize(receive.values.size());
  const auto scaled = [](std::vector<std::size_t> begin) {
    for (std::size_t& b : begin) b *= sizeof(LocalIndex);
    return begin;
  };
  impl_->move_bytes(std::as_bytes(std::span(sent_counts)), scaled(send.begin),
                    std::as_writable_bytes(std::span(received)), scaled(receive.begin));

  std::vector<std::size_t> value_begin(counts.size() + 1, 0);
  for (std::size_t i = 0; i < counts.size(); ++i)
    value_begin[i + 1] = value_begin[i] + static_cast<std::size_t>(counts[i]) * bytes_per_value;
  std::vector<std::byte> out;
  for (const LocalIndex item : send.values) {
    const auto i = static_cast<std::size_t>(item);
    out.insert(out.end(), values.begin() + static_cast<std::ptrdiff_t>(value_begin[i]),
               values.begin() + static_cast<std::ptrdiff_t>(value_begin[i + 1]));
  }
  const std::vector<std::size_t> out_begin = bytes_by_rank(send, sent_counts, bytes_per_value);
  const std::vector<std::size_t> in_begin = bytes_by_rank(receive, received, bytes_per_value);
  std::vector<std::byte> in(in_begin.back());
  impl_->move_bytes(out, out_begin, in, in_begin);
  return in;
}

}  // namespace tenon
