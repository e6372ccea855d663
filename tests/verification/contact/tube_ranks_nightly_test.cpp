// SPDX-License-Identifier: BSD-3-Clause
// A tube that is crushed by two thirds.
#include "tube_ranks.hpp"

namespace tenon::testing {
namespace {

TEST(TubeRanksNightly, CrumplingAndErosionAreTheSameBitsOnAnyNumberOfRanks) {
  Tube tube;
  tube.around = 20, tube.along = 14;
  tube.speed = 60, tube.stroke = 0.055, tube.failure = 0.35;
  check_tube(tube);
}

}  // namespace
}  // namespace tenon::testing
