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

// Of the skins, as it will be at the end of the coming step if the nodes go on as in the last one. A search in good
// time, before a step begins, also remembers velocities of before the kick; one in the middle of a
// step is a way out for sudden motion.
constexpr double in_good_time = 0.9;
constexpr double greatest_widening = 64;
constexpr int searches_before_widening = 20;

}  // namespace

void Contact::prepare(double time, double dt) {
  if (surfaces_.stale()) {
    surfaces_.build();
    search_.forget();
  }
  if (options_.always_search || !search_.sought() || used_ + (used_ - used_before_) > in_good_time) search(time, dt);
  used_before_ = used_;
}

void Contact::search(double time, double dt) {
  for (DistantParty* const distant : surfaces_.distant())
    if (distant) distant->show();
  renew(time, dt);
  ++searches_;
  const bool something = set_.any() || comm_.any(set_.turned_away() > 0);
  if (something && widening_ > 1) {  // something is near after all: wide skins would find too much
    widening_ = 1, narrow_ = searches_before_widening;
    search_.widen(1);
    renew(time, dt);
  } else if (!something && narrow_-- <= 0) {
    widening_ = std::min(2 * widening_, greatest_widening);
    search_.widen(widening_);
  }
  used_ = used_before_ = 0;
  if (started_ && !set_.any()) let_rest();
}

/// Parties that show their nodes by messages need not while there is nothing to enforce.
void Contact::let_rest() {
  std::vector<double> skins;
  auto node = surfaces_.nodes().begin();
  for (std::size_t p = 0; p < parties_.size(); ++p) {
    DistantParty* const distant = surfaces_.distant()[p];
    skins.assign(distant ? static_cast<std::size_t>(parties_[p]->contact_mesh().nodes()) : 0, 0.0);
    for (; node != surfaces_.nodes().end() && node->party == static_cast<std::int32_t>(p); ++node)
      if (distant)
        skins[static_cast<std::size_t>(node->node)] =
            search_.sought(static_cast<std::size_t>(node - surfaces_.nodes().begin())).inverse_square;
    if (distant) distant->rest(skins);
  }
}

void Contact::renew(double time, double dt) {
  {
    const ScopedTimer timer(*phases_.search);
    search_.run(dt);
    search_work_ += search_.work();
  }
  const ScopedTimer timer(*phases_.share);
  std::vector<PairRecord> extra;
  add_rigid_pairs(time, dt, extra);
  set_.build(
      search_, extra, [this](PairRecord& pair) { return admit(pair); }, restored_);
  restored_.clear();
  for (const double energy : set_.lost()) dissipated_.add(energy);
  std::vector<CandidateSearch::Sought> sought(set_.busy().size());
  for (std::size_t b = 0; b < sought.size(); ++b) sought[b] = search_.sought(static_cast<std::size_t>(set_.busy()[b]));
  sought_.resize(static_cast<std::size_t>(set_.nodes()));
  set_.from_home().forward<CandidateSearch::Sought>(sought, sought_);
  limit_clearances();
  make_groups();
  watch_nodes();
}

// Rigid surfaces have a skin, too: as wide as those of the nodes at most, and twice what they move in a step at least.
void Contact::add_rigid_pairs(double time, double dt, std::vector<PairRecord>& extra) {
  if (rigid_.empty()) return;
  const std::vector<SurfaceNode>& nodes = surfaces_.nodes();
  rigid_skin_ = comm_.max(search_.skins().empty() ? 0.0 : std::ranges::max(search_.skins()));
  rigid_sought_.clear();
  for (const MovingSurface& surface : rigid_) {
    rigid_sought_.push_back(surface.shift());
    if (dt > 0)
      rigid_skin_ =
          std::max(rigid_skin_, 2 * dt * norm(surface.velocity(time, dt) - search_.common()) + rigid_reserve_);
  }
  for (std::size_t r = 0; r < rigid_.size(); ++r)
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      const SurfaceNode& node = nodes[n];
      const Vec3 x =
          parties_[static_cast<std::size_t>(node.party)]->contact_positions()[static_cast<std::size_t>(node.node)];
      const double margin = 0.1 * node.size;
      if (!(rigid_[r].distance(x) - node.radius <= search_.skins()[n] + rigid_skin_ + margin)) continue;
      PairRecord pair;
      pair.key = {1, {node.id, static_cast<GlobalId>(r), 0, 0}};
      pair.nodes = 1;
      pair.first_surface = node.surface;
      pair.second_surface = static_cast<std::int32_t>(surfaces_.names().size() + r);
      pair.node[0] = {node.id, {comm_.rank(), static_cast<LocalIndex>(n)}, -1};
      pair.clearance = node.radius, pair.margin = margin;
      extra.push_back(pair);
    }
}

/// Local, the same on every rank: share of the rigid surfaces' skin that is used at the end of the step.
double Contact::used_by_rigid(double time, double dt) const {
  double greatest = 0;
  for (std::size_t r = 0; r < rigid_.size(); ++r) {
    const Vec3 moved = rigid_[r].shift() + dt * rigid_[r].velocity(time, dt) - rigid_sought_[r] -
                       (search_.since() + dt) * search_.common();
    greatest = std::max(greatest, norm(moved));
  }
  return rigid_skin_ > 0 ? greatest / rigid_skin_ : 0;
}

// Shells may be drawn closer to each other than they are thick: at folds and where layers meet. What was so at first
// stays allowed, and so do overlaps that are kept.
void Contact::limit_clearances() {
  struct Drawn {
    Vec3 place;
    double kept;
  };
  std::vector<Drawn> drawn;
  for (const LocalIndex n : set_.busy()) {
    const SurfaceNode& node = surfaces_.nodes()[static_cast<std::size_t>(n)];
    const auto kept = kept_.find(node.id);
    drawn.push_back({parties_[static_cast<std::size_t>(node.party)]
                         ->contact_mesh()
                         .coordinates[static_cast<std::size_t>(node.node)],
                     kept == kept_.end() ? 0.0 : kept->second});
  }
  std::vector<Drawn> at(static_cast<std::size_t>(set_.nodes()));
  set_.from_home().forward<Drawn>(drawn, at);
  const auto of = [&](const WorkingPair& pair, std::int32_t k) -> const Drawn& {
    return at[static_cast<std::size_t>(pair.node[static_cast<std::size_t>(k)])];
  };
  for (WorkingPair& pair : set_.pairs()) {
    double kept = of(pair, 0).kept;
    if (pair.key.kind >= 2) kept = std::max(kept, of(pair, 1).kept);
    if (pair.key.kind == 0 && pair.shells) {
      FaceShape face{pair.nodes - 1, {}};
      for (std::int32_t k = 1; k < pair.nodes; ++k) face.x[static_cast<std::size_t>(k - 1)] = of(pair, k).place;
      pair.clearance = std::min(pair.clearance, closest_point(face, of(pair, 0).place).distance);
    }
    pair.clearance -= kept;
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
