// SPDX-License-Identifier: BSD-3-Clause
// Overlaps of the undeformed bodies: listed, and removed, kept or refused.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "components/contact/buried.hpp"
#include "components/contact/contact.hpp"

namespace tenon {

using namespace contact;

namespace {

// Of the distance within which pairs are of interest, itself a tenth of a face: less is round-off of a mesh.
constexpr double least_overlap = 1e-6;
constexpr int greatest_passes = 10;

/// Overlaps between two surfaces.
struct Overlap {
  std::int32_t first, second;
  double depth;  // m
  Vec3 place;    // m
};

}  // namespace

// The same constraints and the same iteration as in a step, on displacements in place of velocities: a step of one
// second from rest.
void Contact::settle_overlaps() {
  using Choice = ContactOptions::InitialOverlaps;
  std::int64_t left = 0;
  for (int pass = 0; pass <= greatest_passes && set_.any(); ++pass) {
    find_overlaps();
    left = comm_.sum(static_cast<std::int64_t>(constraints_.size()));
    if (left > 0 && pass == 0) list_overlaps();
    if (left == 0 || options_.initial_overlaps != Choice::remove || pass == greatest_passes) break;
    push_apart();
  }
  if (left > 0 && options_.initial_overlaps == Choice::refuse)
    throw Error(ExitCode::geometry,
                warnings_.back() + "; mend the mesh, or let contact do it (initial_overlaps: remove)");
  if (left > 0 && options_.initial_overlaps == Choice::keep) keep_overlaps();
  if (left > 0 && options_.initial_overlaps == Choice::remove)
    warnings_.push_back(
        fmt::format("{}: {} overlaps are not quite removed after {} passes; the rest goes in the first "
                    "steps",
                    name(), left, greatest_passes));
  judge_buried();
  make_groups();
  any_constraint_ = false;
}

// What is so deep inside another body that no surface is near, or coincides with it, cannot be told where to go.
void Contact::judge_buried() {
  std::vector<char> known(surfaces_.nodes().size());  // overlaps that are listed already
  if (set_.any()) {
    std::vector<double> seen(state_.size()), at_home(set_.busy().size());
    for (const Constraint& q : constraints_)
      for (std::size_t k = 0; k < static_cast<std::size_t>(q.nodes); ++k) seen[static_cast<std::size_t>(q.node[k])] = 1;
    set_.results().reverse<double>(seen, at_home);
    for (std::size_t b = 0; b < at_home.size(); ++b)
      if (at_home[b] > 0) known[static_cast<std::size_t>(set_.busy()[b])] = 1;
  }
  const auto count = static_cast<std::size_t>(surface_count_);
  const auto allowed = [&](std::int32_t a, std::int32_t b) {
    return rules_[static_cast<std::size_t>(a) * count + static_cast<std::size_t>(b)].ignore;
  };
  const std::vector<Buried> buried = find_buried(comm_, surfaces_, options_.decomposition, known, allowed);
  if (!comm_.any(!buried.empty())) return;
  std::string text;
  for (std::size_t begin = 0, end = 0; begin < buried.size(); begin = end) {
    const Buried& one = buried[begin];
    while (end < buried.size() && buried[end].first == one.first && buried[end].second == one.second) ++end;
    text += fmt::format("{}{} and {} at {} places, one at ({:.6g}, {:.6g}, {:.6g})", text.empty() ? "" : "; ",
                        surface_name(one.first), surface_name(one.second), end - begin, one.place[0], one.place[1],
                        one.place[2]);
  }
  comm_.broadcast(text);
  text = fmt::format("{}: bodies are inside each other, or coincide, deeper than surfaces can part them: {}", name(),
                     text);
  if (options_.initial_overlaps != ContactOptions::InitialOverlaps::keep)
    throw Error(ExitCode::geometry, text + "; mend the mesh, or let these two not touch (pairs: ignore: true)");
  warnings_.push_back(text + "; there they do not touch");
}

/// Constraints of the pairs that overlap where everything stands.
void Contact::find_overlaps() {
  gather(components_.front()->time(), 1);
  for (std::size_t n = 0; n < state_.size(); ++n) {
    state_[n].velocity = state_[n].former = {};
    end_[n] = state_[n].place;
    predicted_[n] = {};
  }
  for (Body& body : bodies_) {
    body.state.velocity = body.state.spin = {};
    body.state.inverse_mass.fill(0), body.state.inverse_inertia.fill(0);  // bodies stay where they were put
  }
  settling_ = true;
  find_constraints(components_.front()->time(), 1);
  settling_ = false;
  std::erase_if(constraints_, [&](const Constraint& q) {
    return !(q.gap < -least_overlap * set_.pairs()[static_cast<std::size_t>(q.pair)].margin);
  });
  for (Constraint& q : constraints_) {
    q.target = -q.gap;
    q.static_coefficient = q.kinetic_coefficient = 0;
    q.surface_velocity = {};
  }
}

void Contact::list_overlaps() {
  std::vector<Overlap> mine;
  for (const Constraint& q : constraints_) {
    const WorkingPair& pair = set_.pairs()[static_cast<std::size_t>(q.pair)];
    if (pair.primary)
      mine.push_back({std::min(pair.first_surface, pair.second_surface),
                      std::max(pair.first_surface, pair.second_surface), -q.gap,
                      state_[static_cast<std::size_t>(q.node[0])].place});
  }
  std::vector<Overlap> all = comm_.gather<Overlap>(mine);
  std::ranges::sort(all, [](const Overlap& a, const Overlap& b) {
    if (a.first != b.first) return a.first < b.first;
    if (a.second != b.second) return a.second < b.second;
    return a.depth != b.depth ? a.depth > b.depth : a.place < b.place;
  });
  std::string text;
  for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
    while (end < all.size() && all[end].first == all[begin].first && all[end].second == all[begin].second) ++end;
    const Overlap& worst = all[begin];
    text += fmt::format("{}{} and {} at {} places, deepest {:.4g} m at ({:.6g}, {:.6g}, {:.6g})",
                        text.empty() ? "" : "; ", surface_name(worst.first), surface_name(worst.second), end - begin,
                        worst.depth, worst.place[0], worst.place[1], worst.place[2]);
  }
  comm_.broadcast(text);
  const char* then = options_.initial_overlaps == ContactOptions::InitialOverlaps::remove ? "; nodes are moved apart"
                     : options_.initial_overlaps == ContactOptions::InitialOverlaps::keep ? "; they are kept"
                                                                                          : "";
  warnings_.push_back(fmt::format("{}: initial overlaps: {}{}", name(), text, then));
}

