// SPDX-License-Identifier: BSD-3-Clause
// Index and vector types that every room uses.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace tenon {

using LocalIndex = std::int32_t;  ///< position in an array of this rank
using GlobalId = std::int64_t;    ///< canonical, 0-based number over all ranks
using Vec3 = std::array<double, 3>;

inline constexpr LocalIndex no_index = -1;
inline constexpr GlobalId no_id = -1;

inline Vec3 operator+(const Vec3& a, const Vec3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Vec3 operator-(const Vec3& a, const Vec3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Vec3 operator*(double s, const Vec3& a) {
  return {s * a[0], s * a[1], s * a[2]};
}
inline double dot(const Vec3& a, const Vec3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double norm(const Vec3& a) {
  return std::sqrt(dot(a, a));
}

}  // namespace tenon
