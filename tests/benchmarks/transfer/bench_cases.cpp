// SPDX-License-Identifier: BSD-3-Clause
#include "bench_cases.hpp"

#include <cmath>
#include <numbers>

namespace tenon::bench {

namespace {

/// splitmix64 [SLF14], the finaliser as a hash.
std::uint64_t mix(std::uint64_t z) {
  z += 0x9E3779B97F4A7C15ULL;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

double uniform(std::uint64_t seed, std::uint64_t id, std::uint64_t component) {
  return static_cast<double>(mix(mix(seed) + 4 * id + component) >> 11) * 0x1p-53;
}

std::shared_ptr<const Mesh> over_ranks(MeshData&& mesh) {
  return distribute(Communicator::world(), std::move(mesh), {});
}

}  // namespace

std::shared_ptr<const Mesh> cube(int n, std::uint64_t seed, double grading, bool tetrahedra) {
  if (Communicator::world().rank() > 0) return over_ranks({});
  BoxShape shape;
  shape.elements = {n, n, n};
  shape.grading = {grading, grading, grading};
  shape.distortion = 0.2;
  shape.seed = seed;
  shape.tetrahedra = tetrahedra;
  return over_ranks(generate(shape));
}

Targets nodes_of(std::string name, std::shared_ptr<const Mesh> mesh) {
  Targets targets{std::move(name), std::move(mesh), {}};
  targets.points = targets.mesh->coordinates;
  return targets;
}

Targets random_points(GlobalId count, std::uint64_t seed) {
  MeshData data;
  data.source = "random points";
  if (Communicator::world().rank() == 0)
    for (std::uint64_t q = 0; q < static_cast<std::uint64_t>(count); ++q) {
      data.coordinates.push_back({uniform(seed, q, 0), uniform(seed, q, 1), uniform(seed, q, 2)});
      data.node_labels.push_back(static_cast<std::int64_t>(q) + 1);
    }
  return nodes_of("random points", over_ranks(std::move(data)));
}

std::unique_ptr<transfer::GridTransfer> interpolation(const Mesh& source, std::span<const Vec3> coordinates,
                                                      const Targets& targets,
                                                      const transfer::TransferOptions& options) {
  FieldDescription field;
  field.name = "field";
  return std::make_unique<transfer::GridTransfer>(transfer::Grid{&source, coordinates, Location::node}, targets.grid(),
                                                  field, options, "bench");
}

double smooth_field(const Vec3& x) {
  using std::numbers::pi;
  return std::sin(2 * pi * x[0]) * std::cos(3 * pi * x[1]) * std::exp(x[2]);
}

double linear_field(const Vec3& x) {
  return 1 + 2 * x[0] - 3 * x[1] + 0.5 * x[2];
}

std::vector<double> sampled(std::span<const Vec3> points, Function f) {
  std::vector<double> values;
  values.reserve(points.size());
  for (const Vec3& x : points) values.push_back(f(x));
  return values;
}

Errors errors_of(const Targets& targets, std::span<const double> values, Function f) {
  Errors errors;
  ExactSum squares;
  for (const LocalIndex n : targets.mesh->owned_nodes) {
    const double error = std::abs(values[static_cast<std::size_t>(n)] - f(targets.points[static_cast<std::size_t>(n)]));
    errors.greatest = std::max(errors.greatest, std::isnan(error) ? HUGE_VAL : error);
    squares.add(error * error);
  }
  const Communicator& comm = targets.mesh->comm;
  errors.greatest = comm.max(errors.greatest);
  errors.rms = std::sqrt(comm.sum(squares) / static_cast<double>(targets.count()));
  return errors;
}

}  // namespace tenon::bench
