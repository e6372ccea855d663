// SPDX-License-Identifier: BSD-3-Clause
#include "components/contact/enforcement.hpp"

#include <algorithm>
#include <cmath>

namespace tenon::contact {

namespace {

constexpr int least_iterations = 4, check_interval = 4, greatest_iterations = 120;
// Of the greatest impulse: what is left is a ten-thousandth of what contact does in the step.
constexpr double tolerance = 1e-4;

Vec3 times(const std::array<double, 9>& m, const Vec3& a) {
  return {m[0] * a[0] + m[1] * a[1] + m[2] * a[2], m[3] * a[0] + m[4] * a[1] + m[5] * a[2],
          m[6] * a[0] + m[7] * a[1] + m[8] * a[2]};
}

Vec3 transposed_times(const std::array<double, 9>& m, const Vec3& a) {
  return {m[0] * a[0] + m[3] * a[1] + m[6] * a[2], m[1] * a[0] + m[4] * a[1] + m[7] * a[2],
          m[2] * a[0] + m[5] * a[1] + m[8] * a[2]};
}

Vec3 by_component(const Vec3& a, const Vec3& b) {
  return {a[0] * b[0], a[1] * b[1], a[2] * b[2]};
}

double greatest_row(const std::array<double, 9>& m) {
  double greatest = 0;
  for (std::size_t r = 0; r < 9; r += 3)
    greatest = std::max(greatest, std::abs(m[r]) + std::abs(m[r + 1]) + std::abs(m[r + 2]));
  return greatest;
}

double frobenius(const std::array<double, 9>& m) {
  double sum = 0;
  for (const double v : m) sum += v * v;
  return std::sqrt(sum);
}

/// |coefficient| of a node with the couple counted in.
double coefficient(const Constraint& q, std::size_t i) {
  return std::abs(q.c[i]) + (q.couple ? frobenius(q.turn) * norm(q.arm[i]) : 0.0);
}

/// The impulse in Coulomb's cone nearest to what the gradient step asks for.
Vec3 project(const Constraint& q, const Vec3& wanted, bool& sticks) {
  sticks = q.tied;
  if (q.tied) return wanted;
  const double n = dot(wanted, q.normal);
  if (!(n > 0)) return {};
  const Vec3 normal = n * q.normal;
  if (q.static_coefficient == 0) {
    return normal;
  }
  const Vec3 t = wanted - normal;
  const double length = norm(t);
  sticks = length <= q.static_coefficient * n;
  if (sticks) return wanted;
  return normal + (q.kinetic_coefficient * n / length) * t;
}

}  // namespace

Vec3 share(const Constraint& q, std::size_t i, const Vec3& p) {
  Vec3 result = q.c[i] * p;
  if (q.couple) result = result + cross(times(q.turn, p), q.arm[i]);
  return result;
}

Vec3 relative_velocity(const Constraint& q, std::span<const Vec3> v, std::span<const Body> bodies,
                       const Vec3& surface_velocity) {
  Vec3 u{}, turning{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(q.nodes); ++i) {
    const Vec3& vi = v[static_cast<std::size_t>(q.node[i])];
    u = u + q.c[i] * vi;
    if (q.couple) turning = turning + cross(q.arm[i], vi);
  }
  if (q.couple) u = u + transposed_times(q.turn, turning);
  u = u - surface_velocity;
  if (q.body >= 0) u = u - bodies[static_cast<std::size_t>(q.body)].state.velocity;
  return u;
}

// Minimum-norm forces theta x r on the supporting nodes with the moment -(sum c x) x p: theta = -J^-1 (a x p) with
// J = sum |r|^2 I - r r^T about their mean.
void balance_moments(Constraint& q, std::span<const NodeState> nodes, std::size_t support) {
  const auto count = static_cast<std::size_t>(q.nodes);
  Vec3 a{}, mean{};
  double extent = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3& x = nodes[static_cast<std::size_t>(q.node[i])].place;
    a = a + q.c[i] * (x - nodes[static_cast<std::size_t>(q.node[0])].place);
    if (i >= support) mean = mean + x;
  }
  q.couple = false;
  if (a == Vec3{} || count <= support) return;
  mean = (1 / static_cast<double>(count - support)) * mean;
  std::array<double, 9> j{};
  for (std::size_t i = 0; i < count; ++i) {
    q.arm[i] = {};
    if (i < support) continue;
    const Vec3 r = nodes[static_cast<std::size_t>(q.node[i])].place - mean;
    q.arm[i] = r;
    const double rr = dot(r, r);
    extent += rr;
    for (std::size_t row = 0; row < 3; ++row)
      for (std::size_t col = 0; col < 3; ++col) j[3 * row + col] += (row == col ? rr : 0.0) - r[row] * r[col];
  }
  const Vec3 c0 = cross({j[3], j[4], j[5]}, {j[6], j[7], j[8]});
  const Vec3 c1 = cross({j[6], j[7], j[8]}, {j[0], j[1], j[2]});
  const Vec3 c2 = cross({j[0], j[1], j[2]}, {j[3], j[4], j[5]});
  const double det = j[0] * c0[0] + j[1] * c0[1] + j[2] * c0[2];
  if (!(det > 1e-12 * extent * extent * extent)) return;  // all on a line: nothing can take a couple about it
  // inverse = (columns c0, c1, c2) / det; turn = -inverse [a]x.
  const std::array<double, 9> inverse{c0[0] / det, c1[0] / det, c2[0] / det, c0[1] / det, c1[1] / det,
                                      c2[1] / det, c0[2] / det, c1[2] / det, c2[2] / det};
  const std::array<double, 9> skew{0, -a[2], a[1], a[2], 0, -a[0], -a[1], a[0], 0};
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t col = 0; col < 3; ++col) {
      double sum = 0;
      for (std::size_t k = 0; k < 3; ++k) sum += inverse[3 * row + k] * skew[3 * k + col];
      q.turn[3 * row + col] = -sum;
    }
  q.couple = true;
}

