// SPDX-License-Identifier: BSD-3-Clause
#include "oracle_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "framework/mesh/shape_functions.hpp"
#include "transfer/place_many.hpp"
#include "transfer_testing.hpp"

namespace tenon::transfer::testing {

namespace {

class Random {
 public:
  explicit Random(std::uint64_t seed) : seed_(seed) {}
  double operator()() { return random_number(seed_, next_++); }
  double between(double low, double high) { return low + (high - low) * (*this)(); }
  /// 10^x, x uniform.
  double decade(double low, double high) { return std::pow(10.0, between(low, high)); }
  int below(int n) { return static_cast<int>((*this)() * n); }
  Vec3 vector(double most) { return {between(-most, most), between(-most, most), between(-most, most)}; }

 private:
  std::uint64_t seed_, next_ = 0;
};

constexpr std::array families{"perturbed", "tapered", "twisted", "sharp corner", "short edge", "thin", "skewed"};

/// Corners that stand in the middle of straight edges, before these are bent.
void straighten(ElementKind kind, std::vector<Vec3>& x) {
  const auto corners = static_cast<std::size_t>(corner_count(kind));
  for (std::size_t i = 0; i < middle_nodes(kind).size(); ++i) {
    const auto [a, b] = middle_nodes(kind)[i];
    x[corners + i] = 0.5 * (x[static_cast<std::size_t>(a)] + x[static_cast<std::size_t>(b)]);
  }
}

void distort(ElementKind kind, int family, std::vector<Vec3>& x, Random& random) {
  const auto corners = static_cast<std::size_t>(corner_count(kind));
  const auto corner = [&] { return static_cast<std::size_t>(random.below(static_cast<int>(corners))); };
  switch (family) {
    case 0: {
      const double amount = random.between(0.1, 0.7);
      for (std::size_t a = 0; a < corners; ++a) x[a] = x[a] + random.vector(amount);
      break;
    }
    case 1: {
      const double one = random.decade(-3, 0), two = random.decade(-3, 0);
      for (std::size_t a = 0; a < corners; ++a)
        if (x[a][2] > 0.5) x[a][0] *= one, x[a][1] *= two;
      break;
    }
    case 2: {
      const double turn = random.between(0, 0.48) * std::numbers::pi;
      for (std::size_t a = 0; a < corners; ++a) {
        const double angle = turn * x[a][2], c = std::cos(angle), s = std::sin(angle);
        x[a] = {c * x[a][0] - s * x[a][1], s * x[a][0] + c * x[a][1], x[a][2]};
      }
      break;
    }
    case 3: {  // until the three edges are nearly in one plane
      const std::size_t a = corner();
      const Vec3 centre = map_to_space(kind, x, element_centre(kind));
      const double how_far = 2.0 / 3 * (1 - random.decade(-6, -0.5));
      x[a] = x[a] + how_far * (centre - x[a]);
      break;
    }
    case 4: {
      const std::size_t a = corner();
      std::size_t b = corner();
      while (b == a) b = corner();
      x[a] = x[b] + random.decade(-7, -0.5) * (x[a] - x[b]);
      break;
    }
    case 5: {
      const Vec3 scale{random.decade(-4, 0), random.decade(-4, 0), random.decade(-4, 0)};
      for (std::size_t a = 0; a < corners; ++a) {
        x[a] = x[a] + random.vector(0.2);
        for (std::size_t c = 0; c < 3; ++c) x[a][c] *= scale[c];
      }
      break;
    }
    default: {
      const double xy = random.between(-4, 4), yz = random.between(-4, 4), zx = random.between(-4, 4);
      for (std::size_t a = 0; a < corners; ++a) {
        x[a] = x[a] + random.vector(0.35);
        x[a] = {x[a][0] + xy * x[a][1], x[a][1] + yz * x[a][2], x[a][2] + zx * x[a][0]};
      }
    }
  }
}

std::vector<Vec3> random_element(ElementKind kind, int family, Random& random) {
  const std::span<const Vec3> local = local_nodes(kind);
  std::vector<Vec3> x(local.begin(), local.end());
  distort(kind, family, x, random);
  if (random.below(2) == 0) distort(kind, random.below(static_cast<int>(families.size())), x, random);
  straighten(kind, x);
  if (const auto first = static_cast<std::size_t>(corner_count(kind)); first < x.size()) {
    double width = 1e300;  // of the shortest edge
    for (const auto& [a, b] : middle_nodes(kind))
      width = std::min(width, norm(x[static_cast<std::size_t>(a)] - x[static_cast<std::size_t>(b)]));
    const double bend = random.between(0, 0.3) * width;
    for (std::size_t a = first; a < x.size(); ++a) x[a] = x[a] + random.vector(bend);
  }
  const double scale = random.decade(-3, 3);
  const Vec3 origin = random.below(2) == 0 ? Vec3{} : random.vector(10 * scale);
  for (Vec3& p : x) p = origin + scale * p;
  return x;
}

/// Sure for hex8, whose determinant is of degree 2 in each coordinate: its Bernstein coefficients are positive. Others
/// are looked at on a lattice with the faces, edges and corners.
bool is_positive(ElementKind kind, const ExtendedOracle& oracle) {
  const int n = kind == ElementKind::hex8 ? 2 : 8;
  std::vector<Extended> determinants;
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        Extended3 xi{2.0L * i / n - 1, 2.0L * j / n - 1, 2.0L * k / n - 1};
        if (kind == ElementKind::tet10)  // has them from 0 to 1
          for (Extended& c : xi) c = (c + 1) / 2;
        if (kind == ElementKind::pyramid5) {  // it has the determinant of its base all the way up
          if (k > 0) continue;
          xi[2] = 0;
        }
        if (ExtendedOracle::overshoot(kind, xi) > 0) continue;
        determinants.push_back(oracle.determinant(xi));
        if (!(determinants.back() > 0)) return false;
      }
  if (kind != ElementKind::hex8) return true;
  for (const std::size_t stride : {1, 3, 9})
    for (std::size_t m = 0; m < 27; ++m)
      if (m / stride % 3 == 1)
        determinants[m] = 2 * determinants[m] - (determinants[m - stride] + determinants[m + stride]) / 2;
  return std::ranges::all_of(determinants, [](Extended d) { return d > 0; });
}

/// Local coordinates inside; `depth` half widths below a face picked at random, if that is given.
Extended3 local_place(ElementKind kind, Random& random, std::optional<double> depth) {
  const auto simplex = [&](std::size_t n, bool at_face) {
    std::array<double, 4> l{};
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) sum += l[i] = -std::log(1 - random());
    const double room = at_face ? 1 - *depth / 2 : 1;
    if (at_face) {
      const auto f = static_cast<std::size_t>(random.below(static_cast<int>(n)));
      sum -= l[f], l[f] = *depth / 2 * sum / room;
      for (std::size_t i = 0; i < n; ++i) l[i] *= room / sum;
    } else {
      for (std::size_t i = 0; i < n; ++i) l[i] /= sum;
    }
    return l;
  };
  const double side = random.below(2) == 0 ? -1 : 1;
  switch (kind) {
    case ElementKind::tet4:
    case ElementKind::tet10: {
      const auto l = simplex(4, depth.has_value());
      return {l[1], l[2], l[3]};
    }
    case ElementKind::wedge6: {
      const bool end = depth && random.below(2) == 0;
      const auto l = simplex(3, depth && !end);
      return {l[1], l[2], end ? side * (1 - *depth) : random.between(-1, 1)};
    }
    case ElementKind::pyramid5: {
      const bool base = depth && random.below(5) == 0;
      const double z = base ? *depth / 2 : 1 - std::cbrt(random.between(1e-4, 1)), width = 1 - z;
      Extended3 xi{random.between(-width, width), random.between(-width, width), z};
      if (depth && !base)
        xi[static_cast<std::size_t>(random.below(2))] = side * (static_cast<Extended>(width) - *depth);
      return xi;
    }
    default: {
      Extended3 xi{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
      if (depth) xi[static_cast<std::size_t>(random.below(3))] = side * (1 - static_cast<Extended>(*depth));
      return xi;
    }
  }
}

struct Probe {
  Vec3 point;
  Extended3 xi;  ///< about where it is
};

std::vector<Probe> probes(ElementKind kind, const ExtendedOracle& oracle, Random& random) {
  std::vector<Probe> all;
  const auto add = [&](const Extended3& xi) {
    const Extended3 x = oracle.position(xi);
    all.push_back({{static_cast<double>(x[0]), static_cast<double>(x[1]), static_cast<double>(x[2])}, xi});
  };
  for (int k = 0; k < 3; ++k) add(local_place(kind, random, std::nullopt));
  for (int k = 0; k < 8; ++k) add(local_place(kind, random, (k % 2 == 0 ? 1 : -1) * random.decade(-13, -3)));
  for (int k = 0; k < 2; ++k) add(local_place(kind, random, -random.decade(-2, 0)));
  return all;
}

/// One element as a rank of its own sees it, with the boxes that the transfer gives it.
Containers containers(ElementKind kind, const std::vector<Vec3>& x, double tolerance) {
  MeshData mesh;
  mesh.source = "one element";
  mesh.coordinates = x;
  BlockData block{"body", 1, kind, {}, {1}};
  for (std::size_t a = 0; a < x.size(); ++a) {
    mesh.node_labels.push_back(static_cast<std::int64_t>(a) + 1);
    block.connectivity.push_back(static_cast<GlobalId>(a));
  }
  mesh.blocks.push_back(block);
  const MeshPointer whole = distributed(std::move(mesh));
  return containers_of(*whole, whole->coordinates, {}, tolerance, "oracle");
}

Extended gap(const ExtendedOracle& oracle, const Vec3& xi, const Vec3& point) {
  const Extended3 x = oracle.position({xi[0], xi[1], xi[2]});
  Extended most = 0;
  for (std::size_t c = 0; c < 3; ++c) most = std::max(most, std::abs(x[c] - point[c]));
  return most;
}

/// The elements of one run, one after the other.
class Comparison {
 public:
  explicit Comparison(const OracleRun& run) : run_(run), random_(run.seed) {}

