// SPDX-License-Identifier: BSD-3-Clause
// Grid transfer: set-up, application, memory and errors, with VTK's own probe in the same run, turn by turn.
//   transfer_bench [uniform|outside|graded|moving|methods ...] [--large] [--repeats N] [--no-probe] [--no-vtk]
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include "hard_cases.hpp"
#include "work_case.hpp"
#include "work_error.hpp"

namespace tenon::bench {

namespace {

struct Arguments {
  std::vector<std::string> parts{"uniform"};
  bool large = false;
  int finest = 64;
  std::string csv = "transfer.csv";
  WorkOptions work;
};

/// n^3 hexahedra to the nodes of about (1.25 n)^3, and to a million random points.
void uniform(int n, int m, const WorkOptions& options) {
  const auto source = cube(n, 1);
  const std::string title = fmt::format("{}^3 distorted hexahedra", n);
  run_work_case(title, *source, nodes_of(fmt::format("nodes of {}^3", m), cube(m, 2, {.slabs = Slabs::y})), options);
  run_work_case(title, *source, random_points(1'000'000, 3), options);
}

void run(const Arguments& arguments) {
  const int n = arguments.large ? 100 : 64, m = arguments.large ? 126 : 80, repeats = arguments.work.repeats;
  for (const std::string& part : arguments.parts) {
    if (part == "uniform") uniform(n, m, arguments.work);
    if (part == "outside") run_pushed_out();
    if (part == "graded") run_graded(n, m, repeats, arguments.work.vtk);
    if (part == "moving") run_moving(n, m, repeats);
    if (part == "methods") run_work_error(arguments.finest, arguments.csv);
  }
}

}  // namespace

}  // namespace tenon::bench

int main(int argc, char** argv) {
  tenon::MpiEnvironment environment(argc, argv);
  tenon::bench::Arguments arguments;
  CLI::App app("Times grid transfer.");
  app.add_option("part", arguments.parts, "what to time")
      ->check(CLI::IsMember({"uniform", "outside", "graded", "moving", "methods"}));
  app.add_flag("--large", arguments.large, "100^3 and 126^3 instead of 64^3 and 80^3");
  app.add_option("--repeats", arguments.work.repeats)->check(CLI::PositiveNumber);
  app.add_flag("!--no-probe", arguments.work.probe, "leave VTK's probe filter out");
  app.add_flag("!--no-vtk", arguments.work.vtk, "leave VTK out");
  app.add_option("--finest", arguments.finest, "methods: the last of 8, 16 ... elements along a side");
  app.add_option("--csv", arguments.csv, "methods: file to write");
  CLI11_PARSE(app, argc, argv);
  tenon::bench::run(arguments);
  return 0;
}
