// SPDX-License-Identifier: BSD-3-Clause
// Between the order in which a code gave its nodes and elements and that of the mesh.
#include <algorithm>

#include "framework/mesh/assemble.hpp"

namespace tenon {

std::vector<double> AssembledMesh::nodes_to_mesh(std::span<const double> given, int components) const {
  std::vector<double> local(mesh->node_ids.size() * static_cast<std::size_t>(components));
  nodes_to_mesh(given, local, components);
  return local;
}

std::vector<Vec3> AssembledMesh::nodes_to_mesh(std::span<const Vec3> given) const {
  std::vector<Vec3> local(mesh->node_ids.size());
  nodes_to_mesh_.forward(given, std::span(local));
  return local;
}

void AssembledMesh::nodes_to_mesh(std::span<const double> given, std::span<double> local, int components) const {
  nodes_to_mesh_.forward(given, local, components);
}

std::vector<double> AssembledMesh::nodes_from_mesh(std::span<const double> local, int components) const {
  std::vector<double> given(given_nodes_ * static_cast<std::size_t>(components));
  nodes_from_mesh(local, given, components);
  return given;
}

void AssembledMesh::nodes_from_mesh(std::span<const double> local, std::span<double> given, int components) const {
  nodes_from_mesh_.forward(local, given, components);
}

std::vector<double> AssembledMesh::elements_to_mesh(std::span<const double> given, int components) const {
  std::vector<double> local(static_cast<std::size_t>(mesh->elements()) * static_cast<std::size_t>(components));
  elements_to_mesh_.forward(given, std::span(local), components);
  return local;
}

std::vector<double> AssembledMesh::elements_from_mesh(std::span<const double> local, int components) const {
  const auto width = static_cast<std::size_t>(components);
  std::vector<double> given(element_places_.size() * width);
  for (std::size_t e = 0; e < element_places_.size(); ++e)
    std::copy_n(local.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(element_places_[e]) * width),
                width, given.begin() + static_cast<std::ptrdiff_t>(e * width));
  return given;
}

}  // namespace tenon
