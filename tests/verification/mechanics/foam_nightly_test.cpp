// SPDX-License-Identifier: BSD-3-Clause
// The column of foam at the stated speed of case A12 (a).
#include "foam_case.hpp"

namespace tenon::testing {
namespace {

TEST(Foam, CrushesAtOneMetreASecond) {
  foam_column::crush_slowly(1);
}

}  // namespace
}  // namespace tenon::testing
