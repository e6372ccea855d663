// SPDX-License-Identifier: BSD-3-Clause
// How wrong interpolated values may be, from gradients recovered at the source [ZZ87].
//
// Of a quadratic f with gradients g_a at the nodes x_a, sum N_a (f_a + g_a . (x - x_a) / 2) is exact, since
// f_a + g_a . d / 2 = f(x) - g(x) . d / 2 with d = x - x_a and sum N_a d = 0. So sum N_a g_a . d / 2 estimates the
// error of sum N_a f_a, of the size h^2 f'' / 8. Outside, g . (distance to the nearest point) is added. Element values
// are constants: the error is g . (x - centre).
#include <algorithm>
#include <array>
#include <cmath>

#include "framework/mesh/shape_functions.hpp"
#include "transfer/element_points.hpp"
#include "transfer/grid_transfer_impl.hpp"

namespace tenon::transfer {

namespace {

/// dN_a/dx of an element at its centre, 1/m, and its volume; without volume all are 0.
struct CentreGradients {
  std::array<Vec3, max_nodes> gradient{};
  double volume = 0;
};

CentreGradients centre_gradients(ElementKind kind, const Corners& corners) {
  CentreGradients result;
  const auto nodes = static_cast<std::size_t>(topology(kind).nodes);
  std::array<Vec3, max_nodes> local{};
  shape_gradients(kind, element_centre(kind), local);
  Vec3 x_xi{}, x_eta{}, x_zeta{};
  for (std::size_t a = 0; a < nodes; ++a) {
    x_xi = x_xi + local[a][0] * corners[a];
    x_eta = x_eta + local[a][1] * corners[a];
    x_zeta = x_zeta + local[a][2] * corners[a];
  }
  const Vec3 dxi = cross(x_eta, x_zeta), deta = cross(x_zeta, x_xi), dzeta = cross(x_xi, x_eta);
  const double determinant = dot(x_xi, dxi);
  if (!(determinant > 0)) return result;
  result.volume = determinant;  // in units of the reference element: a weight for averages
  for (std::size_t a = 0; a < nodes; ++a)
    result.gradient[a] = 1 / determinant * (local[a][0] * dxi + (local[a][1] * deta + local[a][2] * dzeta));
  return result;
}

/// Averages over the elements around each node, weighted by volume: `value(item, block, e, centre)` per element.
template <typename T, typename Value>
std::vector<T> averaged_at_nodes(const Partner& side, Value&& value) {
  const Mesh& mesh = *side.mesh;
  std::vector<T> sum(static_cast<std::size_t>(mesh.nodes()));
  std::vector<double> volume(sum.size(), 0.0);
  for_each_element(mesh, [&](LocalIndex item, const ElementBlock& block, LocalIndex e) {
    const CentreGradients centre = centre_gradients(block.kind, corners_of(block, e, side.coordinates));
    const T term = value(item, block, e, centre);
    for (const LocalIndex node : block.nodes(e)) {
      const auto n = static_cast<std::size_t>(node);
      sum[n] = sum[n] + centre.volume * term;
      volume[n] += centre.volume;
    }
  });
  for (std::size_t n = 0; n < sum.size(); ++n)
    if (volume[n] > 0) sum[n] = 1 / volume[n] * sum[n];
  if (mesh.comm.size() > 1) mesh.node_halo.forward(std::span<const T>(sum), std::span<T>(sum));
  return sum;
}

Vec3 gradient_in(const ElementBlock& block, LocalIndex e, const CentreGradients& centre,
                 const std::vector<double>& nodal) {
  Vec3 g{};
  const auto nodes = block.nodes(e);
  for (std::size_t a = 0; a < nodes.size(); ++a) g = g + nodal[static_cast<std::size_t>(nodes[a])] * centre.gradient[a];
  return g;
}

/// Recovered gradients of one component at the source's items.
std::vector<Vec3> recovered_gradients(const Partner& source, const std::vector<double>& values) {
  if (source.location == Location::node)
    return averaged_at_nodes<Vec3>(
        source, [&](LocalIndex, const ElementBlock& block, LocalIndex e, const CentreGradients& centre) {
          return gradient_in(block, e, centre, values);
        });
  const auto nodal =
      averaged_at_nodes<double>(source, [&](LocalIndex item, const ElementBlock&, LocalIndex, const CentreGradients&) {
        return values[static_cast<std::size_t>(item)];
      });
  std::vector<Vec3> gradients(source.items().ids.size());
  for_each_element(*source.mesh, [&](LocalIndex item, const ElementBlock& block, LocalIndex e) {
    const CentreGradients centre = centre_gradients(block.kind, corners_of(block, e, source.coordinates));
    gradients[static_cast<std::size_t>(item)] = gradient_in(block, e, centre, nodal);
  });
  return gradients;
}

/// Places of all local items, m.
std::vector<Vec3> places_of(const Partner& side) {
  if (side.location != Location::element) return {side.coordinates.begin(), side.coordinates.end()};
  std::vector<Vec3> places;
  for_each_element(*side.mesh, [&](LocalIndex, const ElementBlock& block, LocalIndex e) {
    places.push_back(centre_of(block.kind, corners_of(block, e, side.coordinates)));
  });
  return places;
}

std::vector<Vec3> gathered(const RowMap& map, const std::vector<Vec3>& values) {
  return map.gathered(std::span<const Vec3>(values));
}

/// Greatest |estimate| over the rows of the owned items.
double greatest_over_rows(const Partner& target, const RowMap& map, bool nodal, const std::vector<Vec3>& targets,
                          const std::vector<Vec3>& x, const std::vector<Vec3>& g) {
  double greatest = 0;
  for (const LocalIndex item : target.items().owned) {
    const auto i = static_cast<std::size_t>(item);
    Vec3 nearest{}, slope{};
    map.for_each_term(i, [&](std::size_t slot, double weight) {
      nearest = nearest + weight * x[slot];
      slope = slope + weight * g[slot];
    });
    double estimate = 0, terms = 0;
    map.for_each_term(i, [&](std::size_t slot, double weight) {
      terms += 1;
      if (nodal) estimate += 0.5 * weight * dot(g[slot], nearest - x[slot]);
    });
    if (terms > 0) greatest = std::max(greatest, std::abs(estimate + dot(slope, targets[i] - nearest)));
  }
  return greatest;
}

}  // namespace

double interpolation_error(const Partner& source, const Partner& target, const RowMap& map,
                           std::span<const double> values, int components) {
  const auto width = static_cast<std::size_t>(components);
  const std::vector<Vec3> targets = places_of(target);
  const std::vector<Vec3> x = gathered(map, places_of(source));
  double greatest = 0;
  std::vector<double> component(source.items().ids.size());
  for (std::size_t c = 0; c < width; ++c) {
    for (std::size_t i = 0; i < component.size(); ++i) component[i] = values[i * width + c];
    const std::vector<Vec3> g = gathered(map, recovered_gradients(source, component));
    greatest = std::max(greatest, greatest_over_rows(target, map, source.location == Location::node, targets, x, g));
  }
  return target.comm().max(greatest);
}

}  // namespace tenon::transfer
