// SPDX-License-Identifier: BSD-3-Clause
#include "can_bench.hpp"

#include <fmt/core.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <memory>

#include "../transfer/bench_clock.hpp"
#include "components/contact/contact.hpp"
#include "contact_bodies.hpp"
#include "framework/simulation/simulation.hpp"

namespace tenon::bench {

namespace {

const std::map<std::string, SearchDecomposition> decompositions{{"rcb", SearchDecomposition::rcb},
                                                                {"slices", SearchDecomposition::slices},
                                                                {"owner_boxes", SearchDecomposition::owner_boxes}};
constexpr std::array phase_names{"check", "search", "share out", "touch", "solve", "exchange"};

struct CanOptions {
  CrushedCan can;
  int steps = 600, windows = 6;
  SearchDecomposition decomposition = SearchDecomposition::rcb;
};

/// A scene that steps, and what it has counted so far.
class Run {
 public:
  Run(MeshData&& mesh, const MechanicsOptions& options, const ContactOptions* contact)
      : simulation_(comm(), log_, 0, 1) {
    auto body = std::make_unique<Mechanics>("body", distribute(comm(), std::move(mesh), {}), options);
    Mechanics* const added = body.get();
    simulation_.add(std::move(body));
    if (contact)
      contact_ = static_cast<Contact*>(
          &simulation_.add(std::make_unique<Contact>("contact", comm(), std::vector<Component*>{added}, *contact)));
    simulation_.initialize();
  }
  static Communicator comm() { return Communicator::world(); }
  void steps(int count) {
    for (int i = 0; i < count; ++i) simulation_.step();
  }
  Contact& contact() { return *contact_; }
  /// Seconds of each of the phases of contact on this rank so far.
  std::array<double, phase_names.size()> seconds() {
    std::array<double, phase_names.size()> all{};
    for (std::size_t p = 0; p < all.size(); ++p)
      for (const PhaseTimer& phase : simulation_.timers().phases())
        if (phase.name == std::string("contact: ") + phase_names[p]) all[p] = phase.seconds;
    return all;
  }
  std::int64_t count(const std::string& column) {
    for (const auto& [name, share] : contact_->amounts())
      if (name == column) return std::llround(comm().sum(share));
    return 0;
  }

