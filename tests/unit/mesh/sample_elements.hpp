// SPDX-License-Identifier: BSD-3-Clause
// Reference and distorted elements of every kind, and reproducible random numbers, for the tests of this room.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "framework/mesh/shape_functions.hpp"

namespace tenon::testing {

/// Every kind that has a shape: all but particles.
inline constexpr std::array<ElementKind, element_kinds - 1> all_kinds{
    ElementKind::hex8,  ElementKind::tet4, ElementKind::wedge6, ElementKind::pyramid5,
    ElementKind::quad4, ElementKind::tri3, ElementKind::hex20,  ElementKind::tet10};
inline constexpr std::array<ElementKind, 6> solid_kinds{ElementKind::hex8,     ElementKind::tet4,  ElementKind::wedge6,
                                                        ElementKind::pyramid5, ElementKind::hex20, ElementKind::tet10};
inline constexpr std::array<ElementKind, 4> linear_solid_kinds{ElementKind::hex8, ElementKind::tet4,
                                                               ElementKind::wedge6, ElementKind::pyramid5};

/// Uniform in [0, 1), the same everywhere.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  double operator()() {
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }
  double between(double low, double high) { return low + (high - low) * (*this)(); }
  Vec3 vector(double low, double high) { return {between(low, high), between(low, high), between(low, high)}; }

 private:
  std::uint64_t state_;
};

/// Nodes of the reference element, in its local coordinates; middle nodes as VTK numbers them.
inline std::vector<Vec3> reference_element(ElementKind kind) {
  switch (kind) {
    case ElementKind::hex20:
      return {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1},  {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1},
              {-1, 1, 1},   {0, -1, -1}, {1, 0, -1},  {0, 1, -1},  {-1, 0, -1}, {0, -1, 1}, {1, 0, 1},
              {0, 1, 1},    {-1, 0, 1},  {-1, -1, 0}, {1, -1, 0},  {1, 1, 0},   {-1, 1, 0}};
    case ElementKind::tet10:
      return {{0, 0, 0},     {1, 0, 0},   {0, 1, 0},   {0, 0, 1},     {0.5, 0, 0},
              {0.5, 0.5, 0}, {0, 0.5, 0}, {0, 0, 0.5}, {0.5, 0, 0.5}, {0, 0.5, 0.5}};
    case ElementKind::tet4:
      return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    case ElementKind::wedge6:
      return {{0, 0, -1}, {1, 0, -1}, {0, 1, -1}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    case ElementKind::pyramid5:
      return {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 1}};
    case ElementKind::quad4:
      return {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    case ElementKind::tri3:
      return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    case ElementKind::particle:
      return {{0, 0, 0}};
    case ElementKind::hex8:
      break;
  }
  return {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}};
}

/// The reference element with every corner moved by up to `amount`, sheared and moved away from the origin.
inline std::vector<Vec3> distorted_element(ElementKind kind, double amount, Random& random) {
  std::vector<Vec3> x = reference_element(kind);
  for (Vec3& p : x) {
    p = p + random.vector(-amount, amount);
    p = {3 + p[0] + 0.3 * p[1], -2 + p[1] - 0.2 * p[2], 0.7 + 1.5 * p[2] + 0.1 * p[0]};
  }
  return x;
}

/// A local point in the reference element.
inline Vec3 local_point(ElementKind kind, Random& random) {
  for (;;) {
    Vec3 xi = random.vector(-1, 1);
    if (topology(kind).dimension == 2) xi[2] = 0;
    if (overshoot(kind, xi) == 0) return xi;
  }
}

}  // namespace tenon::testing
