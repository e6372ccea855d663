// SPDX-License-Identifier: BSD-3-Clause
#include "framework/comm/communicator.hpp"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <limits>
#include <new>
#include <numeric>

#include "framework/comm/communicator_impl.hpp"
#include "framework/comm/mpi_access.hpp"

namespace tenon {

namespace {

// An exception that nobody catches must end the other ranks too: they may wait for this one for ever.
[[noreturn]] void abort_all_ranks() {
  const char* what = "terminated";
  try {
    if (const std::exception_ptr current = std::current_exception()) std::rethrow_exception(current);
  } catch (const std::exception& e) {
    what = e.what();
  } catch (...) {
    what = "unknown exception";
  }
  std::fprintf(stderr, "error: %s (uncaught; all ranks are stopped)\n", what);
  int initialised = 0, finalised = 0;
  MPI_Initialized(&initialised);
  MPI_Finalized(&finalised);
  if (initialised && !finalised) MPI_Abort(MPI_COMM_WORLD, EXIT_FAILURE);
  std::abort();
}

// Order-preserving map of doubles to integers, by which ranks reduce: MPI_MAX of doubles would leave NaN and the
// sign of zero to the order of the ranks. NaN wins in both directions, -0 is less than +0.
std::int64_t key_of_bits(std::int64_t bits) {
  return bits ^ ((bits >> 63) & std::numeric_limits<std::int64_t>::max());
}
std::int64_t key(double value, std::int64_t key_of_nan) {
  return value != value ? key_of_nan : key_of_bits(std::bit_cast<std::int64_t>(value));
}
double value_of_key(std::int64_t key) {
  return std::bit_cast<double>(key_of_bits(key));
}

void reduce(const Communicator::Impl& impl, std::span<std::int64_t> values, MPI_Op op) {
  const std::size_t step = impl.largest_message / sizeof(std::int64_t);
  for (std::size_t first = 0; first < values.size(); first += step)
    MPI_Allreduce(MPI_IN_PLACE, values.data() + first, static_cast<int>(std::min(step, values.size() - first)),
                  MPI_INT64_T, op, impl.mpi);
}

void reduce_doubles(Communicator::Impl& impl, std::span<double> values, MPI_Op op) {
  if (impl.size == 1) return;
  const std::int64_t key_of_nan =
      op == MPI_MAX ? std::numeric_limits<std::int64_t>::max() : std::numeric_limits<std::int64_t>::min();
  impl.scratch.resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) impl.scratch[i] = key(values[i], key_of_nan);
  reduce(impl, impl.scratch, op);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = value_of_key(impl.scratch[i]);
}

std::int64_t reduce_one(const Communicator::Impl& impl, std::int64_t value, MPI_Op op) {
  if (impl.size > 1) reduce(impl, std::span(&value, 1), op);
  return value;
}

std::optional<Error> caught(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& e) {
    return e;
  } catch (const std::bad_alloc&) {
    return Error(ExitCode::file, "out of memory: use more ranks or a smaller mesh");
  } catch (const std::exception& e) {
    return Error(ExitCode::file, e.what());
  } catch (...) {
    return Error(ExitCode::file, "unknown exception");
  }
  return std::nullopt;
}

MPI_Comm duplicate_of(MPI_Comm mpi) {
  int initialised = 0;
  MPI_Initialized(&initialised);
  if (!initialised) throw Error(ExitCode::usage, "a communicator needs MPI: make an MpiEnvironment first, in main");
  MPI_Comm copy = MPI_COMM_NULL;
  MPI_Comm_dup(mpi, &copy);
  return copy;
}

}  // namespace

MpiEnvironment::MpiEnvironment(int& argc, char**& argv) {
  // PT-Scotch (under Zoltan's graph partitions) would send messages from threads of its own, which this level of thread
  // support does not allow: rare crashes.
  setenv("SCOTCH_PTHREAD_NUMBER", "1", 0);
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  std::set_terminate(abort_all_ranks);
}

MpiEnvironment::~MpiEnvironment() {
  // An exception on its way out of main may be on this rank alone; MPI_Finalize would wait for the others.
  if (std::uncaught_exceptions() > 0) MPI_Abort(MPI_COMM_WORLD, EXIT_FAILURE);
  MPI_Finalize();
}

std::string MpiEnvironment::library_version() {
  char text[MPI_MAX_LIBRARY_VERSION_STRING];
  int length = 0;
  MPI_Get_library_version(text, &length);
  const std::string version(text, static_cast<std::size_t>(length));
  return version.substr(0, version.find_first_of(",\n"));
}