 private:
  Log log_{false};
  Simulation simulation_;
  Contact* contact_ = nullptr;
};

void run_can(const CanOptions& options) {
  const Communicator comm = Run::comm();
  MeshData mesh = comm.rank() == 0 ? make_mesh(options.can) : MeshData{};
  const auto elements = static_cast<std::int64_t>(mesh.elements());
  ContactOptions contact;
  contact.decomposition = options.decomposition;
  Run run(std::move(mesh), options_of(options.can), &contact);
  const std::int64_t all_elements = comm.max(elements);
  if (comm.rank() == 0) {
    fmt::print("{} elements; ms of a step (slowest rank) and % of it\n{:>6} {:>8} {:>7} |", all_elements, "steps",
               "ms/step", "contact");
    for (const char* name : phase_names) fmt::print(" {:>9}", name);
    fmt::print(" | {:>8} {:>7} {:>7} | {:>7} {:>7}\n", "searches", "pairs", "iter.", "search", "enforce");
  }
  Times times;
  auto before = run.seconds();
  std::int64_t searches = 0, search_work = 0, enforcement_work = 0, iterations = 0;
  const auto ratio = [&](std::int64_t work) { return imbalance(comm, static_cast<double>(work)); };
  for (int w = 0; w < options.windows; ++w) {
    const int steps = options.steps / options.windows;
    times.take(comm, [&] { return run.steps(steps), 0; });
    const auto now = run.seconds();
    double all = 0;
    std::array<double, phase_names.size()> share{};
    for (std::size_t p = 0; p < now.size(); ++p) {
      share[p] = comm.max(now[p] - before[p]) / times.wall.back();
      all += share[p];
    }
    before = now;
    Contact& c = run.contact();
    const double search = ratio(c.search_work() - search_work),
                 enforce = ratio(c.enforcement_work() - enforcement_work);
    const std::int64_t pairs = run.count("contact_pairs");
    if (comm.rank() == 0) {
      fmt::print("{:6} {:8.1f} {:6.1f}% |", steps * (w + 1), 1e3 * times.wall.back() / steps, 100 * all);
      for (const double s : share) fmt::print(" {:8.1f}%", 100 * s);
      fmt::print(" | {:8} {:7} {:7.1f} | {:7.3f} {:7.3f}\n", c.searches() - searches, pairs,
                 static_cast<double>(c.iterations() - iterations) / steps, search, enforce);
    }
    searches = c.searches(), search_work = c.search_work(), enforcement_work = c.enforcement_work();
    iterations = c.iterations();
  }
}

struct ApartOptions {
  int n = 64, steps = 10, repeats = 15;
};

// Runs of both alternate, so that the load of the machine meets both alike.
void run_apart(const ApartOptions& options) {
  const Communicator comm = Run::comm();
  const auto mesh = [&] { return comm.rank() == 0 ? two_blocks(options.n) : MeshData{}; };
  const ContactOptions contact;
  Run with(mesh(), options_of_blocks(), &contact), without(mesh(), options_of_blocks(), nullptr);
  Times with_times, without_times;
  const std::int64_t first = with.contact().searches();
  const auto check = with.seconds();
  for (int r = 0; r < options.repeats; ++r) {
    if (r % 2 == 0) with_times.take(comm, [&] { return with.steps(options.steps), 0; });
    without_times.take(comm, [&] { return without.steps(options.steps), 0; });
    if (r % 2 == 1) with_times.take(comm, [&] { return with.steps(options.steps), 0; });
  }
  double phases = 0, wall = 0;
  for (std::size_t p = 0; p < check.size(); ++p) phases += with.seconds()[p] - check[p];
  for (const double w : with_times.wall) wall += w;
  if (comm.rank() != 0) return;
  const double scale = 1e3 / options.steps;
  fmt::print(
      "ms per step: with contact {:.3f} (best {:.3f}), without {:.3f} (best {:.3f}): {:+.2f} % (best {:+.2f} %)\n",
      scale * with_times.median(), scale * with_times.best(), scale * without_times.median(),
      scale * without_times.best(), 100 * (with_times.median() / without_times.median() - 1),
      100 * (with_times.best() / without_times.best() - 1));
  fmt::print("phases of contact: {:.2f} % of the step; {} searches in {} steps\n", 100 * phases / wall,
             with.contact().searches() - first, options.steps * options.repeats);
}

}  // namespace

void add_can(CLI::App& app) {
  auto options = std::make_shared<CanOptions>();
  CLI::App* const can = app.add_subcommand("can", "contact in the step of a can that an inclined wall crushes");
  can->add_option("--elements", options->can.elements, "about")->check(CLI::PositiveNumber);
  can->add_option("--layers", options->can.layers, "hexahedra through the wall; 0: shells")->check(CLI::Range(0, 4));
  can->add_option("--speed", options->can.speed, "of the wall, m/s")->check(CLI::PositiveNumber);
  can->add_option("--steps", options->steps)->check(CLI::PositiveNumber);
  can->add_option("--windows", options->windows, "lines of the table")->check(CLI::PositiveNumber);
  can->add_option("--decomposition", options->decomposition)->transform(CLI::CheckedTransformer(decompositions));
  can->callback([options] { run_can(*options); });
}

void add_apart(CLI::App& app) {
  auto options = std::make_shared<ApartOptions>();
  CLI::App* const apart = app.add_subcommand("apart", "two blocks that never meet, with and without contact");
  apart->add_option("--n", options->n, "elements along an edge")->check(CLI::Range(2, 1000));
  apart->add_option("--steps", options->steps, "of a run")->check(CLI::PositiveNumber);
  apart->add_option("--repeats", options->repeats)->check(CLI::PositiveNumber);
  apart->callback([options] { run_apart(*options); });
}

}  // namespace tenon::bench
