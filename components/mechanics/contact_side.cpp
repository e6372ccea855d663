// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/contact_side.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <limits>

namespace tenon {

ContactSide::ContactSide(const Parts& parts)
    : parts_(parts),
      faces_(parts.mesh, parts.options, parts.groups, tied(parts)),
      place_(parts.nodes.size(), -1),
      work_(parts.nodes.size()) {
  parts_.conditions.remember_holds(parts.nodes.size());
  if (parts_.ties.empty()) return;
  tied_compliance_ = parts_.ties.compliance(parts_.nodes.inverse_mass);
  tied_impulse_.resize(parts_.nodes.size());
  left_out_ = parts_.mesh.comm.sum(faces_.left_out());
  shared_.resize(6 * parts_.rigid.size()), shared_total_.resize(shared_.size());
  shared_impulse_.resize(parts_.rigid.size());
  watch({});
}

/// 1 for nodes that follow ties or are tied to; empty without ties.
std::vector<char> ContactSide::tied(const Parts& parts) {
  std::vector<char> result;
  if (parts.ties.empty()) return result;
  std::vector<std::int32_t> marked(parts.nodes.size());
  for (const LocalIndex n : parts.ties.nodes()) marked[static_cast<std::size_t>(n)] = 1;
  for (const LocalIndex n : parts.ties.face_nodes()) marked[static_cast<std::size_t>(n)] = 1;
  parts.mesh.node_halo.forward<std::int32_t>(marked, marked);
  result.assign(marked.begin(), marked.end());
  return result;
}

std::vector<std::string> ContactSide::surface_names() const {
  std::vector<std::string> names;
  for (const ElementBlock& block : parts_.mesh.blocks) names.push_back(block.name);
  return names;
}

double ContactSide::effusivity(std::int32_t surface) const {
  const std::string& block = parts_.mesh.blocks[static_cast<std::size_t>(surface)].name;
  const auto found = std::ranges::find(parts_.options.blocks, block, &MechanicsOptions::Block::name);
  if (found == parts_.options.blocks.end() || !found->material.thermal) return 0;
  const ThermalProperties& thermal = *found->material.thermal;
  return std::sqrt(thermal.conductivity * found->material.density * thermal.specific_heat);
}

// In the middle of a step, the velocity of before the kick is found again for nodes that were not watched; along held
// directions it stays unknown, where it does not matter: contact and reaction take it with opposite signs. Nodes of
// faces that others are tied to are watched as well.
void ContactSide::watch(std::span<const LocalIndex> nodes) {
  std::vector<LocalIndex> all(nodes.begin(), nodes.end());
  if (!parts_.ties.empty()) {
    std::vector<LocalIndex> more = parts_.ties.face_nodes();
    std::ranges::sort(more);
    more.erase(std::unique(more.begin(), more.end()), more.end());
    std::ranges::set_difference(more, nodes, std::back_inserter(all));
  }
  std::vector<Vec3> former(all.size()), impulse(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto n = static_cast<std::size_t>(all[i]);
    if (place_[n] >= 0) {
      former[i] = former_[static_cast<std::size_t>(place_[n])];
      impulse[i] = impulse_[static_cast<std::size_t>(place_[n])];
      continue;
    }
    const double* f = parts_.nodes.force[n].v;
    former[i] = parts_.nodes.velocity()[n] + kick_ * moved(undamped(all[i]), {f[0], f[1], f[2]});
  }
  for (const LocalIndex n : watched_) place_[static_cast<std::size_t>(n)] = -1;
  watched_ = std::move(all), chosen_ = nodes.size();
  for (std::size_t i = 0; i < watched_.size(); ++i)
    place_[static_cast<std::size_t>(watched_[i])] = static_cast<std::int32_t>(i);
  former_ = std::move(former), impulse_ = std::move(impulse);
}

void ContactSide::shift(std::span<const LocalIndex> nodes, std::span<const Vec3> by) {
  const std::span<Vec3> x = parts_.nodes.position();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto n = static_cast<std::size_t>(nodes[i]);
    x[n] = x[n] + by[i];
  }
  parts_.mesh.node_halo.forward<Vec3>(x, x);
  parts_.nodes.renew_reference();
}

