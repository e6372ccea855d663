// SPDX-License-Identifier: BSD-3-Clause
// Which pairs can meet in a step, and the constraints that they make.
#include <algorithm>
#include <cmath>
#include <limits>

#include "components/contact/contact.hpp"
#include "components/contact_geometry/choose_touches.hpp"
#include "components/contact_geometry/closest_point.hpp"
#include "components/contact_geometry/edge_touch.hpp"

namespace tenon {

using namespace contact;

namespace {

// Of what is found to overlap in a step: gone in some ten steps, so that no node is shot out.
constexpr double removal_rate = 0.1;
// Of what friction failed to hold: likewise.
constexpr double return_rate = 0.1;
// Of the distance of interest: what is nearer is tied, if the pair is.
constexpr double touching = 0.02;
// Of the distance of interest: what is less is left to the next step when a stopped node is looked at again.
constexpr double negligible = 1e-3;

Vec3 tangential(const Vec3& a, const Vec3& normal) {
  return a - dot(a, normal) * normal;
}

}  // namespace

void Contact::find_constraints(double time, double dt) {
  const ScopedTimer timer(*phases_.touch);
  for (const Constraint& q : constraints_) constraint_of_pair_[static_cast<std::size_t>(q.pair)] = -1;
  constraints_.clear();
  again_ = false;
  touch_pairs(time, dt);
}

// A node that is stopped at one face may slide into another, which the way that it would have gone missed: ways are
// looked at again with the velocities that contact has found. Whether any constraint is new on this rank.
bool Contact::find_more(double time, double dt) {
  const ScopedTimer timer(*phases_.touch);
  const std::size_t before = constraints_.size();
  moved_.resize(state_.size());
  for (std::size_t n = 0; n < state_.size(); ++n) {
    const Vec3& v = enforcement_.velocities()[n];
    moved_[n] = v != state_[n].velocity ? 1 : 0;
    end_[n] = state_[n].place + dt * v;
  }
  again_ = true;
  touch_pairs(time, dt);
  for (std::size_t k = before; k < constraints_.size(); ++k) limit_removal(constraints_[k], dt);
  return constraints_.size() > before;
}

bool Contact::is_moved(std::size_t begin, std::size_t end) const {
  for (std::size_t q = begin; q < end; ++q)
    for (std::int32_t k = 0; k < set_.pairs()[q].nodes; ++k)
      if (moved_[static_cast<std::size_t>(set_.pairs()[q].node[static_cast<std::size_t>(k)])] != 0) return true;
  return false;
}

/// Pairs of which the first sides are the same node stand together; the others are alone.
void Contact::make_groups() {
  const std::vector<WorkingPair>& pairs = set_.pairs();
  groups_.clear();
  for (std::size_t begin = 0, end = 0; begin < pairs.size(); begin = end) {
    end = begin + 1;
    while (pairs[begin].key.kind == 0 && end < pairs.size() && pairs[end].key.kind == 0 &&
           pairs[end].key.ids[0] == pairs[begin].key.ids[0])
      ++end;
    groups_.push_back({begin, end});
  }
  wake_.assign(pairs.size(), 0.0), group_wake_.assign(groups_.size(), 0.0);
  constraint_of_pair_.assign(pairs.size(), -1);
  constraints_.clear();
  way_ = 0;
}

// A pair that is too far apart sleeps until the ways of all nodes since could have brought it together. What sleeps
// could not touch, so no answer depends on it.
void Contact::touch_pairs(double time, double dt) {
  const std::span<const Vec3> velocity = again_ ? enforcement_.velocities() : std::span<const Vec3>(predicted_);
  fastest_ = std::max(again_ ? fastest_ : 0.0, fastest(velocity, time, dt));
  const double reach = 2 * dt * fastest_;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const auto [begin, end] = groups_[g];
    if (group_wake_[g] > way_ + reach) continue;
    if (again_ && !is_moved(begin, end)) continue;
    for (std::size_t q = begin; q < end; ++q)
      if (wake_[q] <= way_ + reach) {
        wake_[q] = 0;
        if (set_.pairs()[q].memory.empty()) let_sleep(q, least_distance(set_.pairs()[q]), dt);
      }
    const auto wakes = [&] {
      return *std::min_element(wake_.begin() + static_cast<std::ptrdiff_t>(begin),
                               wake_.begin() + static_cast<std::ptrdiff_t>(end));
    };
    group_wake_[g] = wakes();
    if (group_wake_[g] > 0) continue;
    for (std::size_t q = begin; q < end; ++q)
      if (!(wake_[q] > 0)) set_.count_look(q), ++looks_;
    const std::int64_t kind = set_.pairs()[begin].key.kind;
    if (kind == 0)
      touch_faces(begin, end, dt);
    else if (again_ && constraint_of_pair_[begin] >= 0)
      continue;
    else if (kind == 1)
      touch_rigid(begin, time, dt);
    else if (kind == 2)
      touch_edges(begin, dt);
    else
      touch_balls(begin, dt);
    group_wake_[g] = wakes();
  }
}

