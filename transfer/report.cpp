// SPDX-License-Identifier: BSD-3-Clause
// What a transfer tells about itself: integrals on both sides and how far off the values may be.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "transfer/element_points.hpp"
#include "transfer/error_estimate.hpp"
#include "transfer/grid_transfer_impl.hpp"

namespace tenon::transfer {

namespace {

struct Integral {
  double value = 0, magnitude = 0;  ///< of f and of |f|
};

/// Collective. Of the first component over the owned items: the sum of totals, the volume integral of others; 0 where
/// points have no volume.
Integral integral_of(const Partner& partner, std::span<const double> values, int components, bool total) {
  if (!total && !partner.mesh) return {};
  if (!total && partner.volumes.size() != partner.items().ids.size())
    partner.volumes = item_volumes(*partner.mesh, partner.coordinates, partner.location);
  ExactSum sum, magnitude;
  for (const LocalIndex item : partner.items().owned) {
    const auto i = static_cast<std::size_t>(item);
    const double value = values[i * static_cast<std::size_t>(components)];
    const double volume = total ? 1.0 : partner.volumes[i];
    sum.add_product(value, volume);
    magnitude.add_product(std::abs(value), volume);
  }
  return {partner.comm().sum(sum), partner.comm().sum(magnitude)};
}

}  // namespace

double GridTransfer::Impl::error(std::span<const double> source_values, std::span<const double> target_values,
                                 int components, GlobalId samples) const {
  const std::vector<Vec3> places = target.mesh
                                       ? item_points(target.side())
                                       : std::vector<Vec3>(target.coordinates.begin(), target.coordinates.end());
  const std::string estimate = name + ".estimate";
  const auto greatest = [&](const auto& rows) {
    return ErrorEstimate(source.side(), target.items(), places, rows, samples, estimate)(source_values, target_values,
                                                                                         components)
        .greatest;
  };
  // Rows of amounts do not say where a target lies.
  if (method != Method::conserve && method != Method::project) return greatest(map);
  return greatest(PlaceRules{options.tolerance, options.outside == OutsidePolicy::extrapolate});
}

TransferReport GridTransfer::report(std::span<const double> source, std::span<const double> target, int components,
                                    Thoroughness thoroughness) const {
  constexpr GlobalId few = 1024;  // targets
  const bool total = impl_->field.kind == FieldKind::total;
  const Integral from = integral_of(impl_->source, source, components, total);
  const Integral to = integral_of(impl_->target, target, components, total);
  TransferReport report;
  report.targets = impl_->misses.targets;
  report.outside = impl_->misses.outside;
  report.greatest_distance = impl_->misses.greatest_distance;
  report.farthest = impl_->misses.farthest;
  report.skipped = impl_->misses.skipped;
  report.source_integral = from.value;
  report.target_integral = to.value;
  const bool measurable = total || (impl_->source.mesh && impl_->target.mesh);
  const double difference = measurable ? std::abs(to.value - from.value) : 0.0;
  report.mismatch = from.magnitude > 0 ? difference / from.magnitude : difference;
  const bool estimable = !total && impl_->source.mesh && impl_->source.mesh->global_elements > 0 && !impl_->copied;
  if (estimable)
    report.error_estimate = impl_->error(source, target, components, thoroughness == Thoroughness::full ? 0 : few);
  if (impl_->projection) {
    const ProjectionOutcome& outcome = impl_->projection->outcome();
    report.spread = outcome.spread, report.clipped = outcome.clipped, report.unplaced = outcome.unplaced;
  }
  return report;
}

double GridTransfer::round_trip_error(const GridTransfer& back, std::span<const double> source, int components) const {
  const auto width = static_cast<std::size_t>(components);
  std::vector<double> there(impl_->target.items().ids.size() * width), here(source.size());
  const TransferItem forth{source, there, components}, home{there, here, components};
  const bool leads_back = back.impl_->source.items().ids.size() * width == there.size() &&
                          back.impl_->target.items().ids.size() * width == here.size();
  if (impl_->comm().any(!leads_back))
    throw Error(ExitCode::usage, fmt::format("transfer '{}': '{}' does not lead back to where it comes from",
                                             impl_->name, back.impl_->name));
  impl_->apply(std::span(&forth, 1));
  back.impl_->apply(std::span(&home, 1));
  --impl_->applied, --back.impl_->applied;  // nobody's values
  double greatest = 0;
  for (const LocalIndex item : impl_->source.items().owned)
    for (std::size_t c = 0; c < width; ++c) {
      const std::size_t i = static_cast<std::size_t>(item) * width + c;
      greatest = std::max(greatest, std::abs(here[i] - source[i]));
    }
  return impl_->comm().max(greatest);
}

}  // namespace tenon::transfer
