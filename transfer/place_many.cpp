// SPDX-License-Identifier: BSD-3-Clause
#include "transfer/place_many.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

#include "framework/base/hilbert.hpp"
#include "framework/mesh/shape_functions.hpp"
#include "transfer/hex8_place.hpp"

namespace tenon::transfer {

namespace {

constexpr std::size_t block_points = 16;     ///< that share a search
constexpr std::size_t most_leaves = 96;      ///< of the tree that a block may meet
constexpr std::size_t ahead = 48;            ///< points on their way from memory
constexpr std::size_t most_candidates = 24;  ///< elements that a point may be in the boxes of
constexpr double infinite = std::numeric_limits<double>::infinity();
/// A point that is farther inside than this needs no comparison with a neighbour, in half widths.
constexpr double well_inside = 1e-9;

void write_inside(const ElementSet& elements, LocalIndex at, const Vec3& xi, std::size_t work, Placement& place) {
  const auto e = static_cast<std::size_t>(at);
  place.element = elements.ids[e], place.distance = 0, place.xi = xi, place.item = elements.items[e];
  place.at_owner = elements.at_owner(at), place.here = at, place.owner = elements.owner(at);
  place.kind = elements.kind(at), place.state = PlaceState::inside, place.work = static_cast<std::uint8_t>(work);
}

/// Whether a plane has the point on one side and all corners on the other, by more than any tolerance: then the point
/// is outside, whatever Newton does, and at no price (there may be no solution to find). Planes parallel to the faces
/// are tried, and for hexahedra those parallel to two of the three directions.
bool plainly_outside(const ElementSet& elements, LocalIndex e, const Vec3& point, double tolerance) {
  const Topology& t = topology(elements.kind(e));
  const LocalIndex* const nodes = elements.nodes_of(e);
  const auto count = static_cast<std::size_t>(t.nodes);
  std::array<Vec3, max_linear_nodes> x;
  if (count > x.size()) return false;  // curved sides
  for (std::size_t a = 0; a < count; ++a) x[a] = elements.x[static_cast<std::size_t>(nodes[a])] - point;
  const auto separates = [&](const Vec3& normal) {
    double least = infinite, greatest = -infinite;
    for (std::size_t a = 0; a < count; ++a) {
      const double height = dot(normal, x[a]);
      least = std::min(least, height), greatest = std::max(greatest, height);
    }
    const double room = (1e-9 + 4 * tolerance) * (greatest - least);
    return least > room || greatest < -room;
  };
  if (t.kind == ElementKind::hex8) {
    const Vec3 xi = (x[1] + x[2] + x[5] + x[6]) - (x[0] + x[3] + x[4] + x[7]);
    const Vec3 eta = (x[2] + x[3] + x[6] + x[7]) - (x[0] + x[1] + x[4] + x[5]);
    const Vec3 zeta = (x[4] + x[5] + x[6] + x[7]) - (x[0] + x[1] + x[2] + x[3]);
    if (separates(cross(eta, zeta)) || separates(cross(zeta, xi)) || separates(cross(xi, eta))) return true;
  }
  for (std::size_t s = 0; s < static_cast<std::size_t>(t.sides); ++s) {
    const auto corner = [&](std::size_t k) { return x[static_cast<std::size_t>(t.side[s][k])]; };
    const bool quad = t.side_nodes[s] == 4;
    if (separates(cross(corner(2) - corner(0), quad ? corner(3) - corner(1) : corner(1) - corner(0)))) return true;
  }
  return false;
}

/// Points go in block by block; tasks (a point in a hexahedron) wait until there are enough to work on side by side, so
/// a block may be finished together with the next. finish() is to be called at the end.
class Placer {
 public:
  using Points = std::array<const Vec3*, block_points>;
  using Places = std::array<Placement*, block_points>;

  Placer(const ElementSet& elements, const BoxTree& tree, double reach, const PlaceRules& rules)
      : elements_(elements), tree_(tree), reach_(reach), rules_(rules), all_hexahedra_(elements.hexahedra()) {
    for (std::size_t k = 0; k < states; ++k) free_[k] = static_cast<std::uint8_t>(k);
  }