/// Greatest speed of the nodes here and of rigid surfaces, beside what all have in common, m/s.
double Contact::fastest(std::span<const Vec3> velocity, double time, double dt) const {
  double squared = 0;
  const Vec3& common = search_.common();
  for (const Vec3& v : velocity) {
    const Vec3 own = v - common;
    squared = std::max(squared, dot(own, own));
  }
  for (const MovingSurface& surface : rigid_) {
    const Vec3 own = surface.velocity(time, dt) - common;
    squared = std::max(squared, dot(own, own));
  }
  constexpr double chords = 1.05;  // nodes of rigid bodies move by chords of their ways
  return chords * std::sqrt(squared);
}

/// Within this distance a pair is of interest, m.
double Contact::near_of(const WorkingPair& pair) const {
  return std::max(pair.clearance, 0.0) + pair.margin + pair.depth;
}

/// How far a node and a face are from being of interest at the start of the step, at least, m. A node in front of all
/// of a solid's face has to come near it, or behind its plane, before the depth behind it matters; that holds as long
/// as the face turns little.
double Contact::distance_to_face(const WorkingPair& pair, const Vec3& x, const FaceShape& face) const {
  const double distance = closest_point(face, x).distance, apart = distance - near_of(pair);
  if (pair.two_sided) return apart;
  constexpr double least_cosine = 0.5, greatest_turn = 0.1, rim = 2e-3;
  const Vec3 normal = face_normal(face, {0.25, 0.25, 0.25, 0.25});
  double front = std::numeric_limits<double>::infinity(), longest = 0, least_area = front;
  for (int k = 0; k < face.corners; ++k) {
    const auto at = [&](int i) { return face.x[static_cast<std::size_t>((k + i) % face.corners)]; };
    const Vec3 ahead = at(1) - at(0), back = at(face.corners - 1) - at(0), area = cross(ahead, back);
    if (!(dot(area, normal) > least_cosine * norm(area))) return apart;
    front = std::min(front, dot(normal, x - at(0)));
    longest = std::max(longest, norm(ahead)), least_area = std::min(least_area, norm(area));
  }
  const double near = std::max(pair.clearance, 0.0) + pair.margin + rim * longest;
  return std::max(apart, std::min({distance - near, front, greatest_turn * least_area / longest}));
}

/// A pair that is `apart` (m) from being of interest when the step begins need not be looked at until the ways of all
/// nodes have been as long.
void Contact::let_sleep(std::size_t pair, double apart, double dt) {
  wake_[pair] = apart > 2 * dt * fastest_ ? way_ + apart : 0.0;
}

/// How far the two are from being of interest, at least and by a look at their balls, at the start of the step, m.
double Contact::least_distance(const WorkingPair& pair) const {
  const auto place = [&](std::int32_t k) -> const Vec3& {
    return state_[static_cast<std::size_t>(pair.node[static_cast<std::size_t>(k)])].place;
  };
  const auto ball = [&](std::int32_t first, std::int32_t end, Vec3& centre) {
    centre = {};
    for (std::int32_t k = first; k < end; ++k) centre = centre + place(k);
    centre = (1.0 / (end - first)) * centre;
    double squared = 0;
    for (std::int32_t k = first; k < end; ++k) {
      const Vec3 r = place(k) - centre;
      squared = std::max(squared, dot(r, r));
    }
    return std::sqrt(squared);
  };
  const double near = near_of(pair);
  if (pair.key.kind == 1) return rigid_[static_cast<std::size_t>(pair.key.ids[1])].distance(place(0)) - near;
  const std::int32_t split = pair.key.kind == 2 ? 2 : 1;
  Vec3 a, b;
  const double first = ball(0, split, a), second = ball(split, pair.nodes, b);
  return norm(a - b) - first - second - near;
}

