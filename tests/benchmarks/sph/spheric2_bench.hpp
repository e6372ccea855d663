// SPDX-License-Identifier: BSD-3-Clause
// A dam that breaks onto a box, against the experiment (SPHERIC test 2, case B09).
#pragma once

namespace CLI {
class App;
}

namespace tenon::bench {

void add_spheric2(CLI::App& app);

}  // namespace tenon::bench
