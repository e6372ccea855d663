// SPDX-License-Identifier: BSD-3-Clause
// Solids, updated Lagrangian.
#include "components/sph/formulation.hpp"

namespace tenon {

std::unique_ptr<Formulation> make_solid(const SphContext& context) {
  throw Error(ExitCode::usage, context.name + ": this formulation does not exist");
}

}  // namespace tenon
