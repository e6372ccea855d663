// SPDX-License-Identifier: BSD-3-Clause
#include "apps/tenon/trial_steps.hpp"

#include <sys/resource.h>

#include <chrono>
#include <limits>

#include "components/contact/contact.hpp"
#include "components/sph/sph.hpp"

namespace tenon {

namespace {

constexpr double trial_seconds = 1.0;
constexpr std::int64_t greatest_trial_steps = 200;

double processor_time() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// What components have counted since their start.
std::map<std::string, double> counted(const Simulation& simulation) {
  std::map<std::string, double> counts;
  for (const auto& component : simulation.components())
    if (auto* const sph = dynamic_cast<Sph*>(component.get())) {
      const DecompositionCounts& c = sph->decomposition().counts();
      counts[sph->name() + ": renewals"] = static_cast<double>(c.renewals);
      counts[sph->name() + ": refreshes"] = static_cast<double>(c.refreshes);
      counts[sph->name() + ": home"] = static_cast<double>(sph->times_home());
      counts[sph->name() + ": back"] = static_cast<double>(sph->times_back());
      counts[sph->name() + ": refreshed"] = static_cast<double>(c.refreshed);
    }
  for (const auto& interaction : simulation.interactions())
    if (auto* const contact = dynamic_cast<Contact*>(interaction.get())) {
      counts[contact->name() + ": searches"] = static_cast<double>(contact->searches());
      counts[contact->name() + ": iterations"] = static_cast<double>(contact->iterations());
      counts[contact->name() + ": visits"] = static_cast<double>(contact->enforcement_work());
      counts[contact->name() + ": looks"] = static_cast<double>(contact->looks());
      counts[contact->name() + ": pairs that press"] = static_cast<double>(contact->pressing());
    }
  return counts;
}

std::map<std::string, double> seconds_of_phases(Simulation& simulation) {
  std::map<std::string, double> seconds;
  for (const PhaseTimer& phase : simulation.timers().phases()) seconds[phase.name] = phase.seconds;
  return seconds;
}

double mean(const Communicator& comm, double mine) {
  ExactSum sum;
  sum.add(mine);
  return comm.sum(sum) / comm.size();
}

}  // namespace

Trial try_steps(Simulation& simulation, const TrialOptions& options) {
  const Communicator& comm = simulation.comm();
  for (std::int64_t k = 0; k < options.after && !simulation.done(); ++k) simulation.step();
  while (simulation.time() < options.until && !simulation.done()) simulation.step();
  const auto start = std::chrono::steady_clock::now();
  const double processor_start = processor_time();
  const auto elapsed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  const auto counts = counted(simulation), seconds = seconds_of_phases(simulation);
  const std::int64_t most = options.end > 0     ? std::numeric_limits<std::int64_t>::max()
                            : options.steps > 0 ? options.steps
                                                : greatest_trial_steps;
  Trial trial;
  for (; trial.steps < most && !simulation.done(); ++trial.steps) {
    if (options.end > 0 && simulation.time() >= options.end) break;
    if (options.steps == 0 && options.end <= 0 && comm.max(elapsed()) > trial_seconds) break;
    simulation.step();
  }
  if (trial.steps == 0) return trial;
  const auto steps = static_cast<double>(trial.steps);
  const double wall = elapsed(), processor = processor_time() - processor_start;
  trial.seconds = comm.max(wall) / steps;
  trial.processor_seconds = comm.max(processor) / steps;
  // The timers follow the clock, which runs while others have the processor.
  const double share = wall > 0 ? std::min(1.0, processor / wall) : 1.0;
  for (const auto& [name, value] : seconds_of_phases(simulation)) {
    const auto before = seconds.find(name);
    trial.phases[name] = mean(comm, share * (value - (before == seconds.end() ? 0.0 : before->second)) / steps);
  }
  for (const auto& [name, value] : counted(simulation)) {
    const auto before = counts.find(name);
    trial.counts[name] = (value - (before == counts.end() ? 0.0 : before->second)) / steps;
  }
  return trial;
}

}  // namespace tenon
