// SPDX-License-Identifier: BSD-3-Clause
// The scene runner: command line in, exit code out.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <functional>

#include "apps/tenon/commands.hpp"
#include "apps/tenon/scene_schema.hpp"
#include "framework/io/pictures.hpp"

namespace {

using tenon::Communicator;
using tenon::Error;
using tenon::ExitCode;

/// Runs a command on all ranks; one message, from rank 0, if it fails.
int guarded(int& argc, char**& argv, const std::function<ExitCode(const Communicator&)>& command) {
  const tenon::MpiEnvironment environment(argc, argv);
  const Communicator comm = Communicator::world();
  try {
    return static_cast<int>(command(comm));
  } catch (const Error& error) {
    if (comm.rank() == 0) std::fprintf(stderr, "%s\n", error.what());
    return static_cast<int>(error.code());
  }
}

void add_scene_options(CLI::App& command, tenon::RunArguments& arguments) {
  command.add_option("scene", arguments.scene, "Scene file (YAML)")->required();
  command.add_option("--set", arguments.settings, "Change a value of the scene: key.path=value; may be repeated")
      ->allow_extra_args(false);
}

/// Help or a complaint about the command line, from one rank however many were started.
int say_once(int argc, char** argv, const CLI::App& app, const CLI::ParseError& problem) {
  const tenon::MpiEnvironment environment(argc, argv);
  if (Communicator::world().rank() == 0) return app.exit(problem) == 0 ? 0 : static_cast<int>(ExitCode::usage);
  return problem.get_exit_code() == 0 ? 0 : static_cast<int>(ExitCode::usage);
}

int draw(int argc, char** argv, const std::string& folder, const tenon::PictureOptions& options) {
  try {
    tenon::ensure_display(argc, argv);
    for (const std::string& path : tenon::draw_pictures(folder, options)) std::printf("%s\n", path.c_str());
    return 0;
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return static_cast<int>(error.code());
  }
}

int print_reference(const std::string& section) {
  try {
    std::fputs(tenon::scene::scene_reference(tenon::scene_schema(), section).c_str(), stdout);
    return 0;
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return static_cast<int>(error.code());
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Tenon: crash, impact and thermo-mechanical simulation from coupled components.\n"
      "Start with: tenon run SCENE. Run in parallel with: mpirun -n 4 tenon run SCENE");
  app.require_subcommand(1);
  app.set_version_flag("--version", [] { return tenon::version_text(); });
  tenon::RunArguments arguments;
  tenon::PictureOptions pictures;
  std::string section, folder;
  bool last_only = false;

  CLI::App& run = *app.add_subcommand("run", "Run a scene");
  add_scene_options(run, arguments);
  run.add_option("-o,--output", arguments.folder, "Folder for the results (default: the scene's name with .results)");
  run.add_option("--restart", arguments.restart,
                 "Continue from a checkpoint file, or from the latest in the folder: latest");
  CLI::App& check = *app.add_subcommand("check", "Check a scene and its meshes without running");
  add_scene_options(check, arguments);
  CLI::App& plan = *app.add_subcommand("plan", "Say what a run would cost and what it would skip");
  add_scene_options(plan, arguments);
  CLI::App& reference = *app.add_subcommand("reference", "Print the scene reference");
  reference.add_option("section", section, "Only this section, as `materials` or `components`");
  CLI::App& picture = *app.add_subcommand("picture", "Draw PNG pictures of a run's results");
  picture.add_option("folder", folder, "Folder of the results")->required();
  picture.add_option("--component", pictures.component, "Only this component");
  picture.add_option("--field", pictures.fields, "Only these fields")->allow_extra_args(false);
  picture.add_flag("--last", last_only, "Only the last frame and the history");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& problem) {
    return say_once(argc, argv, app, problem);
  }
  pictures.every_frame = !last_only;

  if (reference.parsed()) return print_reference(section);
  if (picture.parsed()) return draw(argc, argv, folder, pictures);
  return guarded(argc, argv, [&](const Communicator& comm) {
    if (run.parsed()) return tenon::run_scene(comm, arguments);
    if (check.parsed()) tenon::check_scene(comm, arguments);
    if (plan.parsed()) tenon::plan_scene(comm, arguments);
    return ExitCode::done;
  });
}