  OracleCount go() {
    for (int attempt = 0; count_.elements < run_.elements && attempt < 100 * run_.elements; ++attempt) {
      family_ = attempt % static_cast<int>(families.size());
      x_ = random_element(run_.kind, family_, random_);
      const ExtendedOracle oracle(run_.kind, x_);
      Box box;
      for (const Vec3& p : x_) box.add(p);
      // Thinner ones count as elements without volume.
      if (!(element_measure(run_.kind, x_) > 1e-13 * std::pow(box.diagonal(), 3))) continue;
      if (!is_positive(run_.kind, oracle)) continue;
      ++count_.elements;
      for (const double tolerance : {1e-9, 1e-12}) compare(oracle, probes(run_.kind, oracle, random_), tolerance);
    }
    return count_;
  }

 private:
  void compare(const ExtendedOracle& oracle, const std::vector<Probe>& all, double tolerance) {
    const Containers here = containers(run_.kind, x_, tolerance);
    const BoxTree tree(here.set.boxes);
    std::vector<Vec3> points;
    for (const Probe& probe : all) points.push_back(probe.point);
    std::vector<Placement> places(points.size());
    const double size = CornerList(here.set, 0).size();
    const PlaceRules rules{tolerance, false};
    place_many(here.set, tree, points, 10 * size, rules, places);
    for (std::size_t i = 0; i < all.size(); ++i) {
      Placement alone;
      place_many(here.set, tree, std::span(&points[i], 1), 10 * size, rules, std::span(&alone, 1));
      if (alone.xi != places[i].xi || alone.state != places[i].state) ++count_.disagreeing;
      judge(oracle, all[i], places[i], tolerance * size);
    }
  }

