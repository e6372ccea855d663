// SPDX-License-Identifier: BSD-3-Clause
#include "framework/comm/sparse_exchange.hpp"

#include <algorithm>
#include <numeric>
#include <thread>

#include "framework/comm/communicator_impl.hpp"

namespace tenon {

namespace {

struct Letter {
  int from;
  std::vector<LocalIndex> content;
};

// Takes one waiting letter in, if there is any.
bool receive_one(MPI_Comm mpi, int tag, std::vector<Letter>& letters) {
  int waiting = 0;
  MPI_Status status;
  MPI_Iprobe(MPI_ANY_SOURCE, tag, mpi, &waiting, &status);
  if (!waiting) return false;
  int count = 0;
  MPI_Get_count(&status, MPI_INT32_T, &count);
  Letter& letter =
      letters.emplace_back(Letter{status.MPI_SOURCE, std::vector<LocalIndex>(static_cast<std::size_t>(count))});
  MPI_Recv(letter.content.data(), count, MPI_INT32_T, letter.from, tag, mpi, MPI_STATUS_IGNORE);
  return true;
}

// A synchronous send is complete when its letter has been received. A rank joins the barrier when all of its letters
// have been; so the barrier ends when none is under way any more.
std::vector<Letter> exchange_letters(Communicator::Impl& impl, const RankLists& outgoing, int tag) {
  std::vector<Letter> letters;
  std::vector<MPI_Request> sends;
  for (std::size_t k = 0; k < outgoing.ranks.size(); ++k) {
    if (outgoing.ranks[k] == impl.rank) continue;
    const std::span<const LocalIndex> list = outgoing.list(k);
    MPI_Issend(list.data(), static_cast<int>(list.size()), MPI_INT32_T, outgoing.ranks[k], tag, impl.mpi,
               &sends.emplace_back());
  }
  MPI_Request barrier = MPI_REQUEST_NULL;
  bool in_barrier = false;
  int done = 0;
  while (!done) {
    if (!receive_one(impl.mpi, tag, letters)) std::this_thread::yield();
    if (in_barrier) {
      MPI_Test(&barrier, &done, MPI_STATUS_IGNORE);
      continue;
    }
    int sent = 0;
    MPI_Testall(static_cast<int>(sends.size()), sends.data(), &sent, MPI_STATUSES_IGNORE);
    if (!sent) continue;
    MPI_Ibarrier(impl.mpi, &barrier);
    in_barrier = true;
  }
  return letters;
}

}  // namespace

RankLists exchange_sparse(const Communicator& comm, const RankLists& outgoing) {
  ExchangeCount& count = comm.count("set-up of exchanges");
  ++count.calls;
  if (comm.size() == 1) return outgoing;
  // A tag of its own: another rank may already be in the next exchange.
  Communicator::Impl& impl = comm.impl();
  std::vector<Letter> letters = exchange_letters(impl, outgoing, impl.next_tag());
  for (std::size_t k = 0; k < outgoing.ranks.size(); ++k) {
    const std::span<const LocalIndex> list = outgoing.list(k);
    if (outgoing.ranks[k] == comm.rank()) {
      letters.push_back({comm.rank(), {list.begin(), list.end()}});
      continue;
    }
    ++count.messages;
    count.bytes += static_cast<std::int64_t>(list.size_bytes());
  }
  std::sort(letters.begin(), letters.end(), [](const Letter& a, const Letter& b) { return a.from < b.from; });
  RankLists arrived;
  for (const Letter& letter : letters) {
    arrived.ranks.push_back(letter.from);
    arrived.values.insert(arrived.values.end(), letter.content.begin(), letter.content.end());
    arrived.begin.push_back(arrived.values.size());
  }
  return arrived;
}

}  // namespace tenon
