// SPDX-License-Identifier: BSD-3-Clause
// Numbers nodes and elements in the order of the code's ids, hands each element to the ranks that own its nodes, and
// pulls the nodes. No rank ever holds more than its share and its part.
#include "framework/mesh/assemble.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <numeric>

#include "framework/mesh/distinct.hpp"
#include "framework/mesh/facets.hpp"
#include "framework/mesh/halo.hpp"
#include "framework/mesh/node_table.hpp"
#include "framework/mesh/ordered_homes.hpp"

namespace tenon {

namespace {

std::size_t nodes_of(ElementKind kind) {
  return static_cast<std::size_t>(topology(kind).nodes);
}

std::size_t elements_of(const BlockPart& block) {
  return block.connectivity.size() / nodes_of(block.kind);
}

[[noreturn]] void refuse(const std::string& source, int rank, const std::string& what) {
  throw Error(ExitCode::file, fmt::format("{}: rank {} gives {}", source, rank, what));
}

void check_block(const BlockPart& block, const std::string& source, int rank) {
  const std::size_t nodes = nodes_of(block.kind);
  if (block.connectivity.size() % nodes != 0)
    refuse(source, rank,
           fmt::format("block \"{}\" with {} entries of connectivity, which is no multiple of the {} "
                       "nodes of a {}",
                       block.name, block.connectivity.size(), nodes, topology(block.kind).name));
  if (!block.ids.empty() && block.ids.size() != elements_of(block))
    refuse(source, rank,
           fmt::format("block \"{}\" with {} elements but {} element ids; give an id for each or none", block.name,
                       elements_of(block), block.ids.size()));
}

/// What can be refused without the other ranks.
void check_part(const MeshPart& part, const std::string& source, int rank) {
  constexpr std::size_t most = std::numeric_limits<LocalIndex>::max();
  if (part.node_ids.size() != part.coordinates.size())
    refuse(source, rank,
           fmt::format("{} node ids but coordinates of {} nodes", part.node_ids.size(), part.coordinates.size()));
  std::size_t entries = part.node_ids.size();
  for (std::size_t b = 0; b < part.blocks.size(); ++b) {
    check_block(part.blocks[b], source, rank);
    entries = std::max(entries, part.blocks[b].connectivity.size());
    for (std::size_t c = 0; c < b; ++c)
      if (part.blocks[c].name == part.blocks[b].name)
        refuse(source, rank, fmt::format("block \"{}\" twice; give its elements together", part.blocks[b].name));
  }
  if (entries > most) refuse(source, rank, fmt::format("more than {} nodes or entries of connectivity", most));
  for (std::size_t n = 0; n < part.coordinates.size(); ++n) {
    const Vec3& x = part.coordinates[n];
    if (!std::isfinite(x[0]) || !std::isfinite(x[1]) || !std::isfinite(x[2]))
      refuse(source, rank,
             fmt::format("node {} at ({}, {}, {}): coordinates must be finite numbers", part.node_ids[n], x[0], x[1],
                         x[2]));
  }
}

/// A block as all ranks agree on it.
struct BlockType {
  std::uint8_t kind;
  bool with_ids, without_ids;  ///< whether any rank has elements of that sort
};
using BlockTypes = std::map<std::string, BlockType>;

void append(std::vector<char>& bytes, const std::string& name, const BlockType& type) {
  const auto length = static_cast<std::uint32_t>(name.size());
  const auto add = [&](const void* from, std::size_t size) {
    bytes.insert(bytes.end(), static_cast<const char*>(from), static_cast<const char*>(from) + size);
  };
  add(&length, sizeof length);
  add(&type, sizeof type);
  add(name.data(), name.size());
}

/// Joins what ranks have said; refuses contradictions.
BlockTypes joined(const std::vector<char>& bytes, const std::string& source) {
  BlockTypes types;
  for (std::size_t at = 0; at < bytes.size();) {
    std::uint32_t length = 0;
    BlockType type{};
    std::memcpy(&length, bytes.data() + at, sizeof length);
    std::memcpy(&type, bytes.data() + at + sizeof length, sizeof type);
    at += sizeof length + sizeof type;
    const std::string name(bytes.data() + at, length);
    at += length;
    const auto [known, added] = types.try_emplace(name, type);
    BlockType& all = known->second;
    if (all.kind != type.kind)
      throw Error(ExitCode::file,
                  fmt::format("{}: ranks give block \"{}\" as {} and as {}; name the elements of each kind differently",
                              source, name, topology(static_cast<ElementKind>(all.kind)).name,
                              topology(static_cast<ElementKind>(type.kind)).name));
    all.with_ids |= type.with_ids, all.without_ids |= type.without_ids;
    if (all.with_ids && all.without_ids)
      throw Error(ExitCode::file,
                  fmt::format("{}: some ranks give element ids for block \"{}\" and some do not", source, name));
  }
  return types;
}

/// Collective. The blocks of all ranks, by name.
BlockTypes agree_on_blocks(const Communicator& comm, const MeshPart& part, const std::string& source) {
  std::vector<char> mine;
  for (const BlockPart& b : part.blocks) {
    const bool any = !b.connectivity.empty();
    append(mine, b.name, {static_cast<std::uint8_t>(b.kind), any && !b.ids.empty(), any && b.ids.empty()});
  }
  std::vector<char> all = comm.gather(std::span<const char>(mine));
  comm.vote_on_root([&] {
    const BlockTypes types = joined(all, source);
    all.clear();
    for (const auto& [name, type] : types) append(all, name, type);
  });
  comm.broadcast(all);
  return joined(all, source);
}

/// Values of one block of this rank, with numbers of the mesh.
struct Numbered {
  std::vector<GlobalId> ids, connectivity;
  std::vector<std::int64_t> labels;
  std::vector<LocalIndex> given;      ///< place among the given elements of this rank
  std::span<const LocalIndex> nodes;  ///< connectivity by places among the used nodes
};

template <typename T>
void reorder(std::vector<T>& values, const std::vector<std::size_t>& order, std::size_t components = 1) {
  std::vector<T> moved(values.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(order[i] * components), components,
                moved.begin() + static_cast<std::ptrdiff_t>(i * components));
  values.swap(moved);
}

}  // namespace

/// The work of assemble(), in its phases; all collective.
class Assembly {
 public:
  Assembly(const Communicator& comm, const MeshPart& part, const AssembleOptions& options)
      : comm_(comm), part_(part), options_(options), mesh_(std::make_shared<Mesh>(comm)) {}

