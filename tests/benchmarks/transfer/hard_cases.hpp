// SPDX-License-Identifier: BSD-3-Clause
// Where maps of point values get lost or slow: targets just outside, graded meshes, meshes that move.
#pragma once

namespace tenon::bench {

/// Collective. 9,602 boundary targets of 40^3 pushed out of 32^3 by 0 to 1e-3: who is found, with what error.
void run_pushed_out();

/// Collective. Set-up on meshes of n^3 and m^3 whose elements grow 1,000 : 1 in each direction, over that on uniform
/// ones.
void run_graded(int n, int m, int repeats, bool vtk);

/// Collective. The map brought up to date after each of several motions, over a new one.
void run_moving(int n, int m, int repeats);

}  // namespace tenon::bench
