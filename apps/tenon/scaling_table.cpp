// SPDX-License-Identifier: BSD-3-Clause
#include "apps/tenon/scaling_table.hpp"

#include <algorithm>
#include <fstream>

#include "framework/base/error.hpp"

namespace tenon {

namespace {

double balance(const PhaseTime& t) {
  return t.work_mean > 0 ? t.work_max / t.work_mean : 1;
}

std::vector<std::string> groups(const std::vector<StepLoads>& steps) {
  std::vector<std::string> names;
  for (const StepLoads& step : steps)
    for (const PhaseLoad& phase : step.phases)
      if (std::ranges::find(names, phase.group) == names.end()) names.push_back(phase.group);
  return names;
}

double seconds_of(const StepLoads& step, const std::string& group, const Machine& machine) {
  double sum = 0;
  for (const PhaseLoad& phase : step.phases)
    if (group.empty() || phase.group == group) sum += predict(phase, machine).seconds;
  return sum;
}

}  // namespace

void print_step(Log& log, const StepLoads& step, const Machine& machine) {
  log.print("\n{} ranks ({}), machine {}", step.ranks, step.decomposition, machine.name);
  log.print("{:<30} {:>11} {:>11} {:>8} {:>9} {:>10} {:>7} {:>11} {:>11}", "phase", "max work", "mean work", "max/mean",
            "messages", "kB", "reduce", "computing s", "seconds");
  for (const PhaseLoad& phase : step.phases) {
    const PhaseTime t = predict(phase, machine);
    log.print("{:<30} {:>11.4g} {:>11.4g} {:>8.3f} {:>9.2f} {:>10.3f} {:>7.2f} {:>11.3e} {:>11.3e}", phase.phase,
              t.work_max, t.work_mean, balance(t), t.messages, 1e-3 * t.bytes, phase.reductions, t.computing,
              t.seconds);
  }
}

void print_speed_up(Log& log, const std::vector<StepLoads>& steps, const Machine& machine) {
  const std::vector<std::string> names = groups(steps);
  std::string header = fmt::format("{:>6} {:<8}", "ranks", "");
  for (const std::string& name : names) header += fmt::format(" {:>16}", name);
  log.print("\nseconds per step and speed-up, machine {}: {}", machine.name, machine.source);
  log.line(header + fmt::format(" {:>11} {:>9} {:>11}", "total", "speed-up", "efficiency"));
  for (const StepLoads& step : steps) {
    const auto first =
        std::ranges::find_if(steps, [&](const StepLoads& s) { return s.decomposition == step.decomposition; });
    std::string row = fmt::format("{:>6} {:<8}", step.ranks, step.decomposition);
    for (const std::string& name : names) {
      const double seconds = seconds_of(step, name, machine), before = seconds_of(*first, name, machine);
      row += fmt::format(" {:>9.3e} {:>6.2f}", seconds, seconds > 0 ? before / seconds : 1.0);
    }
    const double total = seconds_of(step, "", machine), speed = seconds_of(*first, "", machine) / total;
    log.line(row +
             fmt::format(" {:>11.4e} {:>9.2f} {:>10.1f}%", total, speed, 100 * speed * first->ranks / step.ranks));
  }
}

void write_scaling(const std::string& path, const std::vector<StepLoads>& steps, const std::vector<Machine>& machines) {
  std::ofstream file(path);
  file << "machine,decomposition,ranks,group,phase,work_max,work_mean,work_whole,messages,bytes,reductions,computing_s,"
          "seconds\n";
  for (const Machine& machine : machines)
    for (const StepLoads& step : steps)
      for (const PhaseLoad& phase : step.phases) {
        const PhaseTime t = predict(phase, machine);
        file << fmt::format("{},{},{},{},{},{:.8g},{:.8g},{:.8g},{:.6g},{:.8g},{:.6g},{:.6e},{:.6e}\n", machine.name,
                            step.decomposition, step.ranks, phase.group, phase.phase, t.work_max, t.work_mean,
                            phase.whole, t.messages, t.bytes, phase.reductions, t.computing, t.seconds);
      }
  if (!file.flush()) throw Error(ExitCode::file, path + ": cannot be written");
}

}  // namespace tenon
