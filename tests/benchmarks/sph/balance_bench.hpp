// SPDX-License-Identifier: BSD-3-Clause
// How evenly the work of a dam break is spread over the ranks.
#pragma once

namespace CLI {
class App;
}

namespace tenon::bench {

void add_balance(CLI::App& app);

}  // namespace tenon::bench
