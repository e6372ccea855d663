// SPDX-License-Identifier: BSD-3-Clause
#include "transfer/mass_matrix.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "transfer/element_points.hpp"

namespace tenon::transfer {

namespace {

/// By which the error of the worst mode is reduced: 14 iterations for hexahedra, 6 for tetrahedra. What is solved for
/// are corrections of second order, so a hundredth of them is beyond notice: of a wave that has gone to and fro a
/// thousand times, 1e-5 gave the same to three digits.
constexpr double reduction = 1e-2;

/// Least eigenvalue of D^-1 M of one element, D the sums of rows of M; a bound for any mesh of such elements [Wat87].
/// (Where an element is so distorted that it has a smaller one, Chebyshev polynomials still lie between 0 and 1 there:
/// the mode converges more slowly.) Products of 1/3 for a line, 1/4 for a triangle, 1/5 for a tetrahedron.
double least_eigenvalue(ElementKind kind) {
  switch (kind) {
    case ElementKind::tet4:
      return 1. / 5;
    case ElementKind::wedge6:
      return 1. / 12;
    case ElementKind::tri3:
      return 1. / 4;
    case ElementKind::quad4:
      return 1. / 9;
    case ElementKind::pyramid5:
      return 4. / 45;  // of the rational functions, found numerically
    default:
      return 1. / 27;
  }
}

/// How many iterations reduce the error so far: 1 / T_k((1 + a) / (1 - a)) on the spectrum [a, 1].
int iterations_for(double least) {
  return static_cast<int>(std::ceil(std::acosh(1 / reduction) / std::acosh((1 + least) / (1 - least))));
}

}  // namespace

namespace {

template <typename Wanted>
NodeElements elements_around(const Mesh& mesh, Wanted wanted) {
  NodeElements result;
  result.begin.assign(static_cast<std::size_t>(mesh.nodes()) + 1, 0);
  for (const ElementBlock& block : mesh.blocks)
    for (const LocalIndex n : block.connectivity) result.begin[static_cast<std::size_t>(n) + 1] += wanted(n);
  for (std::size_t n = 1; n < result.begin.size(); ++n) result.begin[n] += result.begin[n - 1];
  result.entries.resize(result.begin.back());
  std::vector<std::size_t> next(result.begin.begin(), result.begin.end() - 1);
  for_each_element(mesh, [&](LocalIndex item, const ElementBlock& block, LocalIndex e) {
    const auto nodes = block.nodes(e);
    for (std::size_t a = 0; a < nodes.size(); ++a)
      if (wanted(nodes[a]))
        result.entries[next[static_cast<std::size_t>(nodes[a])]++] = {item, static_cast<std::int32_t>(a)};
  });
  return result;
}

}  // namespace

NodeElements node_elements(const Mesh& mesh) {
  return elements_around(mesh, [](LocalIndex) { return true; });
}

NodeElements node_elements(const Mesh& mesh, std::span<const LocalIndex> nodes) {
  std::vector<char> wanted(static_cast<std::size_t>(mesh.nodes()), 0);
  for (const LocalIndex n : nodes) wanted[static_cast<std::size_t>(n)] = 1;
  return elements_around(mesh, [&](LocalIndex n) { return wanted[static_cast<std::size_t>(n)] != 0; });
}

MassMatrix::MassMatrix(const Side& side, const NodeElements& around) : mesh_(&side.mesh) {
  for (const ElementBlock& block : side.mesh.blocks)
    if (block.global_count > 0) least_ = std::min(least_, least_eigenvalue(block.kind));
  iterations_ = least_ < 1 ? iterations_for(least_) : 0;

  std::vector<std::span<const LocalIndex>> nodes_of;
  nodes_of.reserve(static_cast<std::size_t>(side.mesh.elements()));
  for_each_element(side.mesh,
                   [&](LocalIndex, const ElementBlock& block, LocalIndex e) { nodes_of.push_back(block.nodes(e)); });
  std::vector<LocalIndex> neighbours;
  rows_.begin.reserve(side.mesh.owned_nodes.size() + 1);
  for (const LocalIndex i : side.mesh.owned_nodes) {
    neighbours.clear();
    for (const NodeElements::Entry& at : around.around(i)) {
      const auto nodes = nodes_of[static_cast<std::size_t>(at.element)];
      neighbours.insert(neighbours.end(), nodes.begin(), nodes.end());
    }
    std::sort(neighbours.begin(), neighbours.end());
    neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
    rows_.column.insert(rows_.column.end(), neighbours.begin(), neighbours.end());
    rows_.begin.push_back(static_cast<std::int64_t>(rows_.column.size()));
  }
  fill(side);
}

void MassMatrix::fill(const Side& side) {
  std::vector<LocalIndex> row_of(static_cast<std::size_t>(side.mesh.nodes()), no_index);
  for (std::size_t k = 0; k < side.mesh.owned_nodes.size(); ++k)
    row_of[static_cast<std::size_t>(side.mesh.owned_nodes[k])] = static_cast<LocalIndex>(k);
  std::vector<double> value(rows_.column.size(), 0.0);
  for (const ElementBlock& block : side.mesh.blocks) {
    const PointTable table(block.kind, quadrature_points(block.kind));
    std::vector<double> weights(table.points().size());
    for (LocalIndex e = 0; e < block.size(); ++e) {
      const Corners corners = corners_of(block, e, side.coordinates);
      const auto nodes = block.nodes(e);
      std::array<std::array<double, max_linear_nodes>, max_linear_nodes> mass{};
      table.volumes(corners, weights);
      for (std::size_t q = 0; q < weights.size(); ++q) {
        const std::array<double, max_nodes>& shape = table.points()[q].value;
        for (std::size_t a = 0; a < nodes.size(); ++a)
          for (std::size_t b = 0; b < max_linear_nodes; ++b) mass[a][b] += weights[q] * shape[a] * shape[b];
      }
      for (std::size_t a = 0; a < nodes.size(); ++a) {
        const LocalIndex row = row_of[static_cast<std::size_t>(nodes[a])];
        if (row == no_index) continue;
        const auto first =
            rows_.column.begin() + static_cast<std::ptrdiff_t>(rows_.first(static_cast<std::size_t>(row)));
        const auto last = rows_.column.begin() + static_cast<std::ptrdiff_t>(rows_.last(static_cast<std::size_t>(row)));
        for (std::size_t b = 0; b < nodes.size(); ++b)
          value[static_cast<std::size_t>(std::lower_bound(first, last, nodes[b]) - rows_.column.begin())] += mass[a][b];
      }
    }
  }
  rows_.value.assign(value.begin(), value.end());
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    double sum = 0;
    for (std::size_t k = rows_.first(i); k < rows_.last(i); ++k) sum += double{rows_.value[k]};
    lumped_.push_back(sum);
  }
}

