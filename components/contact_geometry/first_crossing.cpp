// SPDX-License-Identifier: BSD-3-Clause
#include "components/contact_geometry/first_crossing.hpp"

#include <algorithm>
#include <cmath>

namespace tenon::contact {
namespace {

// Share of the patch by which its rim is widened, and of the step by which that begins earlier and ends later.
constexpr double rim_tolerance = 1e-9;
constexpr double time_tolerance = 1e-12;
// A crossing is found when its box is this small, or, where the patch moves in its own plane, when the patch's pieces
// are this small against the patch.
constexpr double converged = 1e-12;
constexpr double smallest_piece = 1e-6;
constexpr double smallest_flat_piece = 1e-3;
constexpr int most_boxes = 2000;

struct UnknownBox {
  Vec3 low, high;  // xi, eta, t
};

/// F and its derivatives at the middle of a box, with the unknowns scaled so that the box is [-1, 1]^3.
struct Expansion {
  Vec3 value, xi, eta, time, xi_eta, xi_time, eta_time, all;
};

Expansion expand(const Patch& start, const Patch& motion, const Vec3& middle, const Vec3& half) {
  const auto [x, e, t] = middle;
  const Vec3 a = start.a + t * motion.a, b = start.b + t * motion.b, twist = start.twist + t * motion.twist;
  Expansion f;
  f.value = start.origin + t * motion.origin + x * a + e * (b + x * twist);
  f.xi = half[0] * (a + e * twist);
  f.eta = half[1] * (b + x * twist);
  f.time = half[2] * motion.at(x, e);
  f.xi_eta = half[0] * half[1] * twist;
  f.xi_time = half[0] * half[2] * motion.along_xi(e);
  f.eta_time = half[1] * half[2] * motion.along_eta(x);
  f.all = half[0] * half[1] * half[2] * motion.twist;
  return f;
}

double spread(const Expansion& f, const Vec3& direction) {
  return std::abs(dot(f.xi, direction)) + std::abs(dot(f.eta, direction)) + std::abs(dot(f.time, direction)) +
         std::abs(dot(f.xi_eta, direction)) + std::abs(dot(f.xi_time, direction)) +
         std::abs(dot(f.eta_time, direction)) + std::abs(dot(f.all, direction));
}

/// True if a projection of the box's values does not contain zero; `noise` is the round-off of F, m.
bool excluded(const Expansion& f, double noise) {
  for (int c = 0; c < 3; ++c) {
    const double reach = std::abs(f.xi[c]) + std::abs(f.eta[c]) + std::abs(f.time[c]) + std::abs(f.xi_eta[c]) +
                         std::abs(f.xi_time[c]) + std::abs(f.eta_time[c]) + std::abs(f.all[c]);
    if (std::abs(f.value[c]) > reach + noise) return true;
  }
  const Vec3 normal = cross(f.xi, f.eta);
  return std::abs(dot(f.value, normal)) > spread(f, normal) * (1 + 1e-14) + noise * norm(normal);
}

enum class Outcome { excluded, reduced, stuck, flat };

/// One step of interval Newton: every root of the box lies in y -+ e, y = -J^-1 F, e = |J^-1 higher terms|.
/// Flat: the patch moves in its own plane, or so nearly that round-off hides the crossing's place.
Outcome reduce(const Expansion& f, double noise, UnknownBox& box, const Vec3& middle, const Vec3& half) {
  const Vec3 r0 = cross(f.eta, f.time), r1 = cross(f.time, f.xi), r2 = cross(f.xi, f.eta);
  const double det = dot(f.xi, r0);
  const double scale = norm(f.xi) * norm(f.eta) * norm(f.time);
  if (!(std::abs(det) > 1e-13 * scale)) return Outcome::flat;
  const double inverse = 1 / det;
  bool smaller = false, hidden = false;
  int k = 0;
  for (const Vec3& row : {r0, r1, r2}) {
    const double y = -inverse * dot(row, f.value);
    const double e =
        std::abs(inverse) * (std::abs(dot(row, f.xi_eta)) + std::abs(dot(row, f.xi_time)) +
                             std::abs(dot(row, f.eta_time)) + std::abs(dot(row, f.all)) + noise * norm(row));
    const double low = std::max(-1.0, y - e), high = std::min(1.0, y + e);
    if (!(low <= high)) return Outcome::excluded;
    if (high - low < 1.0) smaller = true;
    box.low[k] = std::max(box.low[k], middle[k] + low * half[k]);
    box.high[k] = std::min(box.high[k], middle[k] + high * half[k]);
    if (box.high[k] < box.low[k]) box.high[k] = box.low[k];
    ++k;
  }
  return smaller ? Outcome::reduced : hidden ? Outcome::flat : Outcome::stuck;
}

struct Search {
  const Patch& start;
  Patch motion;
  bool outside_only;
  double noise = 0, small = 0, small_flat = 0;
  std::array<UnknownBox, 256> stack{};
  int pending = 0;
  bool found = false;
  Crossing best{0, 0, 2};

