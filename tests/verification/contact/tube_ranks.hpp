// SPDX-License-Identifier: BSD-3-Clause
// A tube that crumples on itself and loses elements: the same bits on all ranks and on one, with every skip forced off,
// and through a restart on another number of ranks.
#pragma once

#include <filesystem>

#include "tube_case.hpp"

namespace tenon::testing {

/// What a run ends with; on rank 0 of its communicator.
struct Ending {
  std::map<std::string, std::vector<double>> fields;
  std::map<std::string, double> rows;
  double time = 0;
  std::int64_t steps = 0;
};

inline Ending ending_of(ContactRun& run) {
  Ending e;
  for (const char* name : {"displacement", "velocity", "eqps", "element_status"})
    e.fields[name] = in_global_order(run.body(), name);
  for (const char* row :
       {"kinetic_energy", "internal_energy", "contact_energy", "friction_energy", "contact_dissipation"})
    e.rows[row] = run.row(row);
  e.rows["force"] = run.force("tube_striker")[2], e.rows["impulse"] = run.impulse("tube_striker")[2];
  e.time = run.time(), e.steps = run.simulation().steps();
  return e;
}

inline void expect_same(const Ending& a, const Ending& b, const std::string& what) {
  EXPECT_EQ(a.steps, b.steps) << what;
  EXPECT_EQ(a.time, b.time) << what;
  EXPECT_EQ(a.rows, b.rows) << what;
  for (const auto& [name, values] : a.fields) expect_same_bits(values, b.fields.at(name), what + ": " + name);
}

inline void check_tube(const Tube& tube) {
  // Of this tube: the short and the long test may run side by side.
  const std::string file =
      "contact_tube_" + std::to_string(tube.around) + "_" + std::to_string(communicator().size()) + ".h5";
  const ContactScene scene = crush(tube);
  ContactRun run(scene);
  bool saved = false;
  run.run(scene.end, [&] {
    if (!saved && run.time() > 0.5 * scene.end) run.save(file), saved = true;
  });
  const Ending all = ending_of(run);
  EXPECT_LE(run.momentum_residual(), 1e-13);
  EXPECT_LE(run.ledger_error(), 1e-11);
  communicator().barrier();
  if (communicator().rank() == 0) {
    double dead = 0;
    for (const double alive : all.fields.at("element_status")) dead += 1 - alive;
    std::printf("tube: %lld steps, %g elements eroded, friction %.3f J\n", static_cast<long long>(all.steps), dead,
                all.rows.at("friction_energy"));
    EXPECT_GT(dead, 0);
    EXPECT_GT(all.rows.at("friction_energy"), 0);
    ContactRun alone(scene, Communicator::self());
    alone.run(scene.end);
    expect_same(all, ending_of(alone), "one rank");
    ContactRun continued(scene, Communicator::self(), file);
    continued.run(scene.end);
    expect_same(all, ending_of(continued), "restart on one rank");
  }
  communicator().barrier();
  ContactRun restarted(scene, communicator(), file);
  restarted.run(scene.end);
  const Ending again = ending_of(restarted);
  if (communicator().rank() == 0) expect_same(all, again, "restart");
  ContactScene always = scene;
  always.contact.always_search = true;
  always.contact.least_work = 30;  // first on one rank, then on more
  ContactRun searched(always);
  searched.run(scene.end);
  const Ending every_step = ending_of(searched);
  if (communicator().rank() == 0) expect_same(all, every_step, "always_search, enforced on few ranks");
  communicator().barrier();
  if (communicator().rank() == 0) std::filesystem::remove(file);
}

}  // namespace tenon::testing
