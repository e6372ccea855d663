// SPDX-License-Identifier: BSD-3-Clause
// Loads as a user states them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "framework/base/space_time_function.hpp"
#include "framework/base/types.hpp"

namespace tenon {

/// Acceleration field on the mass of some blocks (all, if none is named), m/s^2; places are those of the undeformed
/// body.
struct BodyForce {
  std::vector<std::string> blocks;
  std::array<SpaceTimeFunction, 3> acceleration;
  std::string label;  ///< for messages
};

/// Force on nodes, N; places are those of the undeformed body.
struct NodalForce {
  std::vector<std::string> node_sets;
  std::array<SpaceTimeFunction, 3> force;  ///< on each node; on all of them together if shared
  bool shared = false;
  std::string label;
};

/// Force per area on sides.
struct SurfaceLoad {
  enum class Kind {
    pressure,            ///< against the present outward normal, per present area; value[0], Pa; present places
    reference_traction,  ///< fixed direction, per undeformed area: a dead load, Pa; undeformed places
    current_traction     ///< fixed direction, per present area, Pa; present places
  } kind = Kind::pressure;
  std::vector<std::string> side_sets;
  std::array<SpaceTimeFunction, 3> value;
  std::string label;
};

/// C = mass M + stiffness K.
struct RayleighDamping {
  double mass = 0;       ///< 1/s
  double stiffness = 0;  ///< s
};

/// Dashpots that let plane waves out: rho c_p along the normal and rho c_s across, per undeformed area [LK69].
struct NonReflecting {
  std::vector<std::string> side_sets;
  std::string label;
};

/// See KineticRelaxation.
struct RelaxationOptions {
  double tolerance = 1e-6;  ///< of the residual, against loads and reactions
  double after = 0;         ///< s; loads and motions are constant from here on: nothing has converged before
};

/// Springs or dashpots between nodes, or from nodes to the ground (their own undeformed place).
struct Connector {
  enum class Kind { spring, dashpot } kind = Kind::spring;
  enum class Ends {
    ground,  ///< every node of the sets, to where it started
    sets,    ///< every node of `node_sets` to the nearest one of `other_sets`
    labels,  ///< two nodes by their ids in the mesh file
    places   ///< the nodes nearest to two places
  } ends = Ends::ground;
  std::vector<std::string> node_sets, other_sets;
  std::array<std::int64_t, 2> node_labels{};
  std::array<Vec3, 2> place{};
  /// Force (N) over elongation (m) or its rate (m/s), ascending; linear between the points and straight on outside.
  std::vector<std::pair<double, double>> law;
  /// Only the relative displacement along it counts. Without it: along the line between two nodes, and in all
  /// directions alike to the ground (with a linear law).
  std::optional<Vec3> direction;
  std::string label;
};

/// Blocks that move as one rigid body.
struct RigidBody {
  enum class Rotation {
    free,
    fixed,
    hinge,      ///< free about `axis`, which stays where it is
    prescribed  ///< by `angle` about `axis`
  };
  std::vector<std::string> blocks;
  std::optional<Vec3> velocity;  ///< of the pivot at the start, m/s
  std::optional<Vec3> spin;      ///< at the start, rad/s
  /// A point of the body that never moves, m. Else the pivot is the centre of mass.
  std::optional<Vec3> joint;
  std::array<std::optional<TimeFunction>, 3> prescribed_velocity;  ///< of the centre, m/s; constant 0: fixed
  Rotation rotation = Rotation::free;
  Vec3 axis{0, 0, 1};
  TimeFunction angle;  ///< rad
  std::string label;
};

/// Nodes that are bound to the faces nearest to them, as they lie at the start.
struct TiedSet {
  std::vector<std::string> node_sets, side_sets;
  std::optional<double> tolerance;  ///< m; without it 5 % of the greatest face diagonal
  std::string label;
};

/// Uniform or varying Cauchy stress at the start: xx yy zz xy yz zx, Pa.
struct InitialStress {
  std::vector<std::string> blocks;
  std::array<SpaceTimeFunction, 6> stress;
  std::string label;
};

/// Mass that elements get so that none asks for a smaller step.
struct MassScaling {
  double time_step = 0;  ///< s
  double limit = 0.05;   ///< greatest added share of the mass of the whole body
};

struct LoadOptions {
  std::vector<BodyForce> body_forces;
  std::vector<NodalForce> nodal_forces;
  std::vector<SurfaceLoad> surface_loads;
  RayleighDamping damping;
  std::vector<NonReflecting> non_reflecting;
  std::vector<Connector> connectors;
  std::optional<RelaxationOptions> relaxation;
  std::vector<RigidBody> rigid_bodies;
  std::vector<TiedSet> ties;
  std::vector<InitialStress> initial_stresses;
  std::optional<MassScaling> mass_scaling;
};

}  // namespace tenon
