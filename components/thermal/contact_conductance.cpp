// SPDX-License-Identifier: BSD-3-Clause
#include "components/thermal/contact_conductance.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "components/thermal/element_conduction.hpp"

namespace tenon::thermal {
namespace {

const SideSet& side_set(const Mesh& mesh, const std::string& name) {
  const SideSet* set = mesh.find_side_set(name);
  if (!set)
    throw Error(ExitCode::usage, fmt::format("heat conduction, contact_conductance: the mesh {} has no side set '{}'",
                                             mesh.source, name));
  return *set;
}

/// Mean area of the sides, m^2. Collective.
double mean_area(const Mesh& mesh, const SideSet& set) {
  ExactSum area;
  std::array<Vec3, max_side_nodes> place{};
  std::array<double, max_side_nodes> of_corner{};
  for (const Side& side : set.sides) {
    const ElementBlock& block = mesh.blocks[static_cast<std::size_t>(side.block)];
    if (block.owners[static_cast<std::size_t>(side.element)] != mesh.comm.rank()) continue;
    const SideCorners corners = side_corners(mesh, side);
    for (std::size_t a = 0; a < corners.count; ++a)
      place[a] = mesh.coordinates[static_cast<std::size_t>(corners.nodes[a])];
    const auto mine = std::span(of_corner).first(corners.count);
    nodal_areas(std::span<const Vec3>(place).first(corners.count), mine);
    area.add(std::span<const double>(mine));
  }
  const double all = mesh.comm.sum(area);
  return set.global_count > 0 ? all / static_cast<double>(set.global_count) : 0;
}

}  // namespace

double conductance(const ThermalContact& c, double time, double gap, bool touches, double pressure, bool pressed) {
  double sum = 0;
  if (c.over_pressure) {
    if (touches) sum = (*c.over_pressure)(pressed ? pressure : 0.0);
  } else if (touches) {
    sum = c.conductance(time);
    if (c.reference_pressure && pressed) sum *= std::pow(std::max(pressure, 0.0) / *c.reference_pressure, c.exponent);
  }
  if (c.gap_conductivity > 0 && gap <= c.greatest_gap) sum += c.gap_conductivity / std::max(gap, c.least_gap);
  return sum;
}

ContactConductance::ContactConductance(const Mesh& mesh, std::vector<ThermalContact> contacts)
    : mesh_(mesh), contacts_(std::move(contacts)), owners_([&mesh] {
        std::vector<GlobalId> ids;
        for (const LocalIndex n : mesh.owned_nodes) ids.push_back(mesh.node_ids[static_cast<std::size_t>(n)]);
        return Directory(mesh.comm, ids, mesh.owned_nodes);
      }()) {
  for (const ThermalContact& contact : contacts_) pairs_.push_back(make_pair(contact));
}

// The finer surface carries the integration points and its nodes the conductances; of two alike, the second.
ContactConductance::Pair ContactConductance::make_pair(const ThermalContact& contact) const {
  const SideSet &first = side_set(mesh_, contact.first), &second = side_set(mesh_, contact.second);
  const auto number = [](const Side& s) { return std::array{s.block, s.element, static_cast<LocalIndex>(s.side)}; };
  std::set<std::array<LocalIndex, 3>> of_first;
  for (const Side& side : first.sides) of_first.insert(number(side));
  const bool shared =
      std::ranges::any_of(second.sides, [&](const Side& side) { return of_first.contains(number(side)); });
  if (mesh_.comm.any(shared))
    throw Error(ExitCode::usage,
                fmt::format("heat conduction, contact_conductance: the side sets '{}' and '{}' have sides in common; "
                            "expected two surfaces",
                            contact.first, contact.second));
  const bool first_is_finer = mean_area(mesh_, first) < mean_area(mesh_, second);
  return {first_is_finer ? &first : &second, first_is_finer ? &second : &first, first_is_finer,
          contact.touching_gap.value_or(0.0)};
}

bool ContactConductance::varies() const {
  return needs_pressure() ||
         std::ranges::any_of(contacts_, [](const ThermalContact& c) { return !c.conductance.is_constant(); });
}

bool ContactConductance::needs_pressure() const {
  return std::ranges::any_of(contacts_,
                             [](const ThermalContact& c) { return c.over_pressure || c.reference_pressure; });
}

void ContactConductance::weigh(double time, std::span<const double> pressure) {
  const auto at = [&](const std::array<LocalIndex, max_side_nodes>& nodes, const auto& shape, int count) {
    double sum = 0;
    for (std::size_t a = 0; a < static_cast<std::size_t>(count); ++a)
      sum += shape[a] * pressure[static_cast<std::size_t>(nodes[a])];
    return sum;
  };
  const bool pressed = !pressure.empty();
  point_conductance_.resize(points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Point& p = points_[i];
    double mine = 0;
    if (p.opposite.count > 0 && pressed)  // one of the surfaces may know nothing of it
      mine = std::max(at(p.own, p.shape, p.own[3] == no_index ? 3 : 4),
                      at(p.across, p.opposite.weights, p.opposite.count));
    point_conductance_[i] =
        p.opposite.count > 0 ? conductance(contacts_[p.contact], time, p.opposite.gap, p.touches, mine, pressed) : 0;
  }
  weight_.resize(patches_.patch.size());
  for (std::size_t b = 0; b < owned_patches_; ++b) {
    double sum = 0;
    for (std::size_t s = first_share_[b]; s < first_share_[b + 1]; ++s)
      sum += shares_[s].area * point_conductance_[shares_[s].point];
    weight_[b] = sum;
  }
  plan_.forward(std::span<const double>(weight_), std::span(weight_).subspan(owned_patches_));
}

template <typename Use>
void ContactConductance::each_link(const Use& use) const {
  for (const std::size_t b : order_) {
    std::size_t place = first_place_[b];
    for (std::size_t i = first_entry_[b]; i < first_entry_[b + 1]; ++i)
      for (std::size_t j = first_entry_[b]; j < first_entry_[b + 1]; ++j) {
        if (i == j) continue;
        const double product = coefficient_[i] * coefficient_[j];
        use(column_[i], places_[place++], weight_[b] * product);
      }
  }
}

void ContactConductance::add_to(ConductionMatrix& matrix) const {
  each_link([&matrix](LocalIndex, LocalIndex place, double value) {
    if (place != no_index) matrix.add_at(place, value);
  });
}

double ContactConductance::greatest_eigenvalue(std::span<const double> capacity, const ConductionMatrix& matrix) const {
  row_size_.assign(capacity.size(), 0.0);
  each_link([&](LocalIndex node, LocalIndex place, double value) {
    if (place == no_index) return;
    const auto row = static_cast<std::size_t>(matrix.row_of_node()[static_cast<std::size_t>(node)]);
    row_size_[row] += std::abs(value) - value;  // the diagonal is minus the sum of the rest
  });
  double greatest = 0;
  for (std::size_t k = 0; k < capacity.size(); ++k)
    if (capacity[k] > 0) greatest = std::max(greatest, row_size_[k] / capacity[k]);
  return greatest;
}

/// Heat that leaves a node b for the nodes across, W.
double ContactConductance::out_of_finer(std::size_t b, std::span<const double> temperature) const {
  double jump = 0;
  for (std::size_t i = first_entry_[b]; i < first_entry_[b + 1]; ++i)
    jump += coefficient_[i] * temperature[static_cast<std::size_t>(column_[i])];
  return weight_[b] * jump;
}

double ContactConductance::power(std::size_t contact, std::span<const double> temperature) const {
  ExactSum local;
  for (std::size_t b = 0; b < owned_patches_; ++b)
    if (patches_.patch[b].contact == static_cast<std::int64_t>(contact)) local.add(out_of_finer(b, temperature));
  const double sum = mesh_.comm.sum(local);
  return pairs_[contact].first_is_finer ? sum : -sum;
}

void ContactConductance::add_passed(double time, std::span<const double> temperature, const ConductionMatrix& matrix,
                                    std::span<double> heat) const {
  for (std::size_t b = 0; b < owned_patches_; ++b) {
    const bool out_of_first = pairs_[static_cast<std::size_t>(patches_.patch[b].contact)].first_is_finer;
    const auto row = static_cast<std::size_t>(matrix.row_of_node()[static_cast<std::size_t>(node_[b])]);
    heat[row] += (out_of_first ? time : -time) * out_of_finer(b, temperature);
  }
}

ContactPatch ContactConductance::patch(std::size_t p) const {
  const std::size_t first = first_entry_[p], count = first_entry_[p + 1] - first;
  return {node_[p], std::span(column_).subspan(first, count), std::span(coefficient_).subspan(first, count),
          weight_[p]};
}

std::int64_t ContactConductance::memory() const {
  const auto bytes = [](const auto& v) {
    return static_cast<std::int64_t>(v.capacity() * sizeof(typename std::decay_t<decltype(v)>::value_type));
  };
  return bytes(points_) + bytes(patches_.patch) + bytes(patches_.counts) + bytes(patches_.entries) + bytes(shares_) +
         bytes(weight_) + bytes(column_) + bytes(coefficient_) + bytes(places_) + bytes(pattern_);
}

}  // namespace tenon::thermal
