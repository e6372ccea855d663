// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/nodal_damping.hpp"

#include <algorithm>

namespace tenon {

namespace {

/// (1 + a C)^-1 w for a positive semi-definite C, by the adjugate.
Vec3 damped_mean(const SymmetricTensor<double>& c, double a, const Vec3& w) {
  const double xx = 1 + a * c.xx, yy = 1 + a * c.yy, zz = 1 + a * c.zz;
  const double xy = a * c.xy, yz = a * c.yz, zx = a * c.zx;
  const SymmetricTensor<double> adjugate{yy * zz - yz * yz, xx * zz - zx * zx, xx * yy - xy * xy,
                                         zx * yz - xy * zz, xy * zx - xx * yz, xy * yz - yy * zx};
  const double determinant = xx * adjugate.xx + xy * adjugate.xy + zx * adjugate.zx;
  return (1 / determinant) * times(adjugate, w);
}

Vec3 mean_without_damping(const Vec3& v, const ForceRow& f, double a) {
  return v - a * Vec3{f.v[0], f.v[1], f.v[2]};
}

}  // namespace

NodalDamping::NodalDamping(double mass_proportional, std::vector<Entry> entries, const NodalState& nodes)
    : mass_proportional_(mass_proportional) {
  if (!(mass_proportional > 0)) {
    entries_ = std::move(entries);
    return;
  }
  auto next = entries.begin();
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    Entry entry{static_cast<LocalIndex>(n), {}, {}};
    if (next != entries.end() && next->node == entry.node) entry = *next++;
    entries_.push_back(entry);
  }
}

const NodalDamping::Entry* NodalDamping::find(LocalIndex node) const {
  const auto found = std::ranges::lower_bound(entries_, node, {}, &Entry::node);
  return found != entries_.end() && found->node == node ? &*found : nullptr;
}

SymmetricTensor<double> NodalDamping::damper(const Entry& entry, const NodalState& nodes) const {
  const double own = mass_proportional_ * nodes.mass[static_cast<std::size_t>(entry.node)];
  return entry.dashpot + SymmetricTensor<double>{own, own, own, 0, 0, 0};
}

NodalDamping::Forces NodalDamping::forces(const Entry& entry, const NodalState& nodes, double kick) const {
  const auto n = static_cast<std::size_t>(entry.node);
  const double a = 0.5 * kick * nodes.inverse_mass[n];
  const SymmetricTensor<double> damper = this->damper(entry, nodes);
  const Vec3 undamped = mean_without_damping(nodes.velocity()[n], nodes.force[n], a);
  const Vec3 mean = damped_mean(damper + entry.absorbing, a, undamped);
  return {-1.0 * times(damper, mean), -1.0 * times(entry.absorbing, mean)};
}

Vec3 NodalDamping::moment(const NodalState& nodes, std::size_t n, double kick) const {
  const double a = 0.5 * kick * nodes.inverse_inertia[n], c = mass_proportional_ * nodes.inertia[n];
  return (-c / (1 + a * c)) * mean_without_damping(nodes.spin()[n], nodes.moment[n], a);
}

}  // namespace tenon
