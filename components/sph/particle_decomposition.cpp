// SPDX-License-Identifier: BSD-3-Clause
#include "components/sph/particle_decomposition.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <type_traits>
#include <utility>

namespace tenon {

namespace {

/// An array that travels: from the first entries of one to all of another.
template <typename Values>
ExchangeItem travelling(const Values& from, Values& to, std::size_t components = 1) {
  return {reinterpret_cast<const std::byte*>(from.data()), reinterpret_cast<std::byte*>(to.data()),
          components * sizeof(from[0])};
}

template <typename Values>
void permute(Values& values, std::span<const LocalIndex> order, std::size_t components, Values& room) {
  room.resize(order.size() * components);
  const auto take = [&](auto count) {
    for (std::size_t i = 0; i < order.size(); ++i)
      std::copy_n(values.data() + static_cast<std::size_t>(order[i]) * count, count, room.data() + i * count);
  };
  // Of lengths that the compiler knows, without a call for each.
  if (components == 1)
    take(std::integral_constant<std::size_t, 1>());
  else if (components == 3)
    take(std::integral_constant<std::size_t, 3>());
  else
    take(components);
  std::copy(room.begin(), room.end(), values.begin());
}

// What rebalancing has to gain, in pairs: a pair costs about a hundredth of a microsecond, and a particle that is
// sorted in anew on another rank two of them.
constexpr double pairs_of_a_move = 200;
// Steps for which a new balance is taken to last.
constexpr double steps_of_balance = 100;
// Greatest over mean work: above the first parts are made anew at the next renewal, above the second at once.
constexpr double worth_balancing = 1.02, greatest_imbalance = 1.04;

// Particles of a rank; of fewer, one more or less is a percent.
constexpr std::int64_t enough_to_balance = 100;

// So many may be anywhere. A search looks at six distances for each pair that it lists, and at more of them where
// smoothing lengths differ.
constexpr std::int64_t particles_that_never_crowd = 6000, tests_of_a_pair = 70;

}  // namespace

ParticleDecomposition::ParticleDecomposition(const Communicator& comm, std::string name, ParticleData& data,
                                             const ParticleDomain& domain, const DecompositionOptions& options)
    : comm_(comm), name_(std::move(name)), data_(data), images_(domain), options_(options), rcb_(comm) {}

std::int64_t most_neighbours_of(double support, double smoothing, double skin, int dimension) {
  constexpr double pressed = 8, least = 400;
  const double ball = dimension == 3 ? 4.0 / 3 * std::numbers::pi : dimension == 2 ? std::numbers::pi : 2;
  const double expected = ball * std::pow(support * smoothing * (1 + skin), dimension);
  return static_cast<std::int64_t>(std::max(least, std::ceil(pressed * expected)));
}

double ParticleDecomposition::greatest_length() const {
  double greatest = 0;
  for (std::size_t i = 0; i < data_.owned(); ++i) greatest = std::max(greatest, data_.reference_length[i]);
  return comm_.max(greatest);
}

void ParticleDecomposition::renew() {
  for (std::size_t i = 0; i < data_.owned(); ++i) {
    data_.position.set(i, images_.wrapped(data_.position.vec(i)));
    data_.reference.set(i, data_.position.vec(i));
    data_.reference_length[i] = data_.length[i];
  }
  ++counts_.renewals;
  arrange();
}

void ParticleDecomposition::arrange() {
  const double length = greatest_length();
  const std::int64_t all = comm_.sum(static_cast<std::int64_t>(data_.owned()));
  most_.pairs = options_.most_neighbours * (all + particles_that_never_crowd);
  most_.tested = tests_of_a_pair * most_.pairs;
  reach_ = options_.support * length;
  skin_ = options_.skin * options_.support * length;
  for (const ParticleDomain::Axis& axis : images_.domain().axes)
    if (axis.periodic && axis.period() < reach_ + skin_)
      throw Error(
          ExitCode::usage,
          fmt::format("{}: the period of {} m is shorter than the support of the kernel and its skin, {} m; take more "
                      "particles across it",
                      name_, axis.period(), reach_ + skin_));
  // The first parts know nothing of the work, and later ones only that of the lists before: it is counted once there
  // are lists, and parts that are not good for it are made again.
  const int rounds = comm_.size() > 1 && (version_ == 0 || all >= enough_to_balance * comm_.size()) ? 2 : 1;
  for (int round = 0; round < rounds; ++round) {
    migrate();
    sort();
    find_ghosts();
    search(false);
    refuse_crowds();
    ++version_;
    if (rounds > 1 && imbalance_of_work() < greatest_imbalance) break;
  }
}

// Lists that grow with the square of the particles would take all memory, or all time.
void ParticleDecomposition::refuse_crowds() const {
  const std::int64_t pairs = comm_.sum(static_cast<std::int64_t>(lists_.pairs()));
  const bool crowded = pairs > most_.pairs, too_slow = !crowded && comm_.sum(lists_.tested()) > most_.tested;
  if (!crowded && !too_slow) return;
  const auto neighbours = [&](std::size_t i) { return static_cast<double>(lists_.of(i).size()); };
  const auto worth = [&](std::size_t i) {
    const double h = data_.reference_length[i];
    return !too_slow ? neighbours(i) : std::isnan(h) ? 0 : h;
  };
  std::size_t first = data_.owned();
  for (std::size_t i = 0; i < data_.owned(); ++i)
    if (first == data_.owned() || worth(i) > worth(first) ||
        (worth(i) == worth(first) && data_.ids[i] < data_.ids[first]))
      first = i;
  const double mine = first < data_.owned() ? worth(first) : -1, greatest = comm_.max(mine);
  const GlobalId id = comm_.min(mine == greatest ? data_.ids[first] : std::numeric_limits<GlobalId>::max());
  std::optional<Error> error;
  if (mine == greatest && data_.ids[first] == id) {
    const Vec3 x = data_.reference.vec(first);
    error.emplace(
        ExitCode::unstable,
        too_slow
            ? fmt::format("{}: the smoothing length of particle {} near ({:.4g}, {:.4g}, {:.4g}) is {:.4g} m, so long "
                          "beside the others that nearly all pairs have to be tested; take particles "
                          "whose sizes differ less, or keep lengths constant",
                          name_, id + 1, x[0], x[1], x[2], data_.reference_length[first])
            : fmt::format("{}: particle {} near ({:.4g}, {:.4g}, {:.4g}) has at least {:.0f} neighbours, and all "
                          "together more than {:.0e}; particles lie on top of each other or their supports have grown "
                          "over everything: look at the last frame, take a smaller `smoothing`, a smaller "
                          "time_step.cfl, or a stiffer equation of state",
                          name_, id + 1, x[0], x[1], x[2], neighbours(first), static_cast<double>(most_.pairs)));
  }
  comm_.throw_if_any(error);
}

double ParticleDecomposition::imbalance_of_work() const {
  const auto mine =
      static_cast<std::int64_t>(lists_.pairs() + static_cast<std::size_t>(pairs_of_a_particle) * data_.owned());
  const std::int64_t all = comm_.sum(mine);
  return all > 0 ? static_cast<double>(comm_.max(mine)) * comm_.size() / static_cast<double>(all) : 1;
}

// What was counted when the lists were last made decides on the weights.
std::vector<int> ParticleDecomposition::destinations() {
  const std::size_t owned = data_.owned();
  std::vector<double> weight(owned, pairs_of_a_particle);
  double mine = 0;
  for (std::size_t i = 0; i < owned; ++i) {
    if (version_ > 0) weight[i] += static_cast<double>(lists_.of(i).size());
    mine += weight[i];
  }
  const std::int64_t most = comm_.max(static_cast<std::int64_t>(mine)),
                     sum = comm_.sum(static_cast<std::int64_t>(mine));
  const double mean = static_cast<double>(sum) / comm_.size();
  counts_.imbalance = mean > 0 ? static_cast<double>(most) / mean : 1;
  const double particles = static_cast<double>(comm_.sum(static_cast<std::int64_t>(owned))) / comm_.size();
  const double gain = (static_cast<double>(most) - mean) * steps_of_balance;
  const bool may_stay = has_parts_ && !options_.always_rebalance;
  if (may_stay && gain < pairs_of_a_move * particles * (1 - 1 / counts_.imbalance) + pairs_of_a_particle)
    return by_present_parts();
  if (may_stay && counts_.imbalance < worth_balancing) return by_present_parts();
  std::vector<Vec3> places(owned);
  for (std::size_t i = 0; i < owned; ++i) places[i] = data_.reference.vec(i);
  has_parts_ = true;
  ++counts_.rebalances;
  return rcb_.partition(places, weight);
}

std::vector<int> ParticleDecomposition::by_present_parts() const {
  const Box mine = rcb_.part(comm_.rank());
  std::vector<int> rank(data_.owned(), comm_.rank()), found;
  for (std::size_t i = 0; i < data_.owned(); ++i) {
    const Vec3 x = data_.reference.vec(i);
    if (mine.contains(x) || !std::isfinite(x[0] + x[1] + x[2])) continue;
    found.clear();
    rcb_.ranks_overlapping({x, x}, found);
    if (!found.empty()) rank[i] = found.front();
  }
  return rank;
}

void ParticleDecomposition::migrate() {
  const std::size_t owned = data_.owned();
  data_.resize(owned, 0);
  if (comm_.size() == 1) {
    counts_.rebalances = 0;
    return;
  }
  const std::vector<int> destination = destinations();
  const auto leave = std::ranges::count_if(destination, [&](int r) { return r != comm_.rank(); });
  counts_.moved += leave;
  if (!comm_.any(leave > 0)) return;
  const ExchangePlan plan = ExchangePlan::to_ranks(comm_, destination, name_ + " migration");
  const auto arriving = static_cast<std::size_t>(plan.received());
  std::vector<GlobalId> ids(arriving);
  std::vector<std::int32_t> body(arriving), home_rank(arriving);
  std::vector<LocalIndex> home_node(arriving);
  std::vector<ColumnValues> values;
  std::vector<ExchangeItem> items{travelling(data_.ids, ids), travelling(data_.body, body),
                                  travelling(data_.home_rank, home_rank), travelling(data_.home_node, home_node)};
  values.reserve(data_.columns().size());
  for (const Column& column : data_.columns()) {
    if (!column.kept) continue;
    const auto components = static_cast<std::size_t>(column.components);
    values.emplace_back(arriving * components);
    items.push_back(travelling(column.values, values.back(), components));
  }
  plan.forward(items);
  data_.ids = std::move(ids), data_.body = std::move(body);
  data_.home_rank = std::move(home_rank), data_.home_node = std::move(home_node);
  auto next = values.begin();
  for (Column& column : data_.columns())
    if (column.kept) column.values = std::move(*next++);
  data_.resize(arriving, 0);
}

void ParticleDecomposition::sort() {
  const std::size_t owned = data_.owned();
  const CellGrid grid = NeighbourLists::cells(reach_, skin_);
  struct Place {
    CellGrid::Key key;
    GlobalId id;
    LocalIndex index;
    bool operator<(const Place& b) const { return key != b.key ? key < b.key : id < b.id; }
  };
  std::vector<Place> places(owned);
  for (std::size_t i = 0; i < owned; ++i)
    places[i] = {grid.key(data_.reference.vec(i)), data_.ids[i], static_cast<LocalIndex>(i)};
  std::sort(places.begin(), places.end());
  std::vector<LocalIndex> order(owned);
  bool sorted = true;
  for (std::size_t i = 0; i < owned; ++i)
    order[i] = places[i].index, sorted = sorted && order[i] == static_cast<LocalIndex>(i);
  if (sorted) return;
  ColumnValues room;
  for (Column& column : data_.columns())
    if (column.kept) permute(column.values, order, static_cast<std::size_t>(column.components), room);
  std::vector<GlobalId> id_room;
  std::vector<std::int32_t> room32;
  permute(data_.ids, order, 1, id_room);
  permute(data_.body, order, 1, room32);
  permute(data_.home_rank, order, 1, room32);
  permute(data_.home_node, order, 1, room32);
}

// A hot particle may cross a mirror and meet its own image. The images of those that it meets then are so much farther
// from the plane; without them a pair would act on one of its particles only.
double ParticleDecomposition::deepest_beyond_mirrors() const {
  double deepest = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const ParticleDomain::Axis& a = images_.domain().axes[c];
    for (std::size_t i = 0; i < data_.owned() && !a.periodic && (a.low || a.high); ++i) {
      const double x = data_.reference[3 * i + c];
      if (!std::isfinite(x)) continue;
      if (a.low) deepest = std::max(deepest, *a.low - x);
      if (a.high) deepest = std::max(deepest, x - *a.high);
    }
  }
  return images_.domain().open() ? 0 : comm_.max(deepest);
}

