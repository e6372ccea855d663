// SPDX-License-Identifier: BSD-3-Clause
#include "components/materials/linear_elastic.hpp"

#include "components/materials/plane_stress_elastic.hpp"
#include "components/materials/trial_stress.hpp"

namespace tenon {

void LinearElastic::update(const UpdateInput& input, Batch<6>& stress, Batch<1>& state, Batch<1>& plastic_work) const {
  elastic_trial(elasticity, input, stress);
  for (int l = 0; l < lanes; ++l) plastic_work[0][l] = 0;
}

void LinearElastic::update_plane_stress(const UpdateInput& input, Batch<6>& stress, Batch<1>& state,
                                        Batch<1>& plastic_work, Batch<1>& thickness_increment) const {
  elastic_trial_plane_stress(elasticity, input, stress, thickness_increment);
  for (int l = 0; l < lanes; ++l) plastic_work[0][l] = 0;
}

}  // namespace tenon
