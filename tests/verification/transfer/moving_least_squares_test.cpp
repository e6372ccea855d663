// SPDX-License-Identifier: BSD-3-Clause
// Moving least squares between clouds: order, exactness, conservation, and the same bits on any number of ranks.
#include "transfer/moving_least_squares.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <memory>

#include "transfer_testing.hpp"

namespace tenon::transfer {
namespace {

using testing::communicator;
using testing::random_number;

const char* const file_name = "transfer_moving_least_squares.txt";

/// Points of all ranks by their ids, of which this rank owns some.
struct Cloud {
  std::vector<Vec3> all;
  std::unique_ptr<PointCloud> points;  ///< those of this rank
  Items items;
  std::vector<Vec3> places;  ///< of them
};

Vec3 random_point(std::uint64_t seed, std::uint64_t i) {
  return {random_number(seed, 3 * i), random_number(seed, 3 * i + 1), random_number(seed, 3 * i + 2)};
}

enum class Spread { slabs, round_robin, last_rank };

Cloud shared_out(std::vector<Vec3> all, Spread spread = Spread::slabs) {
  Cloud cloud;
  cloud.points = std::make_unique<PointCloud>(PointCloud{communicator(), {}, "points"});
  const auto ranks = static_cast<std::size_t>(communicator().size()),
             rank = static_cast<std::size_t>(communicator().rank());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::size_t owner = spread == Spread::slabs         ? i * ranks / all.size()
                              : spread == Spread::round_robin ? i % ranks
                                                              : ranks - 1;
    if (owner != rank) continue;
    cloud.points->ids.push_back(static_cast<GlobalId>(i));
    cloud.places.push_back(all[i]);
  }
  cloud.items = items_of(*cloud.points);
  cloud.all = std::move(all);
  return cloud;
}

/// (n + 1)^3 points of the unit cube, those inside moved by up to `jitter` of their distance.
std::vector<Vec3> lattice(int n, double jitter, std::uint64_t seed) {
  std::vector<Vec3> all;
  for (int i = 0; i < (n + 1) * (n + 1) * (n + 1); ++i) {
    Vec3 x{static_cast<double>(i % (n + 1)), static_cast<double>(i / (n + 1) % (n + 1)),
           static_cast<double>(i / (n + 1) / (n + 1))};
    const Vec3 moved = random_point(seed, static_cast<std::uint64_t>(i));
    for (std::size_t c = 0; c < 3; ++c) x[c] = (x[c] + (x[c] > 0 && x[c] < n ? jitter * (2 * moved[c] - 1) : 0)) / n;
    all.push_back(x);
  }
  return all;
}

std::vector<Vec3> scattered(int count, std::uint64_t seed) {
  std::vector<Vec3> all;
  for (int i = 0; i < count; ++i) all.push_back(random_point(seed, static_cast<std::uint64_t>(i)));
  return all;
}

/// A hundred times denser along each axis near the origin than at the far end.
std::vector<Vec3> graded(int count, std::uint64_t seed) {
  std::vector<Vec3> all = scattered(count, seed);
  for (Vec3& x : all)
    for (double& value : x) value = (std::pow(100.0, value) - 1) / 99;
  return all;
}

double smooth(const Vec3& x) {
  return std::sin(2 * x[0] + 0.3) * std::cos(3 * x[1]) * std::exp(x[2]);
}
double linear(const Vec3& x) {
  return 1 + 2 * x[0] - 3 * x[1] + 0.5 * x[2];
}

/// Values of the rows' items, the source given by its values at all points.
std::vector<double> multiplied(const Rows& rows, const std::vector<double>& source) {
  std::vector<double> values;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    double sum = 0;
    for (const Term& term : rows.row(i)) sum += term.weight * source[static_cast<std::size_t>(term.source)];
    values.push_back(sum);
  }
  return values;
}

std::vector<double> at(const std::vector<Vec3>& points, double (*f)(const Vec3&)) {
  std::vector<double> values;
  for (const Vec3& x : points) values.push_back(f(x));
  return values;
}

struct Mapped {
  Rows rows;
  std::vector<FittedPoint> fitted;
};

Mapped mapped(const Cloud& source, const Cloud& target, const MovingLeastSquaresOptions& options = {}) {
  Mapped m;
  m.rows =
      moving_least_squares_rows(communicator(), source.items, source.places, target.places, options, "test", m.fitted);
  EXPECT_EQ(m.rows.size(), target.places.size());
  EXPECT_EQ(m.fitted.size(), target.places.size());
  return m;
}

