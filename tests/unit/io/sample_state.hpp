// SPDX-License-Identifier: BSD-3-Clause
// A state that is a function of global ids alone, scattered over the ranks without any order.
#pragma once

#include <bit>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "framework/io/checkpoint.hpp"

namespace tenon::testing {

/// SplitMix64, so that every rank draws the same numbers.
inline std::uint64_t scramble(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// Ids of this rank, in no order; rank 1 of three or more has none.
inline std::vector<GlobalId> scattered_ids(const Communicator& comm, GlobalId count) {
  std::vector<GlobalId> ids;
  for (GlobalId i = 0; i < count; ++i) {
    const GlobalId id = count - 1 - i;
    auto owner = static_cast<int>(scramble(static_cast<std::uint64_t>(id)) % static_cast<std::uint64_t>(comm.size()));
    if (comm.size() >= 3 && owner == 1) owner = 2;
    if (owner == comm.rank()) ids.push_back(id);
  }
  return ids;
}

/// Any bit pattern may occur: NaN with payload, infinities, subnormals, -0.
inline double sample(GlobalId id, int component, int salt) {
  if (id % 97 == 5) return -0.0;
  if (id % 101 == 7) return std::bit_cast<double>(std::uint64_t{0x7ff8000000000123u});
  return std::bit_cast<double>(scramble(static_cast<std::uint64_t>((id * 16 + component) * 8 + salt)));
}

inline std::vector<double> samples(const std::vector<GlobalId>& ids, int components, int salt) {
  std::vector<double> values;
  for (const GlobalId id : ids)
    for (int c = 0; c < components; ++c) values.push_back(sample(id, c, salt));
  return values;
}

inline bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (std::bit_cast<std::uint64_t>(a[i]) != std::bit_cast<std::uint64_t>(b[i])) return false;
  return true;
}

inline constexpr GlobalId sample_nodes = 1237, sample_elements = 911;

/// Everything that a checkpoint can hold, sizes that no rank count divides.
inline void write_sample(const Communicator& comm, const std::string& path) {
  CheckpointWriter file(comm, path);
  file.scalar("time", 1.0 / 3.0);
  file.integer("step", (std::int64_t{1} << 53) + 1);
  file.text("scene", "end_time: 80 us\n\xc2\xb5\n");
  file.text("empty", "");
  const std::vector<GlobalId> nodes = scattered_ids(comm, sample_nodes),
                              elements = scattered_ids(comm, sample_elements);
  const GlobalOrder node_order(comm, nodes, sample_nodes), element_order(comm, elements, sample_elements);
  const GlobalOrder nothing(comm, {}, 0);
  file.array("mechanics/displacement", node_order, samples(nodes, 3, 1), 3);
  file.array("mechanics/stress", element_order, samples(elements, 6, 2), 6);
  file.array("thermal/temperature", node_order, samples(nodes, 1, 3), 1);
  file.array("thermal/nothing", nothing, {}, 2);
  file.finish();
}

/// A fresh folder of this name and rank count below the working folder of the tests.
inline std::string fresh_folder(const Communicator& comm, const std::string& name) {
  const std::string folder = name + "_np" + std::to_string(comm.size());
  comm.vote_on_root([&] {
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
  });
  return folder;
}

}  // namespace tenon::testing
