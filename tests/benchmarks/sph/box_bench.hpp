// SPDX-License-Identifier: BSD-3-Clause
// Particle-steps per second of a weakly compressible fluid in a periodic box.
#pragma once

namespace CLI {
class App;
}

namespace tenon::bench {

void add_fluid(CLI::App& app);

}  // namespace tenon::bench
