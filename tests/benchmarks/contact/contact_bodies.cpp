// SPDX-License-Identifier: BSD-3-Clause
#include "contact_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "framework/mesh/generators.hpp"

namespace tenon::bench {

namespace {

constexpr double pi = std::numbers::pi, radius = 0.5;
constexpr double straight = 0.5, folded = 1.1;  // m, along the wall

/// A place on the middle of the wall: distance from the axis, height, and unit normal.
struct Place {
  double r, z, normal_r, normal_z;
};

/// The wall's course by its length s: straight, then bellows of flanks across (six thicknesses long) and half circles.
class Course {
 public:
  explicit Course(double thickness) : bend_(1.25 * thickness), flank_(6 * thickness) {
    folds_ = std::max(1, static_cast<int>(std::lround(folded / length_of_fold())));
  }
  double length() const { return straight + folds_ * length_of_fold(); }
  double height() const { return straight + folds_ * 4 * bend_; }
  double outer() const { return radius + flank_ + 2 * bend_; }

  Place at(double s) const {
    if (s <= straight) return {radius, s, 1, 0};
    const double along = s - straight, fold = std::min<double>(folds_ - 1, std::floor(along / length_of_fold()));
    double rest = along - fold * length_of_fold();
    double z = straight + fold * 4 * bend_;
    // A quarter up to across, a flank out, a half circle, a flank in, a quarter back to straight.
    const double quarter = 0.5 * pi * bend_, inner = radius, out = radius + flank_;
    if (rest <= quarter) return bend(inner + bend_, z, pi, -1, rest);
    rest -= quarter, z += bend_;
    if (rest <= flank_) return {inner + bend_ + rest, z, 0, -1};
    rest -= flank_;
    if (rest <= 2 * quarter) return bend(out + bend_, z + bend_, -0.5 * pi, 1, rest);
    rest -= 2 * quarter, z += 2 * bend_;
    if (rest <= flank_) return {out + bend_ - rest, z, 0, 1};
    return bend(inner + bend_, z + bend_, -0.5 * pi, -1, rest - flank_);
  }

 private:
  double length_of_fold() const { return 2 * pi * bend_ + 2 * flank_; }
  /// On a circle about (r, z) from an angle on, turning by +1 left or -1 right.
  Place bend(double r, double z, double from, int turn, double s) const {
    const double angle = from + turn * s / bend_, c = std::cos(angle), n = std::sin(angle);
    return {r + bend_ * c, z + bend_ * n, turn * c, turn * n};
  }

