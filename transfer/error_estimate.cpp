// SPDX-License-Identifier: BSD-3-Clause
#include "transfer/error_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "transfer/recovered_gradient.hpp"

namespace tenon::transfer {

struct ErrorEstimate::Impl {
  struct Sample {
    LocalIndex item;
    LocalIndex row;  ///< of the interpolation
    Vec3 place;      ///< m
  };
  Communicator comm;
  bool by_node;  ///< the source's values
  std::vector<Sample> samples;
  GlobalId count = 0;  ///< over all ranks
  /// Rows of the samples; columns are places in the gathered arrays.
  SparseRows<double> rows;
  ExchangePlan gather;
  std::vector<Vec3> places;  ///< of the gathered source items, m
  std::unique_ptr<RecoveredGradient> gradient;
  mutable std::vector<double> component, values;
  mutable std::vector<Vec3> local, gradients;

  explicit Impl(const Side& source)
      : comm(source.mesh.comm),
        by_node(source.location == Location::node),
        component(source.items.ids.size()),
        local(source.items.ids.size()) {}
  void choose(const Items& targets, std::span<const Vec3> where, GlobalId most);
  void take_rows(const Side& source, const RowMap& interpolation, const std::string& name);
  double better_value(std::size_t sample) const;
};

namespace {

/// Spreads ids evenly [SLF14].
std::uint64_t mixed(GlobalId id) {
  auto z = static_cast<std::uint64_t>(id) + 0x9e3779b97f4a7c15;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return z ^ (z >> 31);
}

}  // namespace

void ErrorEstimate::Impl::choose(const Items& targets, std::span<const Vec3> where, GlobalId most) {
  const GlobalId all = comm.sum(static_cast<std::int64_t>(targets.owned.size()));
  const auto every = static_cast<std::uint64_t>(most > 0 ? std::max<GlobalId>(1, all / most) : 1);
  for (std::size_t k = 0; k < targets.owned.size(); ++k) {
    const LocalIndex item = targets.owned[k];
    if (mixed(targets.ids[static_cast<std::size_t>(item)]) % every == 0) samples.push_back({item, item, where[k]});
  }
  count = comm.sum(static_cast<std::int64_t>(samples.size()));
}

void ErrorEstimate::Impl::take_rows(const Side& source, const RowMap& interpolation, const std::string& name) {
  std::vector<LocalIndex> here(source.items.ids.size());
  std::iota(here.begin(), here.end(), LocalIndex{0});
  const std::vector<int> owner = interpolation.gathered(source.items.owners);
  const std::vector<LocalIndex> index = interpolation.gathered(std::span<const LocalIndex>(here));
  SlotTable wanted;
  const auto for_each_term = [&](auto&& visit) {
    for (const Sample& sample : samples) {
      interpolation.for_each_term(static_cast<std::size_t>(sample.row), [&](std::size_t slot, double weight) {
        if (weight != 0) visit(owner[slot], index[slot], weight);
      });
      visit(-1, no_index, 0.0);  // end of the row
    }
  };
  for_each_term([&](int rank, LocalIndex i, double) {
    if (rank >= 0) wanted.mark(rank, i);
  });
  wanted.number();
  for_each_term([&](int rank, LocalIndex i, double weight) {
    if (rank < 0) {
      rows.begin.push_back(static_cast<std::int64_t>(rows.column.size()));
    } else {
      rows.column.push_back(wanted.slot(rank, i));
      rows.value.push_back(weight);
    }
  });
  std::vector<LocalIndex> into(wanted.owners().size());
  std::iota(into.begin(), into.end(), LocalIndex{0});
  gather = ExchangePlan::from_owners(comm, wanted.owners(), wanted.indices(), into, name + ".gather");
  places.resize(into.size()), values.resize(into.size()), gradients.resize(into.size());
  gather.forward(std::span<const Vec3>(local_points(source)), std::span<Vec3>(places));

  const ExchangePlan ask = ExchangePlan::to_ranks(comm, wanted.owners(), name + ".ask");
  std::vector<LocalIndex> asked(static_cast<std::size_t>(ask.received()));
  ask.forward(std::span<const LocalIndex>(wanted.indices()), std::span<LocalIndex>(asked));
  std::sort(asked.begin(), asked.end());
  asked.erase(std::unique(asked.begin(), asked.end()), asked.end());
  gradient = std::make_unique<RecoveredGradient>(source, asked, name + ".means");
}

double ErrorEstimate::Impl::better_value(std::size_t sample) const {
  Vec3 nearest{}, slope{};
  double value = 0, correction = 0;
  for (std::size_t k = rows.first(sample); k < rows.last(sample); ++k) {
    const auto a = static_cast<std::size_t>(rows.column[k]);
    nearest = nearest + rows.value[k] * places[a];
    slope = slope + rows.value[k] * gradients[a];
    value += rows.value[k] * values[a];
  }
  for (std::size_t k = rows.first(sample); by_node && k < rows.last(sample); ++k) {
    const auto a = static_cast<std::size_t>(rows.column[k]);
    correction += 0.5 * rows.value[k] * dot(gradients[a], nearest - places[a]);
  }
  return value + (correction + dot(slope, samples[sample].place - nearest));
}

ErrorEstimate::ErrorEstimate(const Side& source, const Items& targets, std::span<const Vec3> places,
                             const RowMap& interpolation, GlobalId samples, const std::string& name)
    : impl_(std::make_unique<Impl>(source)) {
  impl_->choose(targets, places, samples);
  impl_->take_rows(source, interpolation, name);
}

ErrorEstimate::ErrorEstimate(const Side& source, const Items& targets, std::span<const Vec3> places,
                             const PlaceRules& rules, GlobalId samples, const std::string& name)
    : impl_(std::make_unique<Impl>(source)) {
  impl_->choose(targets, places, samples);
  std::vector<Vec3> points;
  for (Impl::Sample& sample : impl_->samples) {
    sample.row = static_cast<LocalIndex>(points.size());
    points.push_back(sample.place);
  }
  const Communicator& comm = source.mesh.comm;
  const Containers containers = containers_of(source.mesh, source.coordinates, {}, rules.tolerance, name);
  const std::vector<Placement> found = Locator(comm, rules, false, name + ".locate").find(containers, points);
  const InterpolationSource from{containers.set, source.nodes, source.location, containers.set.stride,
                                 source.items.ids.size()};
  impl_->take_rows(source, interpolation_map(comm, from, found, false, 0.0, {}, name), name);
}

ErrorEstimate::ErrorEstimate(ErrorEstimate&&) noexcept = default;
ErrorEstimate& ErrorEstimate::operator=(ErrorEstimate&&) noexcept = default;
ErrorEstimate::~ErrorEstimate() = default;

ErrorEstimate::Result ErrorEstimate::operator()(std::span<const double> source, std::span<const double> target,
                                                int components) const {
  const Impl& impl = *impl_;
  const auto width = static_cast<std::size_t>(components);
  Result result;
  for (std::size_t c = 0; c < width; ++c) {
    for (std::size_t i = 0; i < impl.component.size(); ++i) impl.component[i] = source[i * width + c];
    impl.gradient->apply(impl.component, impl.local);
    impl.gather.forward(std::span<const double>(impl.component), std::span<double>(impl.values));
    impl.gather.forward(std::span<const Vec3>(impl.local), std::span<Vec3>(impl.gradients));
    double greatest = 0;
    ExactSum squares;
    for (std::size_t s = 0; s < impl.samples.size(); ++s) {
      if (impl.rows.first(s) == impl.rows.last(s)) continue;  // dropped: it has the outside value
      const double error = target[static_cast<std::size_t>(impl.samples[s].item) * width + c] - impl.better_value(s);
      greatest = std::max(greatest, std::abs(error));
      squares.add(error * error);
    }
    result.greatest = std::max(result.greatest, impl.comm.max(greatest));
    if (impl.count > 0)
      result.mean_square =
          std::max(result.mean_square, std::sqrt(impl.comm.sum(squares) / static_cast<double>(impl.count)));
  }
  return result;
}

GlobalId ErrorEstimate::samples() const {
  return impl_->count;
}

}  // namespace tenon::transfer
