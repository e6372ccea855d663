// SPDX-License-Identifier: BSD-3-Clause
// Two distributed meshes and a field in, the field out, on any number of ranks: mpirun -n 3 build/transfer_example
#include <fmt/core.h>

#include "framework/comm/mpi_access.hpp"
#include "framework/mesh/assemble.hpp"
#include "transfer/grid_transfer.hpp"
using namespace tenon;

/// Layers `part` of a cube of n x n x n bricks, as any code holds its share: node ids, coordinates, connectivity.
AssembledMesh cube(const Communicator& comm, std::int64_t n, int part) {
  std::vector<std::int64_t> ids, bricks;
  std::vector<Vec3> x;
  const std::int64_t p = n + 1, first = n * part / comm.size(), last = n * (part + 1) / comm.size();
  for (std::int64_t m = first * p * p; m < (last + 1) * p * p; ++m) {
    const std::int64_t i = m % p, j = m / p % p, k = m / (p * p);
    ids.push_back(m);
    x.push_back({double(i) / double(n), double(j) / double(n), double(k) / double(n)});
    if (i == n || j == n || k == last) continue;
    for (const std::int64_t c : {m, m + p * p}) bricks.insert(bricks.end(), {c, c + 1, c + p + 1, c + p});
  }
  return assemble(comm, {ids, x, {{"cube", ElementKind::hex8, bricks, {}}}});
}

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  const Communicator comm = communicator_on(MPI_COMM_WORLD);
  const auto source = cube(comm, 20, comm.rank()).mesh, target = cube(comm, 31, comm.size() - 1 - comm.rank()).mesh;
  std::vector<double> sent, received(target->coordinates.size());
  for (const Vec3& x : source->coordinates) sent.push_back(300 + 50 * x[0] * x[0] - 20 * x[2]);
  const transfer::GridTransfer map({source.get(), source->coordinates}, {target.get(), target->coordinates},
                                   {.name = "temperature", .unit = "K"}, {}, "temperature");
  map.apply(sent, received, 1);
  const transfer::TransferReport r = map.report(sent, received, 1);
  if (comm.rank() == 0)
    fmt::print("{} points, {} outside; integral {:.15g} -> {:.15g} K m^3; estimated error {:.3g} K\n", r.targets,
               r.outside, r.source_integral, r.target_integral, r.error_estimate);
  return MPI_Finalize();
}
