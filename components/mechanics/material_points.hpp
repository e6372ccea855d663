// SPDX-License-Identifier: BSD-3-Clause
// Stress and history at the integration points of a group of elements.
#pragma once

#include <memory>
#include <vector>

#include "components/materials/material_model.hpp"
#include "components/mechanics/small_tensor.hpp"

namespace tenon {

struct StateArray;

TENON_KERNEL SymmetricTensor<Pack> load_tensor(const Batch<6>& s, int lane) {
  return {load(s[0] + lane), load(s[1] + lane), load(s[2] + lane),
          load(s[3] + lane), load(s[4] + lane), load(s[5] + lane)};
}
TENON_KERNEL void store_tensor(const SymmetricTensor<Pack>& t, Batch<6>& s, int lane) {
  store(s[0] + lane, t.xx), store(s[1] + lane, t.yy), store(s[2] + lane, t.zz);
  store(s[3] + lane, t.xy), store(s[4] + lane, t.yz), store(s[5] + lane, t.zx);
}

/// Points of a batch of elements lie together: those of batch b are b * points() ... (b + 1) * points() - 1.
class MaterialPoints {
 public:
  MaterialPoints(std::shared_ptr<const MaterialModel> model, std::size_t batches, int points);

  const MaterialModel& model() const { return *model_; }
  int points() const { return points_; }
  std::size_t index(std::size_t batch, int point) const {
    return batch * static_cast<std::size_t>(points_) + static_cast<std::size_t>(point);
  }

  Batch<6>& stress(std::size_t batch, int point) { return stress_[index(batch, point)]; }
  const Batch<6>& stress(std::size_t batch, int point) const { return stress_[index(batch, point)]; }
  /// Rows of the history of one point of a batch.
  Batch<1>* history(std::size_t batch, int point) {
    return history_.data() + index(batch, point) * static_cast<std::size_t>(rows_);
  }
  const Batch<1>* history(std::size_t batch, int point) const {
    return history_.data() + index(batch, point) * static_cast<std::size_t>(rows_);
  }

  /// Turns the stress of a point, and what turns with it, by the rotation of the step; lanes lane .. lane + 3.
  TENON_KERNEL void rotate(std::size_t batch, int point, const Tensor<Pack>& r, int lane) {
    Batch<6>& s = stress(batch, point);
    store_tensor(rotated(r, load_tensor(s, lane)), s, lane);
    if (turning_) rotate_history(history(batch, point), r, lane);
  }

  /// As `rotate`, of the history alone.
  void rotate_history(Batch<1>* history, const Tensor<Pack>& r, int lane) const;

  double mean_stress(std::int32_t element, int component) const;
  double mean_history(std::int32_t element, int row) const;
  /// Whether any point of the elements of this batch has failed: 1 or 0 in each lane. Only if the material can fail.
  void failed(std::size_t batch, Batch<1>& result) const;

  void add_state(std::vector<StateArray>& arrays);
  std::int64_t memory() const;

 private:
  std::shared_ptr<const MaterialModel> model_;
  int points_, rows_;
  bool turning_;
  std::vector<Batch<6>> stress_;
  std::vector<Batch<1>> history_;
};

}  // namespace tenon