  void place(const Points& points, const Places& places, std::size_t count) {
    if (!find_leaves(points, count)) return place_halves(points, places, count);
    for (std::size_t i = 0; i < count; ++i) {
      while (free_count_ == 0) run(waiting_);  // ends: candidates are finite
      const std::uint8_t s = free_[--free_count_];
      State& state = states_[s];
      state.point = points[i], state.place = places[i];
      state.overshoot = infinite, state.element = no_index;
      if (find_candidates(state)) {
        advance(s);
      } else {
        place_one(*points[i], *places[i]);
        release(s);
      }
      if (waiting_ >= hex_lanes) run(hex_lanes);
    }
  }

  void finish() {
    while (waiting_ > 0) run(std::min(waiting_, hex_lanes));
  }

 private:
  static constexpr std::size_t states = 2 * hex_lanes;

  /// A point on its way: the elements that may hold it, ascending by id, and the best of those tried, in the manner of
  /// place_inside.
  struct State {
    const Vec3* point;
    Placement* place;
    std::array<LocalIndex, most_candidates> candidate;
    std::size_t count, next;
    double overshoot;
    LocalIndex element;
    Vec3 xi;
  };
  struct Queued {
    LocalIndex element;
    std::uint8_t state;
  };

  bool find_leaves(const Points& points, std::size_t count) {
    Box around;
    for (std::size_t i = 0; i < count; ++i) around.add(*points[i]);
    leaves_.clear();
    tree_.leaves_overlapping(around, leaves_);
    return leaves_.size() <= most_leaves || count == 1;
  }

  // Too many candidates: fewer points share the search. How a point is placed does not depend on its company.
  void place_halves(const Points& points, const Places& places, std::size_t count) {
    Points half_points;
    Places half_places;
    for (const auto& [first, last] : {std::pair(std::size_t{0}, count / 2), std::pair(count / 2, count)}) {
      std::copy(points.begin() + first, points.begin() + last, half_points.begin());
      std::copy(places.begin() + first, places.begin() + last, half_places.begin());
      place(half_points, half_places, last - first);
    }
  }

  /// False if there are too many.
  bool find_candidates(State& state) {
    const BoxTree::LeafPoint point = tree_.leaf_point(*state.point);
    state.count = state.next = 0;
    for (const LocalIndex leaf : leaves_)
      for (unsigned hits = tree_.hits(leaf, point); hits != 0; hits &= hits - 1) {
        const LocalIndex e = tree_.in_leaf(leaf, std::countr_zero(hits));
        if (state.count == most_candidates && !make_room(state, e)) return false;
        if (state.count == most_candidates) continue;
        std::size_t k = state.count++;
        for (const GlobalId id = elements_.id(e); k > 0 && elements_.id(state.candidate[k - 1]) > id; --k)
          state.candidate[k] = state.candidate[k - 1];
        state.candidate[k] = e;
      }
    return true;
  }

  /// Of a full list, leaves those whose boxes really hold the point; what the leaves say beyond depends on the origin
  /// of the tree. False if the list stays full and e belongs to it, too.
  bool make_room(State& state, LocalIndex e) const {
    const auto holds = [&](LocalIndex c) {
      return elements_.boxes[static_cast<std::size_t>(c)].contains(*state.point);
    };
    std::size_t kept = 0;
    for (std::size_t k = 0; k < state.count; ++k)
      if (holds(state.candidate[k])) state.candidate[kept++] = state.candidate[k];
    state.count = kept;
    return kept < most_candidates || !holds(e);
  }

  void place_one(const Vec3& point, Placement& place) {
    many_.clear();
    tree_.containing(point, many_);
    place = place_inside(elements_, many_, point, rules_);
    if (!place.found()) place = place_nearest(elements_, tree_, point, reach_, rules_);
    place.work = 255;
  }