  AssembledMesh run() {
    comm_.vote([&] { check_part(part_, options_.source, comm_.rank()); });
    mesh_->source = options_.source;
    const BlockTypes types = agree_on_blocks(comm_, part_, options_.source);
    find_used_nodes();
    const NodeTable nodes(comm_, part_, used_, options_);
    refuse_unknown_nodes(nodes);
    for (const auto& [name, type] : types) add_block(name, type, nodes);
    take_nodes(nodes);
    connect(nodes);
    result_.mesh = mesh_;
    return std::move(result_);
  }

 private:
  void find_used_nodes() {
    std::vector<std::int64_t> entries;
    for (const BlockPart& b : part_.blocks) entries.insert(entries.end(), b.connectivity.begin(), b.connectivity.end());
    Distinct used = distinct(entries);
    used_ = std::move(used.values);
    entries_ = std::move(used.places);
  }

  std::string first_element_at(std::int64_t node) const {
    for (const BlockPart& b : part_.blocks)
      for (std::size_t i = 0; i < b.connectivity.size(); ++i)
        if (const std::size_t e = i / nodes_of(b.kind); b.connectivity[i] == node)
          return fmt::format(
              "node {}, in {} of block \"{}\" on rank {}", node,
              b.ids.empty() ? fmt::format("element number {}", e + 1) : fmt::format("element {}", b.ids[e]), b.name,
              comm_.rank());
    return {};
  }

  void refuse_unknown_nodes(const NodeTable& nodes) const {
    std::int64_t unknown = 0;
    std::string first;
    for (std::size_t i = 0; i < used_.size(); ++i)
      if (nodes.used()[i].id == no_id && unknown++ == 0) first = first_element_at(used_[i]);
    refuse_if_any(comm_, unknown, options_.source, "elements use nodes that no rank gives", first,
                  "Give each rank's elements with the ids and coordinates of all their nodes.");
  }

