// SPDX-License-Identifier: BSD-3-Clause
// The MPI communicator behind a Communicator, for the rooms that must hand it to a library.
#pragma once

#include <mpi.h>

#include "framework/comm/communicator.hpp"

namespace tenon {

/// For decomposition (Zoltan) and io (HDF5) only.
MPI_Comm mpi_communicator(const Communicator& comm);

}  // namespace tenon