// All candidate faces of a node: from those that it can touch, those that matter.
void Contact::touch_faces(std::size_t begin, std::size_t end, double dt) {
  std::vector<WorkingPair>& pairs = set_.pairs();
  const auto n = static_cast<std::size_t>(pairs[begin].node[0]);
  const std::size_t first_constraint = constraints_.size();
  touches_.clear(), touch_nodes_.clear(), touch_ids_.clear(), touch_pairs_.clear();
  remembers_ =
      std::any_of(pairs.begin() + static_cast<std::ptrdiff_t>(begin), pairs.begin() + static_cast<std::ptrdiff_t>(end),
                  [](const WorkingPair& pair) { return !pair.memory.empty(); });
  for (std::size_t q = begin; q < end; ++q) {
    const WorkingPair& pair = pairs[q];
    if (wake_[q] > 0) continue;
    FaceShape start{pair.nodes - 1, {}}, finish{pair.nodes - 1, {}};
    std::array<GlobalId, 4> ids{no_id, no_id, no_id, no_id};
    for (std::int32_t k = 1; k < pair.nodes; ++k) {
      const auto corner = static_cast<std::size_t>(pair.node[static_cast<std::size_t>(k)]);
      start.x[static_cast<std::size_t>(k - 1)] = state_[corner].place;
      finish.x[static_cast<std::size_t>(k - 1)] = end_[corner];
      ids[static_cast<std::size_t>(k - 1)] = set_.id(static_cast<LocalIndex>(corner));
    }
    Touch touch;
    if (!touch_face(state_[n].place, end_[n], start, finish, pair.clearance, pair.depth, pair.two_sided, pair.margin,
                    touch)) {
      if (!again_ && pair.memory.empty()) let_sleep(q, distance_to_face(pair, state_[n].place, start), dt);
      continue;
    }
    touches_.push_back(touch), touch_nodes_.push_back(ids), touch_ids_.push_back(pair.key.ids[1]);
    touch_pairs_.push_back(q);
  }
  if (!touches_.empty()) {
    std::array<Choice, most_touches> chosen;
    const int count = choose_touches(touches_, touch_nodes_, touch_ids_, chosen);
    for (int k = 0; k < count; ++k) {
      const Choice& choice = chosen[static_cast<std::size_t>(k)];
      const std::size_t q = touch_pairs_[static_cast<std::size_t>(choice.candidate)];
      if (constraint_of_pair_[q] < 0) add_constraint(q, &choice.touch, nullptr, nullptr, dt);
    }
  }
  hand_over(begin, end, first_constraint);
}

void Contact::touch_edges(std::size_t q, double dt) {
  const WorkingPair& pair = set_.pairs()[q];
  remembers_ = !pair.memory.empty();
  std::array<EdgeShape, 4> edge;  // first at start and end, second likewise
  for (std::size_t k = 0; k < 4; ++k) {
    const auto n = static_cast<std::size_t>(pair.node[k]);
    edge[k < 2 ? 0 : 2].x[k % 2] = state_[n].place;
    edge[k < 2 ? 1 : 3].x[k % 2] = end_[n];
  }
  EdgeTouch touch;
  if (contact::touch_edges(edge[0], edge[1], edge[2], edge[3], pair.first_outward, pair.second_outward, pair.clearance,
                           pair.depth, pair.margin, touch))
    add_constraint(q, nullptr, &touch, nullptr, dt);
  hand_over(q, q + 1, constraint_of_pair_[q] < 0 ? constraints_.size() : constraints_.size() - 1);
}

void Contact::touch_rigid(std::size_t q, double time, double dt) {
  const WorkingPair& pair = set_.pairs()[q];
  remembers_ = !pair.memory.empty();
  const auto n = static_cast<std::size_t>(pair.node[0]);
  const MovingSurface& surface = rigid_[static_cast<std::size_t>(pair.key.ids[1])];
  RigidTouch touch;
  const Vec3 velocity = settling_ ? Vec3{} : surface.velocity(time, dt);
  if (surface.touch(state_[n].place, end_[n], velocity, dt, pair.clearance, pair.margin, touch))
    add_constraint(q, nullptr, nullptr, &touch, dt);
  if (constraint_of_pair_[q] >= 0) {
    Constraint& constraint = constraints_.back();
    constraint.body = first_body_[parties_.size() + static_cast<std::size_t>(pair.key.ids[1])];
    if (constraint.body < 0) constraint.surface_velocity = velocity;
    constraint.former_surface_velocity = constraint.surface_velocity;
  }
  hand_over(q, q + 1, constraint_of_pair_[q] < 0 ? constraints_.size() : constraints_.size() - 1);
}

