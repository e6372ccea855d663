// SPDX-License-Identifier: BSD-3-Clause
// When contact searches, and what follows from a search.
#include <algorithm>
#include <cmath>
#include <limits>

#include "components/contact/contact.hpp"
#include "components/contact_geometry/closest_point.hpp"

namespace tenon {

using namespace contact;

namespace {

// A search in good time, before a step begins, also remembers velocities of before the kick; one in the middle of a step
// is a way out for sudden motion.
constexpr double in_good_time = 0.7;
constexpr double greatest_widening = 64;
constexpr int searches_before_widening = 20;

}  // namespace

void Contact::prepare(double, double dt) {
  if (surfaces_.stale()) {
    surfaces_.build();
    search_.forget();
  }
  if (options_.always_search || !search_.sought() || used_ > in_good_time) search(dt);
}

void Contact::search(double dt) {
  renew(dt);
  ++searches_;
  if (set_.any() && widening_ > 1) {  // something is near after all: wide skins would find too much
    widening_ = 1, narrow_ = searches_before_widening;
    search_.widen(1);
    renew(dt);
  } else if (!set_.any() && narrow_-- <= 0) {
    widening_ = std::min(2 * widening_, greatest_widening);
    search_.widen(widening_);
  }
  used_ = 0;
}

void Contact::renew(double dt) {
  {
    const ScopedTimer timer(*phases_.search);
    search_.run(dt);
    search_work_ += search_.work();
  }
  const ScopedTimer timer(*phases_.share);
  std::vector<PairRecord> extra;
  add_rigid_pairs(dt, extra);
  set_.build(search_, extra, [this](PairRecord& pair) { return admit(pair); }, restored_);
  restored_.clear();
  limit_clearances();
  watch_nodes();
}

void Contact::add_rigid_pairs(double dt, std::vector<PairRecord>& extra) const {
  const std::vector<SurfaceNode>& nodes = surfaces_.nodes();
  for (std::size_t r = 0; r < rigid_.size(); ++r)
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      const SurfaceNode& node = nodes[n];
      const Vec3 x = parties_[static_cast<std::size_t>(node.party)]
                         ->contact_positions()[static_cast<std::size_t>(node.node)];
      const double skin = search_.skins()[n], margin = 0.1 * node.size;
      if (!(rigid_[r].distance(x) - node.radius <= 2 * skin + margin)) continue;
      PairRecord pair;
      pair.key = {1, {node.id, static_cast<GlobalId>(r), 0, 0}};
      pair.nodes = 1;
      pair.first_surface = node.surface;
      pair.second_surface = static_cast<std::int32_t>(surfaces_.names().size() + r);
      pair.node[0] = {node.id, {comm_.rank(), static_cast<LocalIndex>(n)}, -1};
      pair.clearance = node.radius, pair.margin = margin;
      extra.push_back(pair);
    }
  static_cast<void>(dt);
}

// Shells may be drawn closer to each other than they are thick: at folds and where layers meet. What was so at first
// stays allowed, unless it is an overlap to be removed.
void Contact::limit_clearances() {
  std::vector<Vec3> drawn;
  for (const LocalIndex n : set_.busy()) {
    const SurfaceNode& node = surfaces_.nodes()[static_cast<std::size_t>(n)];
    drawn.push_back(parties_[static_cast<std::size_t>(node.party)]
                        ->contact_mesh()
                        .coordinates[static_cast<std::size_t>(node.node)]);
  }
  std::vector<Vec3> at(static_cast<std::size_t>(set_.nodes()));
  set_.from_home().forward<Vec3>(drawn, at);
  for (WorkingPair& pair : set_.pairs()) {
    if (pair.key.kind != 0 || !pair.two_sided || pair.clearance == 0) continue;
    const std::int32_t blocks = static_cast<std::int32_t>(surfaces_.names().size());
    if (pair.first_surface >= blocks || pair.second_surface >= blocks) continue;
    FaceShape face{pair.nodes - 1, {}};
    for (std::int32_t k = 1; k < pair.nodes; ++k)
      face.x[static_cast<std::size_t>(k - 1)] =
          at[static_cast<std::size_t>(pair.node[static_cast<std::size_t>(k)])];
    const double distance = closest_point(face, at[static_cast<std::size_t>(pair.node[0])]).distance;
    if (distance < pair.clearance) pair.clearance = distance;
  }
}

void Contact::watch_nodes() {
  std::vector<LocalIndex> nodes;
  auto next = set_.busy().begin();
  for (std::size_t p = 0; p < parties_.size(); ++p) {
    nodes.clear();
    for (; next != set_.busy().end(); ++next) {
      const SurfaceNode& node = surfaces_.nodes()[static_cast<std::size_t>(*next)];
      if (node.party != static_cast<std::int32_t>(p)) break;
      nodes.push_back(node.node);
    }
    parties_[p]->watch(nodes);
  }
}

}  // namespace tenon
