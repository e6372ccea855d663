// SPDX-License-Identifier: BSD-3-Clause
// What contact keeps over a restart: memories of pairs, places of rigid surfaces, books.
#include <fmt/core.h>

#include <algorithm>

#include "components/contact/contact.hpp"

namespace tenon {

using namespace contact;

namespace {

// Five numbers of the key, force, slip, energy.
constexpr int row_length = 12;

/// Digits as doubles, which hold 32 bits and a sign exactly.
void save_sum(const Communicator& comm, CheckpointWriter& file, const std::string& name, const ExactSum& local) {
  std::array<std::int64_t, ExactSum::digits + 1> words = local.words();
  comm.sum(std::span<std::int64_t>(words));
  words = ExactSum::from_words(words).words();
  std::vector<GlobalId> ids;
  std::vector<double> values;
  for (std::size_t k = 0; k < words.size() && comm.rank() == 0; ++k)
    ids.push_back(static_cast<GlobalId>(k)), values.push_back(static_cast<double>(words[k]));
  file.array(name, GlobalOrder(comm, ids, static_cast<GlobalId>(words.size())), values, 1);
}

/// All of it on rank 0.
ExactSum load_sum(const Communicator& comm, const CheckpointReader& file, const std::string& name) {
  std::array<std::int64_t, ExactSum::digits + 1> words{};
  std::vector<GlobalId> ids;
  for (std::size_t k = 0; k < words.size() && comm.rank() == 0; ++k) ids.push_back(static_cast<GlobalId>(k));
  std::vector<double> values(ids.size());
  file.array(name, GlobalOrder(comm, ids, static_cast<GlobalId>(words.size())), values, 1);
  for (std::size_t k = 0; k < values.size(); ++k) words[k] = static_cast<std::int64_t>(values[k]);
  return ExactSum::from_words(words);
}

}  // namespace

void Contact::save(CheckpointWriter& file) {
  const auto key = [&](const std::string& what) { return name() + "." + what; };
  std::vector<std::array<double, row_length>> rows;
  for (const WorkingPair& pair : set_.pairs()) {
    if (!pair.primary || pair.memory.empty()) continue;
    std::array<double, row_length> row{static_cast<double>(pair.key.kind)};
    for (std::size_t k = 0; k < 4; ++k) row[1 + k] = static_cast<double>(pair.key.ids[k]);
    std::ranges::copy(pair.memory.force, row.begin() + 5);
    std::ranges::copy(pair.memory.slip, row.begin() + 8);
    row[11] = pair.memory.energy;
    rows.push_back(row);
  }
  for (const auto& [id, depth] : kept_)
    rows.push_back({static_cast<double>(kept_overlap), static_cast<double>(id), 0, 0, 0, 0, 0, 0, 0, 0, 0, depth});
  // Pairs that touch are few beside nodes; in the order of their keys the file is the same for any number of ranks.
  std::vector<std::array<double, row_length>> all = comm_.gather<std::array<double, row_length>>(rows);
  std::ranges::sort(all);
  const std::int64_t count = comm_.max(static_cast<std::int64_t>(all.size()));
  std::vector<GlobalId> ids;
  std::vector<double> values;
  for (std::size_t k = 0; k < all.size(); ++k) {
    ids.push_back(static_cast<GlobalId>(k));
    values.insert(values.end(), all[k].begin(), all[k].end());
  }
  file.integer(key("pairs"), count);
  file.array(key("memory"), GlobalOrder(comm_, ids, count), values, row_length);
  save_sum(comm_, file, key("dissipated"), dissipated_);
  save_sum(comm_, file, key("friction"), friction_);
  save_sum(comm_, file, key("rigid_work"), rigid_work_);
  for (std::size_t t = 0; t < totals_.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c)
      save_sum(comm_, file, key(fmt::format("impulse_{}_{}", t, c)), totals_[t].impulse[c]);
    save_sum(comm_, file, key(fmt::format("friction_{}", t)), totals_[t].friction_work);
  }
  for (std::size_t r = 0; r < rigid_.size(); ++r)
    for (std::size_t c = 0; c < 3; ++c) {
      file.scalar(key(fmt::format("shift_{}_{}", r, c)), rigid_[r].shift()[c]);
      file.scalar(key(fmt::format("velocity_{}_{}", r, c)), rigid_[r].free_velocity()[c]);
    }
}

void Contact::load(const CheckpointReader& file) {
  const auto key = [&](const std::string& what) { return name() + "." + what; };
  if (!file.has(key("pairs")))
    throw Error(ExitCode::file, name() + ": the checkpoint is of a scene without contact; start without --restart");
  const std::int64_t count = file.integer(key("pairs"));
  std::vector<GlobalId> ids(static_cast<std::size_t>(count));
  for (std::size_t k = 0; k < ids.size(); ++k) ids[k] = static_cast<GlobalId>(k);
  std::vector<double> values(ids.size() * row_length);
  file.array(key("memory"), GlobalOrder(comm_, ids, count), values, row_length);
  restored_.clear();
  for (std::size_t k = 0; k < ids.size(); ++k) {
    const double* row = values.data() + k * row_length;
    PairKey pair{static_cast<std::int64_t>(row[0]), {}};
    for (std::size_t i = 0; i < 4; ++i) pair.ids[i] = static_cast<GlobalId>(row[1 + i]);
    PairMemory memory;
    std::copy_n(row + 5, 3, memory.force.begin());
    std::copy_n(row + 8, 3, memory.slip.begin());
    memory.energy = row[11];
    restored_.emplace_back(pair, memory);
  }
  dissipated_ = load_sum(comm_, file, key("dissipated"));
  friction_ = load_sum(comm_, file, key("friction"));
  rigid_work_ = load_sum(comm_, file, key("rigid_work"));
  for (std::size_t t = 0; t < totals_.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c)
      totals_[t].impulse[c] = load_sum(comm_, file, key(fmt::format("impulse_{}_{}", t, c)));
    totals_[t].friction_work = load_sum(comm_, file, key(fmt::format("friction_{}", t)));
  }
  for (std::size_t r = 0; r < rigid_.size(); ++r) {
    Vec3 shift, velocity;
    for (std::size_t c = 0; c < 3; ++c) {
      shift[c] = file.scalar(key(fmt::format("shift_{}_{}", r, c)));
      velocity[c] = file.scalar(key(fmt::format("velocity_{}_{}", r, c)));
    }
    rigid_[r].restore(shift, velocity);
  }
  started_ = true;
}

}  // namespace tenon
