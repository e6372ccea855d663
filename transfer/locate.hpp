// SPDX-License-Identifier: BSD-3-Clause
// The rendezvous: where the points of all ranks lie in the elements of all ranks.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "framework/mesh/mesh.hpp"
#include "framework/search/distributed_search.hpp"
#include "transfer/place.hpp"
#include "transfer/slot_table.hpp"

namespace tenon::transfer {

/// Finds points in the elements of a mesh, and, if it is to serve again, keeps what serves again: the decomposition of
/// the rendezvous, the tree, and the element that each point was in.
class Locator {
 public:
  /// `moving`: find_again() will be called. All calls are collective.
  Locator(const Communicator& comm, const PlaceRules& rules, bool moving, std::string name)
      : comm_(comm), rules_(rules), moving_(moving), name_(std::move(name)) {}

  /// The placement of each point of this rank, in order: every point gets an element if there is any at all, however
  /// far, on any number of ranks. Points outside cost little while they are nearer than about half an element: those
  /// are settled in the first rendezvous, only the others go to further ones, of doubling reach.
  const std::vector<Placement>& find(const Containers& containers, std::span<const Vec3> points) &;
  std::vector<Placement> find(const Containers& containers, std::span<const Vec3> points) && {
    static_cast<Locator&>(*this).find(containers, points);
    return std::move(places_);
  }

  /// The same points and elements, moved by at most `moved` (m) since find(), on any rank. Rebuilds as little as the
  /// motion demands. The placements are those of find(), bit for bit, except where elements overlap: there a point
  /// stays in its element while it is inside.
  const std::vector<Placement>& find_again(const Containers& containers, std::span<const Vec3> points, double moved);

  /// Local: points that the last call searched for, rather than found in their element.
  std::int64_t searched() const { return searched_; }
  /// Whether the last call made a new decomposition.
  bool decomposed() const { return decomposed_; }
  std::int64_t memory() const;

 private:
  bool newcomers(const Containers& containers) const;
  void build(const Containers& containers, std::span<const Vec3> points);
  void search(const Containers& containers, std::span<const Vec3> points, bool again);
  void look_farther(const Containers& containers, std::span<const Vec3> points);
  const ElementSet& elements(const Containers& containers) const {
    return comm_.size() == 1 ? containers.set : arrived_;
  }
  void forget();

  Communicator comm_;
  PlaceRules rules_;
  bool moving_;
  std::string name_;
  double reach_ = 0, skin_ = 0;
  Rcb rcb_{comm_};
  std::unique_ptr<DistributedSearch> search_;  // none on one rank
  ElementSet arrived_;
  BoxTree tree_;
  std::vector<LocalIndex> held_;   // of the points here
  std::vector<Placement> places_;  // of the points of this rank
  std::vector<Placement> here_;    // of the points here, on several ranks
  std::vector<char> absent_;       // elements that had no volume, and so went nowhere
  std::vector<float> work_;        // of the points of this rank, for the balance of the next decomposition
  std::int64_t searched_ = 0;
  bool decomposed_ = false;
};

/// Where the nodes of elements are kept by their owners, fetched from the elements' owners.
class PlacedNodes {
 public:
  /// The nodes of one element.
  struct Nodes {
    const GlobalId* id;
    const int* owner;
    const LocalIndex* at_owner;
    std::size_t count;
  };
  /// Collective. Of the elements that points were placed in. `nodes` are the items of the mesh that `elements` (those
  /// that this rank owns) were taken from.
  PlacedNodes(const Communicator& comm, const ElementSet& elements, const Items& nodes,
              std::span<const Placement> placements, const std::string& name);
  /// Collective. Of elements of a mesh by their owners and their places among all elements there.
  PlacedNodes(const Mesh& mesh, const Items& nodes, const SlotTable& wanted, const std::string& name);

  /// Of the element that a point was placed in.
  Nodes of(std::size_t placement) const { return element(element_of(placement)); }
  std::size_t element_of(std::size_t placement) const { return static_cast<std::size_t>(element_of_[placement]); }
  /// The distinct elements; `stride` entries are kept for each.
  std::size_t elements() const { return count_.size(); }
  std::size_t stride() const { return stride_; }
  Nodes element(std::size_t i) const {
    return {id_.data() + i * stride_, owner_.data() + i * stride_, at_owner_.data() + i * stride_,
            static_cast<std::size_t>(count_[i])};
  }

 private:
  template <typename NodesOf>
  void fetch(const Communicator& comm, const Items& nodes, const SlotTable& wanted, const std::string& name,
             NodesOf nodes_of);

  std::size_t stride_ = 0;
  std::vector<LocalIndex> element_of_;
  std::vector<GlobalId> id_;
  std::vector<int> owner_;
  std::vector<LocalIndex> at_owner_;
  std::vector<std::int8_t> count_;
};

}  // namespace tenon::transfer
