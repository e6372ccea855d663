// SPDX-License-Identifier: BSD-3-Clause
// Run time against error for Taylor-Green vortices.
#pragma once

namespace CLI {
class App;
}

namespace tenon::bench {

void add_taylor_green(CLI::App& app);

}  // namespace tenon::bench
