// SPDX-License-Identifier: BSD-3-Clause
#include "transfer/recovered_gradient.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "framework/mesh/shape_functions.hpp"
#include "transfer/element_points.hpp"
#include "transfer/mass_matrix.hpp"

namespace tenon::transfer {

namespace {

/// dN_a/dx of an element at its centre, 1/m, and its volume or area; without that all are 0.
struct CentreGradients {
  std::array<Vec3, max_nodes> gradient{};
  double volume = 0;
};

/// On a surface, the gradient along it: with the normal as third column, whose coefficient is 0.
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
  if (topology(kind).dimension == 2) {
    const Vec3 normal = cross(x_xi, x_eta);
    if (const double length = norm(normal); length > 0) x_zeta = 1 / length * normal;
  }
  const Vec3 dxi = cross(x_eta, x_zeta), deta = cross(x_zeta, x_xi), dzeta = cross(x_xi, x_eta);
  const double determinant = dot(x_xi, dxi);
  if (!(determinant > 0)) return result;
  result.volume = determinant;  // in units of the reference element: a weight for averages
  for (std::size_t a = 0; a < nodes; ++a)
    result.gradient[a] = 1 / determinant * (local[a][0] * dxi + (local[a][1] * deta + local[a][2] * dzeta));
  return result;
}

struct ElementAt {
  const ElementBlock* block;
  LocalIndex element;
  std::span<const LocalIndex> nodes() const { return block->nodes(element); }
};

std::vector<ElementAt> elements_of(const Mesh& mesh) {
  std::vector<ElementAt> all;
  all.reserve(static_cast<std::size_t>(mesh.elements()));
  for_each_element(mesh, [&](LocalIndex, const ElementBlock& block, LocalIndex e) { all.push_back({&block, e}); });
  return all;
}

/// Least squares: sum_n d_n (d_n . g) = sum_n d_n b_n. Inverse of the matrix, with a little on the diagonal for
/// directions in which there is but one layer of elements.
std::array<Vec3, 3> inverse_of_normal_matrix(std::span<const Vec3> d) {
  std::array<Vec3, 3> m{};
  for (const Vec3& v : d)
    for (std::size_t i = 0; i < 3; ++i) m[i] = m[i] + v[i] * v;
  const double trace = m[0][0] + m[1][1] + m[2][2];
  if (!(trace > 0)) return {};
  for (std::size_t i = 0; i < 3; ++i) m[i][i] += 1e-3 * trace;
  const Vec3 a = cross(m[1], m[2]), b = cross(m[2], m[0]), c = cross(m[0], m[1]);
  const double scale = 1 / dot(m[0], a);
  return {scale * a, scale * b, scale * c};  // symmetric
}

}  // namespace

RecoveredGradient::RecoveredGradient(const Side& side, std::span<const LocalIndex> wanted, const std::string& name)
    : wanted_(wanted.begin(), wanted.end()), by_node_(side.location == Location::node) {
  if (by_node_)
    at_nodes(side, wanted);
  else
    in_elements(side, wanted, name);
}

void RecoveredGradient::at_nodes(const Side& side, std::span<const LocalIndex> wanted) {
  const NodeElements around = node_elements(side.mesh, wanted);
  const std::vector<ElementAt> elements = elements_of(side.mesh);
  std::vector<LocalIndex> nodes;
  std::vector<Vec3> sums;
  for (const LocalIndex i : wanted) {
    nodes.clear();
    for (const NodeElements::Entry& at : around.around(i)) {
      const auto of_element = elements[static_cast<std::size_t>(at.element)].nodes();
      nodes.insert(nodes.end(), of_element.begin(), of_element.end());
    }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    sums.assign(nodes.size(), Vec3{});
    double volume = 0;
    for (const NodeElements::Entry& at : around.around(i)) {
      const ElementAt& element = elements[static_cast<std::size_t>(at.element)];
      const CentreGradients centre =
          centre_gradients(element.block->kind, corners_of(*element.block, element.element, side.coordinates));
      volume += centre.volume;
      const auto of_element = element.nodes();
      for (std::size_t a = 0; a < of_element.size(); ++a) {
        const auto k = std::lower_bound(nodes.begin(), nodes.end(), of_element[a]) - nodes.begin();
        Vec3& sum = sums[static_cast<std::size_t>(k)];
        sum = sum + centre.volume * centre.gradient[a];
      }
    }
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < nodes.size(); ++k) {
        rows_.column.push_back(nodes[k]);
        rows_.value.push_back(volume > 0 ? sums[k][c] / volume : 0.0);
      }
      rows_.begin.push_back(static_cast<std::int64_t>(rows_.column.size()));
    }
  }
}

