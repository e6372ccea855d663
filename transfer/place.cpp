// SPDX-License-Identifier: BSD-3-Clause
#include "transfer/place.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/mesh/shape_functions.hpp"

namespace tenon::transfer {

namespace {

/// Overshoot that is round-off of the inverse map: such a point is on the element's surface.
constexpr double on_surface = 1e-12;
/// Weights below this are round-off.
constexpr double negligible = 1e-15;

bool second_order(ElementKind kind) {
  return !middle_nodes(kind).empty();
}

}  // namespace

Vec3 clamped(ElementKind kind, Vec3 xi) {
  const auto triangle = [](double& a, double& b, double room) {
    a = std::max(a, 0.0), b = std::max(b, 0.0);
    if (const double sum = a + b; sum > room) a *= room / sum, b *= room / sum;
  };
  switch (kind) {
    case ElementKind::tet4:
    case ElementKind::tet10:
      for (double& c : xi) c = std::max(c, 0.0);
      if (const double sum = xi[0] + xi[1] + xi[2]; sum > 1)
        for (double& c : xi) c /= sum;
      break;
    case ElementKind::tri3:
      triangle(xi[0], xi[1], 1.0);
      break;
    case ElementKind::wedge6:
      triangle(xi[0], xi[1], 1.0);
      xi[2] = std::clamp(xi[2], -1.0, 1.0);
      break;
    case ElementKind::pyramid5: {
      xi[2] = std::clamp(xi[2], 0.0, 1.0);
      const double width = 1 - xi[2];
      xi[0] = std::clamp(xi[0], -width, width);
      xi[1] = std::clamp(xi[1], -width, width);
      break;
    }
    default:
      for (double& c : xi) c = std::clamp(c, -1.0, 1.0);
  }
  return xi;
}

double depth(ElementKind kind, const Vec3& xi) {
  const auto [x, y, z] = xi;
  switch (kind) {
    case ElementKind::tet4:
      return std::min({x, y, z, 1 - x - y - z});
    case ElementKind::wedge6:
      return std::min({x, y, 1 - x - y, 1 - std::abs(z)});
    case ElementKind::pyramid5:
      return std::min({z, 1 - z - std::abs(x), 1 - z - std::abs(y)});
    case ElementKind::hex8:
      return 1 - std::max({std::abs(x), std::abs(y), std::abs(z)});
    default:
      return -1;
  }
}

bool ends_search(double overshoot, const PlaceRules& rules) {
  return overshoot <= std::min(on_surface, 2 * rules.tolerance);
}

Placement in_element(const ElementSet& elements, LocalIndex e, const Vec3& point, const Vec3& xi) {
  Placement place;
  place.element = elements.id(e);
  place.item = elements.items[static_cast<std::size_t>(e)];
  place.at_owner = elements.at_owner(e);
  place.here = e;
  place.owner = elements.owner(e);
  place.kind = elements.kind(e);
  place.xi = clamped(place.kind, xi);
  const LocalIndex* const nodes = elements.nodes_of(e);
  const std::span<const Vec3> corners =
      local_nodes(place.kind).first(static_cast<std::size_t>(corner_count(place.kind)));
  for (std::size_t a = 0; a < corners.size(); ++a)
    if (elements.x[static_cast<std::size_t>(nodes[a])] == point) {
      place.xi = corners[a];
      break;
    }
  return place;
}

void make_partition_of_unity(std::span<double> weights) {
  std::size_t largest = 0;
  for (std::size_t a = 0; a < weights.size(); ++a) {
    if (std::abs(weights[a]) <= negligible) weights[a] = 0;
    if (std::abs(weights[a]) > std::abs(weights[largest])) largest = a;
  }
  for (int repeat = 0; repeat < 2; ++repeat) {
    double sum = 0;
    for (const double w : weights) sum += w;
    weights[largest] += 1 - sum;
  }
}

void shape_weights(const Placement& place, std::span<double> weights) {
  if (place.state == PlaceState::linear) {
    const Vec3 centre = element_centre(place.kind);
    std::array<Vec3, max_nodes> gradients;
    shape_values(place.kind, centre, weights);
    shape_gradients(place.kind, centre, gradients);
    for (std::size_t a = 0; a < weights.size(); ++a) weights[a] += dot(gradients[a], place.xi - centre);
  } else {
    shape_values(place.kind, place.xi, weights);
    if (place.state != PlaceState::extended && !second_order(place.kind))
      for (double& w : weights) w = std::max(w, 0.0);
  }
  make_partition_of_unity(weights);
}

namespace {

/// Where the point is in the linear map about the element's centre. False where that is singular.
bool linear_coordinates(ElementKind kind, std::span<const Vec3> corners, const Vec3& point, Vec3& xi) {
  const Vec3 centre = element_centre(kind);
  std::array<Vec3, max_nodes> gradients;
  shape_gradients(kind, centre, gradients);
  Vec3 x_xi{}, x_eta{}, x_zeta{};
  for (std::size_t a = 0; a < corners.size(); ++a) {
    x_xi = x_xi + gradients[a][0] * corners[a];
    x_eta = x_eta + gradients[a][1] * corners[a];
    x_zeta = x_zeta + gradients[a][2] * corners[a];
  }
  const Vec3 dxi = cross(x_eta, x_zeta), deta = cross(x_zeta, x_xi), dzeta = cross(x_xi, x_eta);
  const double determinant = dot(x_xi, dxi);
  if (!(determinant > 1e-9 * norm(x_xi) * norm(x_eta) * norm(x_zeta))) return false;
  const Vec3 away = 1 / determinant * (point - map_to_space(kind, corners, centre));
  xi = centre + Vec3{dot(dxi, away), dot(deta, away), dot(dzeta, away)};
  return true;
}

/// Linear-exact coordinates of a point outside: those of the shape functions themselves, where their inverse map is
/// well-behaved, else those of the linear map about the centre.
void extend(Placement& place, std::span<const Vec3> corners, const Vec3& point) {
  constexpr double trusted_overshoot = 1;  // half an element's width; product terms of xi grow beyond
  const InverseMap inverse = inverse_map(place.kind, corners, point);
  const bool affine = place.kind == ElementKind::tet4;
  if (inverse.converged && (affine || overshoot(place.kind, inverse.xi) <= trusted_overshoot)) {
    place.xi = inverse.xi;
    place.state = PlaceState::extended;
  } else if (linear_coordinates(place.kind, corners, point, place.xi)) {
    place.state = PlaceState::linear;
  }
}

}  // namespace

Placement place_inside(const ElementSet& elements, std::span<LocalIndex> candidates, const Vec3& point,
                       const PlaceRules& rules) {
  std::sort(candidates.begin(), candidates.end(),
            [&](LocalIndex a, LocalIndex b) { return elements.id(a) < elements.id(b); });
  double least = std::numeric_limits<double>::infinity();
  LocalIndex best = no_index;
  Vec3 best_xi{};
  for (const LocalIndex e : candidates) {
    const ElementKind kind = elements.kind(e);
    if (topology(kind).dimension != 3) continue;
    const InverseMap inverse = inverse_map(kind, CornerList(elements, e).span(), point);
    if (!inverse.converged) continue;
    const double outside = overshoot(kind, inverse.xi);
    // Overshoot counts half widths of the element.
    if (outside > 2 * rules.tolerance || !(outside < least)) continue;
    least = outside, best = e, best_xi = inverse.xi;
    if (ends_search(outside, rules)) break;
  }
  if (best == no_index) return {};
  return in_element(elements, best, point, best_xi);
}

Placement place_nearest(const ElementSet& elements, const BoxTree& tree, const Vec3& point, double reach,
                        const PlaceRules& rules) {
  LocalIndex best = no_index;
  NearestPoint best_point;
  int tried = 0;
  // Boxes are larger than their elements by more than round-off, so the tree never leaves out one that could still be
  // as near as the best: the answer does not depend on the order of the visits.
  tree.nearest(point, reach, [&](LocalIndex e) {
    ++tried;
    const NearestPoint nearest = nearest_point(elements.kind(e), CornerList(elements, e).span(), point);
    const bool wins = best == no_index || nearest.distance < best_point.distance ||
                      (nearest.distance == best_point.distance && elements.id(e) < elements.id(best));
    if (wins && nearest.distance <= reach) best = e, best_point = nearest;
    return nearest.distance;
  });
  if (best == no_index) return {};
  const CornerList corners(elements, best);
  Placement place = in_element(elements, best, point, best_point.xi);
  place.work = static_cast<std::uint8_t>(std::min(16 * tried, 255));  // each costs much more than an inverse map
  if (!(best_point.distance > rules.tolerance * corners.size())) return place;
  place.state = PlaceState::outside;
  place.distance = best_point.distance;
  if (rules.extrapolate && topology(place.kind).dimension == 3) extend(place, corners.span(), point);
  return place;
}

}  // namespace tenon::transfer
