// SPDX-License-Identifier: BSD-3-Clause
#include "framework/simulation/debris.hpp"

#include <fmt/core.h>

#include <utility>

namespace tenon {

namespace {

template <typename Part>
Part& part_of(Component& component, const std::string& link, const char* what) {
  if (auto* const part = dynamic_cast<Part*>(&component)) return *part;
  throw Error(ExitCode::usage,
              fmt::format("{}: component '{}' ({}) {}", link, component.name(), component.type(), what));
}

}  // namespace

DebrisLink::DebrisLink(std::string name, Component& source, std::string source_block, Component& target,
                       std::string target_block)
    : Coupling(std::move(name), source, target, CouplingSchedule::source_step),
      from_(part_of<DebrisSource>(source, this->name(), "has no elements that could fail")),
      to_(part_of<DebrisTarget>(target, this->name(), "has no particles that elements could become")),
      source_block_(std::move(source_block)),
      target_block_(std::move(target_block)) {
  const ElementBlock* const block = source.mesh().find_block(source_block_);
  if (!block)
    throw Error(ExitCode::usage,
                fmt::format("{}: component '{}' has no block '{}'", this->name(), source.name(), source_block_));
  const GlobalId waiting = to_.waiting(target_block_);
  if (waiting != block->global_count)
    throw Error(
        ExitCode::usage,
        fmt::format("{}: '{}' has {} elements, but '{}' {} particles; make these with a body of `type: elements`",
                    this->name(), source_block_, block->global_count, target_block_, waiting));
  from_.give_up(source_block_);
}

void DebrisLink::run() {
  if (!from_.has_debris(source_block_)) return;
  const ScopedTimer scoped(timer());
  const std::vector<Debris> debris = from_.take_debris(source_block_);
  for (const Debris& d : debris) ++count_, mass_.add(d.mass);
  to_.wake(target_block_, debris);
}

std::vector<std::string> DebrisLink::report() {
  const Communicator& comm = source().mesh().comm;
  return {fmt::format("{} elements of {}, {:.6g} kg, have become particles of {}", comm.sum(count_), source_block_,
                      comm.sum(mass_), target_block_)};
}

std::vector<std::pair<std::string, ExactSum>> DebrisLink::amounts() {
  ExactSum count;
  count.add(static_cast<double>(count_));
  return {{name() + "_elements", count}, {name() + "_mass", mass_}};
}

void DebrisLink::save(CheckpointWriter& file) {
  const Communicator& comm = source().mesh().comm;
  file.integer(name() + ".elements", comm.sum(count_));
  file.scalar(name() + ".mass", comm.sum(mass_));
}

void DebrisLink::load(const CheckpointReader& file) {
  const std::int64_t count = file.integer(name() + ".elements");
  const double mass = file.scalar(name() + ".mass");
  if (source().mesh().comm.rank() != 0) return;
  count_ = count;
  mass_.add(mass);
}

}  // namespace tenon