  /// Queues the next hexahedron that may hold the point; others are tried on the way. Settles the point if none is
  /// left.
  void advance(std::uint8_t s) {
    State& state = states_[s];
    while (state.next < state.count) {
      const LocalIndex candidate = state.candidate[state.next++];
      if (all_hexahedra_ || elements_.kind(candidate) == ElementKind::hex8) {
        queue_[waiting_++] = {candidate, s};
        return;
      }
      if (try_alone(state, candidate)) break;
    }
    if (state.element == no_index)
      *state.place = place_nearest(elements_, tree_, *state.point, reach_, rules_);
    else
      *state.place = in_element(elements_, state.element, *state.point, state.xi);
    release(s);
  }

  void release(std::uint8_t s) { free_[free_count_++] = s; }

  /// By the scalar inverse map. True if the search for the point is over.
  bool try_alone(State& state, LocalIndex candidate) {
    const ElementKind kind = elements_.kind(candidate);
    if (topology(kind).dimension != 3) return false;
    if (kind != ElementKind::tet4 && plainly_outside(elements_, candidate, *state.point, rules_.tolerance))
      return false;
    const InverseMap inverse = inverse_map(kind, CornerList(elements_, candidate).span(), *state.point);
    return inverse.converged && take(state, candidate, overshoot(kind, inverse.xi), inverse.xi);
  }

  bool take(State& state, LocalIndex candidate, double outside, const Vec3& xi) {
    if (outside > 2 * rules_.tolerance || !(outside < state.overshoot)) return false;
    state.overshoot = outside, state.element = candidate, state.xi = xi;
    return ends_search(outside, rules_);
  }

  /// The last `count` tasks; lanes that are left are filled with copies.
  void run(std::size_t count) {
    std::array<HexTask, hex_lanes> tasks;
    std::array<Queued, hex_lanes> queued;
    count = std::min(count, hex_lanes);
    for (std::size_t l = 0; l < hex_lanes; ++l) {
      queued[l] = queue_[waiting_ - 1 - std::min(l, count - 1)];
      tasks[l] = {elements_.nodes_of(queued[l].element), states_[queued[l].state].point};
    }
    waiting_ -= count;
    HexPlaces at;
    place_in_hexahedra(elements_.x.data(), tasks, at);
    for (std::size_t l = 0; l < count; ++l) {
      State& state = states_[queued[l].state];
      if (!at.converged[l]) {
        if (try_alone(state, queued[l].element)) state.next = state.count;
        advance(queued[l].state);
      } else if (take(state, queued[l].element, at.overshoot[l], at.xi[l])) {
        write_inside(elements_, queued[l].element, at.xi[l], state.next, *state.place);
        release(queued[l].state);
      } else {
        advance(queued[l].state);
      }
    }
  }

  const ElementSet& elements_;
  const BoxTree& tree_;
  double reach_;
  PlaceRules rules_;
  bool all_hexahedra_;
  std::vector<LocalIndex> leaves_, many_;
  std::array<State, states> states_;
  std::array<std::uint8_t, states> free_;
  std::size_t free_count_ = states;
  std::array<Queued, states> queue_;
  std::size_t waiting_ = 0;
};

/// The length that blocks of points may have if points that follow each other are near each other, as the nodes of most
/// meshes are: by the median of some blocks beside that of some boxes. Else 0. Costs no accuracy if it errs.
double ordered_length(std::span<const Vec3> points, std::span<const Box> boxes) {
  constexpr std::size_t samples = 33;
  if (points.size() < samples * block_points || boxes.size() < samples) return 0;
  std::array<double, samples> blocks, sizes;
  for (std::size_t s = 0; s < samples; ++s) {
    Box around;
    const std::size_t first = (points.size() - block_points) / (samples - 1) * s;
    for (std::size_t k = 0; k < block_points; ++k) around.add(points[first + k]);
    blocks[s] = around.diagonal();
    sizes[s] = boxes[(boxes.size() - 1) / (samples - 1) * s].diagonal();
  }
  const auto median = [](std::array<double, samples>& values) {
    std::nth_element(values.begin(), values.begin() + samples / 2, values.end());
    return values[samples / 2];
  };
  const double size = median(sizes);
  return median(blocks) < 16 * size ? 3 * size : 0;
}

/// In blocks that end early where the next point is farther than `most` from the first.
template <typename At>
void place_in_order(Placer& placer, std::span<const Vec3> points, std::span<Placement> places, std::size_t count,
                    double most, At at) {
  Placer::Points block;
  Placer::Places into;
  std::size_t in_block = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = at(k);
    if (k + ahead < count) {
      __builtin_prefetch(&points[at(k + ahead)]);
      __builtin_prefetch(&places[at(k + ahead)], 1);
    }
    if (in_block == block_points) placer.place(block, into, in_block), in_block = 0;
    if (in_block > 0) {
      const Vec3 away = points[i] - *block[0];
      if (dot(away, away) > most * most) placer.place(block, into, in_block), in_block = 0;
    }
    block[in_block] = &points[i], into[in_block] = &places[i];
    ++in_block;
  }
  if (in_block > 0) placer.place(block, into, in_block);
  placer.finish();
}

}  // namespace

