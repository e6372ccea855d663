// SPDX-License-Identifier: BSD-3-Clause
// From options to a kernel known to the compiler.
#pragma once

#include "components/sph/smoothing_kernel.hpp"
#include "components/sph/sph_options.hpp"

namespace tenon {

/// Calls work.operator()<K, d>() with the chosen kernel and the number of dimensions; once per pass, not per pair.
template <typename Work>
void with_kernel(SphKernelKind kind, int dimension, Work&& work) {
  const auto with = [&]<typename K>() {
    if (dimension == 3)
      work.template operator()<K, 3>();
    else if (dimension == 2)
      work.template operator()<K, 2>();
    else
      work.template operator()<K, 1>();
  };
  switch (kind) {
    case SphKernelKind::wendland_c2:
      return with.template operator()<WendlandC2>();
    case SphKernelKind::wendland_c4:
      return with.template operator()<WendlandC4>();
    case SphKernelKind::cubic_spline:
      return with.template operator()<CubicSpline>();
    case SphKernelKind::quintic_spline:
      return with.template operator()<QuinticSpline>();
  }
}

}  // namespace tenon