Communicator::Impl::Impl(MPI_Comm taken, std::shared_ptr<std::deque<ExchangeCount>> shared_counts)
    : mpi(taken), counts(std::move(shared_counts)) {
  MPI_Comm_rank(mpi, &rank);
  MPI_Comm_size(mpi, &size);
  int* limit = nullptr;
  int found = 0;
  MPI_Comm_get_attr(mpi, MPI_TAG_UB, &limit, &found);
  if (found) tag_limit = *limit;
}

Communicator::Impl::~Impl() {
  int finalised = 0;
  MPI_Finalized(&finalised);
  if (!finalised) MPI_Comm_free(&mpi);
}

int Communicator::Impl::next_tag() {
  last_tag = last_tag == tag_limit ? 1 : last_tag + 1;
  return last_tag;
}

MPI_Comm mpi_communicator(const Communicator& comm) {
  return comm.impl().mpi;
}

struct CommunicatorAccess {
  static Communicator on(MPI_Comm mpi) {
    return Communicator(
        std::make_shared<Communicator::Impl>(duplicate_of(mpi), std::make_shared<std::deque<ExchangeCount>>()));
  }
};

Communicator communicator_on(MPI_Comm mpi) {
  return CommunicatorAccess::on(mpi);
}

Communicator Communicator::world() {
  return communicator_on(MPI_COMM_WORLD);
}

Communicator Communicator::self() {
  return communicator_on(MPI_COMM_SELF);
}

Communicator Communicator::duplicate() const {
  return Communicator(std::make_shared<Impl>(duplicate_of(impl_->mpi), impl_->counts));
}

int Communicator::rank() const {
  return impl_->rank;
}
int Communicator::size() const {
  return impl_->size;
}

void Communicator::barrier() const {
  if (size() > 1) MPI_Barrier(impl_->mpi);
}

int Communicator::max(int value) const {
  return static_cast<int>(reduce_one(*impl_, value, MPI_MAX));
}
std::int64_t Communicator::max(std::int64_t value) const {
  return reduce_one(*impl_, value, MPI_MAX);
}
double Communicator::max(double value) const {
  reduce_doubles(*impl_, std::span(&value, 1), MPI_MAX);
  return value;
}
std::int64_t Communicator::min(std::int64_t value) const {
  return reduce_one(*impl_, value, MPI_MIN);
}
double Communicator::min(double value) const {
  reduce_doubles(*impl_, std::span(&value, 1), MPI_MIN);
  return value;
}
std::int64_t Communicator::sum(std::int64_t value) const {
  return reduce_one(*impl_, value, MPI_SUM);
}
bool Communicator::any(bool value) const {
  return reduce_one(*impl_, value ? 1 : 0, MPI_MAX) != 0;
}

void Communicator::max(std::span<double> values) const {
  reduce_doubles(*impl_, values, MPI_MAX);
}
void Communicator::min(std::span<double> values) const {
  reduce_doubles(*impl_, values, MPI_MIN);
}
void Communicator::max(std::span<std::int64_t> values) const {
  if (size() > 1) reduce(*impl_, values, MPI_MAX);
}
void Communicator::sum(std::span<std::int64_t> values) const {
  if (size() > 1) reduce(*impl_, values, MPI_SUM);
}

std::int64_t Communicator::exclusive_scan(std::int64_t value) const {
  std::int64_t before = 0;
  if (size() > 1) MPI_Exscan(&value, &before, 1, MPI_INT64_T, MPI_SUM, impl_->mpi);
  return rank() == 0 ? 0 : before;
}

double Communicator::sum(const ExactSum& local) const {
  double result = 0;
  sum(std::span(&local, 1), std::span(&result, 1));
  return result;
}

void Communicator::sum(std::span<const ExactSum> local, std::span<double> result) const {
  if (size() == 1) {
    std::transform(local.begin(), local.end(), result.begin(), [](const ExactSum& s) { return s.value(); });
    return;
  }
  constexpr std::size_t length = ExactSum::digits + 1;
  std::vector<std::int64_t>& all = impl_->scratch;
  all.resize(local.size() * length);
  for (std::size_t i = 0; i < local.size(); ++i) {
    const auto words = local[i].words();
    std::copy(words.begin(), words.end(), all.begin() + static_cast<std::ptrdiff_t>(i * length));
  }
  reduce(*impl_, all, MPI_SUM);
  for (std::size_t i = 0; i < local.size(); ++i)
    result[i] = ExactSum::from_words(std::span<const std::int64_t>(all).subspan(i * length, length)).value();
}