// A copy of each particle for every rank in whose part, or near it, the particle or an image of it is.
void ParticleDecomposition::find_ghosts() {
  const std::size_t owned = data_.owned();
  std::vector<int> rank;
  std::vector<LocalIndex> send;
  std::vector<std::uint8_t> image;
  std::vector<int> found;
  const bool one = comm_.size() == 1;
  const Box part = one ? Box() : rcb_.part(comm_.rank());
  const auto offer = [&](std::size_t i, const Vec3& x, double reach, std::uint8_t copy) {
    Box box{x, x};
    box.inflate(reach);
    found.clear();
    if (one)
      found.push_back(0);
    else
      rcb_.ranks_overlapping(box, found);
    for (const int r : found) {
      if (copy == 0 && r == comm_.rank()) continue;
      rank.push_back(r), send.push_back(static_cast<LocalIndex>(i)), image.push_back(copy);
    }
  };
  const double reach = reach_ + skin_, reach_of_images = reach + deepest_beyond_mirrors();
  for (std::size_t i = 0; i < owned; ++i) {
    const Vec3 x = data_.reference.vec(i);
    if (!std::isfinite(x[0] + x[1] + x[2])) continue;
    bool inside = one;
    for (std::size_t c = 0; c < 3 && !one; ++c) {
      inside = x[c] - part.low[c] > reach && part.high[c] - x[c] > reach;
      if (!inside) break;
    }
    if (!inside) offer(i, x, reach, 0);
    if (!images_.domain().open())
      images_.for_each(x, reach_of_images, [&](std::uint8_t copy) { offer(i, images_.place(x, copy), reach, copy); });
  }
  any_ghosts_ = comm_.any(!send.empty());
  data_.resize(owned, 0);
  any_images_ = false;
  if (!any_ghosts_) return;
  ghosts_ = ExchangePlan::to_ranks(comm_, rank, send, name_ + " ghosts");
  const auto ghosts = static_cast<std::size_t>(ghosts_.received());
  data_.resize(owned, ghosts);
  std::fill_n(data_.image.begin(), owned, std::uint8_t{0});
  const auto behind = [&]<typename T>(std::vector<T>& values) {
    return ExchangeItem{reinterpret_cast<const std::byte*>(values.data()),
                        reinterpret_cast<std::byte*>(values.data() + owned), sizeof(T)};
  };
  const std::array<ExchangeItem, 2> items{behind(data_.ids), behind(data_.body)};
  ghosts_.forward(items);
  if (!images_.domain().open()) {
    // The same items in the same order, each with a number of its own.
    const ExchangePlan numbers = ExchangePlan::to_ranks(comm_, rank, name_ + " images");
    numbers.forward(std::span<const std::uint8_t>(image), std::span(data_.image).subspan(owned));
    any_images_ = std::ranges::any_of(data_.image, [](std::uint8_t n) { return n != 0; });
  }
  std::vector<Column*> kept;
  for (Column& column : data_.columns())
    if (column.kept) kept.push_back(&column);
  refresh(kept);
}