// Which constraints each node that this rank sums for is in, ascending.
void Enforcement::connect(std::span<const Constraint> constraints) {
  const auto nodes = static_cast<std::size_t>(set_.nodes());
  first_.assign(nodes + 1, 0);
  const auto for_uses = [&](auto visit) {
    for (std::size_t q = 0; q < constraints.size(); ++q)
      for (std::int32_t i = 0; i < constraints[q].nodes; ++i) {
        const LocalIndex n = constraints[q].node[static_cast<std::size_t>(i)];
        if (set_.sums(n)) visit(static_cast<std::size_t>(n), static_cast<std::int32_t>(q), i);
      }
  };
  for_uses([&](std::size_t n, std::int32_t, std::int32_t) { ++first_[n + 1]; });
  for (std::size_t n = 0; n < nodes; ++n) first_[n + 1] += first_[n];
  uses_.resize(static_cast<std::size_t>(first_[nodes]));
  for_uses([&](std::size_t n, std::int32_t q, std::int32_t i) {
    uses_[static_cast<std::size_t>(first_[n]++)] = {q, i};
  });
  for (std::size_t n = nodes; n > 0; --n) first_[n] = first_[n - 1];
  first_[0] = 0;
  used_.clear();
  for (std::size_t n = 0; n < nodes; ++n)
    if (first_[n] < first_[n + 1]) used_.push_back(n);
  if (comm_.size() > 1) agree(constraints);
}

// Whoever has a constraint has all that led to it, so all of them know it: the rank that sums for one of its nodes,
// what the others iterate with, and these, what comes. Nodes that only may touch wait until the iteration is over.
void Enforcement::agree(std::span<const Constraint> constraints) {
  send_.clear(), receive_.clear();
  for (const Constraint& q : constraints)
    for (std::int32_t i = 0; i < q.nodes; ++i) {
      const LocalIndex n = q.node[static_cast<std::size_t>(i)];
      if (!set_.sums(n))
        receive_.push_back({set_.part(n), n});
      else
        for (const std::int32_t rank : set_.others_with(static_cast<std::size_t>(q.pair))) send_.push_back({rank, n});
    }
  for (std::vector<AgreedExchange::Item>* items : {&send_, &receive_}) {  // indices ascend as the ids of nodes do
    std::ranges::sort(*items);
    items->erase(std::unique(items->begin(), items->end()), items->end());
  }
  iteration_.agree(send_, receive_);
}

