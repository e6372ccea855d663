// SPDX-License-Identifier: BSD-3-Clause
#include "transfer/time_samples.hpp"

#include <algorithm>
#include <cassert>

namespace tenon::transfer {

namespace {

std::vector<double> of_items(std::span<const double> values, std::span<const LocalIndex> items, int components) {
  const auto width = static_cast<std::size_t>(components);
  std::vector<double> owned;
  owned.reserve(items.size() * width);
  for (const LocalIndex item : items)
    for (std::size_t c = 0; c < width; ++c) owned.push_back(values[static_cast<std::size_t>(item) * width + c]);
  return owned;
}

}  // namespace

void LinearInTime::take(double time, std::span<const double> values) {
  assert(values.size() == later_.size());
  if (samples_ > 0 && time != later_time_) {
    std::swap(earlier_, later_);
    earlier_time_ = later_time_;
    samples_ = 2;
  }
  samples_ = std::max(samples_, 1);
  later_time_ = time;
  std::copy(values.begin(), values.end(), later_.begin());
}

void LinearInTime::at(double time, std::span<double> values) const {
  assert(values.size() == later_.size());
  const double s = samples_ == 2 ? std::clamp((time - later_time_) / (later_time_ - earlier_time_), -1.0, farthest) : 0;
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = later_[i] + s * (later_[i] - earlier_[i]);
}

void LinearInTime::save(CheckpointWriter& file, const std::string& name, const GlobalOrder& owned,
                        std::span<const LocalIndex> items, int components) const {
  file.integer(name + ".samples", samples_);
  file.scalar(name + ".earlier_time", earlier_time_);
  file.scalar(name + ".later_time", later_time_);
  file.array(name + ".earlier", owned, of_items(earlier_, items, components), components);
  file.array(name + ".later", owned, of_items(later_, items, components), components);
}

void LinearInTime::load(const CheckpointReader& file, const std::string& name, const GlobalOrder& local,
                        int components) {
  if (!file.has(name + ".samples")) return;
  samples_ = static_cast<int>(file.integer(name + ".samples"));
  earlier_time_ = file.scalar(name + ".earlier_time");
  later_time_ = file.scalar(name + ".later_time");
  file.array(name + ".earlier", local, earlier_, components);
  file.array(name + ".later", local, later_, components);
}

void SteadyRelease::take(double time, double now, std::span<const double> amounts) {
  assert(amounts.size() == waiting_.size());
  for (std::size_t i = 0; i < amounts.size(); ++i) waiting_[i] += amounts[i];
  if (!(time > last_)) return;
  end_ = now + (time - last_);
  last_ = time;
}

// w = given + left without rounding: the greater of the two is rounded, and the other is the difference of numbers
// within a factor of two [Ste74].
void SteadyRelease::give(double now, double time, std::span<double> amounts) {
  assert(amounts.size() == waiting_.size());
  const double left = end_ - now, step = time - now;
  const double share = step >= left * (1 - 1e-9) ? 1 : step / left;
  for (std::size_t i = 0; i < amounts.size(); ++i) {
    double& waits = waiting_[i];
    const double all = waits;
    if (share >= 0.5) {
      amounts[i] = share * all;
      waits = all - amounts[i];
    } else {
      waits = (1 - share) * all;
      amounts[i] = all - waits;
    }
  }
}

void SteadyRelease::save(CheckpointWriter& file, const std::string& name, const GlobalOrder& owned,
                         std::span<const LocalIndex> items, int components) const {
  file.scalar(name + ".gathered_to", last_);
  file.scalar(name + ".given_to", end_);
  file.array(name + ".waiting", owned, of_items(waiting_, items, components), components);
}

void SteadyRelease::load(const CheckpointReader& file, const std::string& name, const GlobalOrder& local,
                         int components) {
  if (!file.has(name + ".gathered_to")) return;
  last_ = file.scalar(name + ".gathered_to");
  end_ = file.scalar(name + ".given_to");
  file.array(name + ".waiting", local, waiting_, components);
  loaded_ = true;
}

}  // namespace tenon::transfer
