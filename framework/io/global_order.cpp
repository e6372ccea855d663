// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include "framework/io/checkpoint.hpp"

namespace tenon {

namespace {

/// Slab r holds rows [n r / p, n (r + 1) / p); this is its inverse.
int slab_of(GlobalId id, GlobalId n, int p) {
  return static_cast<int>(((id + 1) * p - 1) / n);
}

}  // namespace

GlobalOrder::GlobalOrder(const Communicator& comm, std::span<const GlobalId> ids, GlobalId global_count)
    : global_count_(global_count), given_(static_cast<LocalIndex>(ids.size())) {
  const int ranks = comm.size();
  slab_first_ = global_count * comm.rank() / ranks;
  slab_size_ = static_cast<LocalIndex>(global_count * (comm.rank() + 1) / ranks - slab_first_);

  std::vector<int> destination(ids.size());
  comm.vote([&] {
    for (std::size_t i = 0; i < ids.size(); ++i) {
      if (ids[i] < 0 || ids[i] >= global_count)
        throw Error(ExitCode::file, fmt::format("checkpoint: id {} is not in 0 .. {}", ids[i], global_count - 1));
      destination[i] = slab_of(ids[i], global_count, ranks);
    }
  });
  plan_ = ExchangePlan::to_ranks(comm, destination, "checkpoint");

  std::vector<GlobalId> arrived(static_cast<std::size_t>(plan_.received()));
  plan_.forward(ids, std::span(arrived));
  std::vector<char> seen(static_cast<std::size_t>(slab_size_), 0);
  bool once = plan_.received() == slab_size_;
  slab_row_.resize(arrived.size());
  for (std::size_t i = 0; i < arrived.size(); ++i) {
    slab_row_[i] = static_cast<LocalIndex>(arrived[i] - slab_first_);
    char& row = seen[static_cast<std::size_t>(slab_row_[i])];
    once = once && row == 0;
    row = 1;
  }
  each_once_ = !comm.any(!once);
}

void GlobalOrder::to_slab(std::span<const double> values, std::span<double> slab, int components) const {
  const auto n = static_cast<std::size_t>(components);
  std::vector<double> arrived(slab_row_.size() * n);
  plan_.forward(values, std::span(arrived), components);
  for (std::size_t i = 0; i < slab_row_.size(); ++i)
    std::copy_n(arrived.begin() + static_cast<std::ptrdiff_t>(i * n), n,
                slab.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(slab_row_[i]) * n));
}

void GlobalOrder::from_slab(std::span<const double> slab, std::span<double> values, int components) const {
  const auto n = static_cast<std::size_t>(components);
  std::vector<double> leaving(slab_row_.size() * n);
  for (std::size_t i = 0; i < slab_row_.size(); ++i)
    std::copy_n(slab.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(slab_row_[i]) * n), n,
                leaving.begin() + static_cast<std::ptrdiff_t>(i * n));
  plan_.reverse(std::span<const double>(leaving), values, components);
}

}  // namespace tenon