double Enforcement::weight(const NodeState& node, std::span<const Body> bodies) const {
  if (node.mobility.body >= 0) {
    const ContactRigidBody& body = bodies[static_cast<std::size_t>(node.mobility.body)].state;
    const Vec3 r = node.place - body.pivot;
    return std::max({body.inverse_mass[0], body.inverse_mass[1], body.inverse_mass[2]}) +
           dot(r, r) * greatest_row(body.inverse_inertia);
  }
  const std::array<double, 6>& w = node.mobility.w;
  return std::max({std::abs(w[0]) + std::abs(w[3]) + std::abs(w[5]), std::abs(w[3]) + std::abs(w[1]) + std::abs(w[4]),
                   std::abs(w[5]) + std::abs(w[4]) + std::abs(w[2])});
}

void Enforcement::precondition(std::span<Constraint> constraints, std::span<const NodeState> nodes,
                               std::span<const Body> bodies, std::span<const double> guess) {
  const auto amount = [&](std::size_t q) { return guess.empty() ? 1.0 : guess[q]; };
  crowd_.assign(nodes.size(), 0.0);
  for (const std::size_t n : used_)
    for (std::int32_t k = first_[n]; k < first_[n + 1]; ++k) {
      const Use use = uses_[static_cast<std::size_t>(k)];
      const auto q = static_cast<std::size_t>(use.constraint);
      crowd_[n] += amount(q) * coefficient(constraints[q], static_cast<std::size_t>(use.slot));
    }
  iteration_.forward<double>(crowd_);
  std::vector<double> body_crowd(bodies.size());
  if (has_bodies_) {  // all that touch a body share it
    std::vector<ExactSum> sums(bodies.size());
    for (std::size_t q = 0; q < constraints.size(); ++q) {
      if (amount(q) == 0 || !set_.pairs()[static_cast<std::size_t>(constraints[q].pair)].primary) continue;
      for (std::int32_t i = 0; i < constraints[q].nodes; ++i) {
        const auto slot = static_cast<std::size_t>(i);
        const std::int32_t body = nodes[static_cast<std::size_t>(constraints[q].node[slot])].mobility.body;
        if (body >= 0) sums[static_cast<std::size_t>(body)].add(amount(q) * coefficient(constraints[q], slot));
      }
      if (constraints[q].body >= 0) sums[static_cast<std::size_t>(constraints[q].body)].add(amount(q));
    }
    comm_.sum(sums, body_crowd);
  }
  for (std::size_t q = 0; q < constraints.size(); ++q) {
    Constraint& constraint = constraints[q];
    double k = 0;
    for (std::int32_t i = 0; i < constraint.nodes; ++i) {
      const auto slot = static_cast<std::size_t>(i);
      const auto n = static_cast<std::size_t>(constraint.node[slot]);
      const std::int32_t body = nodes[n].mobility.body;
      k += coefficient(constraint, slot) * (body >= 0 ? body_crowd[static_cast<std::size_t>(body)] : crowd_[n]) *
           weight(nodes[n], bodies);
    }
    if (constraint.body >= 0) {
      const Body& body = bodies[static_cast<std::size_t>(constraint.body)];
      const Vec3& m = body.state.inverse_mass;
      k += body_crowd[static_cast<std::size_t>(constraint.body)] * std::max({m[0], m[1], m[2]});
    }
    constraint.inverse = k > 0 ? amount(q) / k : 0;
  }
}

