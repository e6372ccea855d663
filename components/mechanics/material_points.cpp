// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/material_points.hpp"

#include <algorithm>

#include "components/mechanics/element_group.hpp"

namespace tenon {

MaterialPoints::MaterialPoints(std::shared_ptr<const MaterialModel> model, std::size_t batches, int points)
    : model_(std::move(model)),
      points_(points),
      rows_(model_->state_size()),
      turning_(!model_->rotating_tensors().empty() || !model_->rotating_vectors().empty()),
      stress_(batches * static_cast<std::size_t>(points)),
      history_(stress_.size() * static_cast<std::size_t>(rows_)) {
  for (std::size_t p = 0; p < stress_.size(); ++p)
    for (int i = 0; i < rows_; ++i) {
      Batch<1>& row = history_[p * static_cast<std::size_t>(rows_) + static_cast<std::size_t>(i)];
      std::fill(row[0], row[0] + lanes, model_->initial_state(i));
    }
}

void MaterialPoints::rotate_history(Batch<1>* history, const Tensor<Pack>& r, int lane) const {
  const auto row = [&](int i) { return history[i][0] + lane; };
  for (const int first : model_->rotating_tensors()) {
    const SymmetricTensor<Pack> t =
        rotated(r, SymmetricTensor<Pack>{load(row(first)), load(row(first + 1)), load(row(first + 2)),
                                         load(row(first + 3)), load(row(first + 4)), load(row(first + 5))});
    store(row(first), t.xx), store(row(first + 1), t.yy), store(row(first + 2), t.zz);
    store(row(first + 3), t.xy), store(row(first + 4), t.yz), store(row(first + 5), t.zx);
  }
  for (const int first : model_->rotating_vectors()) {
    const Vector<Pack> v = r * Vector<Pack>{load(row(first)), load(row(first + 1)), load(row(first + 2))};
    store(row(first), v.x), store(row(first + 1), v.y), store(row(first + 2), v.z);
  }
}

double MaterialPoints::mean_stress(std::int32_t element, int component) const {
  double sum = 0;
  for (int p = 0; p < points_; ++p)
    sum += stress(static_cast<std::size_t>(element / lanes), p)[component][element % lanes];
  return sum / points_;
}

double MaterialPoints::mean_history(std::int32_t element, int row) const {
  double sum = 0;
  for (int p = 0; p < points_; ++p)
    sum += history(static_cast<std::size_t>(element / lanes), p)[row][0][element % lanes];
  return sum / points_;
}

void MaterialPoints::failed(std::size_t batch, Batch<1>& result) const {
  for (int l = 0; l < lanes; ++l) {
    bool any = false;
    for (int p = 0; p < points_ && model_->damage() >= 0; ++p)
      any = any || history(batch, p)[model_->damage()][0][l] >= 1;
    result[0][l] = any ? 1 : 0;
  }
}

void MaterialPoints::add_state(std::vector<StateArray>& arrays) {
  arrays.push_back({"stress", 6 * points_, reinterpret_cast<Batch<1>*>(stress_.data())});
  if (rows_ > 0) arrays.push_back({"history", rows_ * points_, history_.data()});
}

std::int64_t MaterialPoints::memory() const {
  return static_cast<std::int64_t>(stress_.size() * sizeof(Batch<6>) + history_.size() * sizeof(Batch<1>));
}

}  // namespace tenon
