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
constexpr std::size_t most_candidates = 24;  ///< elements that a point may be in the boxes of
constexpr double infinite = std::numeric_limits<double>::infinity();
/// A point that is farther inside than this needs no comparison with a neighbour, in local coordinates.
constexpr double well_inside = 1e-9;

/// The elements that may hold a point, ascending by id, and how far it has come with them.
struct Candidates {
  std::array<LocalIndex, most_candidates> element;
  std::size_t count = 0, next = 0;
  LocalIndex take() { return next < count ? element[next++] : no_index; }
};

void write_inside(const ElementSet& elements, LocalIndex at, const Vec3& xi, std::size_t work, Placement& place) {
  const auto e = static_cast<std::size_t>(at);
  place.element = elements.ids[e], place.distance = 0, place.xi = xi, place.item = elements.items[e];
  place.at_owner = elements.at_owner(at), place.here = at, place.owner = elements.owner(at);
  place.kind = elements.kind(at), place.state = PlaceState::inside, place.work = static_cast<std::uint8_t>(work);
}

class Placer {
 public:
  using Points = std::array<const Vec3*, block_points>;
  using Places = std::array<Placement*, block_points>;

  Placer(const ElementSet& elements, const BoxTree& tree, double reach, const PlaceRules& rules)
      : elements_(elements), tree_(tree), reach_(reach), rules_(rules), all_hexahedra_(elements.hexahedra()) {}

  void place(const Points& points, const Places& places, std::size_t count) {
    if (!find_leaves(points, count)) return place_halves(points, places, count);
    points_ = &points, places_ = &places;
    waiting_ = 0;
    for (std::size_t i = 0; i < count; ++i) {
      best_[i] = {infinite, no_index, {}};
      done_[i] = !find_candidates(i);
      if (done_[i])
        place_one(*points[i], *places[i]);
      else
        advance(i);
    }
    // The last tasks are made up of copies.
    while (waiting_ > 0) run(std::min(waiting_, hex_lanes));
    for (std::size_t i = 0; i < count; ++i) {
      if (done_[i]) continue;
      if (best_[i].element == no_index)
        *places[i] = place_nearest(elements_, tree_, *points[i], reach_, rules_);
      else
        *places[i] = in_element(elements_, best_[i].element, *points[i], best_[i].xi);
    }
  }

 private:
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
  bool find_candidates(std::size_t i) {
    const BoxTree::LeafPoint point = tree_.leaf_point(*(*points_)[i]);
    Candidates& found = candidates_[i];
    found.count = found.next = 0;
    for (const LocalIndex leaf : leaves_)
      for (unsigned hits = tree_.hits(leaf, point); hits != 0; hits &= hits - 1) {
        if (found.count == most_candidates) return false;
        const LocalIndex e = tree_.in_leaf(leaf, std::countr_zero(hits));
        std::size_t k = found.count++;
        for (const GlobalId id = elements_.id(e); k > 0 && elements_.id(found.element[k - 1]) > id; --k)
          found.element[k] = found.element[k - 1];
        found.element[k] = e;
      }
    return true;
  }

  void place_one(const Vec3& point, Placement& place) {
    many_.clear();
    tree_.containing(point, many_);
    place = place_inside(elements_, many_, point, rules_);
    if (!place.found()) place = place_nearest(elements_, tree_, point, reach_, rules_);
    place.work = 255;
  }

  /// Queues the next hexahedron that may hold the point; others are tried on the way.
  void advance(std::size_t i) {
    while (true) {
      const LocalIndex candidate = candidates_[i].take();
      if (candidate == no_index) return;
      if (all_hexahedra_ || elements_.kind(candidate) == ElementKind::hex8) {
        queue_[waiting_++] = {i, candidate};
        return;
      }
      if (try_alone(i, candidate)) return;
    }
  }

  /// By the scalar inverse map. True if the search for the point is over.
  bool try_alone(std::size_t i, LocalIndex candidate) {
    const ElementKind kind = elements_.kind(candidate);
    if (topology(kind).dimension != 3) return false;
    const InverseMap inverse = inverse_map(kind, CornerList(elements_, candidate).span(), *(*points_)[i]);
    return inverse.converged && take(i, candidate, overshoot(kind, inverse.xi), inverse.xi);
  }

  bool take(std::size_t i, LocalIndex candidate, double outside, const Vec3& xi) {
    if (outside > 2 * rules_.tolerance || !(outside < best_[i].overshoot)) return false;
    best_[i] = {outside, candidate, xi};
    return ends_search(outside, rules_);
  }

