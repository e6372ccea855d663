// SPDX-License-Identifier: BSD-3-Clause
// What contact tells: fields of the nodes, rows of the ledger, columns of the history, the end of the log.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "components/contact/contact.hpp"

namespace tenon {

using namespace contact;

namespace {

constexpr double near = 1, slipping = 2, sticking = 3;

ExactSum negative(const ExactSum& sum) {
  std::array<std::int64_t, ExactSum::digits + 1> words = sum.words();
  for (std::size_t k = 0; k + 1 < words.size(); ++k) words[k] = -words[k];
  return ExactSum::from_words(words);
}

}  // namespace

/// Share of the heat of friction that goes to the first side: by the effusivities, half where they are not known.
double Contact::first_share(const WorkingPair& pair) const {
  const auto blocks = static_cast<std::int32_t>(surfaces_.names().size());
  if (pair.second_surface >= blocks) return 0.5;
  const double a = surfaces_.effusivity(pair.first_surface), b = surfaces_.effusivity(pair.second_surface);
  return a > 0 && b > 0 ? a / (a + b) : 0.5;
}

/// Of a node of the set, in the order of its constraints.
Contact::NodeResult Contact::result_of(std::size_t node, double kick) const {
  NodeResult result;
  bool any = false;
  double pressing = 0;
  enforcement_.for_constraints_of(node, [&](std::size_t k, std::size_t slot) {
    const Constraint& q = constraints_[k];
    const Vec3 force = (1 / kick) * share(q, slot, q.impulse);
    const double pressed = dot(q.impulse, q.normal);
    result.force = result.force + force;
    pressing += std::abs(dot(force, q.normal));
    result.gap = any ? std::min(result.gap, q.gap) : q.gap;
    any = true;
    const bool slips = q.static_coefficient > 0 && !q.sticks;
    result.status = std::max(result.status, pressed > 0 ? (slips ? slipping : sticking) : near);
    const double coefficient = std::abs(q.c[slot]);
    result.slip = result.slip + (q.c[slot] > 0 ? coefficient : -coefficient) * slid_[k];
    const double first = first_share(set_.pairs()[static_cast<std::size_t>(q.pair)]);
    result.heat += (q.c[slot] > 0 ? first : 1 - first) * coefficient * heat_[k];
  });
  result.pressure = pressing;
  return result;
}

// Of the nodes that were filled in the step before, those that nothing holds any more are free again.
void Contact::fill_fields(double kick) {
  clear_fields();
  if (any_constraint_) {
    results_.assign(state_.size(), NodeResult{});
    for (std::size_t n = 0; n < state_.size(); ++n)
      if (set_.sums(static_cast<LocalIndex>(n))) results_[n] = result_of(n, kick);
    home_results_.assign(set_.busy().size(), NodeResult{});
    set_.results().reverse<NodeResult>(results_, home_results_);
    for (std::size_t b = 0; b < home_results_.size(); ++b) {
      const SurfaceNode& node = surfaces_.nodes()[static_cast<std::size_t>(set_.busy()[b])];
      const auto n = static_cast<std::size_t>(node.node);
      ContactFields& fields = parties_[static_cast<std::size_t>(node.party)]->contact_fields();
      const NodeResult& result = home_results_[b];
      if (result.status == 0) continue;
      fields.force[n] = result.force;
      fields.gap[n] = result.gap;
      fields.status[n] = result.status;
      fields.pressure[n] = node.area > 0 ? result.pressure / node.area : 0;
      fields.slip[n] = result.status >= slipping ? fields.slip[n] + result.slip : Vec3{};
      fields.friction_heat[n] += result.heat;
      filled_.push_back({node.party, node.node});
    }
  }
  for (const Filled& node : formerly_filled_) {
    ContactFields& fields = parties_[static_cast<std::size_t>(node.party)]->contact_fields();
    const auto n = static_cast<std::size_t>(node.node);
    if (fields.status[n] == 0) fields.slip[n] = {};
  }
}

// What accumulates stays: the heat until it is taken, the slip while a node goes on touching.
void Contact::clear_fields() {
  std::swap(filled_, formerly_filled_);
  filled_.clear();
  for (const Filled& node : formerly_filled_) {
    ContactFields& fields = parties_[static_cast<std::size_t>(node.party)]->contact_fields();
    const auto n = static_cast<std::size_t>(node.node);
    fields.force[n] = {};
    fields.gap[n] = std::numeric_limits<double>::infinity();
    fields.status[n] = fields.pressure[n] = 0;
  }
}

// Supplied: minus what the parties' nodes were given, and what drives rigid surfaces. Stored: what impacts have taken
// and releases will give back, heat of friction, and what neither explains.
void Contact::energies(std::vector<EnergyTerm>& terms) {
  using Role = EnergyTerm::Role;
  EnergyTerm stored{"contact_energy", Role::stored, {}}, friction{"friction_energy", Role::stored, friction_};
  EnergyTerm lost{"contact_dissipation", Role::stored, dissipated_};
  EnergyTerm given{"contact_work_of_bodies", Role::supplied, {}};
  for (const WorkingPair& pair : set_.pairs())
    if (pair.primary) stored.local.add(pair.memory.energy);
  for (const ContactParty* party : parties_) given.local.add(negative(party->contact_work()));
  terms.push_back(std::move(stored)), terms.push_back(std::move(friction)), terms.push_back(std::move(lost));
  terms.push_back(std::move(given));
  if (rigid_.empty()) return;
  EnergyTerm kinetic{"rigid_surface_energy", Role::stored, {}};
  for (const MovingSurface& surface : rigid_)
    if (comm_.rank() == 0) kinetic.local.add(surface.kinetic_energy());
  terms.push_back(std::move(kinetic));
  terms.push_back({"rigid_surface_work", Role::supplied, rigid_work_});
}

std::vector<std::pair<std::string, ExactSum>> Contact::amounts() {
  std::vector<std::pair<std::string, ExactSum>> all;
  ExactSum active;
  active.add(static_cast<double>(active_));
  all.emplace_back("contact_pairs", active);
  for (const PairTotals& total : totals_) {
    const std::string prefix = fmt::format("contact_{}_{}_", surface_name(total.first), surface_name(total.second));
    for (std::size_t c = 0; c < 3; ++c) all.emplace_back(prefix + "force_" + "xyz"[c], total.force[c]);
    for (std::size_t c = 0; c < 3; ++c) all.emplace_back(prefix + "impulse_" + "xyz"[c], total.impulse[c]);
    all.emplace_back(prefix + "friction_work", total.friction_work);
  }
  return all;
}

std::vector<HistoryValue> Contact::history_values() {
  double deepest = 0;
  for (const Constraint& q : constraints_)
    if (any_constraint_) deepest = std::min(deepest, q.gap);
  return {{"contact_least_gap", HistoryValue::Reduce::min, deepest}};
}

std::vector<SkipCount> Contact::skips() const {
  return {{"contact searches (skins not used up)", std::max<std::int64_t>(0, steps_ - searches_)},
          {"contact impulses (nothing touches)", idle_steps_}};
}

std::array<double, 2> Contact::momentum_errors() const {
  std::array<ExactSum, 8> sums;
  double reach = 0;
  Vec3 origin{};
  if (any_constraint_) {
    for (std::size_t b = 0; b < home_impulse_.size(); ++b) {
      const Vec3 &p = home_impulse_[b], &x = home_state_[b].place;
      const Vec3 moment = cross(x, p);
      for (std::size_t c = 0; c < 3; ++c) sums[c].add(p[c]), sums[3 + c].add(moment[c]);
      sums[6].add(norm(p));
      sums[7].add(norm(x - origin) * norm(p));
      reach = std::max(reach, norm(x));
    }
    for (const Constraint& q : constraints_) {  // what rigid surfaces take
      const WorkingPair& pair = set_.pairs()[static_cast<std::size_t>(q.pair)];
      if (pair.key.kind != 1 || !pair.primary) continue;
      const Vec3 moment = cross(state_[static_cast<std::size_t>(q.node[0])].place, q.impulse);
      for (std::size_t c = 0; c < 3; ++c) sums[c].add(-q.impulse[c]), sums[3 + c].add(-moment[c]);
    }
  }
  std::array<double, 8> total{};
  comm_.sum(sums, total);
  if (!(total[6] > 0)) return {0, 0};
  return {norm({total[0], total[1], total[2]}) / total[6], norm({total[3], total[4], total[5]}) / total[7]};
}

std::vector<std::string> Contact::report() {
  std::vector<std::string> lines;
  const std::int64_t nodes = comm_.sum(static_cast<std::int64_t>(surfaces_.nodes().size()));
  const std::int64_t faces = comm_.sum(static_cast<std::int64_t>(surfaces_.faces().size()));
  lines.push_back(fmt::format("{} faces with {} nodes; {} searches in {} steps; {} steps in which nothing touched",
                              faces, nodes, searches_, steps_, idle_steps_));
  const std::int64_t busy = steps_ - idle_steps_;
  if (busy > 0)
    lines.push_back(fmt::format("{:.1f} iterations a step while something touched",
                                static_cast<double>(iterations_total_) / static_cast<double>(busy)));
  if (comm_.size() > 1) {
    const auto ratio = [&](std::int64_t mine) {
      const auto sum = static_cast<double>(comm_.sum(mine));
      return sum > 0 ? static_cast<double>(comm_.max(mine)) * comm_.size() / sum : 1.0;
    };
    const double search = ratio(search_work_), enforcement = ratio(enforcement_work_);
    lines.push_back(
        fmt::format("greatest over mean work of the ranks: search {:.2f}, enforcement {:.2f}", search, enforcement));
  }
  return lines;
}

std::int64_t Contact::memory() const {
  return surfaces_.memory() + search_.memory() + set_.memory() +
         static_cast<std::int64_t>(constraints_.capacity() * sizeof(Constraint) +
                                   state_.capacity() * sizeof(NodeState));
}

}  // namespace tenon