double greatest_error(const Mapped& m, const Cloud& source, const Cloud& target, double (*f)(const Vec3&)) {
  const std::vector<double> values = multiplied(m.rows, at(source.all, f));
  double greatest = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    greatest = std::max(greatest, std::abs(values[i] - f(target.places[i])));
  return communicator().max(greatest);
}

Mapped transposed(const Cloud& source, const Cloud& target, const MovingLeastSquaresOptions& options = {}) {
  std::vector<SpreadPoint> points;
  for (std::size_t i = 0; i < source.places.size(); ++i)
    points.push_back({source.places[i], source.items.ids[i], communicator().rank(), source.items.at_owner[i], 1});
  Mapped m;
  m.rows =
      moving_least_squares_transpose(communicator(), target.items, target.places, points, options, "test", m.fitted);
  EXPECT_EQ(m.rows.size(), target.places.size());
  return m;
}

/// The values of all ranks, by id.
std::vector<double> gathered(const Cloud& cloud, const std::vector<double>& values) {
  std::vector<double> all(cloud.all.size(), -std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < values.size(); ++i) all[static_cast<std::size_t>(cloud.items.ids[i])] = values[i];
  communicator().max(std::span<double>(all));
  return all;
}

double exact_sum(const std::vector<double>& values) {
  ExactSum sum;
  for (const double v : values) sum.add(v);
  return sum.value();
}

TEST(MovingLeastSquares, ReproducesLinearFieldsOnEveryCloudThatFillsSpace) {
  const Cloud targets = shared_out(scattered(700, 11), Spread::round_robin);
  for (const auto& [name, points] : {std::pair{"lattice", lattice(8, 0, 1)},
                                     {"jittered", lattice(8, 0.3, 1)},
                                     {"random", scattered(900, 2)},
                                     {"graded", graded(900, 3)}}) {
    SCOPED_TRACE(name);
    const Cloud source = shared_out(points);
    const Mapped m = mapped(source, targets);
    EXPECT_LE(greatest_error(m, source, targets, linear), 1e-12);
    for (const FittedPoint& f : m.fitted) EXPECT_TRUE(f.exact);
  }
}

TEST(MovingLeastSquares, ConvergesWithSecondOrderInTheMaximumNorm) {
  const Cloud targets = shared_out(scattered(3000, 11), Spread::round_robin);
  for (const bool jittered : {true, false}) {
    double last = 0;
    for (const int n : {8, 16, 32}) {
      const Cloud source = shared_out(jittered ? lattice(n, 0.2, 1) : scattered((n + 1) * (n + 1) * (n + 1), 7));
      const double error = greatest_error(mapped(source, targets), source, targets, smooth);
      if (last > 0) {
        EXPECT_GE(std::log2(last / error), jittered ? 1.8 : 1.6) << "n " << n;
      }
      if (n == 32) {
        EXPECT_LE(error, jittered ? 1.5e-2 : 4e-2);
      }
      last = error;
    }
  }
}

TEST(MovingLeastSquares, FlatCloudsGiveWhatTheyDetermine) {
  const Cloud targets = shared_out(scattered(200, 11));
  std::vector<Vec3> plane = scattered(400, 2), line = plane, place = plane;
  for (Vec3& x : plane) x[2] = 0.25 * x[0] + 0.5;  // normal (1, 0, -4)
  for (Vec3& x : line) x = {x[0], 2 * x[0], -x[0]};
  for (Vec3& x : place) x = {0.3, 0.4, 0.5};
  const auto foot = [](const Vec3& x) {
    const double off = (0.25 * x[0] + 0.5 - x[2]) / 17;
    return x - off * Vec3{4, 0, -16};
  };
  for (const auto& [name, points] : {std::pair{"plane", plane}, {"line", line}, {"place", place}}) {
    SCOPED_TRACE(name);
    const Cloud source = shared_out(points);
    const Mapped m = mapped(source, targets);
    const std::vector<double> values = multiplied(m.rows, at(source.all, linear));
    for (std::size_t i = 0; i < values.size(); ++i) {
      EXPECT_FALSE(m.fitted[i].exact);
      double absolute = 0;
      for (const Term& term : m.rows.row(i)) absolute += std::abs(term.weight);
      EXPECT_LE(absolute, 1 + FitRules{}.trust);
      if (name == std::string("place")) {
        EXPECT_NEAR(values[i], linear({0.3, 0.4, 0.5}), 1e-14);
      }
      const Vec3 there = foot(targets.places[i]);
      const bool beside = there[0] > 0.05 && there[0] < 0.95 && there[1] > 0.05 && there[1] < 0.95;
      if (name == std::string("plane") && beside) {
        EXPECT_NEAR(values[i], linear(there), 1e-11);
      }
    }
  }
}

