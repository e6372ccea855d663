// SPDX-License-Identifier: BSD-3-Clause
// The broad phase on one core: boxes of faces against points.
#pragma once

namespace CLI {
class App;
}

namespace tenon::bench {

/// Adds the subcommand `search`.
void add_search(CLI::App& app);

}  // namespace tenon::bench
