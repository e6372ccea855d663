// SPDX-License-Identifier: BSD-3-Clause
// Contact in the step of a can that is crushed; and what contact costs where nothing can touch.
#pragma once

namespace CLI {
class App;
}

namespace tenon::bench {

/// Add the subcommands `can` and `apart`.
void add_can(CLI::App& app);
void add_apart(CLI::App& app);

}  // namespace tenon::bench
