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

constexpr std::size_t block_points = 16;  ///< that share a search
constexpr std::size_t most_candidates = 128;
constexpr double infinite = std::numeric_limits<double>::infinity();

/// The candidates of a block of points in order of id, and which of them each point is in the box of.
class Block {
 public:
  /// False if there are too many candidates.
  bool find(std::span<const ElementPacket> elements, std::span<const Box> boxes, const BoxTree& tree,
            const std::array<const Vec3*, block_points>& points, std::size_t count) {
    Box around;
    for (std::size_t i = 0; i < count; ++i) around.add(*points[i]);
    found_.clear();
    tree.overlapping(around, found_);
    if (found_.size() > most_candidates) return false;
    const auto id = [&](LocalIndex i) { return elements[static_cast<std::size_t>(i)].id; };
    std::sort(found_.begin(), found_.end(), [&](LocalIndex a, LocalIndex b) { return id(a) < id(b); });
    const std::size_t rows = (found_.size() + pack_width - 1) / pack_width;
    for (std::size_t k = 0; k < rows * pack_width; ++k)
      for (std::size_t c = 0; c < 3; ++c) {
        const bool there = k < found_.size();
        low_[c][k] = there ? boxes[static_cast<std::size_t>(found_[k])].low[c] : infinite;
        high_[c][k] = there ? boxes[static_cast<std::size_t>(found_[k])].high[c] : -infinite;
      }
    for (std::size_t i = 0; i < count; ++i) mask_[i] = hits(*points[i], rows);
    return true;
  }
  /// Takes the next candidate of a point, or no_index.
  LocalIndex next(std::size_t point) {
    for (std::uint64_t& word : mask_[point]) {
      if (word == 0) continue;
      const int bit = std::countr_zero(word);
      word &= word - 1;
      const auto half = static_cast<std::size_t>(&word - mask_[point].data());
      return found_[half * 64 + static_cast<std::size_t>(bit)];
    }
    return no_index;
  }

 private:
  using Mask = std::array<std::uint64_t, most_candidates / 64>;
  Mask hits(const Vec3& point, std::size_t rows) const {
    Mask mask{};
    const Pack x = broadcast<Pack>(point[0]), y = broadcast<Pack>(point[1]), z = broadcast<Pack>(point[2]);
    for (std::size_t r = 0; r < rows; ++r) {
      const std::size_t k = r * pack_width;
      const PackMask in = (load(low_[0].data() + k) <= x) & (load(high_[0].data() + k) >= x) &
                          (load(low_[1].data() + k) <= y) & (load(high_[1].data() + k) >= y) &
                          (load(low_[2].data() + k) <= z) & (load(high_[2].data() + k) >= z);
      mask[k / 64] |= static_cast<std::uint64_t>(bits(in)) << (k % 64);
    }
    return mask;
  }

  std::vector<LocalIndex> found_;
  std::array<std::array<double, most_candidates>, 3> low_, high_;
  std::array<Mask, block_points> mask_;
};

/// The best element for each point of a block so far, in the manner of place_inside.
struct Best {
  double overshoot;
  LocalIndex element;
  Vec3 xi;
};

class Placer {
 public:
  Placer(std::span<const ElementPacket> elements, std::span<const Box> boxes, const BoxTree& tree, double reach,
         const PlaceRules& rules)
      : elements_(elements), boxes_(boxes), tree_(tree), reach_(reach), rules_(rules) {}

  void place(const std::array<const Vec3*, block_points>& points, const std::array<Placement*, block_points>& places,
             std::size_t count) {
    // Too many candidates: fewer points share the search. How a point is placed must not depend on its company, so only
    // one that is alone with too many goes another way.
    if (!block_.find(elements_, boxes_, tree_, points, count)) {
      if (count == 1) return place_one(*points[0], *places[0]);
      std::array<const Vec3*, block_points> half_points;
      std::array<Placement*, block_points> half_places;
      for (const auto& [first, last] : {std::pair(std::size_t{0}, count / 2), std::pair(count / 2, count)}) {
        std::copy(points.begin() + first, points.begin() + last, half_points.begin());
        std::copy(places.begin() + first, places.begin() + last, half_places.begin());
        place(half_points, half_places, last - first);
      }
      return;
    }
    points_ = &points, places_ = &places;
    waiting_ = 0;
    for (std::size_t i = 0; i < count; ++i) best_[i] = {infinite, no_index, {}}, advance(i);
    // Tasks wait until there are four of them; the last ones are made up of copies.
    while (waiting_ > 0) run(std::min<std::size_t>(waiting_, 4));
    for (std::size_t i = 0; i < count; ++i)
      if (best_[i].element == no_index)
        *places[i] = place_nearest(elements_, tree_, *points[i], reach_, rules_);
      else if (best_[i].overshoot >= 0)
        finish(i);
  }

 private:
  const ElementPacket& element(LocalIndex i) const { return elements_[static_cast<std::size_t>(i)]; }

