// SPDX-License-Identifier: BSD-3-Clause
// Random faces of all kinds, from a seed.
#pragma once

#include <algorithm>
#include <random>

#include "components/contact_geometry/closest_point.hpp"

namespace tenon::contact {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double operator()(double low, double high) { return low + (high - low) * (engine_() * 0x1p-64); }
  int below(int n) { return static_cast<int>(engine_() % static_cast<unsigned>(n)); }
  Vec3 in_cube(double half) { return {(*this)(-half, half), (*this)(-half, half), (*this)(-half, half)}; }
  Vec3 direction() {
    for (;;) {
      const Vec3 v = in_cube(1);
      const double length = norm(v);
      if (length > 0.1 && length < 1) return (1 / length) * v;
    }
  }

 private:
  std::mt19937_64 engine_;
};

/// Unit size about: 0 any four points, 1 square, 2 warped square, 3 sliver, 4 collapsed corner, 5 re-entrant, 6
/// triangle.
inline constexpr int kinds_of_face = 7;
inline FaceShape random_face(Random& random, int kind) {
  FaceShape face{4, {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}};
  if (kind == 0)
    for (Vec3& x : face.x) x = random.in_cube(0.7);
  if (kind == 2)
    for (Vec3& x : face.x) x = x + random.in_cube(0.4);
  if (kind == 3)
    for (Vec3& x : face.x) x[1] *= 1e-4;
  if (kind == 4) {
    for (Vec3& x : face.x) x = x + random.in_cube(0.2);
    const int k = random.below(4);
    face.x[k] = face.x[(k + 1) % 4];
  }
  if (kind == 5) face.x[2] = {0.2, 0.3, random(-0.2, 0.2)};
  if (kind == 6) {
    face.corners = 3;
    for (Vec3& x : face.x) x = x + random.in_cube(0.4);
  }
  // A random rotation: the columns of an orthonormal frame.
  const Vec3 u = random.direction();
  Vec3 v = cross(u, random.direction());
  v = (1 / norm(v)) * v;
  const Vec3 w = cross(u, v);
  for (Vec3& x : face.x) x = x[0] * u + x[1] * v + x[2] * w;
  return face;
}

/// Weights of a random place of the face.
inline std::array<double, 4> random_place(Random& random, const FaceShape& face) {
  double xi = random(0, 1), eta = random(0, 1);
  if (face.corners == 4) return {(1 - xi) * (1 - eta), xi * (1 - eta), xi * eta, (1 - xi) * eta};
  if (xi + eta > 1) xi = 1 - xi, eta = 1 - eta;
  return {1 - xi - eta, xi, eta, 0};
}

inline Vec3 place_on(const FaceShape& face, const std::array<double, 4>& w) {
  Vec3 p{0, 0, 0};
  for (int i = 0; i < face.corners; ++i) p = p + w[i] * face.x[i];
  return p;
}

inline FaceShape moved(const FaceShape& face, const Vec3& by, double scale = 1) {
  FaceShape result = face;
  for (Vec3& x : result.x) x = scale * (x + by);
  return result;
}

}  // namespace tenon::contact
