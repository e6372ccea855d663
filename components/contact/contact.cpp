// SPDX-License-Identifier: BSD-3-Clause
#include "components/contact/contact.hpp"

#include <algorithm>
#include <cmath>

namespace tenon {

using namespace contact;

void Contact::act(double time, double dt) {
  ++steps_;
  {
    const ScopedTimer timer(*phases_.check);
    used_ = std::max(search_.used(dt), used_by_rigid(time, dt));
  }
  if (used_ > 1) {
    search(time, dt);
    used_ = std::max(search_.used(dt), used_by_rigid(time, dt));
  }
  if (set_.any()) {
    find_impulses(time, dt);
    if (any_constraint_) {
      book(dt, parties_.front()->contact_kick());
      pressing_ += active_;
      send_back();
    }
    way_ += 2 * dt * std::max(fastest_, any_constraint_ ? fastest(enforcement_.velocities(), time, dt) : 0.0);
    if (any_constraint_ || !filled_.empty()) fill_fields(parties_.front()->contact_kick());
  } else {
    any_constraint_ = false;
    if (!filled_.empty()) fill_fields(1);
  }
  if (!any_constraint_) {
    ++idle_steps_;
    active_ = 0;
    for (PairTotals& total : totals_)
      for (ExactSum& force : total.force) force.clear();
  }
  if (!rigid_.empty()) move_rigid(time, dt);
  search_.passed(dt);
}

// What contact throws farther than its skin may meet what no search has found: then the step is searched anew, with
// skins for the velocities that were found, and its impulses with it, from what the pairs remembered before.
void Contact::find_impulses(double time, double dt) {
  constexpr int greatest_throws = 3;
  for (int k = 0;; ++k) {
    changed_.clear(), given_up_.clear();
    gather(time, dt);
    find_constraints(time, dt);
    any_constraint_ = comm_.any(!constraints_.empty());
    if (!any_constraint_ || solve(time, dt, parties_.front()->contact_kick(), k == greatest_throws)) break;
    for (; !changed_.empty(); changed_.pop_back()) set_.pairs()[changed_.back().first].memory = changed_.back().second;
    expect_thrown(dt);
    search(time, dt);
    search_.expect({}), rigid_reserve_ = 0;
  }
  for (const double energy : given_up_) dissipated_.add(energy);
}

/// Collective. Share of their skins that the nodes and rigid surfaces on which contact acts have used up at the end of
/// the step.
double Contact::used_by_thrown(double time, double dt) const {
  double greatest = 0;
  const Vec3 common = (search_.since() + dt) * search_.common();
  for (const Constraint& q : constraints_)
    for (std::size_t k = 0; k < static_cast<std::size_t>(q.nodes); ++k) {
      const auto n = static_cast<std::size_t>(q.node[k]);
      const Vec3 moved = (state_[n].place - sought_[n].place) + (dt * enforcement_.velocities()[n] - common);
      greatest = std::max(greatest, dot(moved, moved) * sought_[n].inverse_square);
    }
  greatest = std::sqrt(greatest);
  for (std::size_t r = 0; r < rigid_.size() && rigid_skin_ > 0; ++r) {
    const Vec3 moved = rigid_[r].shift() + dt * (rigid_[r].velocity(time, dt) + thrown(r)) - rigid_sought_[r] - common;
    greatest = std::max(greatest, norm(moved) / rigid_skin_);
  }
  return comm_.max(greatest);
}

/// Change of the velocity of a rigid surface by contact, m/s.
Vec3 Contact::thrown(std::size_t surface) const {
  Vec3 dv{};
  if (!rigid_[surface].is_free()) return dv;
  const Body& body = bodies_[static_cast<std::size_t>(first_body_[parties_.size() + surface])];
  for (std::size_t c = 0; c < 3; ++c) dv[c] = body.state.inverse_mass[c] * body.impulse.linear[c];
  return dv;
}

/// The next search has skins for the changes of velocity that contact has found.
void Contact::expect_thrown(double dt) {
  std::vector<double> change(state_.size()), at_home(set_.busy().size()), ways(surfaces_.nodes().size());
  for (std::size_t n = 0; n < state_.size(); ++n)
    change[n] = dt * norm(enforcement_.velocities()[n] - state_[n].velocity);
  set_.results().reverse<double>(change, at_home);
  for (std::size_t b = 0; b < at_home.size(); ++b) ways[static_cast<std::size_t>(set_.busy()[b])] = at_home[b];
  search_.expect(std::move(ways));
  for (std::size_t r = 0; r < rigid_.size(); ++r) rigid_reserve_ = std::max(rigid_reserve_, 2 * dt * norm(thrown(r)));
}

void Contact::gather(double time, double dt) {
  const ScopedTimer timer(*phases_.exchange);
  set_.count_step();
  bodies_.clear();
  first_body_.clear();
  for (ContactParty* party : parties_) {
    first_body_.push_back(static_cast<std::int32_t>(bodies_.size()));
    for (const ContactRigidBody& body : party->contact_rigid_bodies()) bodies_.push_back({body, {}});
  }
  for (const MovingSurface& surface : rigid_) {
    if (!surface.is_free()) {
      first_body_.push_back(-1);
      continue;
    }
    first_body_.push_back(static_cast<std::int32_t>(bodies_.size()));
    ContactRigidBody body;
    body.inverse_mass.fill(1 / *surface.options().mass);
    body.velocity = body.former_velocity = surface.velocity(time, dt);
    bodies_.push_back({body, {}});
  }
  home_state_.resize(set_.busy().size());
  std::vector<LocalIndex> nodes;
  std::vector<Mobility> mobility;
  std::size_t b = 0;
  for (std::size_t p = 0; p < parties_.size(); ++p) {
    nodes.clear();
    const std::size_t first = b;
    for (; b < set_.busy().size(); ++b) {
      const SurfaceNode& node = surfaces_.nodes()[static_cast<std::size_t>(set_.busy()[b])];
      if (node.party != static_cast<std::int32_t>(p)) break;
      nodes.push_back(node.node);
    }
    mobility.resize(nodes.size());
    parties_[p]->mobilities(nodes, mobility);
    const std::span<const Vec3> x = parties_[p]->contact_positions(), v = parties_[p]->contact_velocities(),
                                former = parties_[p]->former_velocities();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const auto n = static_cast<std::size_t>(nodes[i]);
      home_state_[first + i] = {x[n], v[n], former[i], mobility[i]};
      if (mobility[i].body >= 0) home_state_[first + i].mobility.body += first_body_[p];
    }
  }
  state_.resize(static_cast<std::size_t>(set_.nodes()));
  set_.from_home().forward<NodeState>(home_state_, state_);
  end_.resize(state_.size());
  predicted_.resize(state_.size());
  for (std::size_t n = 0; n < state_.size(); ++n) predicted_[n] = state_[n].velocity;
  former_.resize(state_.size());
  for (std::size_t n = 0; n < state_.size(); ++n) former_[n] = state_[n].former;
  former_bodies_ = bodies_;
  for (Body& body : former_bodies_) body.state.velocity = body.state.former_velocity;
  for (std::size_t n = 0; n < state_.size(); ++n) end_[n] = state_[n].place + dt * state_[n].velocity;
}

