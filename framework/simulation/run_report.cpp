// SPDX-License-Identifier: BSD-3-Clause
#include "framework/simulation/run_report.hpp"

#include <sys/resource.h>

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

namespace tenon {

namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> names_of_root(const Communicator& comm, const std::vector<std::string>& mine) {
  std::string joined;
  for (const std::string& name : mine) joined += name + '\n';
  comm.broadcast(joined);
  std::vector<std::string> names;
  std::istringstream lines(joined);
  for (std::string name; std::getline(lines, name);) names.push_back(name);
  return names;
}

double sum_of(const Communicator& comm, double mine) {
  ExactSum sum;
  sum.add(mine);
  return comm.sum(sum);
}

Json phases(Simulation& simulation, double wall) {
  std::vector<std::string> mine;
  for (const PhaseTimer& phase : simulation.timers().phases()) mine.push_back(phase.name);
  Json rows = Json::array();
  for (const std::string& name : names_of_root(simulation.comm(), mine)) {
    const PhaseTimer& phase = simulation.timers().phase(name);
    const double greatest = simulation.comm().max(phase.seconds);
    const double mean = sum_of(simulation.comm(), phase.seconds) / simulation.comm().size();
    rows.push_back({{"phase", name},
                    {"seconds", mean},
                    {"share", wall > 0 ? mean / wall : 0.0},
                    {"imbalance", mean > 0 ? greatest / mean : 1.0},
                    {"calls", simulation.comm().max(phase.calls)}});
  }
  return rows;
}

Json exchanges(const Communicator& comm) {
  std::vector<std::string> mine;
  for (const ExchangeCount& count : comm.counts()) mine.push_back(count.name);
  Json rows = Json::array();
  for (const std::string& name : names_of_root(comm, mine)) {
    const ExchangeCount& count = comm.count(name);
    rows.push_back({{"exchange", name},
                    {"calls", comm.max(count.calls)},
                    {"messages", comm.sum(count.messages)},
                    {"bytes", comm.sum(count.bytes)}});
  }
  return rows;
}

Json skips(Simulation& simulation) {
  Json rows = Json::array();
  for (const auto& component : simulation.components())
    for (const SkipCount& skip : component->skips())
      rows.push_back({{"component", component->name()}, {"what", skip.what}, {"times", skip.times}});
  for (const auto& interaction : simulation.interactions())
    for (const SkipCount& skip : interaction->skips())
      rows.push_back({{"component", interaction->name()}, {"what", skip.what}, {"times", skip.times}});
  if (simulation.comm().size() == 1)
    rows.push_back({{"component", "all"}, {"what", "messages (one rank)"}, {"times", simulation.steps()}});
  return rows;
}

Json components(Simulation& simulation) {
  Json rows = Json::array();
  for (const auto& component : simulation.components())
    rows.push_back({{"name", component->name()},
                    {"type", component->type()},
                    {"nodes", component->mesh().global_nodes},
                    {"elements", component->mesh().global_elements},
                    {"time", component->time()},
                    {"state_bytes", simulation.comm().sum(component->memory())},
                    {"element_steps", simulation.comm().sum(component->work_done())}});
  return rows;
}

Json energies(Simulation& simulation) {
  Json rows = Json::object();
  const LedgerSnapshot ledger = simulation.ledger().take();
  const std::vector<std::string> names = simulation.ledger().columns();
  for (std::size_t i = 0; i < names.size(); ++i) rows[names[i]] = ledger.rows[i].value;
  rows["energy_error"] = ledger.error;
  return rows;
}

void print(Log& log, const Json& summary) {
  log.print("\n{:<34} {:>9} {:>7} {:>9} {:>9}", "phase", "seconds", "share", "max/mean", "calls");
  for (const Json& row : summary["phases"])
    log.print("{:<34} {:>9.3f} {:>6.1f}% {:>9.2f} {:>9}", row["phase"].get<std::string>(), row["seconds"].get<double>(),
              100 * row["share"].get<double>(), row["imbalance"].get<double>(), row["calls"].get<std::int64_t>());
  if (!summary["exchanges"].empty())
    log.print("\n{:<34} {:>9} {:>11} {:>13}", "exchange", "calls", "messages", "bytes");
  for (const Json& row : summary["exchanges"])
    log.print("{:<34} {:>9} {:>11} {:>13}", row["exchange"].get<std::string>(), row["calls"].get<std::int64_t>(),
              row["messages"].get<std::int64_t>(), row["bytes"].get<std::int64_t>());
  if (!summary["skipped"].empty()) log.print("\n{:<54} {:>9}", "skipped because the scene did not need it", "times");
  for (const Json& row : summary["skipped"])
    log.print("{:<54} {:>9}", row["component"].get<std::string>() + ": " + row["what"].get<std::string>(),
              row["times"].get<std::int64_t>());
  log.print("\n{} ranks, {} steps, {:.2f} s, peak memory {:.0f} MiB (greatest rank {:.0f} MiB), ledger error {:.1e}",
            summary["ranks"].get<int>(), summary["steps"].get<std::int64_t>(), summary["wall_seconds"].get<double>(),
            static_cast<double>(summary["peak_memory_bytes"].get<std::int64_t>()) / 1048576.0,
            static_cast<double>(summary["peak_memory_greatest_rank_bytes"].get<std::int64_t>()) / 1048576.0,
            summary["greatest_energy_error"].get<double>());
}

}  // namespace

std::int64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::int64_t>(usage.ru_maxrss) * 1024;
}

void report_run(Simulation& simulation, const RunFacts& facts, const std::string& path) {
  const Communicator& comm = simulation.comm();
  Json summary{{"title", facts.title},
               {"scene", facts.scene},
               {"version", facts.version},
               {"end", facts.end},
               {"ranks", comm.size()},
               {"steps", simulation.steps()},
               {"time", simulation.time()},
               {"wall_seconds", facts.wall_seconds},
               {"greatest_energy_error", facts.greatest_energy_error},
               {"peak_memory_bytes", comm.sum(peak_memory())},
               {"peak_memory_greatest_rank_bytes", comm.max(peak_memory())}};
  summary["energies"] = energies(simulation);
  summary["components"] = components(simulation);
  Json transfers = Json::array();
  for (const auto& coupling : simulation.couplings())
    transfers.push_back({{"name", coupling->name()}, {"runs", coupling->runs()}, {"report", coupling->report()}});
  summary["transfers"] = transfers;
  Json interactions = Json::array();
  for (const auto& interaction : simulation.interactions())
    interactions.push_back({{"name", interaction->name()}, {"report", interaction->report()}});
  summary["interactions"] = interactions;
  summary["skipped"] = skips(simulation);
  summary["phases"] = phases(simulation, facts.wall_seconds);
  summary["exchanges"] = exchanges(comm);
  print(simulation.log(), summary);
  comm.vote_on_root([&] {
    const std::string aside = path + ".part";
    std::ofstream(aside) << summary.dump(2) << '\n';
    if (std::rename(aside.c_str(), path.c_str()) != 0) throw Error(ExitCode::file, path + ": cannot be written");
  });
}

}  // namespace tenon
