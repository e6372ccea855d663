// SPDX-License-Identifier: BSD-3-Clause
#include "scenes.hpp"

#include <cmath>
#include <numbers>
#include <random>

namespace tenon::bench {

namespace {

constexpr double two_pi = 2 * std::numbers::pi;

// Where the s-th of n lines across a graded unit length stands; s need not be whole.
double graded(double s, double n, double grading) {
  return grading == 1 ? s / n : std::expm1(std::log(grading) * s / n) / (grading - 1);
}

Vec3 on_sheet(double x, double y) {
  return {x, y, 0.05 * std::sin(3 * two_pi * x) * std::cos(2 * two_pi * y)};
}

// A facet and half of its size around it.
Box around_facet(double i, double j, double n, double grading) {
  constexpr double margin = 0.5247;  // (1 + 2 margin)^2 = 4.2
  Box box;
  for (int corner = 0; corner < 4; ++corner)
    box.add(on_sheet(graded(i + corner % 2, n, grading), graded(j + corner / 2, n, grading)));
  const double size = std::max(box.high[0] - box.low[0], box.high[1] - box.low[1]);
  for (std::size_t c = 0; c < 3; ++c) {
    const double by = margin * (c < 2 ? box.high[c] - box.low[c] : size);
    box.low[c] -= by, box.high[c] += by;
  }
  return box;
}

}  // namespace

BoxScene wavy_sheet(std::int64_t items, double grading) {
  const int n = static_cast<int>(std::lround(std::sqrt(static_cast<double>(items))));
  BoxScene scene{grading == 1 ? "sheet, mesh order" : "sheet graded 100 : 1 both ways", {}, {}};
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(0, 1);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      scene.boxes.push_back(around_facet(i, j, n, grading));
      const Vec3 x = on_sheet(graded(i + u(random), n, grading), graded(j + u(random), n, grading));
      scene.points.push_back({x, x});
    }
  return scene;
}

BoxScene shuffled(BoxScene scene) {
  std::mt19937 random(2);
  std::shuffle(scene.boxes.begin(), scene.boxes.end(), random);
  std::shuffle(scene.points.begin(), scene.points.end(), random);
  scene.name += ", shuffled";
  return scene;
}

BoxScene random_boxes(std::int64_t items) {
  BoxScene scene{"random boxes in a cube", {}, {}};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(0, 1);
  const double mean = std::cbrt(7.8 / static_cast<double>(items));
  for (std::int64_t i = 0; i < items; ++i) {
    const Vec3 low{u(random), u(random), u(random)}, x{u(random), u(random), u(random)};
    const Vec3 size{0.5 + u(random), 0.5 + u(random), 0.5 + u(random)};
    scene.boxes.push_back({low, low + mean * size});
    scene.points.push_back({x, x});
  }
  return scene;
}

BoxScene fine_and_coarse(std::int64_t items) {
  BoxScene scene = wavy_sheet(items);
  scene.name = "sheet over facets 100 times as long";
  const double n = std::sqrt(static_cast<double>(items)) / 100;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) scene.boxes.push_back(around_facet(i, j, n, 1));
  return scene;
}

namespace {

// Where the point at angle (turns) and height of the whole can stands. Material that the wall has passed lies in folds,
// five times as dense; the wall is higher on one side.
Vec3 on_can(double turn, double height, double progress) {
  constexpr double fold_height = 0.06, depth = 0.04, density = 5;
  const double angle = two_pi * turn, wall = progress * (1 + 0.3 * std::cos(angle));
  const double folded = std::min(height, wall);
  const double z = folded / density + std::max(0.0, height - wall);
  const double fold = std::min(1.0, (wall - folded) / fold_height) * std::min(1.0, wall / fold_height);
  const double r = 0.5 + depth * fold * std::sin(two_pi * folded / fold_height + std::sin(5 * angle));
  return {r * std::cos(angle), r * std::sin(angle), z};
}

}  // namespace

BoxScene crumpled_can(std::int64_t items, double progress, int rank, int ranks) {
  constexpr double height = 1.5, girth = std::numbers::pi;
  const double h = std::sqrt(height * girth / static_cast<double>(items));
  const int around = static_cast<int>(girth / h), up = static_cast<int>(height / h);
  int columns = static_cast<int>(std::sqrt(2.0 * ranks));  // of patches
  while (ranks % columns != 0) --columns;
  const int rows = ranks / columns;
  BoxScene scene{"crumpled can", {}, {}};
  for (int k = 0; k < up; ++k)
    for (int i = 0; i < around; ++i) {
      if (k * rows / up * columns + i * columns / around != rank) continue;
      Box box;
      for (int corner = 0; corner < 4; ++corner)
        box.add(on_can((i + corner % 2) / static_cast<double>(around), h * (k + corner / 2), progress));
      box.inflate(0.3 * h);
      scene.boxes.push_back(box);
      const Vec3 x = on_can(i / static_cast<double>(around), h * k, progress);
      scene.points.push_back({x, x});
    }
  return scene;
}

}  // namespace tenon::bench
