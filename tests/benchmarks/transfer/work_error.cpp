// SPDX-License-Identifier: BSD-3-Clause
#include "work_error.hpp"

#include <fmt/core.h>

#include <cmath>
#include <fstream>
#include <functional>

#include "bench_cases.hpp"
#include "bench_clock.hpp"
#include "vtk_rival.hpp"

namespace tenon::bench {

namespace {

using transfer::Grid;
using transfer::GridTransfer;
using transfer::Method;
using transfer::TransferOptions;

constexpr double least_seconds = 0.3;  ///< that each figure is repeated for
constexpr int least_repeats = 3;
constexpr double enough_seconds = 5;  ///< after which even fewer repeats will do

/// One way to bring values over, on one pair of meshes.
struct Trial {
  Targets targets;
  std::function<void()> set_up;  ///< none: every application does all
  std::function<void(std::span<double> result)> apply;
};

struct Way {
  std::string panel, name;
  std::function<Trial(int n)> make;
};

FieldDescription field_of(FieldKind kind) {
  FieldDescription field;
  field.name = "field";
  field.kind = kind;
  return field;
}

Targets target_nodes(int n) {
  return nodes_of("nodes", cube(n + n / 4, 2));
}

/// Through GridTransfer, from all nodes of the source.
Trial by_transfer(std::shared_ptr<const Mesh> source, Targets targets, FieldKind kind, const TransferOptions& options) {
  auto values = std::make_shared<std::vector<double>>(sampled(source->coordinates, smooth_field));
  auto map = std::make_shared<std::unique_ptr<GridTransfer>>();
  const auto set_up = [=] {
    map->reset();
    *map = std::make_unique<GridTransfer>(Grid{source.get(), source->coordinates, Location::node}, targets.grid(),
                                          field_of(kind), options, "bench");
  };
  return {targets, set_up, [=](std::span<double> result) { (*map)->apply(*values, result, 1); }};
}

Way through(const std::string& name, const TransferOptions& options, FieldKind kind = FieldKind::point_value,
            ElementKind elements = ElementKind::hex8) {
  return {"volume", name,
          [=](int n) { return by_transfer(cube(n, 1, {.kind = elements}), target_nodes(n), kind, options); }};
}

/// From one sphere of facets to the nodes of another.
Way nearest_projection() {
  return {"surface", "nearest_projection, quad4", [](int n) {
            TransferOptions options;
            options.method = Method::nearest_projection;
            return by_transfer(sphere_surface(n), nodes_of("nodes", sphere_surface(n + n / 4)), FieldKind::point_value,
                               options);
          }};
}

/// The weights of VTK's static cell locator, kept: of the cells that hold points, or of the nearest on a surface.
Way vtk_locator(const std::string& panel) {
  const bool surface = panel == "surface";
  return {panel, surface ? "VTK nearest point, weights kept" : "VTK static locator, weights kept", [=](int n) {
            const auto source = surface ? sphere_surface(n) : cube(n, 1);
            const Targets targets = surface ? nodes_of("nodes", sphere_surface(n + n / 4)) : target_nodes(n);
            auto rival = std::make_shared<VtkRival>(*source, source->coordinates);
            auto map = std::make_shared<VtkMap>();
            auto values = std::make_shared<std::vector<double>>(sampled(source->coordinates, smooth_field));
            return Trial{targets,
                         [=] { *map = surface ? rival->project(targets.points) : rival->locate(targets.points); },
                         [=](std::span<double> result) { map->apply(*values, result); }};
          }};
}

Way vtk_probe() {
  return {"volume", "VTK probe filter", [](int n) {
            const auto source = cube(n, 1);
            const Targets targets = target_nodes(n);
            auto rival = std::make_shared<VtkRival>(*source, source->coordinates);
            auto values = std::make_shared<std::vector<double>>(sampled(source->coordinates, smooth_field));
            return Trial{targets, {}, [=](std::span<double> result) { rival->probe(targets.points, *values, result); }};
          }};
}

std::vector<Way> ways() {
  constexpr auto value = FieldKind::point_value;
  return {through("interpolate, hex8", {.method = Method::interpolate}),
          through("interpolate, tet4", {.method = Method::interpolate}, value, ElementKind::tet4),
          through("interpolate, hex20", {.method = Method::interpolate}, value, ElementKind::hex20),
          through("conserve", {.method = Method::conserve}, FieldKind::density),
          through("project", {.method = Method::project}),
          through("project, bounded", {.method = Method::project, .bounded = true}),
          through("moving least squares, 20 points", {.method = Method::moving_least_squares}),
          vtk_locator("volume"),
          vtk_probe(),
          nearest_projection(),
          vtk_locator("surface")};
}

/// Median of enough calls.
double seconds_of(const std::function<void()>& call) {
  const Communicator comm = Communicator::world();
  Times times;
  double sum = 0;
  while (sum < enough_seconds && (sum < least_seconds || static_cast<int>(times.processor.size()) < least_repeats)) {
    times.take(comm, [&] { return call(), 0; });
    sum += times.processor.back();
  }
  return times.median();
}

std::string row(const Way& way, int n) {
  const Trial trial = way.make(n);
  std::vector<double> result(trial.targets.points.size());
  const double set_up = trial.set_up ? seconds_of(trial.set_up) : 0;
  trial.apply(result);
  const double apply = seconds_of([&] { trial.apply(result); });
  const Errors errors = errors_of(trial.targets, result, smooth_field);
  const std::vector<double> nothing(result.size(), 0.0);
  const Errors whole = errors_of(trial.targets, nothing, smooth_field);
  return fmt::format("{},\"{}\",{},{},{:.4e},{:.4e},{:.4e},{:.4e}", way.panel, way.name, n, trial.targets.count, set_up,
                     apply, errors.rms / whole.rms, errors.greatest / whole.greatest);
}

}  // namespace

void run_work_error(int finest, const std::string& csv) {
  std::ofstream file(csv);
  const auto put = [&](const std::string& line) {
    fmt::print("{}\n", line);
    file << line << std::endl;
  };
  put("panel,method,n,targets,set_up,apply,rms_error,greatest_error");
  for (const Way& way : ways())
    for (int n = 8; n <= finest; n *= 2) put(row(way, n));
  if (!file) throw Error(ExitCode::file, csv + ": cannot be written");
}

}  // namespace tenon::bench
