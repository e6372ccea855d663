// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/connectors.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tenon {

using Ends = Connector::Ends;

double law_force(const Connector& connector, double extent) {
  const auto& law = connector.law;
  auto next = std::ranges::upper_bound(law, extent, {}, &std::pair<double, double>::first);
  if (next == law.begin()) ++next;
  if (next == law.end()) --next;
  const auto& [x0, f0] = *(next - 1);
  const auto& [x1, f1] = *next;
  return f0 + (f1 - f0) * ((extent - x0) / (x1 - x0));
}

double greatest_slope(const Connector& connector) {
  double slope = 0;
  for (std::size_t i = 1; i < connector.law.size(); ++i)
    slope = std::max(slope, std::abs((connector.law[i].second - connector.law[i - 1].second) /
                                     (connector.law[i].first - connector.law[i - 1].first)));
  return slope;
}

bool is_linear(const Connector& connector) {
  return connector.law.size() == 2 && connector.law[0] == std::pair(0.0, 0.0);
}

ConnectorForce::ConnectorForce(const Mesh& mesh, const Connector& connector)
    : connector_(connector), links_(find_links(mesh, connector)) {
  std::vector<GlobalId> wanted;
  const auto local = [&](GlobalId id) {
    const auto found = std::ranges::lower_bound(mesh.node_ids, id);
    const bool here = id >= 0 && found != mesh.node_ids.end() && *found == id;
    const auto n = static_cast<LocalIndex>(found - mesh.node_ids.begin());
    return here && mesh.owns_node(n) ? n : no_index;
  };
  for (const Link& link : links_) {
    ends_.push_back(local(link.first)), ends_.push_back(local(link.second));
    wanted.push_back(link.first);
    if (link.second >= 0) wanted.push_back(link.second);
  }
  remote_ = RemoteNodes(mesh, wanted, connector.kind == Connector::Kind::spring ? "springs" : "dashpots");
  position_.resize(wanted.size()), velocity_.resize(wanted.size());
}

std::vector<LocalIndex> ConnectorForce::nodes() const {
  std::vector<LocalIndex> nodes;
  std::ranges::copy_if(ends_, std::back_inserter(nodes), [](LocalIndex n) { return n != no_index; });
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

// Force on the first end; `relative` is the displacement (spring) or velocity (dashpot) of the second end against the
// first.
Vec3 ConnectorForce::link_force(const Link& link, const Vec3& between, const Vec3& relative) const {
  if (connector_.direction) return law_force(connector_, dot(*connector_.direction, relative)) * *connector_.direction;
  if (link.second < 0) return law_force(connector_, 1) * relative;
  const double length = norm(between);
  const Vec3 along = (1 / length) * between;
  const double start = norm(link.second_place - link.first_place);
  const bool spring = connector_.kind == Connector::Kind::spring;
  return law_force(connector_, spring ? length - start : dot(along, relative)) * along;
}

void ConnectorForce::add_forces(const LoadState& state, std::span<ForceRow> force) const {
  const bool spring = connector_.kind == Connector::Kind::spring;
  remote_.pull<Vec3>(state.nodes.position(), position_);
  if (!spring) remote_.pull<Vec3>(state.nodes.velocity(), velocity_);
  std::size_t next = 0;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const Link& link = links_[i];
    const std::size_t a = next++, b = link.second >= 0 ? next++ : a;
    const Vec3 to = link.second >= 0 ? position_[b] : link.first_place;
    const Vec3 between = to - position_[a];
    const Vec3 start = (link.second >= 0 ? link.second_place : link.first_place) - link.first_place;
    const Vec3 rate = (link.second >= 0 ? velocity_[b] : Vec3{}) - velocity_[a];
    const Vec3 f = link_force(link, between, spring ? between - start : rate);
    for (const std::size_t end : {0u, 1u}) {
      const LocalIndex n = ends_[2 * i + end];
      for (std::size_t c = 0; n != no_index && c < 3; ++c)
        force[static_cast<std::size_t>(n)].v[c] += end == 0 ? f[c] : -f[c];
    }
  }
}

// Gershgorin on M^-1 K: a link between nodes adds its slope to the diagonal and beside it.
void ConnectorForce::add_bounds(std::span<double> row_sums) const {
  const double slope = greatest_slope(connector_);
  for (std::size_t i = 0; i < links_.size(); ++i)
    for (const std::size_t end : {0u, 1u}) {
      const LocalIndex n = ends_[2 * i + end];
      if (n != no_index) row_sums[static_cast<std::size_t>(n)] += (links_[i].second >= 0 ? 2 : 1) * slope;
    }
}

}  // namespace tenon
