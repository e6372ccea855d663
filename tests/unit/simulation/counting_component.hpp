// SPDX-License-Identifier: BSD-3-Clause
// A component without physics that notes what it is asked to do.
#pragma once

#include <limits>
#include <vector>

#include "framework/simulation/coupling.hpp"
#include "tests/support/test_communicator.hpp"

namespace tenon::testing {

class CountingComponent : public Component {
 public:
  CountingComponent(std::string name, double limit)
      : Component(std::move(name)), limit_(limit), mesh_(communicator()) {}

  std::string_view type() const override { return "counting"; }
  const Mesh& mesh() const override { return mesh_; }
  void initialize() override { ++initialized; }
  double time_step() override { return limit_; }
  StepLimiter limiter() override { return {limit_, "a constant"}; }
  bool ends_step(double now) override { return now >= hurry; }
  void advance(double dt) override {
    steps.push_back(dt);
    set_time(time() + dt);
    energy += dt;
  }
  std::vector<ExportPort> exports() override { return {}; }
  std::vector<ImportPort> imports() override { return {}; }
  std::span<const Vec3> current_coordinates() const override { return mesh_.coordinates; }
  // One joule per second on rank 0, out of a source that is booked too, less `leak`.
  void energies(std::vector<EnergyTerm>& terms) override {
    EnergyTerm stored{"stored_energy", EnergyTerm::Role::stored, {}},
        supplied{"supplied_energy", EnergyTerm::Role::supplied, {}};
    if (communicator().rank() == 0) {
      stored.local.add(5 + energy - leak);
      supplied.local.add(energy);
    }
    terms.push_back(stored);
    terms.push_back(supplied);
  }
  void save(CheckpointWriter& file) override { file.scalar(name() + ".energy", energy); }
  void load(const CheckpointReader& file) override { energy = file.scalar(name() + ".energy"); }
  std::int64_t work_done() const override { return static_cast<std::int64_t>(steps.size()); }
  std::int64_t memory() const override { return 0; }

  double limit_, energy = 0, leak = 0;
  double hurry = std::numeric_limits<double>::infinity();  // from this time on no step is worth waiting for
  int initialized = 0;
  std::vector<double> steps;

 private:
  Mesh mesh_;
};

/// Notes at which clocks it ran.
class CountingCoupling : public Coupling {
 public:
  using Coupling::Coupling;
  void initialize() override {}
  void run() override { clocks.emplace_back(source().time(), target().time()); }
  bool runs_at_start() const override { return true; }
  std::vector<std::string> report() override { return {}; }
  void save(CheckpointWriter&) override {}
  void load(const CheckpointReader&) override {}
  std::int64_t memory() const override { return 0; }
  std::vector<std::pair<double, double>> clocks;
};

}  // namespace tenon::testing