TEST(MovingLeastSquares, FlatElementsDoNotHideASolid) {
  // Ten times finer along one axis: most of the nearest 20 points stand in one line.
  std::vector<Vec3> points;
  for (int i = 0; i < 7 * 7 * 61; ++i) points.push_back({(i % 61) / 60.0, (i / 61 % 7) / 6.0, (i / 61 / 7) / 6.0});
  const Cloud source = shared_out(points), targets = shared_out(scattered(300, 11));
  EXPECT_LE(greatest_error(mapped(source, targets), source, targets, linear), 1e-12);
}

TEST(MovingLeastSquares, CountsWhoIsOutside) {
  const Cloud source = shared_out(lattice(10, 0.2, 1));
  std::vector<Vec3> away;
  for (int i = 1; i <= 30; ++i) away.push_back({0.5, 0.45, 1 + 0.01 * i});
  const Cloud targets = shared_out(away);
  const Mapped m = mapped(source, targets);
  for (std::size_t i = 0; i < targets.places.size(); ++i) {
    const double d = targets.places[i][2] - 1;
    EXPECT_GE(m.fitted[i].distance, d);
    EXPECT_LE(m.fitted[i].distance, d + 0.1);
    if (d < 0.055) {
      EXPECT_FALSE(m.fitted[i].outside) << d;
    }
    if (d > 0.25) {
      EXPECT_TRUE(m.fitted[i].outside) << d;
    }
    if (d < 0.105) {
      EXPECT_TRUE(m.fitted[i].exact) << d;
    }
  }
}

TEST(MovingLeastSquares, NonNegativeWeightsAddNoExtrema) {
  const Cloud source = shared_out(scattered(2000, 5)), targets = shared_out(scattered(2000, 6));
  const MovingLeastSquaresOptions options{.rules = {.non_negative = true}};
  const std::vector<double> values = multiplied(mapped(source, targets, options).rows, at(source.all, smooth));
  const std::vector<double> given = at(source.all, smooth);
  const auto [least, greatest] = std::minmax_element(given.begin(), given.end());
  for (const double v : values) {
    EXPECT_GE(v, *least - 1e-14);
    EXPECT_LE(v, *greatest + 1e-14);
  }
}

TEST(MovingLeastSquares, TransposeKeepsTotalsAndMomentsThroughAHundredPingPongs) {
  // The target cloud covers the source, so that no fit has to stop extrapolating.
  std::vector<Vec3> wide = scattered(700, 4);
  for (Vec3& x : wide) x = 1.3 * x - Vec3{0.15, 0.15, 0.15};
  const Cloud a = shared_out(lattice(6, 0.2, 3), Spread::round_robin), b = shared_out(wide);
  const Mapped there = transposed(a, b), back = transposed(b, a);
  std::vector<double> amount;
  for (std::size_t i = 0; i < a.all.size(); ++i) amount.push_back(random_number(8, i) - 0.2);
  const double sum = exact_sum(amount);
  const std::vector<double> once = gathered(b, multiplied(there.rows, amount));
  EXPECT_NEAR(exact_sum(once), sum, 1e-13 * std::abs(sum));
  for (std::size_t c = 0; c < 3; ++c) {
    ExactSum before, after;
    for (std::size_t i = 0; i < a.all.size(); ++i) before.add_product(amount[i], a.all[i][c]);
    for (std::size_t i = 0; i < b.all.size(); ++i) after.add_product(once[i], b.all[i][c]);
    EXPECT_NEAR(after.value(), before.value(), 1e-12);
  }
  for (int repeat = 0; repeat < 100; ++repeat)
    amount = gathered(a, multiplied(back.rows, gathered(b, multiplied(there.rows, amount))));
  EXPECT_NEAR(exact_sum(amount), sum, 1e-13 * std::abs(sum));
}

