// SPDX-License-Identifier: BSD-3-Clause
// Rank 1 throws while the others wait for it. Ends by itself only if the exception ends all ranks.
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "framework/comm/communicator.hpp"

namespace {

void run(int argc, char** argv) {
  const tenon::MpiEnvironment environment(argc, argv);
  const tenon::Communicator comm = tenon::Communicator::world();
  if (comm.rank() == 1) throw std::runtime_error("thrown on rank 1");
  comm.barrier();
  std::puts("passed the barrier");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && std::strcmp(argv[1], "unwound") == 0) {
    try {
      run(argc, argv);
    } catch (const std::exception& e) {
      std::puts(e.what());
    }
    return 0;
  }
  run(argc, argv);
}
