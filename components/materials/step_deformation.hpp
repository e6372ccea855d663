// SPDX-License-Identifier: BSD-3-Clause
// Strain increment and rotation of a step, objective at any size of the rotation.
#pragma once

#include "components/materials/small_tensor.hpp"
#include "framework/base/wide_pack.hpp"

namespace tenon {

/// Strain increment (tensor shear) of a step in the frame of its end, and the rotation of the step.
template <typename R>
struct StepDeformation {
  SymmetricTensor<R> strain_increment;
  Tensor<R> rotation;
};

/// (1 - w/2)^-1 (1 + w/2) for the skew tensor w with the axial vector r, in closed form 1 + (w + w w/2)/(1 + |r|^2/4):
/// the rotation about r by the angle 2 atan(|r|/2).
template <typename R>
TENON_KERNEL Tensor<R> cayley_rotation(const Vector<R>& r, const R& squared) {
  const R k = 1.0 / (1.0 + 0.25 * squared), h = 0.5 * k;
  const Vector<R> kr = k * r, hr = h * r;
  const R diagonal = 1.0 - h * squared;
  const R xy = hr.x * r.y, yz = hr.y * r.z, zx = hr.z * r.x;
  return {{diagonal + hr.x * r.x, xy - kr.z, zx + kr.y},
          {xy + kr.z, diagonal + hr.y * r.y, yz - kr.x},
          {zx - kr.y, yz + kr.x, diagonal + hr.z * r.z}};
}

/// [HW80]: with the velocity gradient taken in the geometry half way between start and end of the step, a rigid
/// rotation by any angle theta < 180 degrees gives D = 0 and dt W = 2 tan(theta/2), whose Cayley rotation is exact. The
/// strain increment dt D belongs to mid-step and is turned on by half the rotation, tan(theta/4) = tan(theta/2) /
/// (1 + sqrt(1 + tan^2(theta/2))); without this the stress would be of first order only where W and D go together.
template <typename R>
TENON_KERNEL StepDeformation<R> step_deformation(const Tensor<R>& l, double dt) {
  const double half = 0.5 * dt;
  const SymmetricTensor<R> middle{
      dt * l.x.x, dt * l.y.y, dt * l.z.z, half * (l.x.y + l.y.x), half * (l.y.z + l.z.y), half * (l.z.x + l.x.z)};
  const Vector<R> r{half * (l.z.y - l.y.z), half * (l.x.z - l.z.x), half * (l.y.x - l.x.y)};
  const R squared = dot(r, r);
  const R share = 1.0 / (1.0 + square_root(1.0 + 0.25 * squared));
  return {rotated(cayley_rotation(share * r, share * share * squared), middle), cayley_rotation(r, squared)};
}

}  // namespace tenon