// How fast an overlap may go: as far as what the pair has stored pays for it, for that is what it took to get in; and a
// ten-thousandth of an element per step, which is not felt, where it came by a change of faces. Elements may be much
// thinner than their faces are wide. Where that limit holds, the pair is a little soft: a node that two faces squeeze
// from both sides has no velocity that suits both, and their impulses would grow from step to step.
void Contact::limit_removal(Constraint& q, double dt) const {
  if (q.gap >= 0) return;
  const WorkingPair& pair = set_.pairs()[static_cast<std::size_t>(q.pair)];
  constexpr double slow = 1e-4, faces_a_margin = 10, softness = 1e-3;
  double lightest = 0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(q.nodes); ++k)
    if (q.c[k] > 0) {
      const std::array<double, 6>& w = state_[static_cast<std::size_t>(q.node[k])].mobility.w;
      lightest = std::max({lightest, w[0], w[1], w[2]});
    }
  double size = faces_a_margin * pair.margin;
  if (pair.depth > 0) size = std::min(size, 2 * pair.depth);  // a pair takes half the element's
  const double limit = std::max(slow * size / dt, std::sqrt(2 * pair.memory.energy * lightest));
  if (q.target <= limit) return;
  q.target = limit, q.softness = softness;
}

// False if contact throws a node beyond its skin, unless this is the last trial.
bool Contact::solve(double time, double dt, double kick, bool last) {
  for (Constraint& q : constraints_) {
    const PairMemory& memory = set_.pairs()[static_cast<std::size_t>(q.pair)].memory;
    if (q.tied) {
      q.impulse = kick * memory.force;
      continue;
    }
    const double along = std::max(0.0, dot(memory.force, q.normal));
    q.impulse = (kick * along) * q.normal;
    limit_removal(q, dt);
    if (q.static_coefficient > 0)
      q.impulse = q.impulse + kick * (memory.force - dot(memory.force, q.normal) * q.normal);
  }
  constexpr int greatest_looks = 3;
  for (int look = 1; look <= greatest_looks; ++look) {
    {
      const ScopedTimer timer(*phases_.solve);
      const Enforcement::Report report = enforcement_.solve(constraints_, state_, bodies_);
      iterations_ = report.iterations, iterations_total_ += report.iterations;
      enforcement_work_ += static_cast<std::int64_t>(constraints_.size()) * report.iterations;
    }
    if (!last && used_by_thrown(time, dt) > 1) return false;
    if (look == greatest_looks || !comm_.any(find_more(time, dt))) break;
  }
  const ScopedTimer timer(*phases_.solve);
  release();
  return last || used_by_thrown(time, dt) <= 1;
}

