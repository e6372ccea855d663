// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/contact_side.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace tenon {

ContactSide::ContactSide(const Parts& parts)
    : parts_(parts),
      faces_(parts.mesh, parts.options, parts.groups, tied(parts)),
      place_(parts.nodes.size(), -1),
      work_(parts.nodes.size()) {
  parts_.conditions.remember_holds(parts.nodes.size());
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
// directions it stays unknown, where it does not matter: contact and reaction take it with opposite signs.
void ContactSide::watch(std::span<const LocalIndex> nodes) {
  std::vector<Vec3> former(nodes.size()), impulse(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto n = static_cast<std::size_t>(nodes[i]);
    if (place_[n] >= 0) {
      former[i] = former_[static_cast<std::size_t>(place_[n])],
      impulse[i] = impulse_[static_cast<std::size_t>(place_[n])];
      continue;
    }
    const double* f = parts_.nodes.force[n].v;
    former[i] = parts_.nodes.velocity()[n] + kick_ * moved(mobility(nodes[i]), {f[0], f[1], f[2]});
  }
  for (const LocalIndex n : watched_) place_[static_cast<std::size_t>(n)] = -1;
  watched_.assign(nodes.begin(), nodes.end());
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

Mobility ContactSide::mobility(LocalIndex node) const {
  Mobility m;
  if (!parts_.rigid.empty() && parts_.rigid.holds(node)) {
    m.body = parts_.rigid.body_of(node);
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

void ContactSide::mobilities(std::span<const LocalIndex> nodes, std::span<Mobility> mobility) const {
  for (std::size_t i = 0; i < nodes.size(); ++i) mobility[i] = this->mobility(nodes[i]);
}

void ContactSide::push_node(LocalIndex node, const Vec3& p) {
  const auto n = static_cast<std::size_t>(node);
  assert(place_[n] >= 0);
  const auto i = static_cast<std::size_t>(place_[n]);
  const Vec3 dv = moved(mobility(node), p);
  Vec3& v = parts_.nodes.velocity()[n];
  v = v + dv;
  const Vec3 mean = 0.5 * (former_[i] + v);
  work_[n] += dot(p, mean) + 0.5 * dot(impulse_[i], dv);
  const double* f = parts_.nodes.force[n].v;
  parts_.nodes.internal_work[n] += 0.5 * kick_ * dot({f[0], f[1], f[2]}, dv);
  parts_.conditions.react(node, p, mean);
  impulse_[i] = impulse_[i] + p;
}

void ContactSide::push(std::span<const LocalIndex> nodes, std::span<const Vec3> impulses,
                       std::span<const BodyImpulse> bodies) {
  for (std::size_t i = 0; i < nodes.size(); ++i) push_node(nodes[i], impulses[i]);
  if (bodies.empty()) return;
  body_work_ += parts_.rigid.push(bodies);
  parts_.rigid.set_rates(parts_.nodes);
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
