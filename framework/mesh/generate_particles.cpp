// SPDX-License-Identifier: BSD-3-Clause
// Particles on lattices.
#include <fmt/core.h>

#include "framework/base/error.hpp"
#include "framework/mesh/generators.hpp"

namespace tenon {

MeshData generate(const ParticleBox& shape) {
  if (shape.dimension < 1 || shape.dimension > 3)
    throw Error(ExitCode::usage, fmt::format("particles: {} dimensions; expected 1, 2 or 3", shape.dimension));
  Vec3 spacing{};
  double volume = 1;
  for (std::size_t c = 0; c < 3; ++c) {
    const bool used = c < static_cast<std::size_t>(shape.dimension);
    if (shape.particles[c] < 1 || (used && !(shape.high[c] > shape.low[c])))
      throw Error(ExitCode::usage, "particles: a box needs particles along each axis and a high corner above the low");
    spacing[c] = (shape.high[c] - shape.low[c]) / shape.particles[c];
    if (used) volume *= spacing[c];
  }
  MeshData mesh;
  mesh.source = "box of particles";
  BlockData block;
  block.name = "particles", block.label = 1, block.kind = ElementKind::particle;
  for (int k = 0; k < shape.particles[2]; ++k)
    for (int j = 0; j < shape.particles[1]; ++j)
      for (int i = 0; i < shape.particles[0]; ++i) {
        const auto id = static_cast<std::int64_t>(mesh.coordinates.size());
        mesh.coordinates.push_back({shape.low[0] + (i + 0.5) * spacing[0], shape.low[1] + (j + 0.5) * spacing[1],
                                    shape.low[2] + (k + 0.5) * spacing[2]});
        mesh.node_labels.push_back(id + 1);
        mesh.volumes.push_back(volume);
        block.connectivity.push_back(id);
        block.labels.push_back(id + 1);
      }
  mesh.blocks.push_back(std::move(block));
  return mesh;
}

}  // namespace tenon