void ParticleDecomposition::refresh(std::span<Column* const> columns) const {
  ++counts_.refreshes;
  for (const Column* const column : columns) counts_.refreshed += column->components;
  if (!any_ghosts_) return;
  std::array<ExchangeItem, 64> items;
  std::size_t count = 0;
  for (Column* const column : columns) {
    const auto components = static_cast<std::size_t>(column->components);
    items[count++] = {reinterpret_cast<const std::byte*>(column->data()),
                      reinterpret_cast<std::byte*>(column->data() + data_.owned() * components),
                      components * sizeof(double)};
    if (count < items.size()) continue;
    ghosts_.forward(items);
    count = 0;
  }
  if (count > 0) ghosts_.forward(std::span(items).first(count));
  if (!any_images_) return;
  for (Column* const column : columns) {
    if (column->kind == ColumnKind::scalar) continue;
    const auto components = static_cast<std::size_t>(column->components);
    for (std::size_t i = data_.owned(); i < data_.size(); ++i)
      images_.apply(column->kind, data_.image[i], column->data() + i * components);
  }
}

void ParticleDecomposition::search(bool again) {
  const std::size_t size = data_.size();
  const Column& x = again ? data_.position : data_.reference;
  const Column& h = again ? data_.length : data_.reference_length;
  places_.resize(size), reaches_.resize(size);
  for (std::size_t i = 0; i < size; ++i) {
    places_[i] = x.vec(i);
    reaches_[i] = options_.support * h[i];
  }
  const ListedPoints points{places_, reaches_, data_.ids, data_.image, data_.owned()};
  if (again)
    lists_.build_again(points, 0, most_);
  else
    lists_.build(points, reach_, skin_, most_);
}