  void judge(const ExtendedOracle& oracle, const Probe& probe, const Placement& place, double tolerance) {
    tolerance_ = tolerance;
    const bool found = place.found() && !place.is_outside();
    std::optional<OraclePlace> there = oracle.from(probe.point, probe.xi);
    if (found) {
      double span = 0;
      for (const Vec3& p : x_) span = std::max(span, norm(p - probe.point));
      // Coordinates themselves are given to within their last digit only as far as they go into the point.
      if (gap(oracle, place.xi, probe.point) > 2 * tolerance + 64 * 1.2e-16 * span) {
        ++count_.invented;
        tell("invented", probe, place, there ? there->overshoot : 1);
      }
    }
    const bool inside = there && there->overshoot <= 0;
    if (!inside && !found && count_.elements % run_.thoroughly_each == 0) {
      ++count_.brute_forced;
      there = oracle.find(probe.point, run_.starts);
    }
    if (there && there->overshoot <= 0) {
      ++count_.inside;
      if (found) return;
      if (!(oracle.determinant(there->xi) > 0)) return;  // folded, between the places of the lattice
      ++count_.lost;
      tell("lost", probe, place, there->overshoot);
    } else {
      ++count_.outside;
    }
  }

  void tell(const char* what, const Probe& probe, const Placement& place, Extended overshoot) {
    if (count_.lost + count_.invented > 5) return;
    count_.first += fmt::format(
        "{}: {} (and more) {} element, point ({:.17g}, {:.17g}, {:.17g}) at xi ({:.6g}, {:.6g}, {:.6g}), overshoot "
        "{:.3g}; placed "
        "at ({:.6g}, {:.6g}, {:.6g}), distance {:.3g}\n",
        what, families[static_cast<std::size_t>(family_)], topology(run_.kind).name, probe.point[0], probe.point[1],
        probe.point[2], static_cast<double>(probe.xi[0]), static_cast<double>(probe.xi[1]),
        static_cast<double>(probe.xi[2]), static_cast<double>(overshoot), place.xi[0], place.xi[1], place.xi[2],
        place.distance);
    count_.first +=
        fmt::format("  gap {:.3g}, tolerance {:.3g}\n",
                    static_cast<double>(gap(ExtendedOracle(run_.kind, x_), place.xi, probe.point)), tolerance_);
    for (const Vec3& p : x_) count_.first += fmt::format("  {{{:.17g}, {:.17g}, {:.17g}}},\n", p[0], p[1], p[2]);
  }

  OracleRun run_;
  Random random_;
  OracleCount count_;
  std::vector<Vec3> x_;
  int family_ = 0;
  double tolerance_ = 0;  ///< m
};

}  // namespace

OracleCount compare_with_oracle(const OracleRun& run) {
  return Comparison(run).go();
}

}  // namespace tenon::transfer::testing
