// SPDX-License-Identifier: BSD-3-Clause
// The scene runner: command line in, exit code out.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <functional>

#include "apps/tenon/commands.hpp"
#include "apps/tenon/scene_schema.hpp"
#include "apps/tenon/study_picture.hpp"
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

void add_study_options(CLI::App& study, tenon::StudyArguments& arguments) {
  study.add_option("file", arguments.file, "Study file (YAML); or a scene, with --vary and --quantity")->required();
  study.add_option("-o,--output", arguments.folder, "Folder for the results (default: the file's name with .results)");
  study
      .add_option("--vary", arguments.vary,
                  "A key of the scene and its values: meshes.bar.axial=20,40,80; may be repeated")
      ->allow_extra_args(false);
  study
      .add_option("--quantity", arguments.quantities,
                  "What is measured: a column of history.csv, as max_eqps, max_eqps:maximum or 'tip_z:at 10 us'; with "
                  "--exact a field, as temperature or mechanics.displacement.x; may be repeated")
      ->allow_extra_args(false);
  CLI::Option* const reference = study.add_option(
      "--reference", arguments.reference,
      "Reference of the columns: a number (SI) or expression of t and the varied keys; without it, the Richardson "
      "extrapolation of the three finest runs");
  study.add_option("--exact", arguments.exact, "Exact solution of the fields: an expression of t, x, y, z (SI)")
      ->excludes(reference);
  study.add_option("--size", arguments.size, "Size that the error belongs to, as 1/axial (default: mean element size)");
  study.add_flag("!--no-picture", arguments.picture, "Do not draw study.png (tenon picture FOLDER does it later)");
  study.add_flag("--grid", arguments.grid, "All combinations of the values instead of keys in step");
  study
      .add_option("--set", arguments.settings,
                  "Change a value of the scene in every run: key.path=value; may be repeated")
      ->allow_extra_args(false);
  study.footer(
      "Each run is that of `tenon run` in a folder of its own; runs whose folder already holds the same scene, "
      "settings "
      "and final state are not repeated. Writes study.csv and study.png (error over size, error over run time).\n"
      "Examples:\n"
      "  tenon study apps/scenes/elastic-wave/study.yaml\n"
      "  tenon study scene.yaml --vary meshes.bar.axial=20,40,80 --quantity max_eqps");
}

/// The nearest command to a word that is none; empty if the complaint is about something else.
std::string unknown_command(int argc, char** argv, const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  const std::string word = argc > 1 ? argv[1] : "";
  if (word.empty() || word[0] == '-' || std::find(names.begin(), names.end(), word) != names.end()) return "";
  return "there is no command '" + word + "'" + tenon::scene::suggestion(word, names);
}

/// Help or a complaint about the command line, from one rank however many were started.
int say_once(int argc, char** argv, const CLI::App& app, const CLI::ParseError& problem) {
  const tenon::MpiEnvironment environment(argc, argv);
  const std::string unknown = unknown_command(argc, argv, app);
  if (!unknown.empty()) {
    if (Communicator::world().rank() == 0) std::fprintf(stderr, "%s\n", unknown.c_str());
    return static_cast<int>(ExitCode::usage);
  }
  if (Communicator::world().rank() == 0) return app.exit(problem) == 0 ? 0 : static_cast<int>(ExitCode::usage);
  return problem.get_exit_code() == 0 ? 0 : static_cast<int>(ExitCode::usage);
}

int draw(int argc, char** argv, const std::string& folder, const tenon::PictureOptions& options) {
  try {
    tenon::ensure_display(argc, argv);
    if (tenon::is_study_folder(folder)) {
      std::printf("%s\n", tenon::draw_study(folder).c_str());
      return 0;
    }
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
  tenon::StudyArguments study_arguments;
  CLI::App& study = *app.add_subcommand("study", "Run a scene for several values of its keys, and compare the errors");
  add_study_options(study, study_arguments);
  CLI::App& reference = *app.add_subcommand("reference", "Print the scene reference");
  reference.add_option("section", section, "Only this section, as `materials` or `components`");
  CLI::App& picture = *app.add_subcommand("picture", "Draw PNG pictures of the results of a run or study");
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
    if (study.parsed()) return tenon::study_scene(comm, study_arguments);
    if (plan.parsed()) tenon::plan_scene(comm, arguments);
    return ExitCode::done;
  });
}