TEST(MovingLeastSquares, TransposeGathersThePartsOfASource) {
  const Cloud particles = shared_out(lattice(5, 0.2, 3));
  std::vector<SpreadPoint> points;
  for (int e = 0; e < 40; ++e) {  // every element lets go at four places, shares 0.1 to 0.4
    if (e % communicator().size() != communicator().rank()) continue;
    for (std::uint64_t p = 0; p < 4; ++p)
      points.push_back({random_point(17, static_cast<std::uint64_t>(e) * 4 + p), e, communicator().rank(),
                        static_cast<LocalIndex>(e / communicator().size()), 0.1 * static_cast<double>(p + 1)});
  }
  std::vector<FittedPoint> fitted;
  const Rows rows =
      moving_least_squares_transpose(communicator(), particles.items, particles.places, points, {}, "test", fitted);
  EXPECT_EQ(fitted.size(), points.size());
  std::vector<double> columns(40, 0.0);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    GlobalId last = -1;
    for (const Term& term : rows.row(i)) {
      EXPECT_GT(term.source, last);
      last = term.source;
      EXPECT_EQ(term.owner, term.source % communicator().size());
      EXPECT_EQ(term.at_owner, term.source / communicator().size());
    }
  }
  std::vector<double> ones(40, 1.0);
  EXPECT_NEAR(exact_sum(gathered(particles, multiplied(rows, ones))), 40, 1e-12);
}

TEST(MovingLeastSquares, WithoutPointsThereIsAClearErrorOrNothingToDo) {
  const Cloud nothing = shared_out({}), one = shared_out({{1, 2, 3}}), some = shared_out(scattered(50, 3));
  EXPECT_EQ(mapped(some, nothing).rows.terms.size(), 0u);
  EXPECT_EQ(mapped(nothing, nothing).rows.terms.size(), 0u);
  const Mapped m = mapped(one, some);
  for (std::size_t i = 0; i < m.rows.size(); ++i) {
    ASSERT_EQ(m.rows.row(i).size(), 1u);
    EXPECT_EQ(m.rows.row(i).front().weight, 1.0);
    EXPECT_TRUE(m.fitted[i].outside);
  }
  std::vector<FittedPoint> fitted;
  EXPECT_THROW(moving_least_squares_rows(communicator(), nothing.items, {}, some.places, {}, "test", fitted), Error);
  EXPECT_THROW(moving_least_squares_rows(communicator(), some.items, some.places, some.places, {.neighbours = 65},
                                         "test", fitted),
               Error);
}

/// Bits of rows and distances, in order of the global ids.
std::uint64_t fingerprint(const Cloud& target, const Mapped& m) {
  std::vector<double> hashes;
  for (std::size_t i = 0; i < m.rows.size(); ++i) {
    std::uint64_t hash = 0xcbf29ce484222325;  // FNV-1a
    const auto take = [&](std::uint64_t bits) { hash = (hash ^ bits) * 0x100000001b3; };
    for (const Term& term : m.rows.row(i))
      take(static_cast<std::uint64_t>(term.source)), take(std::bit_cast<std::uint64_t>(term.weight));
    if (m.fitted.size() == m.rows.size())
      take(std::bit_cast<std::uint64_t>(m.fitted[i].distance)), take(std::bit_cast<std::uint64_t>(m.fitted[i].spacing));
    hashes.push_back(static_cast<double>(hash >> 12));
  }
  std::uint64_t hash = 0;
  for (const double h : gathered(target, hashes)) hash = hash * 0x100000001b3 + static_cast<std::uint64_t>(h);
  return hash;
}

TEST(MovingLeastSquares, BitsAreThoseOfOneRank) {
  std::vector<Vec3> plane = scattered(300, 2), doubled = scattered(300, 9);
  for (Vec3& x : plane) x[2] = 0.5;
  doubled.insert(doubled.end(), doubled.begin(), doubled.begin() + 150);
  const std::vector<std::pair<std::string, std::vector<Vec3>>> clouds{{"lattice", lattice(7, 0, 1)},
                                                                      {"jittered", lattice(9, 0.2, 1)},
                                                                      {"random", scattered(800, 2)},
                                                                      {"graded", graded(800, 3)},
                                                                      {"plane", plane},
                                                                      {"doubled", doubled},
                                                                      {"few", scattered(5, 3)}};
  std::map<std::string, std::uint64_t> mine;
  for (const auto& [from, source] : clouds)
    for (const auto& [to, target] : clouds)
      for (const Spread spread : {Spread::slabs, Spread::last_rank}) {
        if (to != "random" && to != "plane") continue;
        const Cloud a = shared_out(source, spread), b = shared_out(target, Spread::round_robin);
        const std::string name = from + "-" + to + "-" + std::to_string(static_cast<int>(spread));
        mine[name] = fingerprint(b, mapped(a, b));
        Mapped t = transposed(a, b, {.rules = {.non_negative = to == "random"}});
        t.fitted.clear();
        mine[name + "-transpose"] = fingerprint(b, t);
      }
  testing::expect_bits_of_one_rank(file_name, mine);
}

}  // namespace
}  // namespace tenon::transfer
