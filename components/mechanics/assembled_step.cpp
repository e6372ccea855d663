// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/assembled_step.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace tenon {

namespace {

std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x ^= x >> 30, x *= 0xbf58476d1ce4e5b9u;
  x ^= x >> 27, x *= 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// Between -1 and 1, by place and direction (splitmix64 [SLF14]): the same whatever the numbering.
double random_value(const Vec3& place, std::uint64_t direction) {
  std::uint64_t x = direction;
  for (const double c : place) x = mixed(x ^ std::bit_cast<std::uint64_t>(c));
  return static_cast<double>(x >> 11) * 0x1p-52 - 1;
}

/// Whether all eigenvalues of the tridiagonal matrix are below x (Sturm's sequence).
bool all_below(const std::vector<double>& diagonal, const std::vector<double>& beside, double x) {
  double pivot = 1;
  for (std::size_t i = 0; i < diagonal.size(); ++i) {
    const double coupling = i == 0 ? 0 : beside[i - 1] * beside[i - 1] / pivot;
    pivot = x - diagonal[i] - coupling;
    if (!(pivot > 0)) return false;
  }
  return true;
}

}  // namespace

RitzValue greatest_ritz_value(const std::vector<double>& diagonal, const std::vector<double>& beside) {
  const std::size_t n = diagonal.size();
  double low = *std::max_element(diagonal.begin(), diagonal.end()), high = low;
  for (std::size_t i = 0; i < n; ++i)
    high = std::max(high, diagonal[i] + (i > 0 ? std::abs(beside[i - 1]) : 0) + (i + 1 < n ? std::abs(beside[i]) : 0));
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (all_below(diagonal, beside, middle) ? high : low) = middle;
  }
  // Eigenvector by the recurrence from the first component on.
  double previous = 0, now = 1, squares = 1;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const double next = ((high - diagonal[i]) * now - (i > 0 ? beside[i - 1] * previous : 0)) / beside[i];
    previous = now, now = next;
    squares += next * next;
    if (squares > 1e200) previous *= 1e-100, now *= 1e-100, squares *= 1e-200;
  }
  return {high, std::abs(now) / std::sqrt(squares)};
}

AssembledStep::AssembledStep(const Mesh& mesh, const NodalState& nodes)
    : mesh_(mesh),
      before_(nodes.size()),
      now_(nodes.size()),
      scaled_(nodes.size() + 1),
      next_(nodes.size()),
      force_(nodes.size()) {}

void AssembledStep::start(const NodalState& nodes) {
  for (std::size_t n = 0; n < nodes.size(); ++n)
    for (std::size_t c = 0; c < 3; ++c) now_[n][c] = nodes.mass[n] > 0 ? random_value(mesh_.coordinates[n], c) : 0;
}

double AssembledStep::product(const std::vector<Vec3>& a, const std::vector<Vec3>& b) const {
  ExactSum sum;
  for (const LocalIndex n : mesh_.owned_nodes) {
    const auto i = static_cast<std::size_t>(n);
    sum.add(dot(a[i], b[i]));
  }
  return mesh_.comm.sum(sum);
}

// next = M^-1/2 (stiffness K + damping C) M^-1/2 now, on owned nodes.
void AssembledStep::multiply(NodalState& nodes, const ElementGroups& groups, double stiffness, double damping) {
  const auto root = [&](std::size_t n) { return std::sqrt(nodes.inverse_mass[n]); };
  for (const LocalIndex n : mesh_.owned_nodes) {
    const auto i = static_cast<std::size_t>(n);
    scaled_[i] = root(i) * now_[i];
  }
  mesh_.node_halo.forward<Vec3>(std::span(scaled_).first(nodes.size()), std::span(scaled_).first(nodes.size()));
  std::fill(force_.begin(), force_.end(), ForceRow{});
  for (const auto& group : groups)
    group->add_product(nodes.arrays(), scaled_.data()->data(), stiffness, damping, force_.data());
  for (const LocalIndex n : mesh_.owned_nodes) {
    const auto i = static_cast<std::size_t>(n);
    next_[i] = root(i) * Vec3{force_[i].v[0], force_[i].v[1], force_[i].v[2]};
  }
  ++products_;
}

double AssembledStep::find(NodalState& nodes, const ElementGroups& groups, double bound) {
  constexpr int most = 80, look_every = 4;
  constexpr double tolerance = 0.01;
  std::vector<double> diagonal, beside;
  products_ = 0;
  start(nodes);
  double size = std::sqrt(product(now_, now_));
  if (!(size > 0)) return bound;
  for (Vec3& v : now_) v = (1 / size) * v;
  std::fill(before_.begin(), before_.end(), Vec3{});
  double eigenvalue = 1;
  for (int i = 0; i < most; ++i) {
    multiply(nodes, groups, 0.25 * bound * bound, 0.5 * bound);
    if (i > 0)
      for (const LocalIndex n : mesh_.owned_nodes) {
        const auto k = static_cast<std::size_t>(n);
        next_[k] = next_[k] - beside.back() * before_[k];
      }
    diagonal.push_back(product(next_, now_));
    for (const LocalIndex n : mesh_.owned_nodes) {
      const auto k = static_cast<std::size_t>(n);
      next_[k] = next_[k] - diagonal.back() * now_[k];
    }
    beside.push_back(std::sqrt(product(next_, next_)));
    const bool done = beside.back() < 1e-10 * diagonal.front() || i + 1 == most;
    if (done || i % look_every == look_every - 1) {
      const RitzValue ritz = greatest_ritz_value(diagonal, beside);
      const double residual = beside.back() * ritz.last;
      eigenvalue = ritz.value + residual;
      if (done || residual < tolerance * ritz.value) break;
    }
    for (const LocalIndex n : mesh_.owned_nodes) {
      const auto k = static_cast<std::size_t>(n);
      before_[k] = now_[k];
      now_[k] = (1 / beside.back()) * next_[k];
    }
  }
  // A step longer by s grows the stiffness part by s^2 and the damping part by s only.
  return bound / std::sqrt(std::min(eigenvalue, 1.0));
}

}  // namespace tenon
