// SPDX-License-Identifier: BSD-3-Clause
#include "components/thermal/conduction_matrix.hpp"

#include <algorithm>
#include <numeric>

namespace tenon::thermal {
namespace {

/// Nodes that share an element with each row's node, in any order and repeated, without the node itself.
std::vector<std::vector<LocalIndex>> neighbours(const Mesh& mesh, const std::vector<LocalIndex>& row_of_node) {
  std::vector<std::vector<LocalIndex>> of_row(mesh.owned_nodes.size());
  for (const ElementBlock& block : mesh.blocks)
    for (LocalIndex e = 0; e < block.size(); ++e)
      for (const LocalIndex i : block.nodes(e)) {
        const LocalIndex row = row_of_node[static_cast<std::size_t>(i)];
        if (row == no_index) continue;
        std::vector<LocalIndex>& list = of_row[static_cast<std::size_t>(row)];
        for (const LocalIndex j : block.nodes(e))
          if (j != i) list.push_back(j);
      }
  return of_row;
}

}  // namespace

ConductionMatrix::ConductionMatrix(const Mesh& mesh, std::vector<Conductivity> conductivity_of_block)
    : mesh_(mesh), conductivity_(std::move(conductivity_of_block)) {
  for (const ElementBlock& block : mesh.blocks) tables_.emplace_back(block.kind);
  row_of_node_.assign(static_cast<std::size_t>(mesh.nodes()), no_index);
  for (std::size_t r = 0; r < mesh.owned_nodes.size(); ++r)
    row_of_node_[static_cast<std::size_t>(mesh.owned_nodes[r])] = static_cast<LocalIndex>(r);
  halo_ = mesh.node_halo;
  make_pattern({});
  place_elements();
}

GlobalId ConductionMatrix::id_of(LocalIndex column) const {
  const auto c = static_cast<std::size_t>(column), nodes = mesh_.node_ids.size();
  return c < nodes ? mesh_.node_ids[c] : beyond_[c - nodes];
}

void ConductionMatrix::make_pattern(std::span<const ExtraEntry> extra) {
  std::vector<std::vector<LocalIndex>> of_row = neighbours(mesh_, row_of_node_);
  for (const ExtraEntry& entry : extra)
    of_row[static_cast<std::size_t>(row_of_node_[static_cast<std::size_t>(entry.node)])].push_back(entry.column);
  offsets_.assign(1, 0);
  columns_.clear();
  for (std::vector<LocalIndex>& row : of_row) {
    std::ranges::sort(row, {}, [this](LocalIndex column) { return id_of(column); });
    row.erase(std::unique(row.begin(), row.end()), row.end());
    columns_.insert(columns_.end(), row.begin(), row.end());
    offsets_.push_back(static_cast<LocalIndex>(columns_.size()));
  }
  values_.assign(columns_.size(), 0.0);
  diagonal_.assign(mesh_.owned_nodes.size(), 0.0);
}

void ConductionMatrix::extend(const Directory& owners, std::vector<GlobalId> beyond,
                              std::span<const ExtraEntry> extra) {
  beyond_ = std::move(beyond);
  std::vector<GlobalId> ids;
  std::vector<LocalIndex> into;
  for (LocalIndex n = 0; n < static_cast<LocalIndex>(width()); ++n) {
    if (n < mesh_.nodes() && mesh_.owns_node(n)) continue;
    ids.push_back(id_of(n));
    into.push_back(n);
  }
  std::vector<int> owner;
  std::vector<LocalIndex> index;
  for (const DirectoryEntry& entry : owners.find(ids)) {
    owner.push_back(entry.rank);
    index.push_back(entry.index);
  }
  halo_ = ExchangePlan::from_owners(mesh_.comm, owner, index, into, "thermal contact halo");
  std::vector<std::size_t> order(into.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&owner](std::size_t i) { return owner[i]; });
  arrivals_.clear();
  for (const std::size_t i : order) arrivals_.push_back(into[i]);
  make_pattern(extra);
  places_.clear();
  first_place_.clear();
  place_elements();
}

LocalIndex ConductionMatrix::place(LocalIndex i, LocalIndex j) const {
  const LocalIndex row = row_of_node_[static_cast<std::size_t>(i)];
  if (row == no_index) return no_index;
  const auto first = columns_.begin() + offsets_[static_cast<std::size_t>(row)];
  const auto last = columns_.begin() + offsets_[static_cast<std::size_t>(row) + 1];
  const auto found =
      std::lower_bound(first, last, id_of(j), [this](LocalIndex a, GlobalId id) { return id_of(a) < id; });
  return static_cast<LocalIndex>(found - columns_.begin());
}

void ConductionMatrix::place_elements() {
  for (const ElementBlock& block : mesh_.blocks) {
    first_place_.push_back(places_.size());
    for (LocalIndex e = 0; e < block.size(); ++e) {
      const auto nodes = block.nodes(e);
      for (std::size_t a = 0; a < nodes.size(); ++a)
        for (std::size_t b = a + 1; b < nodes.size(); ++b) {
          places_.push_back(place(nodes[a], nodes[b]));
          places_.push_back(place(nodes[b], nodes[a]));
        }
    }
  }
}

ConductionMatrix::BadElement ConductionMatrix::assemble(std::span<const Vec3> coordinates,
                                                        std::span<const double> temperature) {
  std::ranges::fill(values_, 0.0);
  stiffest_ = {};
  LocalIndex first_element = 0;
  for (std::size_t b = 0; b < mesh_.blocks.size(); ++b) {
    const BadElement bad = assemble_block(static_cast<LocalIndex>(b), first_element, coordinates, temperature);
    if (bad.id != no_id) return bad;
    first_element += mesh_.blocks[b].size();
  }
  return {};
}