  /// This rank's elements of a block, numbered among those of all ranks.
  Numbered numbered(ElementBlock& block, bool with_ids, const NodeTable& nodes) {
    Numbered mine;
    LocalIndex given = 0;
    std::size_t first_entry = 0;
    const std::size_t width = nodes_of(block.kind);
    std::vector<std::int64_t> rows;
    for (const BlockPart& b : part_.blocks) {
      const auto count = static_cast<LocalIndex>(elements_of(b));
      if (b.name == block.name) {
        mine.given.resize(static_cast<std::size_t>(count));
        std::iota(mine.given.begin(), mine.given.end(), given);
        mine.nodes = std::span(entries_).subspan(first_entry, b.connectivity.size());
        mine.connectivity.reserve(mine.nodes.size());
        for (const LocalIndex n : mine.nodes) mine.connectivity.push_back(nodes.used()[static_cast<std::size_t>(n)].id);
        const std::span<const std::int64_t> keys = with_ids ? b.ids : b.connectivity;
        rows.assign(keys.begin(), keys.end());
        if (with_ids) mine.labels = rows;
      }
      given += count;
      first_entry += b.connectivity.size();
    }
    if (!with_ids)
      for (std::size_t i = 0; i < rows.size(); i += width) sort_few(std::span(rows).subspan(i, width));
    RowNumbers numbers = number_rows(comm_, rows, with_ids ? 1 : width, options_.source + " set-up");
    refuse_repeated(block, numbers, with_ids);
    block.first_id = mesh_->global_elements;
    block.global_count = numbers.count;
    mine.ids = std::move(numbers.numbers);
    for (GlobalId& id : mine.ids) id += block.first_id;
    if (!with_ids)
      for (const GlobalId id : mine.ids) mine.labels.push_back(id + 1);
    return mine;
  }

  void refuse_repeated(const ElementBlock& block, const RowNumbers& numbers, bool with_ids) const {
    if (numbers.repeated == 0) return;
    const std::string list = fmt::format("{}", fmt::join(numbers.first_repeated, ", "));
    throw Error(ExitCode::file,
                fmt::format("{}: {} elements of block \"{}\" are given more than once, the first {} {}\nGive every "
                            "element on the one rank that owns it{}.",
                            options_.source, numbers.repeated, block.name, with_ids ? "with id" : "with nodes", list,
                            with_ids ? "" : ", or element ids to elements with the same nodes"));
  }

  /// Sends the elements of a block to their owner and to the owners of their nodes.
  void add_block(const std::string& name, const BlockType& type, const NodeTable& nodes) {
    ElementBlock block;
    block.name = name, block.kind = static_cast<ElementKind>(type.kind);
    const Numbered mine = numbered(block, type.with_ids, nodes);
    const std::size_t width = nodes_of(block.kind);
    std::vector<int> rank;
    std::vector<LocalIndex> element;
    rank.reserve(mine.ids.size());
    element.reserve(mine.ids.size());
    for (std::size_t e = 0; e < mine.ids.size(); ++e) {
      const std::size_t begin = rank.size();
      rank.push_back(comm_.rank());
      for (const LocalIndex n : mine.nodes.subspan(e * width, width)) {
        const int owner = nodes.used()[static_cast<std::size_t>(n)].owner;
        if (std::find(rank.begin() + static_cast<std::ptrdiff_t>(begin), rank.end(), owner) == rank.end())
          rank.push_back(owner);
      }
      element.resize(rank.size(), static_cast<LocalIndex>(e));
    }
    const ExchangePlan plan = ExchangePlan::to_ranks(comm_, rank, element, options_.source + " set-up");
    receive(block, mine, plan);
    mesh_->global_elements += block.global_count;
    mesh_->blocks.push_back(std::move(block));
  }

