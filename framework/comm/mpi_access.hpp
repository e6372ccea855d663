// SPDX-License-Identifier: BSD-3-Clause
// Between MPI's communicators and ours: for rooms that hand one to a library, and for codes that bring their own.
#pragma once

#include <mpi.h>

#include "framework/comm/communicator.hpp"

namespace tenon {

/// For decomposition (Zoltan) and io (HDF5) only.
MPI_Comm mpi_communicator(const Communicator& comm);

/// Collective over `mpi`, a communicator of a code that uses Tenon as a library and has started MPI itself. It is
/// duplicated, so messages of the two never meet.
Communicator communicator_on(MPI_Comm mpi);

}  // namespace tenon
