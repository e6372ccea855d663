// SPDX-License-Identifier: BSD-3-Clause
// Which element limits the step or has gone bad, in words; the same from every rank.
#include <fmt/core.h>

#include <cmath>
#include <limits>

#include "components/mechanics/mechanics.hpp"

namespace tenon {

namespace {

constexpr GlobalId none = std::numeric_limits<GlobalId>::max();

Vec3 centre(std::span<const LocalIndex> nodes, std::span<const Vec3> x) {
  Vec3 sum{};
  for (const LocalIndex n : nodes) sum = sum + x[static_cast<std::size_t>(n)];
  return (1 / static_cast<double>(nodes.size())) * sum;
}

}  // namespace

std::string Mechanics::describe(const ElementGroup& group, LocalIndex element) const {
  const ElementBlock& b = group.elements();
  const Vec3 now = centre(b.nodes(element), nodes_.position()), start = centre(b.nodes(element), mesh_->coordinates);
  const std::string place = std::isfinite(now[0] + now[1] + now[2])
                                ? fmt::format("at ({:.6g}, {:.6g}, {:.6g})", now[0], now[1], now[2])
                                : "at no finite place";
  return fmt::format("element {} of block {} {}, initially at ({:.6g}, {:.6g}, {:.6g})",
                     b.labels[static_cast<std::size_t>(element)], b.name, place, start[0], start[1], start[2]);
}

StepLimiter Mechanics::limiter() {
  const Communicator& comm = mesh_->comm;
  const bool mine = local_least_.element != no_index && local_least_.step == estimate_;
  const GlobalId least = comm.min(mine ? global_id(*groups_[local_least_group_], local_least_.element) : none);
  const bool here = mine && global_id(*groups_[local_least_group_], local_least_.element) == least;
  const int root = static_cast<int>(comm.min(static_cast<std::int64_t>(here ? comm.rank() : comm.size())));
  std::string reason = "no element";
  if (root < comm.size()) {
    if (comm.rank() == root) reason = describe(*groups_[local_least_group_], local_least_.element);
    comm.broadcast(reason, root);
  }
  const TimeStepOptions& options = options_.time_step;
  const double step = short_step(limit_), with_loads = loads_->stable_step(limit_);
  if (options.fixed)
    reason = fmt::format("time_step.fixed ({:.3g} of the step of {})", step / limit_, reason);
  else if (options.maximum && step == *options.maximum)
    reason = "time_step.maximum";
  else if (step == rigid_->stable_step())
    reason = "the spin of a rigid body";
  else if (with_loads < limit_)
    reason = fmt::format("springs, dashpots or damping ({:.3g} of the step without them, that of {})",
                         with_loads / limit_, reason);
  else if (limit_ > estimate_)
    reason = fmt::format("the whole mesh ({:.3g} times the step that {} allows alone)", limit_ / estimate_, reason);
  if (short_steps() > 1) reason = fmt::format("{} subcycled steps; {}", short_steps(), reason);
  return {stable_step_, reason};
}

// The reduction of the stable step has found the code; the element with it that has the least id is named.
void Mechanics::fail(double code) {
  const Communicator& comm = mesh_->comm;
  GlobalId first = none;
  std::string message;
  ExitCode exit = code == inverted_element ? ExitCode::geometry : ExitCode::unstable;
  if (local_least_.step == code) {
    const ElementGroup& group = *groups_[local_least_group_];
    const LocalIndex e = local_least_.element;
    const double volume = group.volume(e, nodes_.position());
    first = global_id(group, e);
    std::string what =
        fmt::format("allows only a time step of {:.3g} s, {:.1e} of the first one: the step has collapsed", code,
                    code / first_estimate_);
    if (code == inverted_element)
      what = fmt::format("is inside out (volume {:.3g} m^3): the deformation is too large for the mesh", volume);
    else if (code == exploding_element && std::isfinite(volume))
      what = fmt::format("deforms by more than {:g} in one step: the run is unstable, use a smaller time step",
                         greatest_strain);
    else if (code == exploding_element)
      what = "has lost its numbers (not a number): the run is unstable, use a smaller time step";
    message = fmt::format("{}: {} {} at t = {:.6g} s (step {})", name(), describe(group, e), what, time(), steps_);
  }
  if (previous_dt_ > 1.05 * last_good_ && last_good_ > 0) {
    exit = ExitCode::unstable;
    message += fmt::format("; the last step was {:.3g} times the stable one: check time_step.fixed and time_step.scale",
                           previous_dt_ / last_good_);
  }
  const GlobalId lowest = comm.min(first);
  comm.throw_if_any(first == lowest && first != none ? std::optional<Error>(Error(exit, message)) : std::nullopt);
  throw Error(exit, fmt::format("{}: an element has gone bad at t = {:.6g} s", name(), time()));
}

}  // namespace tenon