bool ParticleDecomposition::used_up() const {
  double way = 0, growth = 0;
  for (std::size_t i = 0; i < data_.owned(); ++i) {
    const Vec3 d = data_.position.vec(i) - data_.reference.vec(i);
    const double squared = dot(d, d);
    if (!(squared <= way)) way = squared > way ? squared : std::numeric_limits<double>::infinity();
    growth = std::max(growth, data_.length[i] - data_.reference_length[i]);
  }
  std::array<double, 2> most{way, growth};
  comm_.max(std::span<double>(most));
  return !(2 * std::sqrt(most[0]) + options_.support * most[1] <= skin_);
}

bool ParticleDecomposition::follow() {
  if (used_up()) {
    renew();
    return true;
  }
  if (options_.always_search) {
    const std::array<Column*, 2> columns{&data_.position, &data_.length};
    refresh(columns);
    search(true);
    refuse_crowds();
  }
  return false;
}

std::int64_t ParticleDecomposition::memory() const {
  std::size_t bytes = places_.capacity() * sizeof(Vec3) + reaches_.capacity() * sizeof(double);
  for (const Column& column : data_.columns()) bytes += column.values.capacity() * sizeof(double);
  return static_cast<std::int64_t>(bytes + data_.ids.capacity() * 24) + lists_.memory();
}

}  // namespace tenon
