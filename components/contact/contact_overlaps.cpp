// SPDX-License-Identifier: BSD-3-Clause
// Overlaps of the undeformed bodies: listed, and removed, kept or refused.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "components/contact/contact.hpp"

namespace tenon {

using namespace contact;

namespace {

// Of the margin of a pair, itself a tenth of a face: less is round-off of a mesh.
constexpr double least_overlap = 1e-6;
constexpr int greatest_passes = 10;

}  // namespace

// The same constraints and the same iteration as in a step, on displacements in place of velocities: a step of one
// second from rest.
void Contact::settle_overlaps() {
  std::map<std::pair<std::int32_t, std::int32_t>, std::pair<std::int64_t, double>> before;
  std::int64_t left = 0;
  for (int pass = 0; pass <= greatest_passes; ++pass) {
    left = 0;
    if (!set_.any()) break;
    std::vector<double> depth;
    std::vector<std::pair<std::int32_t, std::int32_t>> between;
    for_overlaps([&](const WorkingPair& pair, double overlap) {
      between.emplace_back(std::minmax(pair.first_surface, pair.second_surface));
      depth.push_back(overlap);
    });
    left = comm_.sum(static_cast<std::int64_t>(depth.size()));
    if (pass == 0) list_overlaps(between, depth);
    if (left == 0 || options_.initial_overlaps != ContactOptions::InitialOverlaps::remove) break;
    if (pass < greatest_passes) push_apart();
  }
  if (left == 0) return;
  if (options_.initial_overlaps == ContactOptions::InitialOverlaps::refuse)
    throw Error(ExitCode::geometry, fmt::format("{}: bodies overlap before the first step ({}); mend the mesh, or say "
                                                "contact.initial_overlaps: remove (or keep)",
                                                name(), warnings_.back()));
  if (options_.initial_overlaps == ContactOptions::InitialOverlaps::remove)
    warnings_.push_back(fmt::format("{}: {} pairs still overlap after {} passes; the rest goes in the first steps",
                                    name(), left, greatest_passes));
}

}  // namespace tenon
