// SPDX-License-Identifier: BSD-3-Clause
#include "hard_cases.hpp"

#include <fmt/core.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "bench_cases.hpp"
#include "bench_clock.hpp"
#include "vtk_rival.hpp"

namespace tenon::bench {

namespace {

using transfer::GridTransfer;
using transfer::OutsidePolicy;
using transfer::TransferOptions;

constexpr Vec3 centre{0.5, 0.5, 0.5};

bool first_rank() {
  return Communicator::world().rank() == 0;
}

struct Found {
  GlobalId outside = 0, without_value = 0;
  double greatest_distance = 0, error = 0;
};

Found values_outside(const Mesh& source, const Targets& targets, OutsidePolicy policy) {
  TransferOptions options;
  options.outside = policy;
  const auto map = interpolation(source, source.coordinates, targets, options);
  const std::vector<double> values = sampled(source.coordinates, linear_field);
  std::vector<double> result(targets.points.size(), std::numeric_limits<double>::quiet_NaN());
  map->apply(values, result, 1);
  const transfer::TransferReport report = map->report(values, result, 1);
  Found found{report.outside, 0, report.greatest_distance, errors_of(targets, result, linear_field).greatest};
  for (const LocalIndex n : targets.owned) found.without_value += std::isnan(result[static_cast<std::size_t>(n)]);
  found.without_value = source.comm.sum(found.without_value);
  return found;
}

/// A motion: where the nodes of a mesh are then.
using Motion = std::function<Vec3(const Vec3&)>;

std::vector<Vec3> moved(std::span<const Vec3> points, const Motion& motion) {
  std::vector<Vec3> result;
  result.reserve(points.size());
  for (const Vec3& x : points) result.push_back(motion(x));
  return result;
}

/// Displacement of a constant length whose direction turns through the body. `within`: towards each face of the unit
/// cube its normal part fades, so that what is on the face stays there.
Motion swirl(double length, bool within = true) {
  return [=](const Vec3& x) {
    const double a = 2 * std::numbers::pi * (x[0] + 2 * x[1]), b = std::numbers::pi * (x[2] - x[0]);
    Vec3 way{std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b)};
    for (std::size_t c = 0; within && c < 3; ++c) way[c] *= std::min({1.0, 10 * x[c], 10 * (1 - x[c])});
    return x + length * way;
  };
}

/// Rotation about the axis (1,1,1) through the centre, and a shift.
Motion rigid(double angle, const Vec3& shift) {
  return [=](const Vec3& x) {
    const double k = 1 / std::sqrt(3.0);
    const Vec3 axis{k, k, k}, d = x - centre;
    return centre + shift + std::cos(angle) * d + std::sin(angle) * cross(axis, d) +
           ((1 - std::cos(angle)) * dot(axis, d)) * axis;
  };
}

/// Collective.
double greatest_difference(const Communicator& comm, std::span<const double> a, std::span<const double> b) {
  double greatest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) greatest = std::max(greatest, std::abs(a[i] - b[i]));
  return comm.max(greatest);
}

struct Movement {
  const char* name;
  Motion source, target;
};

void time_update(const Movement& movement, const Mesh& source, const Targets& targets, int repeats) {
  const Communicator& comm = source.comm;
  const std::vector<Vec3> source_then = moved(source.coordinates, movement.source);
  Targets then = targets;
  then.points = moved(targets.points, movement.target);
  const std::vector<double> values = sampled(source.coordinates, smooth_field);
  std::vector<double> updated(targets.points.size()), fresh(updated);
  Times update, rebuild;
  TransferOptions options;
  options.moving = true;
  const auto map = interpolation(source, source.coordinates, targets, options);
  double share = 0, difference = 0;
  for (int i = 0; i < repeats; ++i) {
    if (update.take(comm, [&] { return map->update(source_then, then.points); }))
      share = static_cast<double>(comm.sum(map->searched())) / static_cast<double>(targets.count);
    map->apply(values, updated, 1);
    const auto other = rebuild.take(comm, [&] { return interpolation(source, source_then, then); });
    other->apply(values, fresh, 1);
    difference = std::max(difference, greatest_difference(comm, updated, fresh));
    update.take(comm, [&] { return map->update(source.coordinates, targets.points); });
  }
  const double scale = 1e6 / targets.greatest_share();
  if (comm.rank() == 0)
    fmt::print("  {:36} {:8.4f} {:8.4f} {:8.4f}   rebuilt {:8.4f}   searched {:6.2f} %   differs {:.0e}\n",
               movement.name, update.median() * scale, update.best() * scale, update.median_wall() * scale,
               rebuild.median() * scale, 100 * share, difference);
}

}  // namespace