/// Velocities by given impulses of all constraints, of the nodes that are in one here.
template <typename Impulse>
void Enforcement::move(std::span<const Constraint> constraints, std::span<const NodeState> nodes,
                       std::vector<Body>& bodies, Impulse impulse) {
  for (const std::size_t n : used_) {
    Vec3 sum{};
    for (std::int32_t k = first_[n]; k < first_[n + 1]; ++k) {
      const Use use = uses_[static_cast<std::size_t>(k)];
      const Constraint& q = constraints[static_cast<std::size_t>(use.constraint)];
      sum = sum + share(q, static_cast<std::size_t>(use.slot), impulse(q));
    }
    sum_[n] = sum;
    velocity_[n] = nodes[n].velocity + moved(nodes[n].mobility, sum);
  }
  if (has_bodies_) {
    std::vector<ExactSum> sums(6 * bodies.size());
    const auto add = [&](std::int32_t body, const Vec3& p, const Vec3& r) {
      const Vec3 l = cross(r, p);
      for (std::size_t c = 0; c < 3; ++c) {
        sums[6 * static_cast<std::size_t>(body) + c].add(p[c]);
        sums[6 * static_cast<std::size_t>(body) + 3 + c].add(l[c]);
      }
    };
    for (const std::size_t n : used_)
      if (nodes[n].mobility.body >= 0)
        add(nodes[n].mobility.body, sum_[n],
            nodes[n].place - bodies[static_cast<std::size_t>(nodes[n].mobility.body)].state.pivot);
    for (const Constraint& q : constraints)
      if (q.body >= 0 && set_.pairs()[static_cast<std::size_t>(q.pair)].primary) add(q.body, -1.0 * impulse(q), {});
    std::vector<double> totals(sums.size());
    comm_.sum(sums, totals);
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      std::copy_n(totals.begin() + static_cast<std::ptrdiff_t>(6 * b), 3, bodies[b].impulse.linear.begin());
      std::copy_n(totals.begin() + static_cast<std::ptrdiff_t>(6 * b + 3), 3, bodies[b].impulse.angular.begin());
    }
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      if (nodes[n].mobility.body < 0) continue;
      const Body& body = bodies[static_cast<std::size_t>(nodes[n].mobility.body)];
      velocity_[n] = nodes[n].velocity + by_component(body.state.inverse_mass, body.impulse.linear) +
                     cross(times(body.state.inverse_inertia, body.impulse.angular), nodes[n].place - body.state.pivot);
    }
  }
  iteration_.forward<Vec3>(velocity_);
}

Enforcement::Change Enforcement::iterate(std::span<Constraint> constraints, std::span<const Body> bodies, double beta) {
  Change found;
  for (Constraint& q : constraints) {
    if (q.inverse == 0) {  // nothing can move
      q.impulse = q.extrapolated = {};
      continue;
    }
    Vec3 plain{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(q.nodes); ++i)
      plain = plain + q.c[i] * velocity_[static_cast<std::size_t>(q.node[i])];
    plain = plain - q.surface_velocity;
    if (q.body >= 0) {
      const Body& body = bodies[static_cast<std::size_t>(q.body)];
      plain = plain - (body.state.velocity + by_component(body.state.inverse_mass, body.impulse.linear));
    }
    Vec3 residual = (dot(plain, q.normal) - q.target) * q.normal;
    if (q.static_coefficient > 0 || q.tied) {
      Vec3 u = plain;
      if (q.couple) {
        Vec3 turning{};
        for (std::size_t i = 0; i < static_cast<std::size_t>(q.nodes); ++i)
          turning = turning + cross(q.arm[i], velocity_[static_cast<std::size_t>(q.node[i])]);
        u = u + transposed_times(q.turn, turning);
      }
      const Vec3 t = u - q.tangent_target;
      residual = residual + (t - dot(t, q.normal) * q.normal);
    }
    const Vec3 before = q.impulse;
    if (q.softness > 0) residual = residual + (q.softness / q.inverse * dot(q.extrapolated, q.normal)) * q.normal;
    q.impulse = project(q, q.extrapolated - q.inverse * residual, q.sticks);
    found.change = std::max(found.change, norm(q.impulse - q.extrapolated) / q.inverse);
    found.size = std::max(found.size, norm(q.impulse) / q.inverse);
    q.extrapolated = q.impulse + beta * (q.impulse - before);
  }
  return found;
}

