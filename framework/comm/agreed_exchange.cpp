// SPDX-License-Identifier: BSD-3-Clause
#include "framework/comm/agreed_exchange.hpp"

#include <algorithm>
#include <vector>

#include "framework/comm/communicator_impl.hpp"
#include "framework/comm/item_copy.hpp"
#include "framework/comm/sparse_exchange.hpp"

namespace tenon {

struct AgreedExchange::Impl {
  Impl(const Communicator& comm_in, const std::string& name)
      : comm(comm_in), count(comm.count(name)), tag(comm.size() > 1 ? comm.impl().next_tag() : 0) {}

  Communicator comm;
  ExchangeCount& count;
  int tag;
  RankLists send, receive;
  std::vector<std::byte> out, in;
  std::vector<MPI_Request> requests;
};

namespace {

/// By rank, which are few, and for each in the order of the list.
void sort_by_rank(std::span<const AgreedExchange::Item> items, RankLists& lists) {
  lists.ranks.clear(), lists.begin.assign(1, 0), lists.values.clear();
  for (const AgreedExchange::Item& item : items) {
    const auto at = std::ranges::lower_bound(lists.ranks, item.rank);
    if (at == lists.ranks.end() || *at != item.rank) lists.ranks.insert(at, item.rank);
  }
  for (const int rank : lists.ranks) {
    for (const AgreedExchange::Item& item : items)
      if (item.rank == rank) lists.values.push_back(item.index);
    lists.begin.push_back(lists.values.size());
  }
}

}  // namespace

AgreedExchange::AgreedExchange(const Communicator& comm, const std::string& name)
    : impl_(std::make_unique<Impl>(comm, name)) {}
AgreedExchange::~AgreedExchange() = default;
AgreedExchange::AgreedExchange(AgreedExchange&&) noexcept = default;

void AgreedExchange::agree(std::span<const Item> send, std::span<const Item> receive) {
  sort_by_rank(send, impl_->send);
  sort_by_rank(receive, impl_->receive);
}

void AgreedExchange::run(std::byte* values, std::size_t bytes) const {
  Impl& my = *impl_;
  if (my.send.ranks.empty() && my.receive.ranks.empty()) return;
  ++my.count.calls;
  const Communicator::Impl& mpi = my.comm.impl();
  my.in.resize(std::max(my.in.size(), my.receive.values.size() * bytes));
  my.out.resize(std::max(my.out.size(), my.send.values.size() * bytes));
  for (std::size_t k = 0; k < my.receive.ranks.size(); ++k)
    MPI_Irecv(my.in.data() + my.receive.begin[k] * bytes, static_cast<int>(my.receive.list(k).size() * bytes), MPI_BYTE,
              my.receive.ranks[k], my.tag, mpi.mpi, &my.requests.emplace_back());
  for (std::size_t k = 0; k < my.send.ranks.size(); ++k) {
    std::byte* const place = my.out.data() + my.send.begin[k] * bytes;
    gather_items(values, my.send.list(k), place, bytes);
    const int length = static_cast<int>(my.send.list(k).size() * bytes);
    MPI_Isend(place, length, MPI_BYTE, my.send.ranks[k], my.tag, mpi.mpi, &my.requests.emplace_back());
    ++my.count.messages;
    my.count.bytes += length;
  }
  MPI_Waitall(static_cast<int>(my.requests.size()), my.requests.data(), MPI_STATUSES_IGNORE);
  my.requests.clear();
  for (std::size_t k = 0; k < my.receive.ranks.size(); ++k)
    scatter_items(my.in.data() + my.receive.begin[k] * bytes, my.receive.list(k), values, bytes);
}

}  // namespace tenon