// Algorithm 12.1 of [Saa03] on D^-1 M with the spectrum [least, 1], as in [WR09].
void MassMatrix::solve(std::span<const double> r, std::span<double> d, int components) const {
  const auto width = static_cast<std::size_t>(components);
  const std::size_t owned = rows_.size();
  residual_.resize(owned * width), product_.resize(owned * width);
  step_.resize(static_cast<std::size_t>(mesh_->nodes()) * width);
  const double middle = (1 + least_) / 2, half = (1 - least_) / 2, sigma = middle / half;
  const auto for_each = [&](auto&& visit) {
    for (std::size_t k = 0; k < owned; ++k) {
      const std::size_t to = static_cast<std::size_t>(mesh_->owned_nodes[k]) * width;
      for (std::size_t c = 0; c < width; ++c) visit(k, k * width + c, to + c);
    }
  };
  for_each([&](std::size_t k, std::size_t row, std::size_t node) {
    residual_[row] = lumped_[k] > 0 ? r[row] / lumped_[k] : 0.0;
    step_[node] = residual_[row] / middle;
    d[node] = 0;
  });
  double rho = 1 / sigma;
  for (int iteration = 0; iteration < iterations_; ++iteration) {
    if (mesh_->comm.size() > 1)
      mesh_->node_halo.forward(std::span<const double>(step_), std::span<double>(step_), components);
    rows_.multiply(step_, product_, components);
    const double next = 1 / (2 * sigma - rho);
    for_each([&](std::size_t k, std::size_t row, std::size_t node) {
      d[node] += step_[node];
      if (lumped_[k] > 0) residual_[row] -= product_[row] / lumped_[k];
      step_[node] = next * rho * step_[node] + 2 * next / half * residual_[row];
    });
    rho = next;
  }
  for_each([&](std::size_t, std::size_t row, std::size_t node) { d[node] += residual_[row]; });
}

std::int64_t MassMatrix::memory() const {
  std::int64_t bytes = rows_.memory();
  for (const auto& v : {std::cref(lumped_), std::cref(std::as_const(residual_)), std::cref(std::as_const(step_)),
                        std::cref(std::as_const(product_))})
    bytes += static_cast<std::int64_t>(v.get().capacity() * sizeof(double));
  return bytes;
}

}  // namespace tenon::transfer