  /// Looks at one box; leaves what is still to be looked at on the stack.
  void visit(UnknownBox box) {
    for (int round = 0; round < 60; ++round) {
      if (box.low[2] >= best.time) return;
      if (start.triangle && box.low[0] + box.low[1] > 1 + 2 * rim_tolerance) return;
      const Vec3 middle = 0.5 * (box.low + box.high), half = 0.5 * (box.high - box.low);
      const Expansion f = expand(start, motion, middle, half);
      if (excluded(f, noise)) return;
      if (std::max({half[0], half[1], half[2]}) < converged) return accept(middle);
      const Outcome outcome = reduce(f, noise, box, middle, half);
      if (outcome == Outcome::excluded) return;
      if (outcome == Outcome::reduced) continue;
      const Vec3 length{norm(f.xi), norm(f.eta), norm(f.time)};
      const int longest = length[2] >= std::max(length[0], length[1]) ? 2 : length[0] >= length[1] ? 0 : 1;
      const double least = outcome == Outcome::flat ? small_flat : small;
      if (length[longest] < least || pending + 2 > static_cast<int>(stack.size())) return accept(middle);
      UnknownBox later = box;
      later.low[longest] = box.high[longest] = 0.5 * (box.low[longest] + box.high[longest]);
      stack[pending++] = later;
    }
    stack[pending++] = box;
  }

  void accept(const Vec3& at) {
    if (at[2] >= best.time) return;
    if (start.triangle && at[0] + at[1] > 1 + 2 * rim_tolerance) return;
    if (outside_only) {
      const Vec3 a = start.along_xi(at[1]) + at[2] * motion.along_xi(at[1]);
      const Vec3 b = start.along_eta(at[0]) + at[2] * motion.along_eta(at[0]);
      const Vec3 normal = cross(a, b), speed = motion.at(at[0], at[1]);
      if (!(dot(speed, normal) >= -1e-12 * norm(speed) * norm(normal))) return;
    }
    best = {at[0], at[1], at[2]};
    found = true;
  }
};

double largest(const Patch& p) {
  double most = 0;
  for (const Vec3& v : {p.origin, p.a, p.b, p.twist})
    for (const double c : v) most = std::max(most, std::abs(c));
  return most;
}

}  // namespace

bool first_crossing(const Patch& start, const Patch& end, bool outside_only, Crossing& crossing) {
  const Patch motion{end.origin - start.origin, end.a - start.a, end.b - start.b, end.twist - start.twist,
                     start.triangle};
  Search search{start, motion, outside_only};
  search.noise = 2e-15 * (largest(start) + largest(motion));
  const double size = std::max(norm(start.a), norm(start.b));
  search.small = smallest_piece * size;
  search.small_flat = smallest_flat_piece * size;
  search.stack[search.pending++] = {{-rim_tolerance, -rim_tolerance, -time_tolerance},
                                    {1 + rim_tolerance, 1 + rim_tolerance, 1 + time_tolerance}};
  for (int boxes = 0; search.pending > 0 && boxes < most_boxes; ++boxes) search.visit(search.stack[--search.pending]);
  if (!search.found) return false;
  crossing = {std::clamp(search.best.xi, 0.0, 1.0), std::clamp(search.best.eta, 0.0, 1.0),
              std::clamp(search.best.time, 0.0, 1.0)};
  if (start.triangle && crossing.xi + crossing.eta > 1) {
    const double sum = crossing.xi + crossing.eta;
    crossing.xi /= sum;
    crossing.eta /= sum;
  }
  return true;
}

}  // namespace tenon::contact