/// Moves nodes by what the constraints ask for, without stress.
void Contact::push_apart() {
  enforcement_.solve(constraints_, state_, bodies_);
  std::vector<Vec3> by(set_.busy().size());
  set_.results().reverse<Vec3>(enforcement_.velocities(), by);
  std::vector<LocalIndex> nodes;
  std::vector<Vec3> shifts;
  std::size_t b = 0;
  for (std::size_t p = 0; p < parties_.size(); ++p) {
    nodes.clear(), shifts.clear();
    for (; b < set_.busy().size(); ++b) {
      const SurfaceNode& node = surfaces_.nodes()[static_cast<std::size_t>(set_.busy()[b])];
      if (node.party != static_cast<std::int32_t>(p)) break;
      if (by[b] == Vec3{}) continue;
      nodes.push_back(node.node), shifts.push_back(by[b]);
    }
    parties_[p]->shift(nodes, shifts);
  }
  search(components_.front()->time(), 0);
}

/// Every node that overlaps may go on to do so, to the same depth.
void Contact::keep_overlaps() {
  std::vector<double> depth(state_.size()), at_home(set_.busy().size());
  for (const Constraint& q : constraints_)
    for (std::int32_t k = 0; k < q.nodes; ++k)
      if (q.c[static_cast<std::size_t>(k)] > 0) {
        double& d = depth[static_cast<std::size_t>(q.node[static_cast<std::size_t>(k)])];
        d = std::max(d, -q.gap);
      }
  set_.results().reverse<double>(depth, at_home);
  for (std::size_t b = 0; b < at_home.size(); ++b)
    if (at_home[b] > 0) kept_[surfaces_.nodes()[static_cast<std::size_t>(set_.busy()[b])].id] = at_home[b];
  limit_clearances();
}

}  // namespace tenon