  void place_one(const Vec3& point, Placement& place) {
    candidates_.clear();
    tree_.containing(point, candidates_);
    place = place_inside(elements_, candidates_, point, rules_);
    if (place.element == no_id) place = place_nearest(elements_, tree_, point, reach_, rules_);
  }

  /// Queues the next hexahedron that may hold the point; others are tried on the way.
  void advance(std::size_t i) {
    while (true) {
      const LocalIndex candidate = block_.next(i);
      if (candidate == no_index) return;
      if (element(candidate).kind == ElementKind::hex8) {
        queue_[waiting_++] = {i, candidate};
        return;
      }
      if (try_alone(i, candidate)) return;
    }
  }

  /// By the scalar inverse map. True if the search for the point is over.
  bool try_alone(std::size_t i, LocalIndex candidate) {
    const ElementPacket& e = element(candidate);
    const InverseMap inverse = inverse_map(e.kind, e.corner_span(), *(*points_)[i]);
    return inverse.converged && take(i, candidate, overshoot(e.kind, inverse.xi), inverse.xi);
  }

  bool take(std::size_t i, LocalIndex candidate, double outside, const Vec3& xi) {
    if (outside > 2 * rules_.tolerance || !(outside < best_[i].overshoot)) return false;
    best_[i] = {outside, candidate, xi};
    return ends_search(outside, rules_);
  }

  void run(std::size_t count) {
    std::array<HexTask, 4> tasks;
    std::array<Queued, 4> queued;
    for (std::size_t l = 0; l < 4; ++l) {
      queued[l] = queue_[waiting_ - 1 - std::min(l, count - 1)];
      tasks[l] = {element(queued[l].element).corners.data(), (*points_)[queued[l].point]};
    }
    waiting_ -= count;
    const HexCorners corners = hex_corners(tasks);
    const HexLocal at = hex_newton(hex_polynomial(corners));
    const Pack outside = hex_overshoot(at);
    bool any_over = false;
    std::array<bool, 4> over{};
    for (std::size_t l = 0; l < count; ++l) {
      const std::size_t i = queued[l].point;
      if (!at.converged[l]) {
        if (!try_alone(i, queued[l].element)) advance(i);
        continue;
      }
      over[l] = take(i, queued[l].element, outside[l], {at.xi[l], at.eta[l], at.zeta[l]});
      any_over = any_over || over[l];
      if (!over[l]) advance(i);
    }
    if (!any_over) return;
    Pack w[8];
    hex_weights(corners, at, w);
    for (std::size_t l = 0; l < count; ++l) {
      if (!over[l]) continue;
      const std::size_t i = queued[l].point;
      Placement& place = *(*places_)[i];
      place = in_element(element(best_[i].element));
      for (std::size_t a = 0; a < 8; ++a) place.weights[a] = w[a][l];
      best_[i].overshoot = -1;  // written
    }
  }

  void finish(std::size_t i) {
    Placement& place = *(*places_)[i];
    place = in_element(element(best_[i].element));
    set_weights_at(place, element(best_[i].element), *(*points_)[i], best_[i].xi);
  }

  struct Queued {
    std::size_t point;
    LocalIndex element;
  };
  std::span<const ElementPacket> elements_;
  std::span<const Box> boxes_;
  const BoxTree& tree_;
  double reach_;
  PlaceRules rules_;
  Block block_;
  const std::array<const Vec3*, block_points>* points_ = nullptr;
  const std::array<Placement*, block_points>* places_ = nullptr;
  std::array<Best, block_points> best_;
  std::array<Queued, block_points + 4> queue_;
  std::size_t waiting_ = 0;
  std::vector<LocalIndex> candidates_;
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
void place_in_order(Placer& placer, std::span<const Vec3> points, std::span<Placement> places, double most, At at) {
  std::array<const Vec3*, block_points> block;
  std::array<Placement*, block_points> into;
  std::size_t count = 0;
  Box around;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::size_t i = at(k);
    Box larger = around;
    larger.add(points[i]);
    if (count == block_points || (count > 0 && larger.diagonal() > most)) {
      placer.place(block, into, count);
      count = 0, larger = Box{points[i], points[i]};
    }
    around = larger;
    block[count] = &points[i], into[count] = &places[i];
    ++count;
  }
  if (count > 0) placer.place(block, into, count);
}

}  // namespace

void place_many(std::span<const ElementPacket> elements, std::span<const Box> boxes, const BoxTree& tree,
                std::span<const Vec3> points, double reach, const PlaceRules& rules, std::span<Placement> places) {
  Placer placer(elements, boxes, tree, reach, rules);
  if (const double most = ordered_diagonal(points, boxes); most > 0) {
    place_in_order(placer, points, places, most, [](std::size_t i) { return i; });
    return;
  }
  Box around;
  for (const Vec3& p : points) around.add(p);
  const HilbertCurve curve(around);
  std::vector<HilbertPlace> order(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) order[i] = {curve.code(points[i]), static_cast<LocalIndex>(i)};
  sort_along_curve(order);
  place_in_order(placer, points, places, infinite,
                 [&](std::size_t i) { return static_cast<std::size_t>(order[i].index); });
}

}  // namespace tenon::transfer
