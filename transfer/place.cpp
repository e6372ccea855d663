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

/// The nearest local coordinates within the reference element, for points that are outside by less than a tolerance.
Vec3 clamped(ElementKind kind, Vec3 xi) {
  const auto triangle = [](double& a, double& b, double room) {
    a = std::max(a, 0.0), b = std::max(b, 0.0);
    if (const double sum = a + b; sum > room) a *= room / sum, b *= room / sum;
  };
  switch (kind) {
    case ElementKind::tet4: {
      for (double& c : xi) c = std::max(c, 0.0);
      if (const double sum = xi[0] + xi[1] + xi[2]; sum > 1)
        for (double& c : xi) c /= sum;
      break;
    }
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

}  // namespace

bool ends_search(double overshoot, const PlaceRules& rules) {
  return overshoot <= std::min(on_surface, 2 * rules.tolerance);
}

Placement in_element(const ElementPacket& element) {
  Placement place;
  place.element = element.id;
  place.item = element.item;
  place.owner = element.owner;
  place.kind = element.kind;
  return place;
}

namespace {

std::span<double> weights_of(Placement& place) {
  return std::span(place.weights).first(static_cast<std::size_t>(topology(place.kind).nodes));
}

}  // namespace

void set_weights_at(Placement& place, const ElementPacket& element, const Vec3& point, const Vec3& xi) {
  const std::span<double> weights = weights_of(place);
  const auto corners = element.corner_span();
  const auto corner = std::find(corners.begin(), corners.end(), point);
  if (corner != corners.end()) {
    weights[static_cast<std::size_t>(corner - corners.begin())] = 1;
    return;
  }
  shape_values(element.kind, clamped(element.kind, xi), weights);
  for (double& w : weights) w = std::max(w, 0.0);
  make_partition_of_unity(weights);
}

namespace {

/// Gradients dN_a/dx at xi, 1/m. False where the Jacobian is singular.
bool spatial_gradients(const ElementPacket& element, const Vec3& xi, std::span<Vec3> gradients) {
  shape_gradients(element.kind, xi, gradients);
  Vec3 x_xi{}, x_eta{}, x_zeta{};
  const auto corners = element.corner_span();
  for (std::size_t a = 0; a < corners.size(); ++a) {
    x_xi = x_xi + gradients[a][0] * corners[a];
    x_eta = x_eta + gradients[a][1] * corners[a];
    x_zeta = x_zeta + gradients[a][2] * corners[a];
  }
  const Vec3 dxi = cross(x_eta, x_zeta), deta = cross(x_zeta, x_xi), dzeta = cross(x_xi, x_eta);
  const double determinant = dot(x_xi, dxi);
  if (!(determinant > 1e-9 * norm(x_xi) * norm(x_eta) * norm(x_zeta))) return false;
  for (Vec3& g : gradients.first(corners.size())) g = 1 / determinant * (g[0] * dxi + (g[1] * deta + g[2] * dzeta));
  return true;
}

/// Linear-exact weights of a point outside. The shape functions themselves, where their inverse map is well-behaved,
/// else N_a(nearest) + grad N_a . (x - nearest): sum N_a x_a = x in both. (The gradient may be taken anywhere in the
/// element: at its centre if it is singular at the nearest point.)
void set_extrapolated_weights(Placement& place, const ElementPacket& element, const Vec3& point, const Vec3& nearest) {
  constexpr double trusted_overshoot = 1;  // half an element's width; product terms of xi grow beyond
  const std::span<double> weights = weights_of(place);
  const InverseMap inverse = inverse_map(element.kind, element.corner_span(), point);
  if (inverse.converged &&
      (element.kind == ElementKind::tet4 || overshoot(element.kind, inverse.xi) <= trusted_overshoot)) {
    shape_values(element.kind, inverse.xi, weights);
  } else {
    std::array<Vec3, max_nodes> gradients{};
    if (!spatial_gradients(element, nearest, gradients) &&
        !spatial_gradients(element, element_centre(element.kind), gradients))
      return set_weights_at(place, element, point, nearest);
    shape_values(element.kind, nearest, weights);
    const Vec3 away = point - map_to_space(element.kind, element.corner_span(), nearest);
    for (std::size_t a = 0; a < weights.size(); ++a) weights[a] += dot(gradients[a], away);
  }
  make_partition_of_unity(weights);
}

}  // namespace

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

Placement place_inside(std::span<const ElementPacket> elements, std::span<LocalIndex> candidates, const Vec3& point,
                       const PlaceRules& rules) {
  const auto at = [&](LocalIndex i) -> const ElementPacket& { return elements[static_cast<std::size_t>(i)]; };
  std::sort(candidates.begin(), candidates.end(), [&](LocalIndex a, LocalIndex b) { return at(a).id < at(b).id; });
  double least = std::numeric_limits<double>::infinity();
  const ElementPacket* best = nullptr;
  Vec3 best_xi{};
  for (const LocalIndex c : candidates) {
    const ElementPacket& element = at(c);
    const InverseMap inverse = inverse_map(element.kind, element.corner_span(), point);
    if (!inverse.converged) continue;
    const double outside = overshoot(element.kind, inverse.xi);
    // Overshoot counts half widths of the element.
    if (outside > 2 * rules.tolerance || !(outside < least)) continue;
    least = outside, best = &element, best_xi = inverse.xi;
    if (ends_search(outside, rules)) break;
  }
  if (!best) return {};
  Placement place = in_element(*best);
  set_weights_at(place, *best, point, best_xi);
  return place;
}

Placement place_nearest(std::span<const ElementPacket> elements, const BoxTree& tree, const Vec3& point, double reach,
                        const PlaceRules& rules) {
  const ElementPacket* best = nullptr;
  NearestPoint best_point;
  // Boxes are larger than their elements by more than round-off, so the tree never leaves out one that could still be
  // as near as the best: the answer does not depend on the order of the visits.
  tree.nearest(point, reach, [&](LocalIndex i) {
    const ElementPacket& element = elements[static_cast<std::size_t>(i)];
    const NearestPoint nearest = nearest_point(element.kind, element.corner_span(), point);
    const bool wins = !best || nearest.distance < best_point.distance ||
                      (nearest.distance == best_point.distance && element.id < best->id);
    if (wins && nearest.distance <= reach) best = &element, best_point = nearest;
    return nearest.distance;
  });
  if (!best) return {};
  Placement place = in_element(*best);
  place.outside = best_point.distance > rules.tolerance * best->size;
  if (!place.outside || !rules.extrapolate)
    set_weights_at(place, *best, point, best_point.xi);
  else
    set_extrapolated_weights(place, *best, point, best_point.xi);
  if (place.outside) place.distance = best_point.distance;
  return place;
}

}  // namespace tenon::transfer