  double bend_, flank_;
  int folds_;
};

void append(MeshData& all, MeshData body, const std::string& name) {
  const auto first = static_cast<GlobalId>(all.coordinates.size());
  all.coordinates.insert(all.coordinates.end(), body.coordinates.begin(), body.coordinates.end());
  BlockData block = std::move(body.blocks.front());
  block.name = name, block.label = static_cast<std::int64_t>(all.blocks.size()) + 1;
  for (GlobalId& n : block.connectivity) n += first;
  auto label = static_cast<std::int64_t>(all.elements());
  for (std::int64_t& l : block.labels) l = ++label;
  all.blocks.push_back(std::move(block));
  for (auto n = static_cast<std::int64_t>(all.node_labels.size());
       n < static_cast<std::int64_t>(all.coordinates.size());)
    all.node_labels.push_back(++n);
}

MeshData wall_of_can(const CrushedCan& can) {
  const double h = can.size();
  const Course course(h);
  const int around = static_cast<int>(std::lround(2 * pi * radius / h)),
            up = static_cast<int>(std::lround(course.length() / h)), sheets = can.layers + 1;
  MeshData mesh;
  BlockData block{"can", 1, can.layers > 0 ? ElementKind::hex8 : ElementKind::quad4, {}, {}};
  NodeSetData rim{"rim", 1, {}};
  for (int k = 0; k <= up; ++k)
    for (int i = 0; i < around; ++i)
      for (int l = 0; l < sheets; ++l) {
        const Place p = course.at(course.length() * k / up);
        const double off = can.layers > 0 ? h * (static_cast<double>(l) / can.layers - 0.5) : 0.0;
        const double angle = 2 * pi * i / around, r = p.r + off * p.normal_r;
        if (k == 0) rim.nodes.push_back(static_cast<GlobalId>(mesh.coordinates.size()));
        mesh.coordinates.push_back({r * std::cos(angle), r * std::sin(angle), p.z + off * p.normal_z});
      }
  const auto node = [&](int i, int k, int l) { return (static_cast<GlobalId>(k) * around + i % around) * sheets + l; };
  for (int k = 0; k < up; ++k)
    for (int i = 0; i < around; ++i)
      for (int l = 0; l < std::max(1, can.layers); ++l) {
        for (int side = 0; side < std::min(2, sheets); ++side)
          block.connectivity.insert(block.connectivity.end(), {node(i, k, l + side), node(i + 1, k, l + side),
                                                               node(i + 1, k + 1, l + side), node(i, k + 1, l + side)});
        block.labels.push_back(static_cast<std::int64_t>(block.labels.size()) + 1);
      }
  mesh.blocks = {std::move(block)}, mesh.node_sets = {std::move(rim)};
  return mesh;
}

MaterialDescription steel(double yield_stress) {
  MaterialDescription m;
  m.name = "steel";
  m.density = 7850;
  m.elastic = Elasticity{210e9, 0.3, 0};
  if (yield_stress > 0) m.plasticity = LinearHardeningParameters{yield_stress, 0};
  return m;
}

Vec3 downwards(const CrushedCan& can) {
  const double angle = can.tilt * pi / 180;
  return {std::sin(angle), 0, -std::cos(angle)};
}

}  // namespace

double CrushedCan::size() const {
  const double area = 2 * pi * radius * (straight + folded);
  return std::sqrt(area * std::max(1, layers) / static_cast<double>(elements));
}

MeshData make_mesh(const CrushedCan& can) {
  const double h = can.size();
  const Course course(h);
  MeshData mesh;
  mesh.source = "crushed can";
  MeshData body = wall_of_can(can);
  mesh.node_sets = body.node_sets;
  append(mesh, std::move(body), "can");
  // The inclined wall starts a tenth of its elements above the highest point of the can.
  const double half = 1.1 * course.outer(), side = 4 * h, angle = can.tilt * pi / 180;
  const int across = static_cast<int>(2 * half / side);
  BoxShape box;
  box.low = {-half, -half, 0}, box.high = {half, half, 4 * side}, box.elements = {across, across, 4};
  MeshData wall = generate(box);
  const double lift = course.height() + 0.5 * h + course.outer() * std::sin(angle) + 0.1 * h;
  for (Vec3& x : wall.coordinates)
    x = {std::cos(angle) * x[0] - std::sin(angle) * x[2], x[1], std::sin(angle) * x[0] + std::cos(angle) * x[2] + lift};
  append(mesh, std::move(wall), "wall");
  return mesh;
}

MechanicsOptions options_of(const CrushedCan& can) {
  MechanicsOptions options;
  MechanicsOptions::Block body, wall;
  body.name = "can", body.material = steel(400e6);
  if (can.layers == 0) body.shell.thickness = can.size(), body.shell.points = 5;
  wall.name = "wall", wall.material = steel(400e6);
  options.blocks = {body, wall};
  options.initial_velocities = {{"wall", "", can.speed * downwards(can), {}, {}}};
  PrescribedMotion standing;
  standing.node_sets = {"rim"}, standing.label = "rim";
  options.motions = {standing};
  return options;
}

MeshData two_blocks(int n) {
  MeshData mesh;
  mesh.source = "two blocks";
  for (const double z : {0.0, 2.0}) {
    BoxShape box;
    box.low = {0, 0, z}, box.high = {1, 1, z + 0.5}, box.elements = {n, n, n / 2};
    append(mesh, generate(box), z == 0 ? "left" : "right");
  }
  return mesh;
}

MechanicsOptions options_of_blocks() {
  MechanicsOptions options;
  for (const char* name : {"left", "right"}) {
    MechanicsOptions::Block block;
    block.name = name, block.material = steel(0);
    options.blocks.push_back(block);
  }
  InitialVelocity stretch;
  stretch.gradient = {-40, 6, 0, 0, 10, 0, 0, 0, 14};
  options.initial_velocities = {stretch};
  return options;
}

}  // namespace tenon::bench
