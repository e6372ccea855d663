// SPDX-License-Identifier: BSD-3-Clause
// What a transfer tells about itself: integrals on both sides and how far off the values may be.
#include <algorithm>
#include <cmath>

#include "transfer/element_points.hpp"
#include "transfer/grid_transfer_impl.hpp"

namespace tenon::transfer {

namespace {

struct Integral {
  double value = 0, magnitude = 0;  ///< of f and of |f|
};

/// Collective. Of the first component over the owned items: the sum of totals, the volume integral of others.
Integral integral_of(const Partner& partner, std::span<const double> values, int components, bool total) {
  if (!partner.mesh && !total) return {};  // points fill no volume
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

TransferReport GridTransfer::report(std::span<const double> source, std::span<const double> target,
                                    int components) const {
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
  const double difference = std::abs(to.value - from.value);
  report.mismatch = from.magnitude > 0 ? difference / from.magnitude : difference;
  if (impl_->field.kind == FieldKind::point_value && impl_->source.mesh && !impl_->projection)
    report.error_estimate = interpolation_error(impl_->source, impl_->target, impl_->map, source, components);
  return report;
}

}  // namespace tenon::transfer