void run_pushed_out() {
  const auto source = cube(32, 1);
  const Targets at_rest = nodes_of("nodes", cube(40, 2, {.slabs = Slabs::y}));
  if (first_rank())
    fmt::print(
        "pushed out: 32^3 -> nodes of 40^3, of which 9,602 stand outside by d\n"
        "         d  counted outside  distance  without value  f_l nearest  extrapolated  lost by VTK\n");
  for (const double d : {0.0, 1e-14, 1e-12, 1e-9, 1e-7, 1e-5, 1e-3}) {
    Targets targets = at_rest;
    for (Vec3& x : targets.points) x = centre + (1 + 2 * d) * (x - centre);
    const Found nearest = values_outside(*source, targets, OutsidePolicy::nearest);
    const Found beyond = values_outside(*source, targets, OutsidePolicy::extrapolate);
    const std::string lost =
        source->comm.size() > 1 ? std::string("-")
                                : fmt::format("{}", VtkRival(*source, source->coordinates).locate(targets.points).lost);
    if (first_rank())
      fmt::print("  {:8.0e}  {:15}  {:8.2e}  {:13}  {:11.2e}  {:12.2e}  {:>11}\n", d, nearest.outside,
                 nearest.greatest_distance, nearest.without_value + beyond.without_value, nearest.error, beyond.error,
                 lost);
  }
}

void run_graded(int n, int m, int repeats, bool vtk) {
  struct Pair {
    std::shared_ptr<const Mesh> source;
    Targets targets;
    std::vector<double> values, result;
    Times set_up, locate;
    Errors errors;
    double share = 0;
  };
  std::vector<Pair> pairs;
  for (const double grading : {1.0, 1000.0}) {
    const auto source = cube(n, 1, {.grading = grading});
    pairs.push_back({source, nodes_of("", cube(m, 2, {.grading = grading, .slabs = Slabs::y})), {}, {}, {}, {}, {}, 0});
    pairs.push_back({source, random_points(1'000'000, 3), {}, {}, {}, {}, {}, 0});
  }
  for (Pair& p : pairs) p.share = p.targets.greatest_share();
  for (int i = 0; i < repeats; ++i)
    for (Pair& p : pairs) {
      const auto map =
          p.set_up.take(p.source->comm, [&] { return interpolation(*p.source, p.source->coordinates, p.targets); });
      if (vtk && p.source->comm.size() == 1) {
        const VtkRival rival(*p.source, p.source->coordinates);
        p.locate.take(p.source->comm, [&] { return rival.locate(p.targets.points); });
      }
      p.result.resize(p.targets.points.size());
      map->apply(sampled(p.source->coordinates, linear_field), p.result, 1);
      p.errors = errors_of(p.targets, p.result, linear_field);
    }
  if (!first_rank()) return;
  fmt::print("graded 1,000 : 1 in each direction, {}^3; set-up, us per target\n", n);
  for (const std::size_t k : {0, 1}) {
    const auto us = [&](const Times& t, const Pair& p) { return t.processor.empty() ? 0 : 1e6 * t.median() / p.share; };
    const Pair &uniform = pairs[k], &graded = pairs[k + 2];
    fmt::print("  {:14} uniform {:.4f}, graded {:.4f}: ratio {:.3f}; f_l {:.1e}", k == 0 ? "nodes" : "random points",
               us(uniform.set_up, uniform), us(graded.set_up, graded),
               us(graded.set_up, graded) / us(uniform.set_up, uniform), graded.errors.greatest);
    if (!uniform.locate.processor.empty())
      fmt::print("; VTK {:.4f}, {:.4f}", us(uniform.locate, uniform), us(graded.locate, graded));
    fmt::print("\n");
  }
}

void run_moving(int n, int m, int repeats) {
  const auto source = cube(n, 1);
  const Targets targets = nodes_of("nodes", cube(m, 2, {.slabs = Slabs::y}));
  const double h = 1.0 / n;
  const Motion rest = [](const Vec3& x) { return x; };
  const Motion together = rigid(0.1, {0.3, -0.2, 0.1}), shifted = rigid(0, {0.5, 0.25, -0.125});
  const Motion opposite = [h](const Vec3& x) { return swirl(-0.05 * h)(x); };
  if (first_rank())
    fmt::print("moving: {}^3 -> {} nodes; update, us per target\n  {:36} {:>8} {:>8} {:>8}\n", n, targets.count, "",
               "median", "best", "wall");
  for (const Movement& movement : {Movement{"target by 0.1 h", rest, swirl(0.1 * h)},
                                   {"target by 0.01 h", rest, swirl(0.01 * h)},
                                   {"target by 0.1 h, out of the source", rest, swirl(0.1 * h, false)},
                                   {"source by 0.1 h", swirl(0.1 * h), rest},
                                   {"both, opposite, by 0.05 h", swirl(0.05 * h), opposite},
                                   {"common rigid shift", shifted, shifted},
                                   {"common rigid shift and rotation", together, together},
                                   {"none", rest, rest}})
    time_update(movement, *source, targets, repeats);
}

}  // namespace tenon::bench