void ContactSide::begin(double kick) {
  kick_ = kick;
  for (std::size_t i = 0; i < watched_.size(); ++i) {
    former_[i] = parts_.nodes.velocity()[static_cast<std::size_t>(watched_[i])];
    impulse_[i] = {};
  }
}

Mobility ContactSide::undamped(LocalIndex node) const {
  Mobility m;
  if (!parts_.rigid.empty() && parts_.rigid.holds(node)) {
    m.body = parts_.rigid.body_of(node);
    return m;
  }
  if (const std::int32_t tied = parts_.ties.index_of(node); tied >= 0) {
    m.w[0] = m.w[1] = m.w[2] = tied_compliance_[static_cast<std::size_t>(tied)];
    return m;
  }
  const double inverse = parts_.nodes.inverse_mass[static_cast<std::size_t>(node)];
  const NodalConditions::Holds holds = parts_.conditions.holds(node);
  if (holds.count == 3 || inverse == 0) return m;
  std::array<double, 6> free{1, 1, 1, 0, 0, 0};
  for (int k = 0; k < holds.count; ++k) {
    const Vec3& d = holds.direction[k];
    for (std::size_t c = 0; c < 3; ++c) free[c] -= d[c] * d[c], free[3 + c] -= d[c] * d[(c + 1) % 3];
  }
  for (std::size_t i = 0; i < 6; ++i) m.w[i] = inverse * free[i];
  return m;
}

// Implicit dampers take their share of an impulse: (m + kick C/2) dv = p in the directions that are free.
Mobility ContactSide::mobility(LocalIndex node) const {
  Mobility m = undamped(node);
  const double mass = parts_.nodes.mass[static_cast<std::size_t>(node)];
  if (m.body >= 0 || !(mass > 0) || parts_.ties.index_of(node) >= 0) return m;
  const std::optional<SymmetricTensor<double>> damping = parts_.loads.damping(node, parts_.nodes);
  if (!damping) return m;
  Eigen::Matrix3d free, c;
  const std::array<double, 6>& w = m.w;
  free << w[0], w[3], w[5], w[3], w[1], w[4], w[5], w[4], w[2];
  free *= mass;
  c << damping->xx, damping->xy, damping->zx, damping->xy, damping->yy, damping->yz, damping->zx, damping->yz,
      damping->zz;
  const Eigen::Matrix3d held = Eigen::Matrix3d::Identity() - free;
  const Eigen::Matrix3d resisting = free * (mass * Eigen::Matrix3d::Identity() + 0.5 * kick_ * c) * free + mass * held;
  const Eigen::Matrix3d inverse = free * resisting.inverse() * free;
  m.w = {inverse(0, 0), inverse(1, 1), inverse(2, 2), inverse(0, 1), inverse(1, 2), inverse(2, 0)};
  return m;
}

void ContactSide::mobilities(std::span<const LocalIndex> nodes, std::span<Mobility> mobility) const {
  for (std::size_t i = 0; i < nodes.size(); ++i) mobility[i] = this->mobility(nodes[i]);
}

void ContactSide::push_node(LocalIndex node, const Vec3& p) {
  const auto n = static_cast<std::size_t>(node);
  assert(place_[n] >= 0);
  const auto i = static_cast<std::size_t>(place_[n]);
  const Vec3 dv = moved(mobility(node), p);
  change_velocity(node, dv);
  // The work that nodes.force has done so far, and that of what dampers add to it.
  const Vec3 more = parts_.loads.resist(node, dv, parts_.nodes);
  parts_.nodes.internal_work[n] += 0.5 * kick_ * dot(more, former_[i] + parts_.nodes.velocity()[n]);
  const Vec3 mean = 0.5 * (former_[i] + parts_.nodes.velocity()[n]);
  work_[n] += dot(p, mean);
  parts_.conditions.react(node, p, mean);
  impulse_[i] = impulse_[i] + p;
}

// What the forces of the kick and the impulses so far do on it.
void ContactSide::change_velocity(LocalIndex node, const Vec3& dv) {
  const auto n = static_cast<std::size_t>(node);
  parts_.nodes.velocity()[n] = parts_.nodes.velocity()[n] + dv;
  const double* f = parts_.nodes.force[n].v;
  parts_.nodes.internal_work[n] += 0.5 * kick_ * dot({f[0], f[1], f[2]}, dv);
  work_[n] += 0.5 * dot(impulse_[static_cast<std::size_t>(place_[n])], dv);
}

