// SPDX-License-Identifier: BSD-3-Clause
// Everything that a user may say about contact. Nothing has to be said.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "framework/base/time_function.hpp"
#include "framework/base/types.hpp"
#include "framework/search/box_pairs.hpp"

namespace tenon {

/// Coulomb's law: |t| <= static_coefficient n while sticking, kinetic_coefficient n while slipping.
struct CoulombFriction {
  double static_coefficient = 0, kinetic_coefficient = 0;
};

/// What holds between two surfaces instead of the general rule. Names are blocks ("plate"), or component and block
/// ("car.plate"), or rigid surfaces of ContactOptions.
struct ContactPair {
  std::string first, second;  ///< may be the same: self contact
  bool ignore = false;
  std::optional<CoulombFriction> friction;
  bool tied = false;  ///< what touches holds on for good: no gap opens again, nothing slides
};

/// A surface of simple shape that does not deform: it moves as told, or freely with a mass.
struct RigidSurface {
  enum class Shape { plane, sphere, cylinder };
  std::string name;
  Shape shape = Shape::plane;
  Vec3 point{};             ///< m: of the plane, or the centre
  Vec3 direction{0, 0, 1};  ///< normal of the plane, to where bodies may be; axis of the (endless) cylinder
  double radius = 0;        ///< m
  bool hollow = false;      ///< bodies are inside of the sphere or cylinder
  std::array<TimeFunction, 3> displacement;  ///< m, of time; unless it has a mass
  std::optional<double> mass;                ///< kg: it translates freely, from rest or `velocity`
  Vec3 velocity{};                           ///< m/s, at the start, with a mass
};

/// For least_work: a visit takes about 0.1 us, a message some 1.5 us, and a part sends some twenty in a step at least.
constexpr double sensible_least_work = 250;

struct ContactOptions {
  /// Overlaps of the undeformed bodies are listed before the first step, and then ...
  enum class InitialOverlaps {
    remove,  ///< nodes are moved apart, without stress
    keep,    ///< the overlap is taken as touching: it may not grow
    refuse   ///< the run does not start
  } initial_overlaps = InitialOverlaps::remove;
  CoulombFriction friction;
  std::vector<ContactPair> pairs;
  std::vector<RigidSurface> rigid_surfaces;
  /// For comparison only; the answer is the same.
  SearchDecomposition decomposition = SearchDecomposition::rcb;
  /// Pairs are shared out to as few ranks as have so much counted work each in a step (visits of a constraint), or to
  /// all; 0: always to all. Where a rank has less, messages of the iteration cost more than it saves.
  double least_work = 0;
  bool always_search = false;  ///< skips forced off: search and partition in every step
};

}  // namespace tenon
