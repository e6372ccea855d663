// SPDX-License-Identifier: BSD-3-Clause
// Boxes of every kind of solid element.
#pragma once

#include "mechanics_case.hpp"

namespace tenon::testing {

inline void add_element(BlockData& block, std::initializer_list<GlobalId> nodes) {
  block.connectivity.insert(block.connectivity.end(), nodes);
  block.labels.push_back(static_cast<std::int64_t>(block.labels.size()) + 1);
}

/// Every hexahedron of a mesh cut into two wedges or six pyramids about its centre; side sets are lost.
inline MeshData cut(MeshData mesh, ElementKind kind) {
  BlockData hexes = std::move(mesh.blocks[0]);
  BlockData block{hexes.name, hexes.label, kind, {}, {}};
  for (std::size_t e = 0; e < hexes.size(); ++e) {
    const GlobalId* n = hexes.connectivity.data() + 8 * e;
    if (kind == ElementKind::wedge6) {
      add_element(block, {n[0], n[1], n[2], n[4], n[5], n[6]});
      add_element(block, {n[0], n[2], n[3], n[4], n[6], n[7]});
      continue;
    }
    Vec3 centre{};
    for (int i = 0; i < 8; ++i) centre = centre + 0.125 * mesh.coordinates[static_cast<std::size_t>(n[i])];
    const auto apex = static_cast<GlobalId>(mesh.coordinates.size());
    mesh.coordinates.push_back(centre);
    mesh.node_labels.push_back(apex + 1);
    for (const auto& f : {std::array{0, 1, 2, 3}, std::array{7, 6, 5, 4}, std::array{0, 4, 5, 1},
                          std::array{1, 5, 6, 2}, std::array{2, 6, 7, 3}, std::array{3, 7, 4, 0}})
      add_element(block, {n[f[0]], n[f[1]], n[f[2]], n[f[3]], apex});
  }
  mesh.blocks[0] = std::move(block);
  mesh.side_sets.clear();
  return mesh;
}

/// A box of one kind of element, whole on rank 0.
inline MeshData solid_box(BoxShape box, ElementKind kind) {
  if (communicator().rank() != 0) return {};
  box.tetrahedra = kind == ElementKind::tet4;
  MeshData mesh = generate(box);
  return kind == ElementKind::wedge6 || kind == ElementKind::pyramid5 ? cut(std::move(mesh), kind) : mesh;
}

/// A body of solids by all quadrature points, or by the formulation that is usual for the kind.
inline std::unique_ptr<Mechanics> solid_body(std::shared_ptr<const Mesh> mesh, const MaterialDescription& material,
                                             MechanicsOptions::Formulation formulation, MechanicsOptions options) {
  for (const ElementBlock& block : mesh->blocks) options.blocks.push_back({block.name, material, formulation, {}});
  return std::make_unique<Mechanics>("body", std::move(mesh), std::move(options));
}

}  // namespace tenon::testing
