// SPDX-License-Identifier: BSD-3-Clause
// HDF5 handles that close themselves, and HDF5 failures as text.
#pragma once

#include "framework/comm/communicator.hpp"

#include <hdf5.h>

#include <string>
#include <utility>

namespace tenon {

/// Owns one handle; `closer` is the H5?close that fits it.
class Hdf5Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Hdf5Handle() = default;
  Hdf5Handle(hid_t id, Close closer) : id_(id), close_(closer) {}
  Hdf5Handle(Hdf5Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Hdf5Handle& operator=(Hdf5Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Hdf5Handle() { close(); }

  operator hid_t() const { return id_; }
  bool valid() const { return id_ >= 0; }
  /// False if HDF5 could not close it.
  bool close() { return id_ < 0 || close_(std::exchange(id_, -1)) >= 0; }

 private:
  hid_t id_ = -1;
  Close close_ = nullptr;
};

/// Keeps HDF5 from printing its error stack for the life of this object.
class Hdf5Quiet {
 public:
  Hdf5Quiet();
  ~Hdf5Quiet();
  Hdf5Quiet(const Hdf5Quiet&) = delete;
  Hdf5Quiet& operator=(const Hdf5Quiet&) = delete;

 private:
  H5E_auto2_t print_ = nullptr;
  void* data_ = nullptr;
};

/// Why the last HDF5 call failed: the innermost entry of its error stack.
std::string hdf5_reason();
/// Access of a file by all ranks of `comm`, with collective metadata; collective transfers.
Hdf5Handle parallel_access(const Communicator& comm);
Hdf5Handle collective_transfer();

/// Selects `rows` rows from `first` in both file and memory space; nothing if rows is 0.
struct SlabSpaces {
  Hdf5Handle file, memory;
};
SlabSpaces slab_spaces(hid_t dataset, hsize_t first, hsize_t rows, hsize_t components);

}  // namespace tenon
