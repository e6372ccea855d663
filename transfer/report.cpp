// SPDX-License-Identifier: BSD-3-Clause
// What a transfer tells about itself: integrals on both sides and how far off the values may be.
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
  // With nothing but copies there is nothing to estimate; other methods than interpolation need one.
  if (method == Method::interpolate)
    return ErrorEstimate(source.side(), target.items(), places, map, samples, estimate)(source_values, target_values,
                                                                                        components)
        .greatest;
  const PlaceRules rules{options.tolerance, options.outside == OutsidePolicy::extrapolate};
  return ErrorEstimate(source.side(), target.items(), places, rules, samples, estimate)(source_values, target_values,
                                                                                        components)
      .greatest;
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
  if (!total && impl_->source.mesh && !impl_->copied)
    report.error_estimate = impl_->error(source, target, components, thoroughness == Thoroughness::full ? 0 : few);
  return report;
}

}  // namespace tenon::transfer
