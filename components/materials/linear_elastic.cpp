// SPDX-License-Identifier: BSD-3-Clause
#include "components/materials/linear_elastic.hpp"

#include "components/materials/trial_stress.hpp"

namespace tenon {

void LinearElastic::update(const UpdateInput& input, Batch<6>& stress, Batch<1>& state, Batch<1>& plastic_work) const {
  elastic_trial(elasticity, input, stress);
  for (int l = 0; l < lanes; ++l) plastic_work[0][l] = 0;
}

}  // namespace tenon
