// SPDX-License-Identifier: BSD-3-Clause
// The state of a run in one parallel HDF5 file, every dataset in global-id order: independent of the ranks.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "framework/comm/exchange_plan.hpp"

namespace tenon {

/// Redistribution between "each rank has some ids" and "each rank has a contiguous slab of rows" that HDF5 writes.
/// Built once per set of ids, used by every dataset over them.
class GlobalOrder {
 public:
  /// Collective. Each id 0 .. global_count-1 is given by exactly one rank when writing; when reading, ids may repeat
  /// (ghosts).
  GlobalOrder(const Communicator& comm, std::span<const GlobalId> ids, GlobalId global_count);
  GlobalId global_count() const { return global_count_; }

 private:
  friend class CheckpointWriter;
  friend class CheckpointReader;
  /// Collective. Rows of this rank's slab from values in the order of the ids, and back.
  void to_slab(std::span<const double> values, std::span<double> slab, int components) const;
  void from_slab(std::span<const double> slab, std::span<double> values, int components) const;

  GlobalId global_count_ = 0, slab_first_ = 0;
  LocalIndex slab_size_ = 0, given_ = 0;
  bool each_once_ = false;            // every id was given by exactly one rank: fit for writing
  std::vector<LocalIndex> slab_row_;  // of each arriving id
  ExchangePlan plan_;
};

/// Writes beside the target and renames when whole, so that a kill at any moment leaves the old file or the new.
/// No time stamps, no rank counts: equal states give equal files (h5diff prints nothing). All functions collective.
class CheckpointWriter {
 public:
  CheckpointWriter(const Communicator& comm, std::string path);
  ~CheckpointWriter();
  void scalar(const std::string& name, double value);
  void integer(const std::string& name, std::int64_t value);
  void text(const std::string& name, const std::string& value);
  /// Dataset of global_count x components; `values` holds `components` per id, in the order of the ids of `order`.
  /// Without any ids (global_count 0) nothing is written, and nothing is looked for when it is read.
  void array(const std::string& name, const GlobalOrder& order, std::span<const double> values, int components);
  /// Flushes to the disk and renames. Throws Error(file), on all ranks, if anything failed; then the old file stands.
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Reads a checkpoint on any number of ranks. Collective; throws Error(file) naming the file and dataset when it is not
/// a checkpoint, is truncated or corrupted (a checksum per dataset is compared), or lacks what is asked.
class CheckpointReader {
 public:
  CheckpointReader(const Communicator& comm, std::string path);
  ~CheckpointReader();
  double scalar(const std::string& name) const;
  std::int64_t integer(const std::string& name) const;
  std::string text(const std::string& name) const;
  void array(const std::string& name, const GlobalOrder& order, std::span<double> values, int components) const;
  bool has(const std::string& name) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Checkpoints of a run in a folder: checkpoint-<step>.h5; the last two whole ones are kept.
struct CheckpointFiles {
  static std::string name(const std::string& folder, std::int64_t step);
  /// Newest first; only files whose name fits.
  static std::vector<std::string> list(const std::string& folder);
  /// Removes all but the newest two. Call on rank 0.
  static void prune(const std::string& folder);
  /// Removes those of later steps, which a run that restarts from `step` abandons (and which `prune` would else
  /// prefer). Call on rank 0.
  static void remove_later_than(const std::string& folder, std::int64_t step);
  /// Collective. The newest that is whole and undamaged; empty if there is none. The messages about newer, damaged ones
  /// are appended to `damaged`.
  static std::string newest_valid(const Communicator& comm, const std::string& folder,
                                  std::vector<std::string>* damaged = nullptr);
};

}  // namespace tenon
