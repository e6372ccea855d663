// SPDX-License-Identifier: BSD-3-Clause
// How evenly the broad phase's counted work is spread over the ranks while a can is crumpled.
#pragma once

namespace CLI {
class App;
}

namespace tenon::bench {

/// Adds the subcommand `balance`.
void add_balance(CLI::App& app);

}  // namespace tenon::bench
