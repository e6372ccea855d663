// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/element_cost.hpp"

#include <map>

namespace tenon {

namespace {

template <typename... F>
struct Overloaded : F... {
  using F::operator()...;
};

}  // namespace

double element_cost(const MaterialDescription& material) {
  return std::visit(
      Overloaded{[](std::monostate) { return 1.0; }, [](const LinearHardeningParameters&) { return 1.05; },
                 [](const JohnsonCookParameters&) { return 1.8; }, [](const auto&) { return 1.3; }},
      material.plasticity);
}

ElementCost mechanics_cost(const MechanicsOptions& options) {
  std::map<std::string, double> costs;
  for (const MechanicsOptions::Block& block : options.blocks) costs[block.name] = element_cost(block.material);
  return [costs](const std::string& block, ElementKind) {
    const auto found = costs.find(block);
    return found == costs.end() ? 1.0 : found->second;
  };
}

}  // namespace tenon
