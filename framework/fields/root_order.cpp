// SPDX-License-Identifier: BSD-3-Clause
#include "framework/fields/root_order.hpp"

#include <numeric>

namespace tenon {

RootOrder::RootOrder(const Mesh& mesh, Location location) {
  std::vector<LocalIndex> index;
  if (location == Location::node) {
    index.assign(mesh.node_ids.begin(), mesh.node_ids.end());
  } else {
    for (const ElementBlock& block : mesh.blocks) index.insert(index.end(), block.ids.begin(), block.ids.end());
  }
  local_ = index.size();
  if (mesh.comm.rank() == 0)
    whole_ = static_cast<std::size_t>(location == Location::node ? mesh.global_nodes : mesh.global_elements);
  std::vector<LocalIndex> into(local_);
  std::iota(into.begin(), into.end(), 0);
  plan_ = ExchangePlan::from_owners(mesh.comm, std::vector<int>(local_, 0), index, into, "fields of files");
}

std::vector<double> RootOrder::to_local(std::span<const double> whole, int components) const {
  std::vector<double> local(local_ * static_cast<std::size_t>(components));
  plan_.forward(whole, std::span(local), components);
  return local;
}

std::vector<double> RootOrder::to_root(std::span<const double> local, int components) const {
  std::vector<double> whole(whole_ * static_cast<std::size_t>(components));
  plan_.reverse(local, std::span(whole), components);
  return whole;
}

}  // namespace tenon
