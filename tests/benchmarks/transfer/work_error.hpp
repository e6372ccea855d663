// SPDX-License-Identifier: BSD-3-Clause
// Run time against error of every method, and of VTK's ways, on meshes of four sizes.
#pragma once

#include <string>

namespace tenon::bench {

/// One rank. Meshes of n^3 with n = 8, 16 ... finest; writes CSV: panel, method, n, targets, seconds of the set-up and
/// of one application, relative errors (rms, greatest) of sin(2 pi x) cos(3 pi y) e^z.
void run_work_error(int finest, const std::string& csv);

}  // namespace tenon::bench