void ConductionMatrix::add_link(LocalIndex i, LocalIndex j, double value) {
  for (const LocalIndex p : {place(i, j), place(j, i)})
    if (p != no_index) values_[static_cast<std::size_t>(p)] += value;
}

void ConductionMatrix::finish() {
  for (std::size_t r = 0; r < diagonal_.size(); ++r) {
    double sum = 0;
    for (LocalIndex p = offsets_[r]; p < offsets_[r + 1]; ++p) sum += values_[static_cast<std::size_t>(p)];
    diagonal_[r] = -sum;
  }
}

ConductionMatrix::BadElement ConductionMatrix::assemble_block(LocalIndex b, LocalIndex first_element,
                                                              std::span<const Vec3> coordinates,
                                                              std::span<const double> temperature) {
  const ElementBlock& block = mesh_.blocks[static_cast<std::size_t>(b)];
  const ElementTable& table = tables_[static_cast<std::size_t>(b)];
  const bool warm = !conductivity_[static_cast<std::size_t>(b)].is_constant();
  double mean[lanes] = {};  // temperature
  CornerBatch corners{};
  ConductionBatch links;
  for (LocalIndex first = 0; first < block.size(); first += lanes) {
    const LocalIndex count = std::min(static_cast<LocalIndex>(lanes), block.size() - first);
    for (LocalIndex l = 0; l < lanes; ++l) {  // the last batch is padded with its last element
      const auto nodes = block.nodes(first + std::min(l, count - 1));
      for (std::size_t a = 0; a < nodes.size(); ++a)
        for (std::size_t c = 0; c < 3; ++c) corners.x[a][c][l] = coordinates[static_cast<std::size_t>(nodes[a])][c];
      if (!warm) continue;
      double sum = 0;
      for (const LocalIndex n : nodes) sum += temperature[static_cast<std::size_t>(n)];
      mean[l] = sum / static_cast<double>(nodes.size());
    }
    conduct(static_cast<std::size_t>(b), corners, mean, links);
    for (LocalIndex l = 0; l < count; ++l) {
      const LocalIndex e = first + l;
      if (!(links.least_jacobian[l] > 0)) return {block.ids[static_cast<std::size_t>(e)], b, e};
      scatter(first_place_[static_cast<std::size_t>(b)] +
                  static_cast<std::size_t>(2 * table.pairs) * static_cast<std::size_t>(e),
              links, l, table);
    }
    if (!capacity_.empty())
      note_eigenvalues(table, links, b, first, count, static_cast<std::size_t>(first_element + first));
  }
  return {};
}

void ConductionMatrix::conduct(std::size_t block, const CornerBatch& corners, const double (&temperature)[lanes],
                               ConductionBatch& links) const {
  const Conductivity& k = conductivity_[block];
  if (k.tensor) return conduction(tables_[block], corners, *k.tensor, links);
  double at[lanes];
  for (int l = 0; l < lanes; ++l) at[l] = k.over_temperature(temperature[l]);
  conduction(tables_[block], corners, at, links);
}

void ConductionMatrix::scatter(std::size_t place, const ConductionBatch& links, int lane, const ElementTable& table) {
  for (int pair = 0; pair < table.pairs; ++pair)
    for (int way = 0; way < 2; ++way, ++place)
      if (const LocalIndex p = places_[place]; p != no_index)
        values_[static_cast<std::size_t>(p)] += links.link[pair][lane];
}

void ConductionMatrix::note_eigenvalues(const ElementTable& table, const ConductionBatch& links, LocalIndex block,
                                        LocalIndex first, LocalIndex count, std::size_t first_of_all) {
  double capacity[max_linear_nodes][lanes], bound[lanes];
  for (LocalIndex l = 0; l < lanes; ++l)
    for (std::size_t a = 0; a < max_linear_nodes; ++a)
      capacity[a][l] = capacity_[first_of_all + static_cast<std::size_t>(std::min(l, count - 1))][a];
  eigenvalue_bound(table, links, capacity, bound);
  for (LocalIndex l = 0; l < count; ++l)
    if (bound[l] > stiffest_.eigenvalue) stiffest_ = {bound[l], block, first + l};
}

void ConductionMatrix::conducted(std::span<const double> x, std::span<double> out) const {
  for (std::size_t r = 0; r < diagonal_.size(); ++r) {
    const double mine = x[static_cast<std::size_t>(mesh_.owned_nodes[r])];
    double sum = 0;
    for (auto p = static_cast<std::size_t>(offsets_[r]); p < static_cast<std::size_t>(offsets_[r + 1]); ++p)
      sum += values_[p] * (x[static_cast<std::size_t>(columns_[p])] - mine);
    out[r] = -sum;
  }
}

void ConductionMatrix::multiply(std::span<const double> d, double factor, std::span<const double> x,
                                std::span<double> out) const {
  for (std::size_t r = 0; r < diagonal_.size(); ++r) {
    double sum = 0;
    for (auto p = static_cast<std::size_t>(offsets_[r]); p < static_cast<std::size_t>(offsets_[r + 1]); ++p)
      sum += values_[p] * x[static_cast<std::size_t>(columns_[p])];
    out[r] = d[r] * x[static_cast<std::size_t>(mesh_.owned_nodes[r])] + factor * sum;
  }
}

std::int64_t ConductionMatrix::memory() const {
  const auto bytes = [](const auto& v) {
    return static_cast<std::int64_t>(v.capacity() * sizeof(typename std::decay_t<decltype(v)>::value_type));
  };
  return bytes(offsets_) + bytes(columns_) + bytes(values_) + bytes(diagonal_) + bytes(row_of_node_) + bytes(places_) +
         bytes(capacity_);
}

}  // namespace tenon::thermal
