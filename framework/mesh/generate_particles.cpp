// SPDX-License-Identifier: BSD-3-Clause
// Particles on lattices.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "framework/base/error.hpp"
#include "framework/mesh/generator_tools.hpp"
#include "framework/mesh/generators.hpp"
#include "framework/mesh/particle_bodies.hpp"
#include "framework/mesh/shape_functions.hpp"

namespace tenon {

namespace {

constexpr int most_sweeps = 200;
constexpr double most_particles = 5e8;

MeshData mesh_of(const std::vector<Vec3>& places, double volume, const std::string& source) {
  MeshData mesh;
  mesh.source = source, mesh.coordinates = places;
  mesh.volumes.assign(places.size(), volume);
  BlockData block;
  block.name = "particles", block.label = 1, block.kind = ElementKind::particle;
  for (std::size_t i = 0; i < places.size(); ++i) {
    mesh.node_labels.push_back(static_cast<std::int64_t>(i) + 1);
    block.connectivity.push_back(static_cast<GlobalId>(i));
    block.labels.push_back(static_cast<std::int64_t>(i) + 1);
  }
  mesh.blocks.push_back(std::move(block));
  return mesh;
}

void require_fill(const std::string& what, const ParticleFill& fill) {
  if (fill.dimension < 1 || fill.dimension > 3)
    throw Error(ExitCode::usage, fmt::format("{}: {} dimensions; expected 1, 2 or 3", what, fill.dimension));
  require_positive(what, "spacing", fill.spacing);
}

/// Whole steps of about `pitch` in `length`, at least one.
int steps_in(double length, double pitch) {
  return std::max(1, static_cast<int>(std::lround(length / pitch)));
}

/// Distances between columns, rows and layers, in spacings.
Vec3 pitches(const ParticleFill& fill) {
  if (fill.lattice == ParticleLattice::cubic || fill.dimension == 1) return {1, 1, 1};
  if (fill.dimension == 2) {
    const double a = std::sqrt(2 / std::sqrt(3.0));
    return {a, 0.5 * std::sqrt(3.0) * a, 1};
  }
  const double a = std::pow(2.0, 1.0 / 6);
  return {a, 0.5 * std::sqrt(3.0) * a, std::sqrt(2.0 / 3) * a};
}

/// Lattice of `count` cells of size `pitch` from `low` on.
std::vector<Vec3> lattice(const Vec3& low, const std::array<int, 3>& count, const Vec3& pitch,
                          const ParticleFill& fill) {
  if (1.0 * count[0] * count[1] * count[2] > most_particles)
    throw Error(ExitCode::usage, "particles: more than 5e8 in one body; take a greater spacing");
  const bool hexagonal = fill.lattice == ParticleLattice::hexagonal && fill.dimension > 1;
  std::vector<Vec3> places;
  places.reserve(static_cast<std::size_t>(count[0]) * static_cast<std::size_t>(count[1]) *
                 static_cast<std::size_t>(count[2]));
  for (int k = 0; k < count[2]; ++k)
    for (int j = 0; j < count[1]; ++j)
      for (int i = 0; i < count[0]; ++i) {
        // Rows are shifted by half a pitch against each other, layers by a third of the distance of two rows.
        const double x = hexagonal ? ((j + k) % 2 == 0 ? 0.25 : 0.75) : 0.5;
        const double y = hexagonal && fill.dimension == 3 ? (k % 2 == 0 ? 1.0 / 3 : 2.0 / 3) : 0.5;
        Vec3 place = low;
        place[0] += (i + x) * pitch[0];
        if (fill.dimension > 1) place[1] += (j + y) * pitch[1];
        if (fill.dimension > 2) place[2] += (k + 0.5) * pitch[2];
        places.push_back(place);
      }
  return places;
}

}  // namespace

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
  std::vector<Vec3> places;
  for (int k = 0; k < shape.particles[2]; ++k)
    for (int j = 0; j < shape.particles[1]; ++j)
      for (int i = 0; i < shape.particles[0]; ++i)
        places.push_back({shape.low[0] + (i + 0.5) * spacing[0], shape.low[1] + (j + 0.5) * spacing[1],
                          shape.low[2] + (k + 0.5) * spacing[2]});
  return mesh_of(places, volume, "box of particles");
}

MeshData fill_box(const Vec3& low, const Vec3& high, const ParticleFill& fill) {
  require_fill("box of particles", fill);
  std::array<int, 3> count{1, 1, 1};
  Vec3 pitch = fill.spacing * pitches(fill);
  double volume = 1;
  for (std::size_t c = 0; c < static_cast<std::size_t>(fill.dimension); ++c) {
    require_positive("box of particles", "high - low", high[c] - low[c]);
    count[c] = steps_in(high[c] - low[c], pitch[c]);
    pitch[c] = (high[c] - low[c]) / count[c];
    volume *= pitch[c];
  }
  return mesh_of(lattice(low, count, pitch, fill), volume, "box of particles");
}

