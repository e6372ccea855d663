// SPDX-License-Identifier: BSD-3-Clause
// Planes across the axes where space repeats itself or is mirrored, and the images of particles beyond them.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "components/sph/particle_data.hpp"

namespace tenon {

/// Along each axis: open, periodic from `low` to `high`, or with mirrors (symmetry planes) at either.
struct ParticleDomain {
  struct Axis {
    bool periodic = false;            ///< then low and high are the ends of the period, m
    std::optional<double> low, high;  ///< m: mirrors if not periodic
    double period() const { return *high - *low; }
  };
  std::array<Axis, 3> axes;

  bool open() const {
    for (const Axis& a : axes)
      if (a.low || a.high) return false;
    return true;
  }
};

/// Image numbers: three digits to the base 3, of x, y, z; 0 itself, 1 the image below `low`, 2 the one above `high`.
class DomainImages {
 public:
  explicit DomainImages(const ParticleDomain& domain) : domain_(domain) {}
  const ParticleDomain& domain() const { return domain_; }

  /// Into the period.
  Vec3 wrapped(Vec3 x) const {
    for (std::size_t c = 0; c < 3; ++c) {
      const ParticleDomain::Axis& a = domain_.axes[c];
      if (a.periodic) x[c] -= a.period() * std::floor((x[c] - *a.low) / a.period());
    }
    return x;
  }

  /// Calls visit(image) for every image of the point that may be within `reach` of anything in the domain.
  template <typename Visit>
  void for_each(const Vec3& x, double reach, Visit&& visit) const {
    std::array<bool, 9> there{};
    for (std::size_t c = 0; c < 3; ++c) {
      const ParticleDomain::Axis& a = domain_.axes[c];
      const bool at_low = a.low && !(x[c] - *a.low > reach), at_high = a.high && !(*a.high - x[c] > reach);
      there[3 * c] = true;
      there[3 * c + 1] = a.periodic ? at_high : at_low;
      there[3 * c + 2] = a.periodic ? at_low : at_high;
    }
    for (std::uint8_t image = 1; image < 27; ++image)
      if (there[image % 3u] && there[3 + image / 3u % 3u] && there[6 + image / 9u]) visit(image);
  }

  Vec3 place(Vec3 x, std::uint8_t image) const {
    for (std::size_t c = 0; c < 3; ++c) {
      const unsigned digit = digit_of(image, c);
      if (digit == 0) continue;
      const ParticleDomain::Axis& a = domain_.axes[c];
      if (a.periodic)
        x[c] += digit == 1 ? -a.period() : a.period();
      else
        x[c] = 2 * (digit == 1 ? *a.low : *a.high) - x[c];
    }
    return x;
  }
  /// -1 along the axes in which the image is mirrored, else 1.
  Vec3 signs(std::uint8_t image) const {
    Vec3 s{1, 1, 1};
    for (std::size_t c = 0; c < 3; ++c)
      if (digit_of(image, c) != 0 && !domain_.axes[c].periodic) s[c] = -1;
    return s;
  }

  /// Turns the value of a particle into that of its image.
  void apply(ColumnKind kind, std::uint8_t image, double* value) const {
    if (image == 0 || kind == ColumnKind::scalar) return;
    if (kind == ColumnKind::position) {
      const Vec3 x = place({value[0], value[1], value[2]}, image);
      for (std::size_t c = 0; c < 3; ++c) value[c] = x[c];
      return;
    }
    const Vec3 s = signs(image);
    if (kind == ColumnKind::vector)
      for (std::size_t c = 0; c < 3; ++c) value[c] *= s[c];
    else if (kind == ColumnKind::tensor)
      for (std::size_t c = 0; c < 3; ++c) value[3 + c] *= s[c] * s[(c + 1) % 3];
    else
      for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 3; ++c) value[3 * r + c] *= s[r] * s[c];
  }

 private:
  static unsigned digit_of(std::uint8_t image, std::size_t axis) {
    return axis == 0 ? image % 3u : axis == 1 ? image / 3u % 3u : image / 9u;
  }
  ParticleDomain domain_;
};

}  // namespace tenon
