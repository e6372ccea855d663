// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/hex8_block.hpp"

#include <algorithm>
#include <cmath>

#include "components/mechanics/hex8_volume.hpp"

namespace tenon {

Hex8Block::Hex8Block(const ElementBlock& block, std::span<const Vec3> coordinates, const MaterialDescription& material)
    : size_(block.size()), material_(material) {
  const auto n = static_cast<std::size_t>((size_ + lanes - 1) / lanes);
  connectivity.resize(n);
  stresses.resize(n);
  for (ElementValues* values :
       {&mass, &reference_size, &temperature, &temperature_used, &plastic_work, &hourglass_energy, &viscosity_energy})
    values->resize(n);
  for (LocalIndex e = 0; e < static_cast<LocalIndex>(n) * lanes; ++e) {
    const std::span<const LocalIndex> nodes = block.nodes(std::min(e, size_ - 1));
    for (std::size_t i = 0; i < 8; ++i) connectivity[static_cast<std::size_t>(e / lanes)].node[i][e % lanes] = nodes[i];
    const double volume = hex8_volume(nodes, coordinates);
    value_of(mass, e) = material.density * volume;
    value_of(reference_size, e) = std::cbrt(volume);
  }
}

void Hex8Block::fill_padding() {
  for (LocalIndex e = size_; e < static_cast<LocalIndex>(batches()) * lanes; ++e) {
    for (int i = 0; i < 6; ++i) stress(e, i) = stress(size_ - 1, i);
    for (ElementValues* values : {&temperature, &temperature_used, &plastic_work, &hourglass_energy, &viscosity_energy})
      value_of(*values, e) = value_of(*values, size_ - 1);
  }
}

std::int64_t Hex8Block::memory() const {
  return static_cast<std::int64_t>(batches() * (sizeof(HexConnectivity) + sizeof(Batch<6>) + 7 * sizeof(Batch<1>)));
}

}  // namespace tenon
