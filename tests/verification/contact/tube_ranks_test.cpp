// SPDX-License-Identifier: BSD-3-Clause
// The first part of a small tube.
#include "tube_ranks.hpp"

namespace tenon::testing {
namespace {

TEST(TubeRanks, CrumplingAndErosionAreTheSameBitsOnAnyNumberOfRanks) {
  Tube tube;
  tube.around = 16, tube.along = 10;
  tube.speed = 100, tube.stroke = 0.018, tube.failure = 0.12;
  check_tube(tube);
}

}  // namespace
}  // namespace tenon::testing