Enforcement::Report Enforcement::solve(std::span<Constraint> constraints, std::span<const NodeState> nodes,
                                       std::vector<Body>& bodies) {
  has_bodies_ = !bodies.empty() && comm_.any(std::ranges::any_of(constraints, [&](const Constraint& q) {
    return q.body >= 0 || std::any_of(q.node.begin(), q.node.begin() + q.nodes, [&](LocalIndex n) {
             return nodes[static_cast<std::size_t>(n)].mobility.body >= 0;
           });
  }));
  velocity_.resize(nodes.size());
  for (std::size_t n = 0; n < nodes.size(); ++n) velocity_[n] = nodes[n].velocity;
  sum_.assign(nodes.size(), Vec3{});
  connect(constraints);
  precondition(constraints, nodes, bodies, {});
  for (Constraint& q : constraints) q.extrapolated = q.impulse;
  Report report;
  double t = 1;
  for (int iteration = 1; iteration <= greatest_iterations; ++iteration) {
    move(constraints, nodes, bodies, [](const Constraint& q) { return q.extrapolated; });
    const double next = 0.5 * (1 + std::sqrt(1 + 4 * t * t));
    const Change found = iterate(constraints, bodies, (t - 1) / next);
    t = next;
    report.iterations = iteration;
    if (iteration < least_iterations || iteration % check_interval != 0) continue;
    std::array<double, 2> greatest{found.change, found.size};
    comm_.max(std::span<double>(greatest));
    report.residual = greatest[0];
    if (greatest[0] <= tolerance * greatest[1]) break;
  }
  move(constraints, nodes, bodies, [](const Constraint& q) { return q.impulse; });
  set_.halo().forward<Vec3>(velocity_, velocity_);
  for (const Constraint& q : constraints) set_.count_visits(static_cast<std::size_t>(q.pair), report.iterations);
  return report;
}

// p (u- + u + k p)/2 + p (u - u*)/2 = E with u by the impulses so far and u* without any:
// p = (sqrt(s^2 + 8 k E) - s)/(2 k), s = u- + 2 u - u*. For any g > 0, k_q = (|C| M^-1 |C|^T g)_q / g_q bounds what all
// do together: sum p k p >= p |C| M^-1 |C|^T p, with equality where g = p. So each guess is as safe, and the next loses
// less.
void Enforcement::release(std::span<Constraint> constraints, std::span<const NodeState> nodes,
                          std::vector<Body>& bodies, std::span<const Release> releases) {
  constexpr int guesses = 2;
  guess_.resize(constraints.size()), pace_.resize(constraints.size());
  for (std::size_t q = 0; q < constraints.size(); ++q) {
    const Constraint& constraint = constraints[q];
    guess_[q] = releases[q].energy > 0 ? 1 : 0;
    if (guess_[q] == 0) continue;
    Vec3 u = relative_velocity(constraint, velocity_, bodies, constraint.surface_velocity);
    if (constraint.body >= 0) {
      const Body& body = bodies[static_cast<std::size_t>(constraint.body)];
      u = u - by_component(body.state.inverse_mass, body.impulse.linear);
    }
    pace_[q] = releases[q].former + 2 * dot(u, constraint.normal) - releases[q].free;
  }
  for (int pass = 0; pass < guesses; ++pass) {
    precondition(constraints, nodes, bodies, guess_);
    for (std::size_t q = 0; q < constraints.size(); ++q) {
      const double inverse = constraints[q].inverse, s = pace_[q];
      if (guess_[q] == 0) continue;
      guess_[q] = 0.5 * inverse * (std::sqrt(s * s + (inverse > 0 ? 8 * releases[q].energy / inverse : 0)) - s);
    }
  }
  for (std::size_t q = 0; q < constraints.size(); ++q)
    if (guess_[q] != 0) constraints[q].impulse = constraints[q].impulse + guess_[q] * constraints[q].normal;
  move(constraints, nodes, bodies, [](const Constraint& q) { return q.impulse; });
  set_.halo().forward<Vec3>(velocity_, velocity_);
}

}  // namespace tenon::contact
