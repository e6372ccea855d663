// SPDX-License-Identifier: BSD-3-Clause
// Everything that a user may say about the mechanics of a body.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "components/materials/material.hpp"
#include "components/mechanics/bulk_viscosity.hpp"
#include "components/mechanics/load_options.hpp"
#include "components/mechanics/shell4_section.hpp"
#include "framework/base/time_function.hpp"
#include "framework/base/types.hpp"

namespace tenon {

struct HourglassOptions {
  enum class Form { viscous, stiffness, physical, none } form = Form::viscous;
  double coefficient = 0.03;  ///< viscous 0.03 (see docs/decisions/0015), stiffness 0.05; physical has none
};

struct TimeStepOptions {
  enum class Estimate {
    automatic,  ///< that of the assembled mesh where all elements allow it
    element     ///< the least that an element alone allows
  } estimate = Estimate::automatic;
  double scale = 0.9;             ///< of the estimate
  int subcycling = 1;             ///< greatest ratio of the longest to the shortest step of elements, a power of two
  std::optional<double> fixed;    ///< s; the estimate is then only watched
  std::optional<double> maximum;  ///< s
  double collapse = 1e-4;         ///< the run stops when the estimate falls below this share of the first one
};

/// When elements are taken out, other than by the failure of their material, and what becomes of their nodes.
struct ErosionOptions {
  enum class LooseNodes {
    keep,   ///< nodes that no element holds any more fly on as point masses
    remove  ///< they leave the body with their mass, momentum and energy
  };
  std::optional<double> minimum_step;  ///< s: an element whose own stable step falls below is taken out
  bool inverted = false;               ///< elements that turn inside out are taken out; else they stop the run
  LooseNodes loose_nodes = LooseNodes::keep;

  bool takes_elements() const { return minimum_step || inverted; }
};

/// Where the share of plastic work that turns into heat goes.
enum class HeatMode {
  none,       ///< it is only shown in the ledger
  adiabatic,  ///< it warms the element that it arises in
  exported    ///< it waits in the field plastic_heat for another component
};

/// v = velocity + gradient (X - centre) on a block, a node set or, if both are empty, everywhere. Later ones replace
/// earlier ones.
struct InitialVelocity {
  std::string block, node_set;
  Vec3 velocity{};                   ///< m/s
  std::array<double, 9> gradient{};  ///< rows, 1/s
  Vec3 centre{};                     ///< m
};

/// Motion that the nodes of a set must follow, in the chosen components or along a normal.
struct PrescribedMotion {
  enum class Kind {
    fixed,         ///< stands still
    displacement,  ///< u = value(t), component by component, m
    velocity,      ///< v = value(t), component by component, m/s
    acceleration,  ///< dv/dt = value(t), component by component, m/s^2
    gradient,      ///< u = factor(t) gradient (X - centre)
    rotation,      ///< x = centre + R(factor(t)) (X - centre), right-handed about axis, rad
    symmetry,      ///< no motion along the normal
    wall           ///< moves along the normal by factor(t), m, as the rigid wall that it is bonded to does
  } kind = Kind::fixed;
  std::vector<std::string> node_sets;                ///< one or more; a node in several counts once
  std::array<bool, 3> components{true, true, true};  ///< of fixed, displacement, velocity, acceleration, gradient
  std::array<bool, 3> rotations{true, true, true};   ///< of fixed: of nodes that have them (shells)
  std::array<TimeFunction, 3> value;
  TimeFunction factor;
  std::array<double, 9> gradient{};  ///< rows
  Vec3 centre{};                     ///< m; of wall: a point of the plane, on which the nodes must start
  Vec3 axis{0, 0, 1};                ///< of rotation
  Vec3 normal{0, 0, 1};              ///< of symmetry and wall
  std::string label;                 ///< for messages: "symmetry on x_min"
};

/// Half space that nodes may not enter; frictionless. They may leave it at any time.
struct RigidWall {
  Vec3 point{};                        ///< m
  Vec3 normal{0, 0, 1};                ///< towards the side where the body may be
  TimeFunction motion;                 ///< along the normal, m
  std::vector<std::string> node_sets;  ///< none: every node
  std::string label;                   ///< for messages
};

struct MechanicsOptions {
  enum class Formulation {
    automatic,  ///< hex8 one point, tet4 and wedge6 with nodal averages of the volume strain, pyramid5 full
    full        ///< every quadrature point, volume strain of the element; tet4 and wedge6 can lock
  };
  struct Block {
    std::string name;
    MaterialDescription material;
    Formulation formulation = Formulation::automatic;
    ShellSection shell;  ///< of blocks of quad4 and tri3
  };
  std::vector<Block> blocks;  ///< every block of the mesh
  HourglassOptions hourglass;
  BulkViscosity viscosity;
  TimeStepOptions time_step;
  ErosionOptions erosion;
  HeatMode heat = HeatMode::none;
  std::optional<double> initial_temperature;  ///< K; else the reference temperature of the material
  std::vector<InitialVelocity> initial_velocities;
  std::vector<PrescribedMotion> motions;
  std::vector<RigidWall> walls;
  LoadOptions loads;

  /// For programs and manufactured solutions; a scene cannot give it. Velocity (m/s) at a reference position (m), added
  /// to `initial_velocities`.
  std::function<Vec3(const Vec3&)> initial_velocity_function;
  /// Likewise, rad/s, added to what the gradients of `initial_velocities` mean for the nodes of shells.
  std::function<Vec3(const Vec3&)> initial_spin_function;
};

}  // namespace tenon
