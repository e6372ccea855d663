// SPDX-License-Identifier: BSD-3-Clause
// Particles of one component against those of another: balls that may not overlap.
#include <algorithm>
#include <cmath>

#include "components/contact/contact.hpp"

namespace tenon::contact {

namespace {

// Of the spacing: what is farther off is of no interest.
constexpr double near_share = 0.1;

/// A particle as others need to know it.
struct BallRecord {
  NodeRef node;
  std::int32_t surface, party;
  double radius, size, skin;
  Vec3 place;  // when sought, m
};

}  // namespace

// Of several components of particles, all but the last against all but the first: those of one component meet each
// other only where there are three and more, and are left out.
void CandidateSearch::find_balls() {
  ball_balls_.clear();
  const std::vector<std::int32_t>& parties = surfaces_.particle_parties();
  if (parties.size() < 2) return;
  for (std::size_t side = 0; side < 2; ++side) {
    const std::int32_t other = side == 0 ? parties.back() : parties.front();
    balls_[side].clear(), ball_boxes_[side].clear();
    for (std::size_t n = 0; n < surfaces_.nodes().size(); ++n) {
      const std::int32_t party = surfaces_.nodes()[n].party;
      if (party == other || std::ranges::find(parties, party) == parties.end()) continue;
      balls_[side].push_back(static_cast<LocalIndex>(n));
      ball_boxes_[side].push_back(node_boxes_[n]);
    }
  }
  ball_search_.find(ball_boxes_[0], ball_boxes_[1], ball_balls_);
}

// A pair belongs to the rank of the ball of the first component.
void WorkingSet::add_balls(const CandidateSearch& search) {
  if (surfaces_.particle_parties().size() < 2) return;
  const std::vector<BoxPair>& found = search.ball_balls();
  std::array<std::vector<BallRecord>, 2> sides;
  for (std::size_t side = 0; side < 2; ++side) {
    std::vector<BallRecord> own;
    for (const LocalIndex n : search.balls(side)) {
      const SurfaceNode& node = surfaces_.nodes()[static_cast<std::size_t>(n)];
      own.push_back({{node.id, {comm_.rank(), n}, -1},
                     node.surface,
                     node.party,
                     node.radius,
                     node.size,
                     search.skins()[static_cast<std::size_t>(n)],
                     search.sought_place(n)});
    }
    std::vector<int> owners(found.size());
    std::vector<LocalIndex> index(found.size()), into(found.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      const ItemHandle& handle = side == 0 ? found[i].first : found[i].second;
      owners[i] = handle.rank, index[i] = handle.index, into[i] = static_cast<LocalIndex>(i);
    }
    const ExchangePlan pull = ExchangePlan::from_owners(comm_, owners, index, into, "contact candidates");
    sides[side].resize(found.size());
    pull.forward<BallRecord>(own, sides[side]);
  }
  std::vector<int> to;
  std::vector<PairRecord> send;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const BallRecord &a = sides[0][i], &b = sides[1][i];
    if (a.party >= b.party) continue;
    PairRecord pair;
    pair.key = {3, {a.node.id, b.node.id, 0, 0}};
    pair.nodes = 2;
    pair.first_surface = a.surface, pair.second_surface = b.surface;
    pair.node[0] = a.node, pair.node[1] = b.node;
    pair.clearance = a.radius + b.radius, pair.margin = near_share * std::min(a.size, b.size);
    constexpr double round_off = 1 + 1e-9;
    if (norm(a.place - b.place) > round_off * (pair.clearance + pair.margin + a.skin + b.skin)) {
      ++turned_away_;
      continue;
    }
    to.push_back(a.node.home.rank);
    send.push_back(pair);
  }
  const ExchangePlan plan = ExchangePlan::to_ranks(comm_, to, "contact candidates");
  const std::size_t before = records_.size();
  records_.resize(before + static_cast<std::size_t>(plan.received()));
  plan.forward<PairRecord>(send, std::span(records_).subspan(before));
}

}  // namespace tenon::contact

namespace tenon {

// Along the line between the two at the start of the step, which keeps linear and angular momentum; a plane across it
// keeps the balls apart however far they go in the step. Balls that pass each other do not touch.
void Contact::touch_balls(std::size_t q, double dt) {
  const contact::WorkingPair& pair = set_.pairs()[q];
  remembers_ = !pair.memory.empty();
  const auto a = static_cast<std::size_t>(pair.node[0]), b = static_cast<std::size_t>(pair.node[1]);
  const Vec3 start = state_[a].place - state_[b].place, way = end_[a] - end_[b] - start;
  const double squared = dot(way, way), distance = norm(start);
  const double when = squared > 0 ? std::clamp(-dot(start, way) / squared, 0.0, 1.0) : 0;
  const double nearest = norm(start + when * way);
  if (nearest <= pair.clearance + pair.margin) {
    contact::RigidTouch touch;
    touch.normal = distance > 0 ? (1 / distance) * start : Vec3{1, 0, 0};
    touch.gap = distance - pair.clearance;
    touch.end_gap =
        nearest > pair.clearance ? nearest - pair.clearance : dot(touch.normal, start + way) - pair.clearance;
    add_constraint(q, nullptr, nullptr, &touch, dt);
  }
  hand_over(q, q + 1, constraint_of_pair_[q] < 0 ? constraints_.size() : constraints_.size() - 1);
}

}  // namespace tenon
