// SPDX-License-Identifier: BSD-3-Clause
#include "framework/io/hdf5_handle.hpp"

#include <array>

#include "framework/comm/mpi_access.hpp"

namespace tenon {

Hdf5Quiet::Hdf5Quiet() {
  H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Hdf5Quiet::~Hdf5Quiet() {
  H5Eset_auto2(H5E_DEFAULT, print_, data_);
}

std::string hdf5_reason() {
  std::string reason = "unknown reason";
  const auto keep_innermost = [](unsigned level, const H5E_error2_t* entry, void* text) -> herr_t {
    if (level == 0 && entry->desc != nullptr) *static_cast<std::string*>(text) = entry->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_innermost, &reason);
  return reason;
}

Hdf5Handle parallel_access(const Communicator& comm) {
  Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fapl_mpio(access, mpi_communicator(comm), MPI_INFO_NULL);
  H5Pset_all_coll_metadata_ops(access, true);
  H5Pset_coll_metadata_write(access, true);
  H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
  return access;
}

Hdf5Handle collective_transfer() {
  Hdf5Handle transfer(H5Pcreate(H5P_DATASET_XFER), H5Pclose);
  H5Pset_dxpl_mpio(transfer, H5FD_MPIO_COLLECTIVE);
  return transfer;
}

SlabSpaces slab_spaces(hid_t dataset, hsize_t first, hsize_t rows, hsize_t components) {
  const std::array<hsize_t, 2> start{first, 0}, count{rows, components};
  SlabSpaces spaces{{H5Dget_space(dataset), H5Sclose}, {H5Screate_simple(2, count.data(), nullptr), H5Sclose}};
  if (rows == 0 || components == 0) {
    H5Sselect_none(spaces.file);
    H5Sselect_none(spaces.memory);
  } else {
    H5Sselect_hyperslab(spaces.file, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
  }
  return spaces;
}

}  // namespace tenon
