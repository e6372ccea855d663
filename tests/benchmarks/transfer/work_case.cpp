// SPDX-License-Identifier: BSD-3-Clause
#include "work_case.hpp"

#include <fmt/core.h>

#include <cstring>
#include <optional>

#include "bench_clock.hpp"
#include "vtk_rival.hpp"

namespace tenon::bench {

namespace {

using transfer::GridTransfer;

constexpr int applies = 10;  ///< in one repeat
constexpr std::size_t copied =
    96;  ///< bytes read and written per target: what a row of 8 nodes and 7 weights and the value need

std::string line(const Times& times, double targets, int each = 1) {
  const double scale = 1e6 / (targets * each);
  return fmt::format("{:9.4f} {:9.4f} {:9.4f}", times.median() * scale, times.best() * scale,
                     times.median_wall() * scale);
}

class Work {
 public:
  Work(const Mesh& source, const Targets& targets, const WorkOptions& options)
      : source_(source),
        targets_(targets),
        options_(options),
        comm_(source.comm),
        values_(sampled(source.coordinates, smooth_field)),
        linear_(sampled(source.coordinates, linear_field)),
        result_(targets.points.size()),
        others_(2, result_) {
    if (options_.vtk && comm_.size() == 1) rival_.emplace(source, source.coordinates);
  }

  void set_up() {
    for (int i = 0; i < options_.repeats; ++i) {
      map_.reset();
      map_ = set_up_.take(comm_, [&] { return interpolation(source_, source_.coordinates, targets_); });
      if (!rival_) continue;
      rival_map_ = {};
      rival_map_ = locate_.take(comm_, [&] { return rival_->locate(targets_.points); });
      if (options_.probe)
        probe_lost_ = probe_.take(comm_, [&] { return rival_->probe(targets_.points, values_, result_); });
    }
  }

  void apply() {
    const std::array<transfer::TransferItem, 3> three{
        {{values_, result_, 1}, {linear_, others_[0], 1}, {values_, others_[1], 1}}};
    map_->apply(three);
    for (int i = 0; i < options_.repeats; ++i) {
      repeat(apply_, [&] { map_->apply(values_, result_, 1); });
      repeat(apply_three_, [&] { map_->apply(three); });
      repeat(copy_, [&] { copy_once(); });
      if (rival_) repeat(rival_apply_, [&] { rival_map_.apply(values_, result_); });
    }
  }

  void print() {
    const double n = targets_.greatest_share();
    map_->apply(values_, result_, 1);
    const Errors smooth = errors_of(targets_, result_, smooth_field);
    const auto [outside, distance] = outside_of();
    map_->apply(linear_, result_, 1);
    const Errors linear = errors_of(targets_, result_, linear_field);
    const double bytes = static_cast<double>(comm_.sum(map_->memory())) / static_cast<double>(targets_.count);
    Errors theirs;
    if (rival_) {
      rival_map_.apply(linear_, result_);
      theirs = errors_of(targets_, result_, linear_field);
    }
    if (comm_.rank() > 0) return;
    fmt::print("  us per target of a rank        median      best      wall\n");
    fmt::print("  set-up                      {}\n", line(set_up_, n));
    if (rival_) {
      fmt::print("  VTK static locator          {}   ours / VTK {:.3f}\n", line(locate_, n),
                 set_up_.median() / locate_.median());
      if (options_.probe) fmt::print("  VTK probe filter, each call {}   lost {}\n", line(probe_, n), probe_lost_);
    }
    fmt::print("  apply, one field            {}\n", line(apply_, n, applies));
    fmt::print("  apply, each of three fields {}\n", line(apply_three_, n, 3 * applies));
    if (rival_) fmt::print("  VTK's weights kept, apply   {}\n", line(rival_apply_, n, applies));
    fmt::print("  copying {} bytes            {}\n", copied, line(copy_, n, applies));
    fmt::print("  {:.1f} bytes per target; outside {}, greatest distance {:.3g}\n", bytes, outside, distance);
    fmt::print("  errors: f_s {:.3e} max {:.3e} rms, f_l {:.2e} max\n", smooth.greatest, smooth.rms, linear.greatest);
    if (rival_) fmt::print("  VTK static locator: f_l {:.2e} max, lost {}\n", theirs.greatest, rival_map_.lost);
  }

 private:
  /// Collective. How many targets lie outside of the source, and how far.
  std::pair<GlobalId, double> outside_of() const {
    std::vector<transfer::PointStatus> status(targets_.points.size());
    std::vector<double> distance(status.size());
    map_->status(status, distance);
    GlobalId count = 0;
    double greatest = 0;
    for (const LocalIndex n : targets_.owned) {
      const auto i = static_cast<std::size_t>(n);
      if (status[i] != transfer::PointStatus::inside) ++count;
      greatest = std::max(greatest, distance[i]);
    }
    return {comm_.sum(count), comm_.max(greatest)};
  }

  /// Moves as many bytes per target.
  void copy_once() {
    const std::size_t half = copied / 2 * targets_.owned.size();
    if (from_.empty()) from_.resize(half, 1), to_.resize(half);
    std::memcpy(to_.data(), from_.data(), half);
  }

  template <typename Call>
  void repeat(Times& times, Call&& call) {
    times.take(comm_, [&] {
      for (int k = 0; k < applies; ++k) call();
      return 0;
    });
  }

  const Mesh& source_;
  const Targets& targets_;
  WorkOptions options_;
  Communicator comm_;
  std::vector<double> values_, linear_, result_;
  std::vector<std::vector<double>> others_;
  std::optional<VtkRival> rival_;
  std::unique_ptr<GridTransfer> map_;
  VtkMap rival_map_;
  std::size_t probe_lost_ = 0;
  std::vector<char> from_, to_;
  Times set_up_, locate_, probe_, copy_, apply_, apply_three_, rival_apply_;
};

}  // namespace

void run_work_case(const std::string& title, const Mesh& source, const Targets& targets, const WorkOptions& options) {
  if (source.comm.rank() == 0)
    fmt::print("{} -> {} {}, {} rank{}\n", title, targets.count, targets.name, source.comm.size(),
               source.comm.size() > 1 ? "s" : "");
  Work work(source, targets, options);
  work.set_up();
  work.apply();
  work.print();
}

}  // namespace tenon::bench