void ContactSide::push(std::span<const LocalIndex> nodes, std::span<const Vec3> impulses,
                       std::span<const BodyImpulse> bodies) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (parts_.ties.index_of(nodes[i]) < 0)
      push_node(nodes[i], impulses[i]);
    else
      tied_impulse_[static_cast<std::size_t>(nodes[i])] = impulses[i];
  }
  if (!bodies.empty()) body_work_ += parts_.rigid.push(bodies);
  if (!parts_.ties.empty()) push_through_ties();
  if (!parts_.rigid.empty()) parts_.rigid.set_rates(parts_.nodes);
  if (!parts_.ties.empty()) parts_.ties.follow(parts_.nodes);
}

// An impulse on a tied node goes to the nodes of its face, which may belong to a rigid body.
void ContactSide::push_through_ties() {
  for (ExactSum& sum : shared_) sum.clear();
  parts_.ties.share(tied_impulse_, [&](LocalIndex node, const Vec3& p) {
    if (dot(p, p) == 0) return;
    if (parts_.rigid.empty() || !parts_.rigid.holds(node)) return push_node(node, p);
    const auto b = static_cast<std::size_t>(parts_.rigid.body_of(node));
    const Vec3 arm = parts_.nodes.position()[static_cast<std::size_t>(node)] - parts_.rigid.state(b).pivot;
    const Vec3 moment = cross(arm, p);
    for (std::size_t c = 0; c < 3; ++c) shared_[6 * b + c].add(p[c]), shared_[6 * b + 3 + c].add(moment[c]);
  });
  for (const LocalIndex n : parts_.ties.nodes()) tied_impulse_[static_cast<std::size_t>(n)] = {};
  if (shared_.empty()) return;
  parts_.mesh.comm.sum(shared_, shared_total_);
  for (std::size_t b = 0; b < shared_impulse_.size(); ++b) {
    const double* t = shared_total_.data() + 6 * b;
    shared_impulse_[b] = {{t[0], t[1], t[2]}, {t[3], t[4], t[5]}};
  }
  body_work_ += parts_.rigid.push(shared_impulse_);
}

void ContactSide::end(double dt) {
  Vec3 dv{};
  for (std::size_t i = 0; i < watched_.size() && parts_.conditions.has_walls(); ++i) {
    if (dot(impulse_[i], impulse_[i]) == 0) continue;
    const LocalIndex node = watched_[i];
    const auto n = static_cast<std::size_t>(node);
    while (parts_.nodes.mass[n] > 0 && parts_.conditions.stop(node, parts_.nodes, dt, dv)) {
      change_velocity(node, dv);
      const Vec3 mean = 0.5 * (former_[i] + parts_.nodes.velocity()[n]);
      parts_.conditions.add_wall_work(node, parts_.nodes.mass[n] * dot(dv, mean));
    }
  }
  if (!parts_.ties.empty()) parts_.ties.follow(parts_.nodes);
}

ExactSum ContactSide::contact_work() const {
  ExactSum sum;
  for (const LocalIndex n : parts_.mesh.owned_nodes) sum.add(work_[static_cast<std::size_t>(n)]);
  if (parts_.mesh.comm.rank() == 0) sum.add(body_work_);
  return sum;
}

ContactFields& ContactSide::contact_fields() {
  if (!fields_) {
    const std::size_t size = parts_.nodes.size();
    fields_ = std::make_unique<ContactFields>();
    fields_->force.resize(size), fields_->slip.resize(size);
    fields_->gap.assign(size, std::numeric_limits<double>::infinity());
    fields_->status.resize(size), fields_->pressure.resize(size), fields_->friction_heat.resize(size);
  }
  return *fields_;
}

std::int64_t ContactSide::memory() const {
  std::size_t bytes = watched_.size() * sizeof(LocalIndex) + place_.size() * sizeof(std::int32_t) +
                      (former_.size() + impulse_.size()) * sizeof(Vec3) + work_.size() * sizeof(double);
  if (fields_) bytes += fields_->force.size() * (2 * sizeof(Vec3) + 4 * sizeof(double));
  return static_cast<std::int64_t>(bytes) + faces_.memory();
}

}  // namespace tenon
