// SPDX-License-Identifier: BSD-3-Clause
// Run time against error, of every formulation that a case has, at several resolutions.
#pragma once

namespace CLI {
class App;
}

namespace tenon::bench {

void add_work_precision(CLI::App& app);

}  // namespace tenon::bench