void RecoveredGradient::in_elements(const Side& side, std::span<const LocalIndex> wanted, const std::string& name) {
  const Communicator& comm = side.mesh.comm;
  const std::vector<ElementAt> elements = elements_of(side.mesh);
  // The nodes of wanted elements ask their owners for means.
  SlotTable asked;
  const auto owner = [&](LocalIndex n) { return side.nodes.owners[static_cast<std::size_t>(n)]; };
  const auto at_owner = [&](LocalIndex n) { return side.nodes.at_owner[static_cast<std::size_t>(n)]; };
  for (const LocalIndex e : wanted)
    for (const LocalIndex n : elements[static_cast<std::size_t>(e)].nodes()) asked.mark(owner(n), at_owner(n));
  asked.number();
  means_ = ExchangePlan::to_ranks(comm, asked.owners(), name);
  std::vector<LocalIndex> nodes(static_cast<std::size_t>(means_.received()));
  means_.forward(std::span<const LocalIndex>(asked.indices()), std::span<LocalIndex>(nodes));

  const NodeElements around = node_elements(side.mesh, nodes);
  std::vector<Vec3> mean_places;
  for (const LocalIndex n : nodes) {
    double volume = 0;
    Vec3 place{};
    const std::size_t first = rows_.column.size();
    for (const NodeElements::Entry& at : around.around(n)) {
      const ElementAt& element = elements[static_cast<std::size_t>(at.element)];
      const Corners corners = corners_of(*element.block, element.element, side.coordinates);
      const double weight = centre_gradients(element.block->kind, corners).volume;
      rows_.column.push_back(at.element);
      rows_.value.push_back(weight);
      volume += weight;
      place = place + weight * centre_of(element.block->kind, corners);
    }
    for (std::size_t k = first; k < rows_.value.size(); ++k)
      rows_.value[k] = volume > 0 ? rows_.value[k] / volume : 0.0;
    rows_.begin.push_back(static_cast<std::int64_t>(rows_.column.size()));
    mean_places.push_back(volume > 0 ? 1 / volume * place : side.coordinates[static_cast<std::size_t>(n)]);
  }
  std::vector<Vec3> places(asked.owners().size());
  means_.reverse(std::span<const Vec3>(mean_places), std::span<Vec3>(places));

  std::vector<Vec3> d;
  for (const LocalIndex e : wanted) {
    const ElementAt& element = elements[static_cast<std::size_t>(e)];
    const Vec3 centre = centre_of(element.block->kind, corners_of(*element.block, element.element, side.coordinates));
    d.clear();
    for (const LocalIndex n : element.nodes()) {
      const LocalIndex slot = asked.slot(owner(n), at_owner(n));
      d.push_back(places[static_cast<std::size_t>(slot)] - centre);
      parts_.push_back({slot, {}});
    }
    const std::array<Vec3, 3> inverse = inverse_of_normal_matrix(d);
    for (std::size_t a = 0; a < d.size(); ++a)
      parts_[first_part_.back() + a].weight = {dot(inverse[0], d[a]), dot(inverse[1], d[a]), dot(inverse[2], d[a])};
    first_part_.push_back(parts_.size());
  }
}

void RecoveredGradient::apply(std::span<const double> values, std::span<Vec3> gradients) const {
  product_.resize(rows_.size());
  rows_.multiply(values, product_, 1);
  if (by_node_) {
    for (std::size_t k = 0; k < wanted_.size(); ++k)
      gradients[static_cast<std::size_t>(wanted_[k])] = {product_[3 * k], product_[3 * k + 1], product_[3 * k + 2]};
    return;
  }
  LocalIndex greatest = no_index;
  for (const Part& part : parts_) greatest = std::max(greatest, part.mean);
  arrived_.resize(static_cast<std::size_t>(greatest + 1));
  means_.reverse(std::span<const double>(product_), std::span<double>(arrived_));
  for (std::size_t k = 0; k < wanted_.size(); ++k) {
    const auto e = static_cast<std::size_t>(wanted_[k]);
    Vec3 g{};
    for (std::size_t p = first_part_[k]; p < first_part_[k + 1]; ++p)
      g = g + (arrived_[static_cast<std::size_t>(parts_[p].mean)] - values[e]) * parts_[p].weight;
    gradients[e] = g;
  }
}

}  // namespace tenon::transfer
