// SPDX-License-Identifier: BSD-3-Clause
// Elements with longer steps than the shortest: when they are chosen, and groups for them.
#include <fmt/core.h>

#include <algorithm>
#include <limits>

#include "components/mechanics/element_kinds.hpp"
#include "components/mechanics/mechanics.hpp"

namespace tenon {

namespace {

/// Elements of a block of the mesh that have one level, and where they are in the block.
struct Part {
  ElementBlock block;
  std::vector<LocalIndex> elements;
};

Part part_of(const ElementBlock& whole, const std::vector<std::int32_t>& levels, int level) {
  Part part;
  part.block.name = whole.name, part.block.kind = whole.kind;
  part.block.global_count = whole.global_count, part.block.first_id = whole.first_id;
  for (LocalIndex e = 0; e < whole.size(); ++e) {
    const auto i = static_cast<std::size_t>(e);
    if (levels[i] != level) continue;
    part.elements.push_back(e);
    part.block.ids.push_back(whole.ids[i]);
    part.block.labels.push_back(whole.labels[i]);
    part.block.owners.push_back(whole.owners[i]);
    const std::span<const LocalIndex> nodes = whole.nodes(e);
    part.block.connectivity.insert(part.block.connectivity.end(), nodes.begin(), nodes.end());
  }
  return part;
}

/// What every element is and was, from where it stands to where it shall stand.
void move_state(GroupStates& states, const ElementGroups::Place& from, const ElementGroups::Place& to) {
  const std::vector<StateArray>& source = states.of(*from.group);
  const std::vector<StateArray>& target = states.of(*to.group);
  for (std::size_t a = 0; a < source.size(); ++a)
    for (int row = 0; row < source[a].rows; ++row) target[a].at(to.element, row) = source[a].at(from.element, row);
  value_of(to.group->mass, to.element) = value_of(from.group->mass, from.element);
}

}  // namespace

// After the step of the longest. Levels are chosen anew where elements of higher levels have come to set the shortest
// step, or the shortest step has become half of what it was; rarely, for it costs some tens of steps.
bool Mechanics::levels_are_due() const {
  constexpr std::int64_t least_steps = 20;
  if (steps_ - leveled_at_ < least_steps) return false;
  return estimate_ < 0.75 * shortest_ || shortest_ < 0.5 * leveled_shortest_;
}

void Mechanics::choose_levels() {
  int greatest = 0;
  while ((2 << greatest) <= options_.time_step.subcycling) ++greatest;
  const TimeStepOptions& options = options_.time_step;
  const LevelRules rules{short_step(shortest_), std::min(slow_share, options.scale),
                         options.maximum.value_or(std::numeric_limits<double>::infinity()), greatest};
  if (previous_dt_ > 0) former_force_ = nodes_.force, former_moment_ = nodes_.moment;
  split(find_levels(*mesh_, groups_, rules, stiff_nodes()));
  leveled_at_ = steps_, leveled_shortest_ = shortest_;
  forget_steps();
  compute_forces(0, 0);
  choose_step();
}

void Mechanics::split(const ElementLevels& levels) {
  std::deque<ElementBlock> parts;
  std::vector<std::unique_ptr<ElementGroup>> groups;
  std::vector<int> group_levels;
  ElementGroups::Places places(mesh_->blocks.size());
  owned_elements_.clear();
  GroupStates states;
  for (int level = 0;; ++level) {
    bool more = false;
    std::int64_t owned = 0;
    for (std::size_t b = 0; b < mesh_->blocks.size(); ++b) {
      const ElementBlock& whole = mesh_->blocks[b];
      places[b].resize(levels[b].size());
      const bool here = std::ranges::find(levels[b], level) != levels[b].end();
      more = more || std::ranges::any_of(levels[b], [&](int l) { return l > level; });
      if (!mesh_->comm.any(here)) continue;
      Part part = part_of(whole, levels[b], level);
      parts.push_back(std::move(part.block));
      owned += std::ranges::count(parts.back().owners, mesh_->comm.rank());
      const auto options = std::ranges::find(options_.blocks, whole.name, &MechanicsOptions::Block::name);
      const auto old = std::ranges::find_if(groups_, [&](const auto& group) { return group->block() == b; });
      std::unique_ptr<ElementGroup> group = make_element_group(b, parts.back(), mesh_->coordinates, *options, options_);
      group->rigid = (*old)->rigid, group->heating = (*old)->heating;
      group->steps.resize(group->mass.size());
      if (options_.heat == HeatMode::exported) group->heat_given.resize(group->mass.size());
      for (LocalIndex e = 0; e < group->size(); ++e) {
        const LocalIndex in_block = part.elements[static_cast<std::size_t>(e)];
        const ElementGroups::Place to{group.get(), e};
        move_state(states, groups_.place(b, in_block), to);
        places[b][static_cast<std::size_t>(in_block)] = to;
      }
      group->fill_padding();
      group->fill_padding_of(group->mass);
      groups.push_back(std::move(group)), group_levels.push_back(level);
    }
    owned_elements_.push_back(owned);
    if (!mesh_->comm.any(more)) break;
  }
  groups_.replace(std::move(groups), std::move(places));
  deaths_ = 0;
  parts_ = std::move(parts);
  levels_ = levels;
  const std::vector<int> busy = busy_nodes();
  subcycling_ = std::make_unique<Subcycling>(*mesh_, levels, std::move(group_levels), busy, nodes_);
}

std::vector<int> Mechanics::busy_nodes() const {
  std::vector<int> busy(nodes_.size());
  const auto mark = [&](const auto& nodes) {
    for (const LocalIndex n : nodes) busy[static_cast<std::size_t>(n)] = 1;
  };
  mark(conditions_.nodes());
  for (const Loads::Row& row : loads_->rows()) mark(row.nodes);
  mark(ties_->nodes()), mark(ties_->face_nodes());
  for (LocalIndex n = 0; n < mesh_->nodes() && !rigid_->empty(); ++n)
    if (rigid_->holds(n)) busy[static_cast<std::size_t>(n)] = 1;
  return busy;
}

// What couples them is as stiff as the shortest step allows: no long steps beside it.
std::vector<std::int32_t> Mechanics::stiff_nodes() const {
  std::vector<std::int32_t> stiff(nodes_.size());
  const auto mark = [&](const auto& nodes) {
    for (const LocalIndex n : nodes) stiff[static_cast<std::size_t>(n)] = 1;
  };
  mark(ties_->nodes()), mark(ties_->face_nodes());
  for (const Loads::Row& row : loads_->rows())
    if (row.name == "spring_energy" || (row.name == "damping_energy" && options_.loads.damping.mass == 0))
      mark(row.nodes);
  for (LocalIndex n = 0; n < mesh_->nodes() && !rigid_->empty(); ++n)
    if (rigid_->holds(n)) stiff[static_cast<std::size_t>(n)] = 1;
  mesh_->node_halo.forward<std::int32_t>(stiff, stiff);
  return stiff;
}

void Mechanics::report_levels() {
  std::vector<std::int64_t> counts = owned_elements_;
  mesh_->comm.sum(std::span<std::int64_t>(counts));
  double all = 0, done = 0;
  std::string list;
  for (std::size_t level = 0; level < counts.size(); ++level) {
    const auto count = static_cast<double>(counts[level]);
    all += count, done += count / static_cast<double>(1 << level);
    list += fmt::format("{}{} with {} {:.4g} s", level > 0 ? ", " : "", counts[level],
                        level > 0 ? fmt::format("{} x", 1 << level) : std::string("steps of"),
                        stable_step_ / short_steps());
  }
  warnings_.push_back(
      fmt::format("{}: subcycling: elements {}; {:.3g} % of the updates without", name(), list, 100 * done / all));
}

}  // namespace tenon
