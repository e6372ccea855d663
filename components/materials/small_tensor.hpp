// SPDX-License-Identifier: BSD-3-Clause
// Vectors and 3 x 3 tensors of one number type: double for a single point, Pack for four at once.
#pragma once

#include "components/materials/pack.hpp"

namespace tenon {

template <typename R>
struct Vector {
  R x, y, z;
};

template <typename R>
TENON_KERNEL Vector<R> operator+(const Vector<R>& a, const Vector<R>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <typename R>
TENON_KERNEL Vector<R> operator-(const Vector<R>& a, const Vector<R>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <typename R>
TENON_KERNEL Vector<R> operator*(const R& s, const Vector<R>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <typename R>
TENON_KERNEL R dot(const Vector<R>& a, const Vector<R>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <typename R>
TENON_KERNEL Vector<R> cross(const Vector<R>& a, const Vector<R>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Rows x, y, z.
template <typename R>
struct Tensor {
  Vector<R> x, y, z;
};

template <typename R>
TENON_KERNEL Vector<R> operator*(const Tensor<R>& t, const Vector<R>& a) {
  return {dot(t.x, a), dot(t.y, a), dot(t.z, a)};
}

/// In the order of all fields: xx yy zz xy yz zx.
template <typename R>
struct SymmetricTensor {
  R xx, yy, zz, xy, yz, zx;
};

template <typename R>
TENON_KERNEL R trace(const SymmetricTensor<R>& s) {
  return s.xx + s.yy + s.zz;
}
/// s : s
template <typename R>
TENON_KERNEL R squared_norm(const SymmetricTensor<R>& s) {
  return s.xx * s.xx + s.yy * s.yy + s.zz * s.zz + 2.0 * (s.xy * s.xy + s.yz * s.yz + s.zx * s.zx);
}

/// r s r^T
template <typename R>
TENON_KERNEL SymmetricTensor<R> rotated(const Tensor<R>& r, const SymmetricTensor<R>& s) {
  const Tensor<R> columns{{s.xx, s.xy, s.zx}, {s.xy, s.yy, s.yz}, {s.zx, s.yz, s.zz}};
  const Vector<R> x = columns * r.x, y = columns * r.y, z = columns * r.z;
  return {dot(r.x, x), dot(r.y, y), dot(r.z, z), dot(r.x, y), dot(r.y, z), dot(r.z, x)};
}

}  // namespace tenon