namespace {

/// Rigid bodies with the linear velocities that their impulses give them.
void set_pushed(const std::vector<Body>& bodies, std::vector<Body>& pushed) {
  pushed = bodies;
  for (Body& body : pushed)
    for (std::size_t c = 0; c < 3; ++c) body.state.velocity[c] += body.state.inverse_mass[c] * body.impulse.linear[c];
}

}  // namespace

// Pairs that pressed before and no longer do give back what their impact took. The impulses p of all others work more
// by what a release moves their nodes; p . C W C^T r = r . (u - u*), which the release pays for as well.
void Contact::release() {
  released_.assign(constraints_.size(), {});
  bool any = false;
  for (std::size_t k = 0; k < constraints_.size(); ++k) {
    const Constraint& q = constraints_[k];
    const PairMemory& memory = set_.pairs()[static_cast<std::size_t>(q.pair)].memory;
    if (q.tied || !(memory.energy > 0) || dot(q.impulse, q.normal) > 0) continue;
    const Vec3 former = relative_velocity(q, former_, former_bodies_, q.former_surface_velocity);
    const Vec3 free = relative_velocity(q, predicted_, bodies_, q.surface_velocity);
    released_[k] = {memory.energy, dot(former, q.normal), dot(free, q.normal)};
    any = true;
  }
  const std::span<const Vec3> velocity = enforcement_.velocities();
  solved_.assign(velocity.begin(), velocity.end());
  set_pushed(bodies_, solved_bodies_);
  if (comm_.any(any)) enforcement_.release(constraints_, state_, bodies_, released_);
}