void Communicator::all_gather_bytes(const void* value, void* all, std::size_t bytes) const {
  if (size() == 1) {
    std::memcpy(all, value, bytes);
    return;
  }
  const int count = static_cast<int>(bytes);
  MPI_Allgather(value, count, MPI_BYTE, all, count, MPI_BYTE, impl_->mpi);
}

std::vector<std::byte> Communicator::gather_bytes(std::span<const std::byte> bytes) const {
  if (size() == 1) return {bytes.begin(), bytes.end()};
  const std::vector<std::int64_t> lengths = all_gather(static_cast<std::int64_t>(bytes.size()));
  const std::int64_t total = std::accumulate(lengths.begin(), lengths.end(), std::int64_t{0});
  std::vector<std::byte> all(rank() == 0 ? static_cast<std::size_t>(total) : 0);
  const std::size_t largest = impl_->largest_message;
  if (static_cast<std::size_t>(total) <= largest) {
    const std::vector<int> counts(lengths.begin(), lengths.end());
    std::vector<int> offsets(counts.size(), 0);
    std::exclusive_scan(counts.begin(), counts.end(), offsets.begin(), 0);
    MPI_Gatherv(bytes.data(), counts[static_cast<std::size_t>(rank())], MPI_BYTE, all.data(), counts.data(),
                offsets.data(), MPI_BYTE, 0, impl_->mpi);
    return all;
  }
  const int tag = impl_->next_tag();
  std::size_t to = 0;
  for (int from = 0; from < size(); ++from) {
    const std::size_t length = static_cast<std::size_t>(lengths[static_cast<std::size_t>(from)]);
    for (std::size_t first = 0; first < length; first += largest) {
      const std::size_t count = std::min(largest, length - first);
      if (rank() == from && from == 0)
        std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(first), count,
                    all.begin() + static_cast<std::ptrdiff_t>(first));
      else if (rank() == from)
        MPI_Send(bytes.data() + first, static_cast<int>(count), MPI_BYTE, 0, tag, impl_->mpi);
      else if (rank() == 0)
        MPI_Recv(all.data() + to + first, static_cast<int>(count), MPI_BYTE, from, tag, impl_->mpi, MPI_STATUS_IGNORE);
    }
    to += length;
  }
  return all;
}

void Communicator::broadcast_bytes(void* data, std::size_t bytes, int root) const {
  if (size() == 1) return;
  for (std::size_t first = 0; first < bytes; first += impl_->largest_message)
    MPI_Bcast(static_cast<std::byte*>(data) + first, static_cast<int>(std::min(impl_->largest_message, bytes - first)),
              MPI_BYTE, root, impl_->mpi);
}

void Communicator::broadcast(std::string& text, int root) const {
  std::int64_t count = static_cast<std::int64_t>(text.size());
  broadcast_bytes(&count, sizeof count, root);
  text.resize(static_cast<std::size_t>(count));
  broadcast_bytes(text.data(), text.size(), root);
}

void Communicator::copy_bytes(void* to, const std::vector<std::byte>& from) {
  if (!from.empty()) std::memcpy(to, from.data(), from.size());
}

void Communicator::throw_if_any(const std::optional<Error>& mine) const {
  const std::int64_t failed = min(std::int64_t{mine ? rank() : size()});
  if (failed == size()) return;
  const int root = static_cast<int>(failed);
  int code = mine ? static_cast<int>(mine->code()) : 0;
  std::string message = mine ? mine->what() : "";
  broadcast_bytes(&code, sizeof code, root);
  broadcast(message, root);
  throw Error(static_cast<ExitCode>(code), message);
}

void Communicator::vote(const std::function<void()>& work) const {
  throw_if_any(caught(work));
}

void Communicator::vote_on_root(const std::function<void()>& work) const {
  throw_if_any(rank() == 0 ? caught(work) : std::nullopt);
}

ExchangeCount& Communicator::count(const std::string& exchange) const {
  std::deque<ExchangeCount>& counts = *impl_->counts;
  const auto found =
      std::find_if(counts.begin(), counts.end(), [&](const ExchangeCount& c) { return c.name == exchange; });
  return found != counts.end() ? *found : counts.emplace_back(ExchangeCount{exchange});
}

std::vector<ExchangeCount> Communicator::counts() const {
  return {impl_->counts->begin(), impl_->counts->end()};
}

}  // namespace tenon
