// SPDX-License-Identifier: BSD-3-Clause
// A round bar that mushrooms and heats up at its foot: a run's output without a run.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "framework/io/history.hpp"
#include "framework/io/vtk_output.hpp"
#include "sample_state.hpp"

namespace tenon::testing {

/// A bar along z, `across` x `across` x `along` cells of hexes, or six tets in each. All ranks hold all of it; the
/// owner is that of the slice along z.
inline Mesh bar_mesh(const Communicator& comm, int across, int along, bool tets) {
  Mesh mesh(comm);
  mesh.source = "test";
  const int side = across + 1;
  const double radius = 3.2e-3, length = 32.4e-3;
  for (int k = 0; k <= along; ++k)
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i) {
        const double x = 2.0 * i / across - 1, y = 2.0 * j / across - 1;  // square to disc, after Nowell
        mesh.coordinates.push_back(
            {radius * x * std::sqrt(1 - y * y / 2), radius * y * std::sqrt(1 - x * x / 2), length * k / along});
        mesh.node_ids.push_back(mesh.global_nodes++);
        mesh.node_labels.push_back(mesh.global_nodes);
        mesh.node_owners.push_back(0);
      }
  ElementBlock block;
  block.name = "bar";
  block.kind = tets ? ElementKind::tet4 : ElementKind::hex8;
  const int corners[8] = {
      0, 1, side + 1, side, side * side, side * side + 1, side * side + side + 1, side * side + side};
  const int split[6][4] = {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6}, {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}};
  for (int k = 0; k < along; ++k)
    for (int j = 0; j < across; ++j)
      for (int i = 0; i < across; ++i) {
        const int base = (k * side + j) * side + i;
        for (int part = 0; part < (tets ? 6 : 1); ++part) {
          block.ids.push_back(mesh.global_elements++);
          block.labels.push_back(mesh.global_elements);
          block.owners.push_back(k * comm.size() / along);
          for (int n = 0; n < (tets ? 4 : 8); ++n)
            block.connectivity.push_back(base + corners[tets ? split[part][n] : n]);
        }
      }
  block.global_count = mesh.global_elements;
  mesh.blocks.push_back(std::move(block));
  return mesh;
}

/// Plastic strain at height z (m) when the share `s` (0..1) of the impact is over.
inline double foot(double z, double s) {
  return 1.6 * s * std::exp(-z / (5e-3 * (0.3 + s)));
}

/// Deformed place: shortened along z and widened, keeping the volume.
inline Vec3 mushroomed(const Vec3& x, double s) {
  double z = 0;
  constexpr int steps = 40;
  for (int i = 0; i < steps; ++i) z += x[2] / steps * std::exp(-foot((i + 0.5) * x[2] / steps, s));
  const double wide = std::exp(0.5 * foot(x[2], s));
  return {wide * x[0], wide * x[1], z};
}

/// A coupled run of `frames` frames: mechanics on hexes, thermal on finer tets, and its history.
inline void write_sample_run(const Communicator& comm, const std::string& folder, int across, int along, int frames) {
  const Mesh hexes = bar_mesh(comm, across, along, false), tets = bar_mesh(comm, 3 * across / 2, 3 * along / 2, true);
  VtkOutput output(comm, folder, std::numeric_limits<double>::quiet_NaN());
  History history(comm, folder + "/history.csv",
                  {"time", "step", "dt", "kinetic_energy", "internal_energy", "hourglass_energy", "viscosity_energy",
                   "wall_work", "plastic_work", "thermal_energy", "energy_error", "max_eqps", "max_von_mises",
                   "max_temperature", "max_displacement", "heat.max_temperature", "min_temperature"},
                  -1);
  std::vector<Vec3> at_hexes(hexes.coordinates.size()), at_tets(tets.coordinates.size());
  std::vector<double> eqps(hexes.blocks[0].ids.size()), von_mises(eqps.size()), displacement(3 * at_hexes.size()),
      temperature(at_tets.size());
  for (int frame = 0; frame < frames; ++frame) {
    const double t = frames > 1 ? 80e-6 * frame / (frames - 1) : 80e-6, s = std::sin(1.5707963 * t / 80e-6);
    for (std::size_t n = 0; n < at_hexes.size(); ++n) {
      at_hexes[n] = mushroomed(hexes.coordinates[n], s);
      for (std::size_t c = 0; c < 3; ++c) displacement[3 * n + c] = at_hexes[n][c] - hexes.coordinates[n][c];
    }
    for (std::size_t n = 0; n < at_tets.size(); ++n) {
      at_tets[n] = mushroomed(tets.coordinates[n], s);
      temperature[n] = 294 + 220 * foot(tets.coordinates[n][2], s);
    }
    for (std::size_t e = 0; e < eqps.size(); ++e) {
      const LocalIndex first = hexes.blocks[0].nodes(static_cast<LocalIndex>(e))[0];
      eqps[e] = foot(hexes.coordinates[static_cast<std::size_t>(first)][2], s);
      von_mises[e] = (90e6 + 292e6 * std::pow(eqps[e], 0.31)) * std::min(1.0, 20 * s);
    }
    const OutputPart parts[] = {
        {"mechanics",
         &hexes,
         at_hexes,
         {{{"displacement", Location::node, FieldKind::point_value, 3, "m"}, displacement},
          {{"eqps", Location::element, FieldKind::point_value, 1, "1"}, eqps},
          {{"von_mises", Location::element, FieldKind::point_value, 1, "Pa"}, von_mises}}},
        {"thermal", &tets, at_tets, {{{"temperature", Location::node, FieldKind::point_value, 1, "K"}, temperature}}}};
    output.write(t, 100 * frame, parts);
  }
  for (int i = 0; i <= 800; ++i) {
    const double t = 1e-7 * i, s = std::sin(1.5707963 * t / 80e-6), k = 240 * (1 - s) * (1 - s);
    history.row(std::vector{t, 10.0 * i, 1.2e-8 * (1 - 0.4 * s), k, 235 - 235 * k / 240, 1.5 * s, 3.5 * s, 0.0, 220 * s,
                            198 * s, i == 0 ? 0.0 : 1e-15 * (1 + 0.5 * std::sin(0.3 * i)) * i, foot(0, s),
                            5e8 * std::min(1.0, 20 * s), 294 + 220 * foot(0, s), 11e-3 * s, 294 + 220 * foot(0, s),
                            294.0});
  }
  history.flush();
}

}  // namespace tenon::testing
