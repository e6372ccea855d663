// SPDX-License-Identifier: BSD-3-Clause
// Regions of simple shape.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "framework/base/error.hpp"
#include "framework/mesh/generator_tools.hpp"
#include "framework/mesh/particle_bodies.hpp"

namespace tenon {

namespace {

constexpr double pi = std::numbers::pi;

/// Between the radii inner and outer, at the distance r: negative inside, and whether the outer one is nearer.
struct Radial {
  double distance;
  bool outer;
};
Radial radial(double r, double inner, double outer) {
  const bool nearer_outer = inner == 0 || outer - r < r - inner;
  return {nearer_outer ? r - outer : inner - r, nearer_outer};
}

void require_radii(const std::string& shape, double inner, double outer) {
  require_positive(shape, "radius", outer);
  if (!(inner >= 0 && inner < outer))
    throw Error(ExitCode::usage, shape + ": the inner radius must be less than the outer one, and not negative");
}

}  // namespace

ParticleRegion ball_region(const Vec3& centre, double inner, double outer, int dimension) {
  const bool flat = dimension == 2;
  require_radii(flat ? "circle" : "sphere", inner, outer);
  ParticleRegion region;
  region.name = flat ? "circle" : "sphere";
  const Vec3 reach{outer, outer, flat ? 0 : outer};
  region.bounds = {centre - reach, centre + reach};
  region.measure = flat ? pi * (outer * outer - inner * inner) : 4 * pi / 3 * (std::pow(outer, 3) - std::pow(inner, 3));
  region.surface = [centre, inner, outer](const Vec3& x) {
    const Vec3 d = x - centre;
    const double r = norm(d);
    const Radial here = radial(r, inner, outer);
    const Vec3 away = r > 0 ? (1 / r) * d : Vec3{1, 0, 0};
    return ParticleRegion::Surface{here.distance, here.outer ? away : -1.0 * away};
  };
  region.inside = [surface = region.surface](const Vec3& x) { return surface(x).distance < 0; };
  return region;
}

ParticleRegion cylinder_region(const Vec3& foot, const Vec3& axis, double inner, double outer, double length) {
  require_radii("cylinder", inner, outer);
  require_positive("cylinder", "length", length);
  require_positive("cylinder", "length of its axis", norm(axis));
  const Vec3 up = (1 / norm(axis)) * axis;
  ParticleRegion region;
  region.name = "cylinder";
  for (std::size_t c = 0; c < 3; ++c) {
    const double across = outer * std::sqrt(std::max(0.0, 1 - up[c] * up[c])), top = foot[c] + length * up[c];
    region.bounds.low[c] = std::min(foot[c], top) - across, region.bounds.high[c] = std::max(foot[c], top) + across;
  }
  region.measure = pi * (outer * outer - inner * inner) * length;
  region.surface = [foot, up, inner, outer, length](const Vec3& x) {
    const double height = dot(x - foot, up);
    const Vec3 d = x - foot - height * up;
    const double r = norm(d);
    const Radial here = radial(r, inner, outer);
    const double end = std::max(-height, height - length);
    const Vec3 away = r > 0 ? (1 / r) * d : Vec3{};
    if (end > here.distance) return ParticleRegion::Surface{end, height > 0.5 * length ? up : -1.0 * up};
    return ParticleRegion::Surface{here.distance, here.outer ? away : -1.0 * away};
  };
  region.inside = [surface = region.surface](const Vec3& x) { return surface(x).distance < 0; };
  return region;
}

}  // namespace tenon