// The work of each pair by the velocities before the kick and after contact, which together is what the parties book
// for their nodes; that of releases on the nodes of others counts as theirs. What is not friction is stored, as long as
// it can be, or lost.
void Contact::book(double dt, double kick) {
  set_pushed(bodies_, pushed_bodies_);
  active_ = 0;
  slid_.resize(constraints_.size()), heat_.resize(constraints_.size());
  for (PairTotals& total : totals_)
    for (ExactSum& force : total.force) force.clear();
  for (std::size_t k = 0; k < constraints_.size(); ++k) {
    const Constraint& q = constraints_[k];
    WorkingPair& pair = set_.pairs()[static_cast<std::size_t>(q.pair)];
    PairMemory& memory = pair.memory;
    const Vec3 before = relative_velocity(q, former_, former_bodies_, q.former_surface_velocity);
    const Vec3 solved = relative_velocity(q, solved_, solved_bodies_, q.surface_velocity);
    const Vec3 after = relative_velocity(q, enforcement_.velocities(), pushed_bodies_, q.surface_velocity);
    const bool is_released = released_[k].energy > 0;
    const Vec3 by_others = solved - released_[k].free * q.normal;
    const Vec3 mean = 0.5 * (before + (is_released ? after + by_others : solved));
    const double pressed = dot(q.impulse, q.normal);
    const Vec3 across = q.impulse - pressed * q.normal;
    const double friction = q.tied ? 0.0 : -dot(across, mean);
    const double normal_work = q.tied ? dot(q.impulse, mean) : pressed * dot(q.normal, mean);
    const double stored = memory.energy;
    memory.energy = is_released ? 0.0 : std::max(0.0, stored - normal_work);
    memory.force = is_released ? Vec3{} : (1 / kick) * q.impulse;
    const Vec3 way = memory.slip + dt * after;
    memory.slip = q.sticks && (pressed > 0 || q.tied) ? way - dot(way, q.normal) * q.normal : Vec3{};
    slid_[k] = pressed > 0 ? dt * (after - dot(after, q.normal) * q.normal) : Vec3{};
    heat_[k] = friction;
    if (!pair.primary) continue;
    dissipated_.add(-normal_work - (memory.energy - stored));
    friction_.add(friction);
    rigid_work_.add(dot(q.impulse, q.surface_velocity));
    active_ += pressed > 0 || q.tied ? 1 : 0;
    const std::int32_t low = std::min(pair.first_surface, pair.second_surface),
                       high = std::max(pair.first_surface, pair.second_surface);
    for (PairTotals& total : totals_) {
      if (total.first != low || total.second != high) continue;
      const double sign = pair.first_surface == low ? 1 : -1;
      for (std::size_t c = 0; c < 3; ++c) {
        total.force[c].add(sign * q.impulse[c] / kick);
        total.impulse[c].add(sign * q.impulse[c]);
      }
      total.friction_work.add(friction);
    }
  }
}

void Contact::send_back() {
  const ScopedTimer timer(*phases_.exchange);
  home_impulse_.assign(set_.busy().size(), Vec3{});
  set_.results().reverse<Vec3>(enforcement_.impulses(), home_impulse_);
  std::vector<LocalIndex> nodes;
  std::size_t b = 0;
  std::vector<BodyImpulse> impulses;
  std::vector<Vec3> free;
  for (std::size_t p = 0; p < parties_.size(); ++p) {
    nodes.clear(), impulses.clear(), free.clear();
    for (; b < set_.busy().size(); ++b) {
      const SurfaceNode& node = surfaces_.nodes()[static_cast<std::size_t>(set_.busy()[b])];
      if (node.party != static_cast<std::int32_t>(p)) break;
      if (home_state_[b].mobility.body >= 0 || home_impulse_[b] == Vec3{}) continue;
      nodes.push_back(node.node);
      free.push_back(home_impulse_[b]);
    }
    const auto bodies = static_cast<std::size_t>(
        (p + 1 < parties_.size() ? first_body_[p + 1] : static_cast<std::int32_t>(party_bodies())) - first_body_[p]);
    for (std::size_t i = 0; i < bodies; ++i)
      impulses.push_back(bodies_[static_cast<std::size_t>(first_body_[p]) + i].impulse);
    parties_[p]->push(nodes, free, impulses);
  }
}

std::int32_t Contact::party_bodies() const {
  for (std::size_t r = 0; r < rigid_.size(); ++r)
    if (first_body_[parties_.size() + r] >= 0) return first_body_[parties_.size() + r];
  return static_cast<std::int32_t>(bodies_.size());
}

void Contact::move_rigid(double time, double dt) {
  for (std::size_t r = 0; r < rigid_.size(); ++r) {
    Vec3 velocity = rigid_[r].velocity(time, dt);
    if (any_constraint_) velocity = velocity + thrown(r);
    rigid_[r].move(velocity, time, dt);
  }
}

}  // namespace tenon
