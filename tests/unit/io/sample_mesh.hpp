// SPDX-License-Identifier: BSD-3-Clause
// A bar of hexes with a tail of tets, every rank holding all of it as ghosts and owning scattered elements.
#pragma once

#include <memory>

#include "framework/io/vtk_output.hpp"
#include "sample_state.hpp"

namespace tenon::testing {

inline Vec3 corner(GlobalId n) {
  return {static_cast<double>(n / 4), static_cast<double>(n % 2), static_cast<double>(n / 2 % 2)};
}

/// `hexes` unit cubes in a row along x, then `tets` tetrahedra in the corner of further cubes; one node that no element
/// uses.
inline Mesh sample_mesh(const Communicator& comm, LocalIndex hexes, LocalIndex tets) {
  const auto owner = [&](GlobalId id) {
    auto rank = static_cast<int>(scramble(static_cast<std::uint64_t>(id)) % static_cast<std::uint64_t>(comm.size()));
    return comm.size() >= 3 && rank == 1 ? 2 : rank;  // rank 1 owns nothing
  };
  Mesh mesh(comm);
  mesh.source = "test";
  mesh.global_nodes = 4 * (hexes + tets + 1) + 1;
  mesh.global_elements = hexes + tets;
  for (GlobalId n = 0; n < mesh.global_nodes; ++n) {
    mesh.node_ids.push_back(n);
    mesh.node_labels.push_back(n + 1);
    mesh.node_owners.push_back(owner(n));
    mesh.coordinates.push_back(corner(n));
  }
  const LocalIndex hex_nodes[] = {0, 4, 5, 1, 2, 6, 7, 3}, tet_nodes[] = {0, 4, 1, 2};
  const auto add = [&](const char* name, ElementKind kind, std::span<const LocalIndex> nodes, LocalIndex count,
                       GlobalId first) {
    ElementBlock block;
    block.name = name;
    block.kind = kind;
    block.first_id = first;
    block.global_count = count;
    for (GlobalId id = first; id < first + count; ++id) {
      block.ids.push_back(id);
      block.labels.push_back(id + 1);
      block.owners.push_back(owner(id + 1000));
      for (const LocalIndex n : nodes) block.connectivity.push_back(static_cast<LocalIndex>(4 * id) + n);
    }
    mesh.blocks.push_back(std::move(block));
  };
  add("bar", ElementKind::hex8, hex_nodes, hexes, 0);
  if (tets > 0) add("tail", ElementKind::tet4, tet_nodes, tets, hexes);
  return mesh;
}

/// Field values that are a function of the global id (ids are local indices here) and time.
inline std::vector<double> field_values(GlobalId items, int components, double time) {
  std::vector<double> values;
  for (GlobalId i = 0; i < items; ++i)
    for (int c = 0; c < components; ++c) values.push_back(static_cast<double>(i) + 0.1 * c + 1000 * time);
  return values;
}

/// The parts of a coupled run: a bar with nodal and element fields, and a second component.
struct SampleFrame {
  SampleFrame(const Communicator& comm, double time)
      : bar(sample_mesh(comm, 20, 5)),
        heat(sample_mesh(comm, 7, 0)),
        displacement(field_values(bar.global_nodes, 3, time)),
        stress(field_values(bar.global_elements, 6, time)),
        eqps(field_values(bar.global_elements, 1, time)),
        temperature(field_values(heat.global_nodes, 1, time)) {
    parts.push_back({"mechanics",
                     &bar,
                     bar.coordinates,
                     {{{"displacement", Location::node, FieldKind::point_value, 3, "m"}, displacement},
                      {{"stress", Location::element, FieldKind::point_value, 6, "Pa"}, stress},
                      {{"eqps", Location::element, FieldKind::point_value, 1, "1"}, eqps}}});
    parts.push_back({"thermal",
                     &heat,
                     heat.coordinates,
                     {{{"temperature", Location::node, FieldKind::point_value, 1, "K"}, temperature}}});
  }
  Mesh bar, heat;
  std::vector<double> displacement, stress, eqps, temperature;
  std::vector<OutputPart> parts;
};

}  // namespace tenon::testing
