// SPDX-License-Identifier: BSD-3-Clause
// Runs a reader in a child process first, for libraries that can crash or hang on corrupt files. Private to the room.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace tenon::mesh_file {

/// Runs `read` in a forked child whose memory is a copy of ours, so that what happens there would happen here. Throws
/// the child's Error; throws Error(file) if the child crashes or uses more processor time than a file of `bytes` can
/// need. The child makes no MPI call.
void trial_run(const std::string& path, std::uint64_t bytes, const std::function<void()>& read);

}  // namespace tenon::mesh_file
