// SPDX-License-Identifier: BSD-3-Clause
// What a receiver sees between the samples of a field that come at the source's own steps.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "framework/io/checkpoint.hpp"

namespace tenon::transfer {

/// hold: a point value stays as it was last given, and an amount is handed over at once. linear: a point value goes on
/// along the line through the last two samples, and an amount is handed over evenly in the time that it took to gather.
enum class BetweenSamples { hold, linear };

/// The last two samples of a point value, and the line through them.
class LinearInTime {
 public:
  /// Beyond the later sample, the line is followed for at most this many times the time between the two: a source that
  /// suddenly lengthens its steps says little about what follows.
  static constexpr double farthest = 2;

  explicit LinearInTime(std::size_t values = 0) : earlier_(values), later_(values) {}
  /// A sample at `time` (s); one at the time of the last one replaces it.
  void take(double time, std::span<const double> values);
  /// Whether there is a line and `time` is not where its later end stands: that value has been given already.
  bool moves(double time) const { return samples_ == 2 && time != later_time_; }
  void at(double time, std::span<double> values) const;

  void save(CheckpointWriter& file, const std::string& name, const GlobalOrder& owned,
            std::span<const LocalIndex> items, int components) const;
  /// `local`: all local items, ghosts too. A checkpoint without samples leaves none.
  void load(const CheckpointReader& file, const std::string& name, const GlobalOrder& local, int components);
  std::size_t values() const { return earlier_.size() + later_.size(); }

 private:
  int samples_ = 0;
  double earlier_time_ = 0, later_time_ = 0;
  std::vector<double> earlier_, later_;
};

/// Amounts that wait to be handed over evenly. Nothing is lost to rounding: what is given and what goes on waiting add
/// up exactly to what waited.
class SteadyRelease {
 public:
  explicit SteadyRelease(std::size_t values = 0) : waiting_(values) {}
  /// Amounts that a source gathered up to `time`, since the last call (or `start`); they are for the receiver's time
  /// from `now` on, as long as they took to gather.
  void take(double time, double now, std::span<const double> amounts);
  void start(double time) { last_ = end_ = time; }
  /// The share of a receiver's step from `now` to `time` (s).
  void give(double now, double time, std::span<double> amounts);
  std::span<const double> waiting() const { return waiting_; }

  void save(CheckpointWriter& file, const std::string& name, const GlobalOrder& owned,
            std::span<const LocalIndex> items, int components) const;
  void load(const CheckpointReader& file, const std::string& name, const GlobalOrder& local, int components);
  bool loaded() const { return loaded_; }

 private:
  double last_ = 0, end_ = 0;  // of gathering and of giving, s
  bool loaded_ = false;
  std::vector<double> waiting_;
};

}  // namespace tenon::transfer