  void run(std::size_t count) {
    std::array<HexTask, hex_lanes> tasks;
    std::array<Queued, hex_lanes> queued;
    for (std::size_t l = 0; l < hex_lanes; ++l) {
      queued[l] = queue_[waiting_ - 1 - std::min(l, count - 1)];
      tasks[l] = {elements_.nodes_of(queued[l].element), (*points_)[queued[l].point]};
    }
    waiting_ -= count;
    HexPlaces at;
    place_in_hexahedra(elements_.x.data(), tasks, at);
    for (std::size_t l = 0; l < count; ++l) {
      const std::size_t i = queued[l].point;
      if (!at.converged[l]) {
        if (!try_alone(i, queued[l].element)) advance(i);
      } else if (take(i, queued[l].element, at.overshoot[l], at.xi[l])) {
        write_inside(elements_, queued[l].element, at.xi[l], candidates_[i].next, *(*places_)[i]);
        done_[i] = true;
      } else {
        advance(i);
      }
    }
  }

  struct Queued {
    std::size_t point;
    LocalIndex element;
  };

  /// The best element for a point so far, in the manner of place_inside.
  struct Best {
    double overshoot;
    LocalIndex element;
    Vec3 xi;
  };
  const ElementSet& elements_;
  const BoxTree& tree_;
  double reach_;
  PlaceRules rules_;
  bool all_hexahedra_;
  std::vector<LocalIndex> leaves_, many_;
  const Points* points_ = nullptr;
  const Places* places_ = nullptr;
  std::array<Candidates, block_points> candidates_;
  std::array<Best, block_points> best_;
  std::array<bool, block_points> done_;
  std::array<Queued, block_points + hex_lanes> queue_;
  std::size_t waiting_ = 0;
};

/// The diagonal that blocks of points may have if points that follow each other are near each other, as the nodes of
/// most meshes are: by the median of some blocks beside that of some boxes. Else 0. Costs no accuracy if it errs.
double ordered_diagonal(std::span<const Vec3> points, std::span<const Box> boxes) {
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
  const double most = 16 * median(sizes);
  return median(blocks) < most ? most : 0;
}

/// In blocks that end early where the next point would make them larger than `most`.
template <typename At>
void place_in_order(Placer& placer, std::span<const Vec3> points, std::span<Placement> places, std::size_t count,
                    double most, At at) {
  Placer::Points block;
  Placer::Places into;
  std::size_t in_block = 0;
  Box around;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = at(k);
    Box larger = around;
    larger.add(points[i]);
    if (in_block == block_points || (in_block > 0 && larger.diagonal() > most)) {
      placer.place(block, into, in_block);
      in_block = 0, larger = Box{points[i], points[i]};
    }
    around = larger;
    block[in_block] = &points[i], into[in_block] = &places[i];
    ++in_block;
  }
  if (in_block > 0) placer.place(block, into, in_block);
}

}  // namespace

void place_many(const ElementSet& elements, const BoxTree& tree, std::span<const Vec3> points, double reach,
                const PlaceRules& rules, std::span<Placement> places) {
  Placer placer(elements, tree, reach, rules);
  if (const double most = ordered_diagonal(points, elements.boxes); most > 0) {
    place_in_order(placer, points, places, points.size(), most, [](std::size_t k) { return k; });
    return;
  }
  Box around;
  for (const Vec3& p : points) around.add(p);
  std::vector<HilbertPlace> order =
      HilbertCurve(around).places(points.size(), [&](std::size_t i) { return points[i]; });
  sort_along_curve(order);
  place_in_order(placer, points, places, points.size(), infinite,
                 [&](std::size_t k) { return static_cast<std::size_t>(order[k].index); });
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
  const double most = ordered_diagonal(points, elements.boxes);
  if (most > 0) {
    place_in_order(placer, points, places, rest.size(), most, [&](std::size_t k) { return rest[k]; });
    return;
  }
  Box around;
  for (const std::size_t i : rest) around.add(points[i]);
  std::vector<HilbertPlace> order =
      HilbertCurve(around).places(rest.size(), [&](std::size_t k) { return points[rest[k]]; });
  sort_along_curve(order);
  place_in_order(placer, points, places, rest.size(), infinite,
                 [&](std::size_t k) { return rest[static_cast<std::size_t>(order[k].index)]; });
}

}  // namespace tenon::transfer
