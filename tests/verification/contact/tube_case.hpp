// SPDX-License-Identifier: BSD-3-Clause
// Tubes of shells that are crushed between two rigid planes (case C06).
#pragma once

#include "depth.hpp"

namespace tenon::testing {

struct Tube {
  double diameter = 0.05, thickness = 1e-3, length = 0.08;  // m
  int around = 64, along = 32;
  double trigger = 1e-4;  // m, by which one ring is drawn in
  double speed = 10;      // m/s
  double stroke = 0.05;   // m
  double friction = 0.2;
  std::optional<double> failure;  // plastic strain at which elements are eroded
};

/// Shells about the z axis from z = 0; normals point outwards. Sets "bottom" and "top".
inline MeshData tube_mesh(const Tube& tube) {
  MeshData mesh;
  BlockData block{"tube", 1, ElementKind::quad4, {}, {}};
  const int trigger = tube.along - tube.along / 8;
  for (int k = 0; k <= tube.along; ++k)
    for (int i = 0; i < tube.around; ++i) {
      const double a = 2 * std::numbers::pi * i / tube.around,
                   r = 0.5 * tube.diameter - (k == trigger ? tube.trigger : 0);
      mesh.coordinates.push_back({r * std::cos(a), r * std::sin(a), tube.length * k / tube.along});
    }
  const auto node = [&](int i, int k) { return static_cast<GlobalId>(k) * tube.around + i % tube.around; };
  for (int k = 0; k < tube.along; ++k)
    for (int i = 0; i < tube.around; ++i) {
      block.connectivity.insert(block.connectivity.end(),
                                {node(i, k), node(i + 1, k), node(i + 1, k + 1), node(i, k + 1)});
      block.labels.push_back(static_cast<std::int64_t>(block.labels.size()) + 1);
    }
  NodeSetData bottom{"bottom", 1, {}}, top{"top", 2, {}};
  for (int i = 0; i < tube.around; ++i) bottom.nodes.push_back(node(i, 0)), top.nodes.push_back(node(i, tube.along));
  mesh.blocks = {block}, mesh.node_sets = {bottom, top};
  return mesh;
}

inline ContactScene crush(const Tube& tube) {
  ContactScene s;
  s.mesh = beside({{"tube", tube_mesh(tube)}});
  MaterialDescription metal = elastic_material(70e9, 0.33, 2700);
  metal.plasticity = LinearHardeningParameters{200e6, 0};
  if (tube.failure) metal.failure.emplace().plastic_strain = tube.failure;
  s.mechanics.blocks = {of_material("tube", metal)};
  s.mechanics.blocks[0].shell.thickness = tube.thickness;
  s.mechanics.motions = {motion(PrescribedMotion::Kind::fixed, {"tube_bottom"})};
  s.contact.friction = {tube.friction, tube.friction};
  s.end = (tube.stroke + 0.5 * tube.thickness) / tube.speed;
  RigidSurface striker = rigid_plane("striker", {0, 0, tube.length + 0.5 * tube.thickness}, {0, 0, -1});
  striker.displacement[2] = TimeFunction::table({{0, 0}, {s.end, -tube.speed * s.end}});
  s.contact.rigid_surfaces = {rigid_plane("floor", {0, 0, -0.5 * tube.thickness}, {0, 0, 1}), striker};
  return s;
}

}  // namespace tenon::testing
