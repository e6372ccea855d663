// SPDX-License-Identifier: BSD-3-Clause
#include "framework/mesh/node_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "framework/mesh/distinct.hpp"
#include "framework/mesh/halo.hpp"
#include "framework/mesh/ordered_homes.hpp"

namespace tenon {

namespace {

template <typename T, typename U>
ExchangeItem travelling(const T& from, U& to) {
  return {reinterpret_cast<const std::byte*>(from.data()), reinterpret_cast<std::byte*>(to.data()),
          sizeof(typename U::value_type)};
}

/// Adding 0 makes the two zeros one.
Vec3 one_zero(const Vec3& x) {
  return {x[0] + 0.0, x[1] + 0.0, x[2] + 0.0};
}

}  // namespace

void refuse_if_any(const Communicator& comm, std::int64_t problems, const std::string& source, const std::string& what,
                   const std::string& first, const std::string& advice) {
  const std::int64_t all = comm.sum(problems);
  if (all == 0) return;
  const std::string more = all > 1 ? fmt::format("\n  and {} more", all - 1) : "";
  comm.throw_if_any(problems == 0
                        ? std::optional<Error>()
                        : Error(ExitCode::file, fmt::format("{}: {}:\n  {}{}\n{}", source, what, first, more, advice)));
}

NodeTable::NodeTable(const Communicator& comm, const MeshPart& part, std::span<const std::int64_t> used,
                     const AssembleOptions& options)
    : comm_(comm) {
  const OrderedHomes homes(comm, part.node_ids);
  const std::string name = options.source + " set-up";
  const ExchangePlan gifts = ExchangePlan::to_ranks(comm, homes.homes(part.node_ids), name);
  take_given(gifts, part, options);

  const ExchangePlan question = ExchangePlan::to_ranks(comm, homes.homes(used), name);
  std::vector<std::int64_t> asked(static_cast<std::size_t>(question.received()));
  question.forward(used, std::span(asked));
  choose_owners(asked, question.received_from());

  const auto answers = [&](const ExchangePlan& plan, const std::vector<std::int64_t>& labels, std::size_t count) {
    std::vector<NodeAnswer> answer(labels.size()), arrived(count);
    for (std::size_t i = 0; i < labels.size(); ++i) {
      const auto found = std::lower_bound(labels_.begin(), labels_.end(), labels[i]);
      if (found == labels_.end() || *found != labels[i]) continue;
      const auto place = static_cast<std::size_t>(found - labels_.begin());
      answer[i] = {first_ + static_cast<GlobalId>(place), owners_[place]};
    }
    plan.reverse(std::span<const NodeAnswer>(answer), std::span(arrived));
    return arrived;
  };
  used_ = answers(question, asked, used.size());
  std::vector<std::int64_t> offered(static_cast<std::size_t>(gifts.received()));
  gifts.forward(part.node_ids, std::span(offered));
  given_ = answers(gifts, offered, part.node_ids.size());
}

void NodeTable::take_given(const ExchangePlan& plan, const MeshPart& part, const AssembleOptions& options) {
  const auto count = static_cast<std::size_t>(plan.received());
  std::vector<std::int64_t> labels(count);
  std::vector<Vec3> places(count);
  std::vector<LocalIndex> mine(part.node_ids.size()), index(count);
  std::iota(mine.begin(), mine.end(), 0);
  const std::array<ExchangeItem, 3> arrays{travelling(part.node_ids, labels), travelling(part.coordinates, places),
                                           travelling(mine, index)};
  plan.forward(arrays);
  const std::vector<int> from = plan.received_from();

  std::int64_t conflicts = 0;
  std::string first;
  const std::vector<std::size_t> order = sorted_positions(labels);
  for (std::size_t begin = 0, end = 0; begin < count; begin = end) {
    const std::int64_t label = labels[order[begin]];
    Vec3 least = one_zero(places[order[begin]]), farthest = least;
    for (; end < count && labels[order[end]] == label; ++end) least = std::min(least, one_zero(places[order[end]]));
    for (std::size_t k = begin; k < end; ++k)
      if (norm(places[order[k]] - least) > norm(farthest - least)) farthest = places[order[k]];
    if (norm(farthest - least) > options.coordinate_tolerance && conflicts++ == 0)
      first = fmt::format("node {} at ({}, {}, {}) and at ({}, {}, {}) m", label, least[0], least[1], least[2],
                          farthest[0], farthest[1], farthest[2]);
    labels_.push_back(label);
    coordinates_.push_back(least);
    givers_.ranks.push_back(from[order[begin]]);
    givers_.places.push_back(index[order[begin]]);
  }
  refuse_if_any(comm_, conflicts, options.source, "ranks give the same node at different places", first,
                "Give every copy of a node the same coordinates, or allow for round-off with "
                "AssembleOptions::coordinate_tolerance.");
  const auto share = static_cast<std::int64_t>(labels_.size());
  first_ = comm_.exclusive_scan(share);
  count_ = comm_.sum(share);
  firsts_ = comm_.all_gather(first_);
}

void NodeTable::choose_owners(const std::vector<std::int64_t>& labels, const std::vector<int>& ranks) {
  owners_ = givers_.ranks;
  const std::vector<std::size_t> order = sorted_positions(labels);  // ranks ascend for each node
  std::vector<int> users;
  auto place = labels_.begin();
  for (std::size_t i = 0; i < order.size(); ++i) {
    users.push_back(ranks[order[i]]);
    const std::int64_t label = labels[order[i]];
    if (i + 1 < order.size() && labels[order[i + 1]] == label) continue;
    place = std::lower_bound(place, labels_.end(), label);
    if (place != labels_.end() && *place == label) {
      const auto n = place - labels_.begin();
      owners_[static_cast<std::size_t>(n)] = node_owner(first_ + n, users);
    }
    users.clear();
  }
}

NodeTable::Givers NodeTable::pull(Mesh& mesh, const std::string& name) const {
  const std::size_t count = mesh.node_ids.size();
  std::vector<int> home(count);
  std::vector<LocalIndex> index(count), into(count);
  std::iota(into.begin(), into.end(), 0);
  for (std::size_t n = 0; n < count; ++n) {
    // Of equal firsts the last has nodes.
    const auto next = std::upper_bound(firsts_.begin(), firsts_.end(), mesh.node_ids[n]);
    home[n] = static_cast<int>(next - firsts_.begin()) - 1;
    index[n] = static_cast<LocalIndex>(mesh.node_ids[n] - *(next - 1));
  }
  const ExchangePlan plan = ExchangePlan::from_owners(comm_, home, index, into, name);
  Givers givers{std::vector<int>(count), std::vector<LocalIndex>(count)};
  mesh.node_labels.resize(count);
  mesh.node_owners.resize(count);
  mesh.coordinates.resize(count);
  const std::array<ExchangeItem, 5> arrays{travelling(labels_, mesh.node_labels), travelling(owners_, mesh.node_owners),
                                           travelling(coordinates_, mesh.coordinates),
                                           travelling(givers_.ranks, givers.ranks),
                                           travelling(givers_.places, givers.places)};
  plan.forward(arrays);
  return givers;
}

}  // namespace tenon