void Contact::add_constraint(std::size_t q, const Touch* face, const EdgeTouch* edges, const RigidTouch* rigid,
                             double dt) {
  const WorkingPair& pair = set_.pairs()[q];
  const double gap = face ? face->gap : edges ? edges->gap : rigid->gap;
  const double end_gap = face ? face->end_gap : edges ? edges->end_gap : rigid->end_gap;
  const Rule& rule = rules_[static_cast<std::size_t>(pair.first_surface) * static_cast<std::size_t>(surface_count_) +
                            static_cast<std::size_t>(pair.second_surface)];
  const bool tied = rule.tied && (remembers_ || gap <= touching * pair.margin);
  if ((rule.tied && edges) || (tied && again_)) return;  // nodes hold, each where it is
  if (again_ ? end_gap > -negligible * pair.margin : end_gap > 0 && !remembers_ && !tied) return;  // near, no more
  Constraint c;
  c.pair = static_cast<std::int32_t>(q), c.nodes = pair.nodes, c.node = pair.node;
  c.gap = gap;
  std::size_t support = 0;
  if (face) {
    c.normal = face->normal, c.c[0] = 1;
    for (std::size_t k = 1; k < static_cast<std::size_t>(pair.nodes); ++k) c.c[k] = -face->weights[k - 1];
    support = 1;
  } else if (edges) {
    c.normal = edges->normal;
    c.c = {1 - edges->first, edges->first, edges->second - 1, -edges->second, 0};
  } else {
    c.normal = rigid->normal, c.c[0] = 1;
    if (pair.key.kind == 3) c.c[1] = -1;
  }
  if (!rigid) balance_moments(c, state_, support);
  c.target = gap >= 0 ? -gap / dt : -removal_rate * gap / dt;
  if (pair.key.kind != 3)  // a force across the line of two balls would turn them: they have no spin
    c.static_coefficient = rule.friction.static_coefficient, c.kinetic_coefficient = rule.friction.kinetic_coefficient;
  c.tied = tied;
  if (c.tied) c.target = -return_rate * gap / dt;
  if (c.static_coefficient > 0 || c.tied)
    c.tangent_target = (-return_rate / dt) * tangential(pair.memory.slip, c.normal);
  constraint_of_pair_[q] = static_cast<std::int32_t>(constraints_.size());
  constraints_.push_back(c);
}

// A node that slides from face to face takes along what its pair remembers; what no pair takes over is lost. Then the
// impulse of the step before is the first guess.
void Contact::hand_over(std::size_t begin, std::size_t end, std::size_t first_constraint) {
  if (again_) return;
  std::vector<WorkingPair>& pairs = set_.pairs();
  for (std::size_t q = begin; q < end; ++q) {
    PairMemory& memory = pairs[q].memory;
    if (constraint_of_pair_[q] >= 0 || memory.empty()) continue;
    for (std::size_t k = first_constraint; k < constraints_.size(); ++k) {
      WorkingPair& heir = pairs[static_cast<std::size_t>(constraints_[k].pair)];
      bool meet = false;
      for (std::int32_t a = 1; a < pairs[q].nodes; ++a)
        for (std::int32_t b = 1; b < heir.nodes; ++b)
          meet = meet || pairs[q].node[static_cast<std::size_t>(a)] == heir.node[static_cast<std::size_t>(b)];
      if (!meet) continue;
      changed_.emplace_back(static_cast<std::size_t>(constraints_[k].pair), heir.memory);
      changed_.emplace_back(q, memory);
      heir.memory.force = heir.memory.force + memory.force;
      heir.memory.slip = heir.memory.slip + memory.slip;
      heir.memory.energy += memory.energy;
      memory = {};
      break;
    }
    if (memory.energy != 0 && pairs[q].primary) given_up_.push_back(memory.energy);
    if (!memory.empty()) changed_.emplace_back(q, memory);
    memory = {};
  }
}

}  // namespace tenon