void place_many(const ElementSet& elements, const BoxTree& tree, std::span<const Vec3> points, double reach,
                const PlaceRules& rules, std::span<Placement> places) {
  Placer placer(elements, tree, reach, rules);
  if (const double most = ordered_length(points, elements.boxes); most > 0) {
    place_in_order(placer, points, places, points.size(), most, [](std::size_t k) { return k; });
    return;
  }
  Box around;
  for (const Vec3& p : points) around.add(p);
  const std::vector<LocalIndex> order =
      HilbertCurve(around).order(points.size(), [&](std::size_t i) { return points[i]; });
  place_in_order(placer, points, places, points.size(), infinite,
                 [&](std::size_t k) { return static_cast<std::size_t>(order[k]); });
}

bool place_again(const ElementSet& elements, std::span<const Vec3> points, std::span<LocalIndex> held,
                 std::span<Placement> places) {
  bool all = true;
  std::array<HexTask, hex_lanes> tasks;
  std::array<std::size_t, hex_lanes> of;
  std::size_t waiting = 0;
  const auto settle = [&](std::size_t i, bool within, const Vec3& xi) {
    if (within)
      write_inside(elements, held[i], xi, 1, places[i]);
    else
      held[i] = no_index, all = false;
  };
  HexPlaces at;
  const auto run = [&] {
    for (std::size_t l = waiting; l < hex_lanes; ++l) tasks[l] = tasks[0];
    place_in_hexahedra(elements.x.data(), tasks, at);
    for (std::size_t l = 0; l < waiting; ++l) settle(of[l], at.converged[l] && at.depth[l] > well_inside, at.xi[l]);
    waiting = 0;
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const LocalIndex e = held[i];
    if (e == no_index) {
      all = false;
    } else if (elements.kind(e) == ElementKind::hex8) {
      tasks[waiting] = {elements.nodes_of(e), &points[i]}, of[waiting] = i;
      if (++waiting == hex_lanes) run();
    } else {
      const ElementKind kind = elements.kind(e);
      const InverseMap inverse = inverse_map(kind, CornerList(elements, e).span(), points[i]);
      settle(i, inverse.converged && depth(kind, inverse.xi) > well_inside, inverse.xi);
    }
  }
  if (waiting > 0) run();
  return !all;
}

void place_rest(const ElementSet& elements, const BoxTree& tree, std::span<const Vec3> points,
                std::span<const LocalIndex> held, double reach, const PlaceRules& rules, std::span<Placement> places) {
  Placer placer(elements, tree, reach, rules);
  std::vector<std::size_t> rest;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (held[i] == no_index) rest.push_back(i);
  const double most = ordered_length(points, elements.boxes);
  if (most > 0) {
    place_in_order(placer, points, places, rest.size(), 2 * most, [&](std::size_t k) { return rest[k]; });
    return;
  }
  Box around;
  for (const std::size_t i : rest) around.add(points[i]);
  const std::vector<LocalIndex> order =
      HilbertCurve(around).order(rest.size(), [&](std::size_t k) { return points[rest[k]]; });
  place_in_order(placer, points, places, rest.size(), infinite,
                 [&](std::size_t k) { return rest[static_cast<std::size_t>(order[k])]; });
}

}  // namespace tenon::transfer