  void receive(ElementBlock& block, const Numbered& mine, const ExchangePlan& plan) {
    const std::size_t width = nodes_of(block.kind);
    const auto count = static_cast<std::size_t>(plan.received());
    block.ids.resize(count);
    block.labels.resize(count);
    std::vector<LocalIndex> given(count);
    std::vector<GlobalId> connectivity(count * width);
    const auto item = [](const auto& from, auto& to, std::size_t components) -> ExchangeItem {
      return {reinterpret_cast<const std::byte*>(from.data()), reinterpret_cast<std::byte*>(to.data()),
              components * sizeof(from[0])};
    };
    const std::array<ExchangeItem, 4> arrays{item(mine.ids, block.ids, 1), item(mine.labels, block.labels, 1),
                                             item(mine.given, given, 1), item(mine.connectivity, connectivity, width)};
    plan.forward(arrays);
    block.owners = plan.received_from();
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return block.ids[a] < block.ids[b]; });
    reorder(block.ids, order);
    reorder(block.labels, order);
    reorder(block.owners, order);
    reorder(given, order);
    reorder(connectivity, order, width);
    connectivity_.push_back(std::move(connectivity));
    giver_ranks_.insert(giver_ranks_.end(), block.owners.begin(), block.owners.end());
    giver_places_.insert(giver_places_.end(), given.begin(), given.end());
  }

  /// Nodes of the local elements, and those without elements that this rank owns.
  void take_nodes(const NodeTable& nodes) {
    std::vector<GlobalId> entries;
    for (const std::vector<GlobalId>& c : connectivity_) entries.insert(entries.end(), c.begin(), c.end());
    for (const NodeAnswer& n : nodes.given())
      if (n.owner == comm_.rank()) entries.push_back(n.id);
    Distinct local = distinct(entries);
    mesh_->node_ids = std::move(local.values);
    mesh_->global_nodes = nodes.count();
    auto next = local.places.begin();
    for (std::size_t b = 0; b < mesh_->blocks.size(); ++b) {
      const auto end = next + static_cast<std::ptrdiff_t>(connectivity_[b].size());
      mesh_->blocks[b].connectivity.assign(next, end);
      next = end;
    }
    connectivity_.clear();
  }

  /// The ways between given and local order, and the halo.
  void connect(const NodeTable& nodes) {
    const std::string& name = options_.source;
    const NodeTable::Givers givers = nodes.pull(*mesh_, name + " set-up");
    connect_halo(*mesh_, name);
    std::vector<LocalIndex> all(mesh_->node_ids.size());
    std::iota(all.begin(), all.end(), 0);
    result_.nodes_to_mesh_ = ExchangePlan::from_owners(comm_, givers.ranks, givers.places, all, name + " to mesh");

    std::vector<int> owners;
    std::vector<GlobalId> ids;
    for (const NodeAnswer& n : nodes.given()) owners.push_back(n.owner), ids.push_back(n.id);
    const std::vector<LocalIndex> places = places_at_owners(comm_, owners, ids, mesh_->node_ids, name);
    all.resize(ids.size());
    std::iota(all.begin(), all.end(), 0);
    result_.nodes_from_mesh_ = ExchangePlan::from_owners(comm_, owners, places, all, name + " from mesh");
    result_.given_nodes_ = ids.size();

    all.resize(giver_ranks_.size());
    std::iota(all.begin(), all.end(), 0);
    result_.elements_to_mesh_ = ExchangePlan::from_owners(comm_, giver_ranks_, giver_places_, all, name + " to mesh");
    std::size_t given = 0;
    for (const BlockPart& b : part_.blocks) given += elements_of(b);
    result_.element_places_.resize(given);
    for (std::size_t e = 0; e < giver_ranks_.size(); ++e)
      if (giver_ranks_[e] == comm_.rank())
        result_.element_places_[static_cast<std::size_t>(giver_places_[e])] = static_cast<LocalIndex>(e);
  }

  const Communicator& comm_;
  const MeshPart& part_;
  const AssembleOptions& options_;
  std::shared_ptr<Mesh> mesh_;
  AssembledMesh result_;
  std::vector<LocalIndex> entries_;                  // connectivity of given elements, by places in used_
  std::vector<std::int64_t> used_;                   // ids of the nodes of given elements, ascending
  std::vector<std::vector<GlobalId>> connectivity_;  // of local elements by block, until nodes have places
  std::vector<int> giver_ranks_;                     // of local elements of all blocks
  std::vector<LocalIndex> giver_places_;
};

AssembledMesh assemble(const Communicator& comm, const MeshPart& part, const AssembleOptions& options) {
  return Assembly(comm, part, options).run();
}

}  // namespace tenon