MeshData fill_region(const ParticleRegion& region, const ParticleFill& fill) {
  require_fill(region.name, fill);
  const Vec3 pitch = fill.spacing * pitches(fill);
  std::array<int, 3> count{1, 1, 1};
  Vec3 low = region.bounds.low;
  for (std::size_t c = 0; c < static_cast<std::size_t>(fill.dimension); ++c) {
    const double length = region.bounds.high[c] - region.bounds.low[c];
    constexpr double whole = 1e-9;  // of a cell: round-off makes no further one
    count[c] = static_cast<int>(std::min(std::max(std::ceil(length / pitch[c] - whole), 1.0), 1e9));
    low[c] -= 0.5 * (count[c] * pitch[c] - length);
  }
  std::vector<Vec3> places = lattice(low, count, pitch, fill);
  std::erase_if(places, [&](const Vec3& x) { return !region.inside(x); });
  if (places.empty())
    throw Error(ExitCode::geometry, fmt::format("{}: no particle of the spacing {:.4g} m fits in; take a smaller one",
                                                region.name, fill.spacing));
  const double volume = region.measure / static_cast<double>(places.size());
  if (fill.relaxed)
    relax_particles(region, std::pow(volume, 1.0 / fill.dimension), fill.dimension, most_sweeps, places);
  return mesh_of(places, volume, region.name + " of particles");
}

MeshData tank_walls(const TankShape& shape) {
  ParticleFill fill;
  fill.spacing = shape.spacing, fill.dimension = shape.dimension;
  require_fill("tank", fill);
  if (shape.layers < 1) throw Error(ExitCode::usage, "tank: expected one layer or more");
  std::array<int, 3> inside{1, 1, 1}, count{1, 1, 1}, below{};
  Vec3 pitch{1, 1, 1}, low = shape.low;
  double volume = 1;
  for (std::size_t c = 0; c < static_cast<std::size_t>(shape.dimension); ++c) {
    require_positive("tank", "high - low", shape.high[c] - shape.low[c]);
    inside[c] = steps_in(shape.high[c] - shape.low[c], shape.spacing);
    pitch[c] = (shape.high[c] - shape.low[c]) / inside[c];
    below[c] = shape.open[2 * c] ? 0 : shape.layers;
    count[c] = inside[c] + below[c] + (shape.open[2 * c + 1] ? 0 : shape.layers);
    low[c] -= below[c] * pitch[c];
    volume *= pitch[c];
  }
  std::vector<Vec3> places = lattice(low, count, pitch, fill), walls;
  std::size_t at = 0;
  for (int k = 0; k < count[2]; ++k)
    for (int j = 0; j < count[1]; ++j)
      for (int i = 0; i < count[0]; ++i, ++at) {
        const std::array<int, 3> cell{i, j, k};
        bool in = true;
        for (std::size_t c = 0; c < 3; ++c) in = in && cell[c] >= below[c] && cell[c] < below[c] + inside[c];
        if (!in) walls.push_back(places[at]);
      }
  if (walls.empty()) throw Error(ExitCode::usage, "tank: all sides are open; leave the body out");
  return mesh_of(walls, volume, "tank of particles");
}

MeshData particles_of_elements(const MeshData& mesh, const std::string& block) {
  const auto found = std::ranges::find(mesh.blocks, block, &BlockData::name);
  if (found == mesh.blocks.end() || topology(found->kind).dimension != 3)
    throw Error(ExitCode::usage, fmt::format("{}: there is no block '{}' of solid elements that could become particles",
                                             mesh.source, block));
  const auto nodes = static_cast<std::size_t>(topology(found->kind).nodes);
  const auto corners = static_cast<std::size_t>(corner_count(found->kind));
  std::vector<Vec3> places, x(nodes);
  std::vector<double> volumes;
  for (std::size_t e = 0; e < found->size(); ++e) {
    Vec3 sum{};
    for (std::size_t i = 0; i < nodes; ++i) {
      x[i] = mesh.coordinates[static_cast<std::size_t>(found->connectivity[nodes * e + i])];
      if (i < corners) sum = sum + x[i];
    }
    places.push_back((1.0 / static_cast<double>(corners)) * sum);
    volumes.push_back(element_measure(found->kind, x));
  }
  MeshData particles = mesh_of(places, 0, "elements of " + mesh.source);
  particles.volumes = std::move(volumes);
  return particles;
}

MeshData join_particles(std::vector<std::pair<std::string, MeshData>> bodies) {
  MeshData all;
  all.source = "particles";
  for (auto& [name, body] : bodies)
    for (BlockData& block : body.blocks) {
      BlockData& joined = all.blocks.emplace_back();
      joined.name = body.blocks.size() == 1 ? name : name + "_" + block.name;
      joined.label = static_cast<std::int64_t>(all.blocks.size()), joined.kind = block.kind;
      for (const GlobalId n : block.connectivity) {
        joined.connectivity.push_back(static_cast<GlobalId>(all.coordinates.size()));
        all.coordinates.push_back(body.coordinates[static_cast<std::size_t>(n)]);
        all.volumes.push_back(body.volumes[static_cast<std::size_t>(n)]);
        all.node_labels.push_back(static_cast<std::int64_t>(all.coordinates.size()));
        joined.labels.push_back(all.node_labels.back());
      }
    }
  return all;
}

}  // namespace tenon
