// SPDX-License-Identifier: BSD-3-Clause
// Implicit conduction beside hypre's BoomerAMG-PCG: the same matrices, right-hand sides and tolerance in one run.
//   thermal_hypre [cells = 55] [tolerance = 1e-8]   (a unit cube of cells^3 x 6 tetrahedra; CSV on standard
// output; set-up is done once, solve once per step)
#include <HYPRE.h>
#include <HYPRE_IJ_mv.h>
#include <HYPRE_krylov.h>
#include <HYPRE_parcsr_ls.h>
#include <fmt/core.h>

#include <cmath>
#include <cstdlib>
#include <ctime>

#include "components/thermal/conjugate_gradient.hpp"
#include "framework/mesh/generators.hpp"

namespace {

using namespace tenon;

/// Processor time, which other work on the machine disturbs least.
double now() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// A step of backward Euler on the cube, held at x = 0: the matrix, and a right-hand side of many wave lengths.
struct Problem {
  std::shared_ptr<const Mesh> mesh;
  thermal::ConductionMatrix matrix;
  std::vector<double> capacity, diagonal, inverse, b;
  double factor = 0;

  explicit Problem(int cells) : mesh(make_mesh(cells)), matrix(*mesh, {1.0}) {
    matrix.assemble(mesh->coordinates, {});
    matrix.finish();
    capacity.assign(mesh->owned_nodes.size(), 0.0);
    std::array<Vec3, 4> corners;
    std::array<double, 4> volumes{};
    const ElementBlock& block = mesh->blocks.front();
    for (LocalIndex e = 0; e < block.size(); ++e) {
      for (std::size_t a = 0; a < 4; ++a) corners[a] = mesh->coordinates[static_cast<std::size_t>(block.nodes(e)[a])];
      thermal::nodal_volumes(block.kind, corners, volumes);
      for (std::size_t a = 0; a < 4; ++a)
        if (const LocalIndex row = matrix.row_of_node()[static_cast<std::size_t>(block.nodes(e)[a])]; row != no_index)
          capacity[static_cast<std::size_t>(row)] += volumes[a];
    }
  }
  static std::shared_ptr<const Mesh> make_mesh(int cells) {
    const Communicator comm = Communicator::world();
    MeshData data;
    BoxShape shape;
    shape.elements = {cells, cells, cells};
    shape.tetrahedra = true;
    if (comm.rank() == 0) data = generate(shape);
    return distribute(comm, std::move(data), {});
  }
  void set_step(double dt) {
    factor = dt;
    diagonal = capacity;
    inverse.assign(capacity.size(), 0.0);
    b = inverse;
    for (std::size_t k = 0; k < capacity.size(); ++k) {
      const Vec3& x = place(k);
      diagonal[k] += dt * matrix.diagonal()[k];
      if (x[0] > 0) inverse[k] = 1 / diagonal[k];
      for (const double w : {1.0, 7.0, 40.0}) b[k] += capacity[k] * std::sin(w * x[0] + 1) * std::cos(w * x[1] * x[2]);
    }
  }
  const Vec3& place(std::size_t k) const { return mesh->coordinates[static_cast<std::size_t>(mesh->owned_nodes[k])]; }
  thermal::HeatSystem system() const { return {matrix, factor, diagonal, inverse}; }
  /// |b - A x| / |b| in the plain norm, held rows left out.
  double error(std::span<const double> x) const {
    std::vector<double> ax(b.size());
    matrix.multiply(diagonal, factor, x, ax);
    ExactSum rest, all;
    for (std::size_t k = 0; k < b.size(); ++k)
      if (inverse[k] > 0) rest.add((b[k] - ax[k]) * (b[k] - ax[k])), all.add(b[k] * b[k]);
    return std::sqrt(mesh->comm.sum(rest) / mesh->comm.sum(all));
  }
};

struct Timing {
  double set_up, again, solve;  ///< again: set-up for other numbers in a matrix of the same pattern
  int iterations;
  double error;
};

Timing ours(const Problem& p, double tolerance, bool multigrid) {
  thermal::ConjugateGradient solver(*p.mesh);
  const double start = now();
  thermal::Multigrid levels(*p.mesh);
  if (multigrid) levels.build(p.system());
  const double built = now();
  if (multigrid) levels.build(p.system());
  const double filled = now();
  std::vector<double> x(static_cast<std::size_t>(p.mesh->nodes()), 0.0), rest(p.b.size());
  const auto report = solver.solve(p.system(), p.b, x, rest, tolerance, 5000, multigrid ? &levels : nullptr);
  const double end = now();
  return {built - start, filled - built, end - filled, report.iterations, p.error(x)};
}

/// On one rank, where local indices are the global ones.
Timing theirs(const Problem& p, double tolerance, double threshold) {
  const auto rows = static_cast<HYPRE_Int>(p.b.size());
  HYPRE_IJMatrix a;
  HYPRE_IJMatrixCreate(MPI_COMM_WORLD, 0, rows - 1, 0, rows - 1, &a);
  HYPRE_IJMatrixSetObjectType(a, HYPRE_PARCSR);
  HYPRE_IJMatrixInitialize(a);
  std::vector<HYPRE_Int> columns;
  std::vector<double> values;
  for (HYPRE_Int r = 0; r < rows; ++r) {
    const auto k = static_cast<std::size_t>(r);
    columns = {r}, values = {p.inverse[k] > 0 ? p.diagonal[k] : 1.0};
    if (p.inverse[k] > 0)
      for (auto q = static_cast<std::size_t>(p.matrix.offsets()[k]);
           q < static_cast<std::size_t>(p.matrix.offsets()[k + 1]); ++q) {
        const auto column = static_cast<std::size_t>(p.matrix.columns()[q]);
        if (p.inverse[column] > 0)
          columns.push_back(p.matrix.columns()[q]), values.push_back(p.factor * p.matrix.values()[q]);
      }
    auto count = static_cast<HYPRE_Int>(columns.size());
    HYPRE_IJMatrixSetValues(a, 1, &count, &r, columns.data(), values.data());
  }
  HYPRE_IJMatrixAssemble(a);
  HYPRE_IJVector b, x;
  std::vector<HYPRE_Int> index(p.b.size());
  std::vector<double> right(p.b.size()), zero(p.b.size(), 0.0);
  for (std::size_t k = 0; k < index.size(); ++k) {
    index[k] = static_cast<HYPRE_Int>(k);
    right[k] = p.inverse[k] > 0 ? p.b[k] : 0;
  }
  for (auto* v : {&b, &x}) {
    HYPRE_IJVectorCreate(MPI_COMM_WORLD, 0, rows - 1, v);
    HYPRE_IJVectorSetObjectType(*v, HYPRE_PARCSR);
    HYPRE_IJVectorInitialize(*v);
    HYPRE_IJVectorSetValues(*v, rows, index.data(), v == &b ? right.data() : zero.data());
    HYPRE_IJVectorAssemble(*v);
  }
  HYPRE_ParCSRMatrix matrix;
  HYPRE_ParVector vector_b, vector_x;
  HYPRE_IJMatrixGetObject(a, reinterpret_cast<void**>(&matrix));
  HYPRE_IJVectorGetObject(b, reinterpret_cast<void**>(&vector_b));
  HYPRE_IJVectorGetObject(x, reinterpret_cast<void**>(&vector_x));
  // As the manual advises for scalar elliptic problems in three dimensions.
  HYPRE_Solver amg, pcg;
  HYPRE_BoomerAMGCreate(&amg);
  HYPRE_BoomerAMGSetCoarsenType(amg, 10);  // HMIS
  HYPRE_BoomerAMGSetAggNumLevels(amg, 1);  // aggressive on the first level
  HYPRE_BoomerAMGSetInterpType(amg, 6);    // extended+i
  HYPRE_BoomerAMGSetPMaxElmts(amg, 4);
  HYPRE_BoomerAMGSetRelaxType(amg, 6);  // symmetric hybrid Gauss-Seidel
  HYPRE_BoomerAMGSetStrongThreshold(amg, threshold);
  HYPRE_BoomerAMGSetTol(amg, 0);
  HYPRE_BoomerAMGSetMaxIter(amg, 1);
  HYPRE_ParCSRPCGCreate(MPI_COMM_WORLD, &pcg);
  HYPRE_PCGSetTol(pcg, tolerance);
  HYPRE_PCGSetTwoNorm(pcg, 1);
  HYPRE_PCGSetMaxIter(pcg, 1000);
  HYPRE_PCGSetPrecond(pcg, reinterpret_cast<HYPRE_PtrToSolverFcn>(HYPRE_BoomerAMGSolve),
                      reinterpret_cast<HYPRE_PtrToSolverFcn>(HYPRE_BoomerAMGSetup), amg);
  Timing t{};
  const double start = now();
  HYPRE_ParCSRPCGSetup(pcg, matrix, vector_b, vector_x);
  const double built = now();
  HYPRE_ParCSRPCGSolve(pcg, matrix, vector_b, vector_x);
  t.solve = now() - built;
  t.set_up = t.again = built - start;
  HYPRE_PCGGetNumIterations(pcg, &t.iterations);
  std::vector<double> result(p.b.size());
  HYPRE_IJVectorGetValues(x, rows, index.data(), result.data());
  t.error = p.error(result);
  HYPRE_ParCSRPCGDestroy(pcg);
  HYPRE_BoomerAMGDestroy(amg);
  HYPRE_IJMatrixDestroy(a);
  HYPRE_IJVectorDestroy(b);
  HYPRE_IJVectorDestroy(x);
  return t;
}

void run(int cells, double tolerance) {
  Problem problem(cells);
  const double h = 1.0 / cells;
  fmt::print("dt alpha / h^2,solver,set-up s,set-up again s,solve s,set-up again and solve s,iterations,residual\n");
  for (const double fourier : {1.0, 10.0, 100.0, 1e4, 1e8}) {
    problem.set_step(fourier * h * h);
    const auto show = [&](const char* name, const Timing& t) {
      fmt::print("{:.0e},{},{:.3f},{:.3f},{:.3f},{:.3f},{},{:.1e}\n", fourier, name, t.set_up, t.again, t.solve,
                 t.again + t.solve, t.iterations, t.error);
    };
    show("diagonal", ours(problem, tolerance, false));
    show("multigrid", ours(problem, tolerance, true));
    // Its manual gives 0.25 for two dimensions and 0.5 or 0.6 for three: the better of the two is the rival.
    for (const double threshold : {0.25, 0.5}) {
      const std::string name = fmt::format("BoomerAMG {:.2f}", threshold);
      show(name.c_str(), theirs(problem, tolerance, threshold));
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  MpiEnvironment environment(argc, argv);
  if (Communicator::world().size() > 1) {
    fmt::print(stderr, "thermal_hypre compares on one rank\n");
    return 2;
  }
  HYPRE_Init();
  run(argc > 1 ? std::atoi(argv[1]) : 55, argc > 2 ? std::atof(argv[2]) : 1e-8);
  HYPRE_Finalize();
  return 0;
}
