// SPDX-License-Identifier: BSD-3-Clause
// Boxes and points for the broad phase.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "framework/base/box.hpp"

namespace tenon::bench {

struct BoxScene {
  std::string name;
  std::vector<Box> boxes, points;  // points: boxes without extent
};

/// A wavy sheet of about `items` facets in rows, boxes inflated so that each holds about 4.2 of as many points on the
/// sheet. Facets at one corner are `grading` times as long and as wide as at the opposite one.
BoxScene wavy_sheet(std::int64_t items, double grading = 1);
/// The same in random order.
BoxScene shuffled(BoxScene scene);
/// Boxes and points anywhere in a cube, about 7.8 points in a box.
BoxScene random_boxes(std::int64_t items);
/// A fine wavy sheet under one of facets a hundred times as long, which hold ten thousand points each.
BoxScene fine_and_coarse(std::int64_t items);

/// The share of one rank in about `items` faces and nodes of a can (diameter 1, height 1.5) that a slanting wall
/// crumples from the bottom: at `progress` 0 it is whole, at 1 two thirds of it lie in folds. Ranks own patches of the
/// whole can, as in a static decomposition.
BoxScene crumpled_can(std::int64_t items, double progress, int rank, int ranks);

}  // namespace tenon::bench
