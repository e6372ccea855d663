// SPDX-License-Identifier: BSD-3-Clause
#include "components/sph/particle_data.hpp"

#include <algorithm>
#include <utility>

namespace tenon {

Column& ParticleData::add(std::string name, ColumnKind kind, int components, bool kept) {
  Column& column = columns_.emplace_back();
  column.name = std::move(name), column.kind = kind, column.components = components, column.kept = kept;
  column.values.resize(static_cast<std::size_t>(components) * ids.size());
  return column;
}

const Column* ParticleData::find(const std::string& name) const {
  const auto found = std::ranges::find(columns_, name, &Column::name);
  return found == columns_.end() ? nullptr : &*found;
}

void ParticleData::resize(std::size_t owned, std::size_t ghosts) {
  const std::size_t size = owned + ghosts;
  owned_ = owned;
  for (Column& column : columns_) column.values.resize(static_cast<std::size_t>(column.components) * size);
  ids.resize(size), body.resize(size), image.resize(size);
  home_rank.resize(owned), home_node.resize(owned);
}

}  // namespace tenon
