// SPDX-License-Identifier: BSD-3-Clause
// Particles that push each other apart until they are evenly spread in a region.
#include <algorithm>
#include <cmath>

#include "framework/mesh/particle_bodies.hpp"
#include "framework/search/box_tree.hpp"

namespace tenon {

namespace {

/// Smoothing length over spacing, and the share of its square by which the gradient of the concentration pushes.
constexpr double smoothing = 1.3, push = 0.2;
/// No way in a sweep is longer than this share of the spacing, and below that one they count as at rest.
constexpr double longest_way = 0.2, rest = 0.01;

/// How pairs push each other over q = r/h, up to q = 2, over h^(d+1). As the slope of Wendland's C2 kernel where
/// neighbours are, but not less for those that are nearer: these would form pairs.
double slope(double q, int dimension) {
  const double sigma = dimension == 2 ? 7 / (4 * 3.14159265358979) : 21 / (16 * 3.14159265358979);
  const double rest_of_support = 1 - 0.5 * q;
  return -5 * sigma * std::max(q, 0.5) * rest_of_support * rest_of_support * rest_of_support;
}

}  // namespace

int relax_particles(const ParticleRegion& region, double spacing, int dimension, int sweeps,
                    std::vector<Vec3>& places) {
  const double h = smoothing * spacing, reach = 2 * h;
  const double volume = std::pow(spacing, dimension), scale = volume / std::pow(h, dimension + 1);
  std::vector<Vec3> all, moved(places.size());
  std::vector<Box> boxes;
  std::vector<LocalIndex> found;
  for (int sweep = 1; sweep <= sweeps; ++sweep) {
    all = places;
    for (const Vec3& x : places) {
      const ParticleRegion::Surface near = region.surface(x);
      if (near.distance > -reach) all.push_back(x - 2 * near.distance * near.outward);
    }
    boxes.resize(all.size());
    for (std::size_t k = 0; k < all.size(); ++k) boxes[k] = {all[k], all[k]};
    const BoxTree tree(boxes);
    double longest = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      Box around{places[i], places[i]};
      around.inflate(reach);
      found.clear();
      tree.overlapping(around, found);
      std::sort(found.begin(), found.end());
      Vec3 gradient{};
      for (const LocalIndex k : found) {
        const Vec3 d = places[i] - all[static_cast<std::size_t>(k)];
        const double r = norm(d);
        if (r > 0 && r < reach) gradient = gradient + (scale * slope(r / h, dimension) / r) * d;
      }
      Vec3 way = -(push * h * h) * gradient;
      if (const double length = norm(way); length > longest_way * spacing) way = (longest_way * spacing / length) * way;
      moved[i] = places[i] + way;
      const ParticleRegion::Surface near = region.surface(moved[i]);
      if (near.distance > -0.5 * spacing) moved[i] = moved[i] - (near.distance + 0.5 * spacing) * near.outward;
      longest = std::max(longest, norm(moved[i] - places[i]));
    }
    places.swap(moved);
    if (longest < rest * spacing) return sweep;
  }
  return sweeps;
}

}  // namespace tenon
