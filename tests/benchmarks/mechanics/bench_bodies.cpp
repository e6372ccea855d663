// SPDX-License-Identifier: BSD-3-Clause
#include "bench_bodies.hpp"

#include "framework/mesh/generators.hpp"

namespace tenon::bench {

namespace {

/// Every hexahedron becomes two wedges.
MeshData wedges(MeshData mesh) {
  BlockData cut{mesh.blocks[0].name, 1, ElementKind::wedge6, {}, {}};
  const std::vector<GlobalId>& from = mesh.blocks[0].connectivity;
  for (std::size_t n = 0; n < from.size(); n += 8)
    for (const int corner : {1, 2}) {
      for (const int layer : {0, 4})
        for (const int i : {0, corner, corner + 1})
          cut.connectivity.push_back(from[n + static_cast<std::size_t>(layer + i)]);
      cut.labels.push_back(static_cast<std::int64_t>(cut.labels.size()) + 1);
    }
  mesh.blocks[0] = std::move(cut);
  mesh.side_sets.clear();
  return mesh;
}

MaterialDescription material(Law law) {
  MaterialDescription m;
  m.name = "steel";
  m.density = 7850;
  m.elastic = Elasticity{210e9, 0.3, 0};
  if (law == Law::j2) m.plasticity = LinearHardeningParameters{400e6, 1e9};
  if (law == Law::johnson_cook) m.plasticity = JohnsonCookParameters{400e6, 500e6, 0.3, 0.015, 1, 1, 293.15, 1773};
  return m;
}

}  // namespace

MeshData make_mesh(Kind kind) {
  if (kind == Kind::quad4) {
    PlateShape plate;
    plate.elements_x = plate.elements_y = 512;
    return generate(plate);
  }
  BoxShape box;
  const int n = kind == Kind::tet4 ? 35 : kind == Kind::wedge6 ? 51 : 64;
  box.elements = {n, n, n};
  box.tetrahedra = kind == Kind::tet4;
  return kind == Kind::wedge6 ? wedges(generate(box)) : generate(box);
}

std::shared_ptr<const Mesh> distributed(MeshData&& mesh) {
  return distribute(Communicator::world(), std::move(mesh), {});
}

std::unique_ptr<Mechanics> make_body(std::shared_ptr<const Mesh> mesh, const Case& c) {
  MechanicsOptions options;
  MechanicsOptions::Block block;
  block.name = mesh->blocks.front().name;
  block.material = material(c.law);
  if (c.kind == Kind::hex8_full) block.formulation = MechanicsOptions::Formulation::full;
  if (c.kind == Kind::quad4) block.shell.thickness = 2e-3, block.shell.points = 5;
  options.blocks = {block};
  options.hourglass.form = c.hourglass;
  if (c.hourglass == HourglassOptions::Form::stiffness) options.hourglass.coefficient = 0.05;
  options.time_step.fixed = 0.15e-6;
  InitialVelocity stretch;
  stretch.gradient = {-4000, 600, 0, 0, 1000, 0, 0, 0, c.kind == Kind::quad4 ? 0.0 : 1400};
  options.initial_velocities = {stretch};
  auto body = std::make_unique<Mechanics>("body", std::move(mesh), std::move(options));
  body->initialize();
  return body;
}

void take_steps(Mechanics& body, int steps) {
  for (int i = 0; i < steps; ++i) body.advance(body.time_step());
}

}  // namespace tenon::bench
