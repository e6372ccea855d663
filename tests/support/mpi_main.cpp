// SPDX-License-Identifier: BSD-3-Clause
// Main of every test program: starts MPI, runs the tests, fails everywhere if one rank failed.
#include <gtest/gtest.h>

#include <memory>

#include "framework/comm/communicator.hpp"
#include "tests/support/test_communicator.hpp"

namespace {
std::unique_ptr<tenon::Communicator> world;
}

const tenon::Communicator& tenon::testing::communicator() {
  return *world;
}

int main(int argc, char** argv) {
  const tenon::MpiEnvironment environment(argc, argv);
  ::testing::InitGoogleTest(&argc, argv);
  world = std::make_unique<tenon::Communicator>(tenon::Communicator::world());
  if (world->rank() != 0) {
    auto& listeners = ::testing::UnitTest::GetInstance()->listeners();
    delete listeners.Release(listeners.default_result_printer());
    struct FailurePrinter : ::testing::EmptyTestEventListener {
      void OnTestPartResult(const ::testing::TestPartResult& r) override {
        if (r.failed())
          std::fprintf(stderr, "[rank %d] %s:%d\n%s\n", world->rank(), r.file_name(), r.line_number(), r.message());
      }
    };
    listeners.Append(new FailurePrinter);
  }
  const int failed = RUN_ALL_TESTS();
  const int any = world->max(failed);
  world.reset();
  return any;
}
