// SPDX-License-Identifier: BSD-3-Clause
// Owners of the nodes of a divided mesh, such that few elements are ghosts. Time and memory are linear in its size, but
// for the sorting of nodes between parts.
#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <span>

#include "framework/base/box.hpp"
#include "framework/mesh/dual_graph.hpp"

namespace tenon {

namespace {

class NodeOwners {
 public:
  NodeOwners(const MeshData& mesh, const std::vector<int>& element_owners)
      : mesh_(mesh), element_owners_(element_owners), owners_(mesh.coordinates.size(), nobody) {
    find_elements_around();
  }

  std::vector<int> choose() {
    std::vector<int> ranks;
    for (std::size_t n = 0; n < owners_.size(); ++n) {
      ranks_around(n, ranks);
      if (ranks.size() <= 1)
        owners_[n] = ranks.empty() ? 0 : ranks.front();
      else if (ranks.size() == 2)
        between_two_.push_back({ranks[0], ranks[1], n});
      else
        between_more_.push_back(n);
    }
    halve();
    const auto most = std::ranges::max_element(element_owners_);
    chosen_.assign(most == element_owners_.end() ? 1 : static_cast<std::size_t>(*most) + 1, 0);
    for (const std::size_t n : between_more_) owners_[n] = who_has_most(n, ranks);
    return std::move(owners_);
  }

 private:
  static constexpr int nobody = -1;

  /// A node between two ranks.
  struct Between {
    int low, high;
    std::size_t node;
  };

  void find_elements_around() {
    first_.assign(owners_.size() + 1, 0);
    const auto for_all = [&](auto visit) {
      std::size_t element = 0;
      for (const BlockData& block : mesh_.blocks) {
        const auto nodes = static_cast<std::size_t>(topology(block.kind).nodes);
        for (std::size_t e = 0; e < block.size(); ++e, ++element)
          for (std::size_t i = 0; i < nodes; ++i)
            visit(static_cast<std::size_t>(block.connectivity[e * nodes + i]), static_cast<LocalIndex>(element));
      }
    };
    for_all([&](std::size_t n, LocalIndex) { ++first_[n + 1]; });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    around_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for_all([&](std::size_t n, LocalIndex element) { around_[next[n]++] = element; });
    std::size_t before = 0;
    for (const BlockData& block : mesh_.blocks) {
      first_element_.push_back(before);
      before += block.size();
    }
  }

  std::span<const LocalIndex> around(std::size_t n) const {
    return std::span(around_).subspan(first_[n], first_[n + 1] - first_[n]);
  }

  void ranks_around(std::size_t n, std::vector<int>& ranks) const {
    ranks.clear();
    for (const LocalIndex e : around(n)) ranks.push_back(element_owners_[static_cast<std::size_t>(e)]);
    std::ranges::sort(ranks);
    ranks.erase(std::unique(ranks.begin(), ranks.end()), ranks.end());
  }

  std::span<const GlobalId> nodes_of(std::size_t element) const {
    const auto b =
        static_cast<std::size_t>(std::ranges::upper_bound(first_element_, element) - first_element_.begin() - 1);
    const BlockData& block = mesh_.blocks[b];
    const auto nodes = static_cast<std::size_t>(topology(block.kind).nodes);
    return std::span(block.connectivity).subspan((element - first_element_[b]) * nodes, nodes);
  }

  /// What lies between two ranks is cut in two across its longest axis.
  void halve() {
    std::ranges::sort(between_two_, [](const Between& a, const Between& b) {
      return std::array{a.low, a.high} != std::array{b.low, b.high}
                 ? std::array{a.low, a.high} < std::array{b.low, b.high}
                 : a.node < b.node;
    });
    for (auto begin = between_two_.begin(), end = begin; begin != between_two_.end(); begin = end) {
      Box box;
      for (; end != between_two_.end() && end->low == begin->low && end->high == begin->high; ++end)
        box.add(mesh_.coordinates[end->node]);
      std::size_t axis = 0;
      for (std::size_t c = 1; c < 3; ++c)
        if (box.high[c] - box.low[c] > box.high[axis] - box.low[axis]) axis = c;
      std::sort(begin, end, [&](const Between& a, const Between& b) {
        const double x = mesh_.coordinates[a.node][axis], y = mesh_.coordinates[b.node][axis];
        return x != y ? x < y : a.node < b.node;
      });
      const auto half = (end - begin + (begin->low + begin->high) % 2) / 2;  // the odd one to either in turn
      for (auto it = begin; it != end; ++it) owners_[it->node] = it - begin < half ? it->low : it->high;
    }
  }

  /// Of the ranks around a node the one that would have to take fewest more elements; of equals, the one that was
  /// chosen least.
  int who_has_most(std::size_t n, std::vector<int>& ranks) {
    ranks_around(n, ranks);
    int best = ranks.front();
    std::array<std::int64_t, 2> least{std::numeric_limits<std::int64_t>::max(), 0};
    for (const int rank : ranks) {
      const auto has = [&](LocalIndex e) {
        const auto element = static_cast<std::size_t>(e);
        return element_owners_[element] == rank || std::ranges::any_of(nodes_of(element), [&](GlobalId node) {
                 return owners_[static_cast<std::size_t>(node)] == rank;
               });
      };
      const std::array<std::int64_t, 2> cost{
          static_cast<std::int64_t>(around(n).size()) - std::ranges::count_if(around(n), has),
          chosen_[static_cast<std::size_t>(rank)]};
      if (cost < least) least = cost, best = rank;
    }
    ++chosen_[static_cast<std::size_t>(best)];
    return best;
  }

  const MeshData& mesh_;
  const std::vector<int>& element_owners_;
  std::vector<int> owners_;
  std::vector<std::size_t> first_, first_element_;
  std::vector<LocalIndex> around_;
  std::vector<Between> between_two_;
  std::vector<std::size_t> between_more_;
  std::vector<std::int64_t> chosen_;  // of each rank, where several meet
};

}  // namespace

std::vector<int> node_owners(const MeshData& mesh, const std::vector<int>& element_owners) {
  return NodeOwners(mesh, element_owners).choose();
}

}  // namespace tenon
