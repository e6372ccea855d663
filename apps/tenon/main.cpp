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

void add_plan_options(CLI::App& plan, tenon::PlanArguments& arguments) {
  plan.add_option("scene", arguments.scene, "Scene file (YAML)")->required();
  plan.add_option("--set", arguments.settings, "Change a value of the scene: key.path=value; may be repeated")
      ->allow_extra_args(false);
  plan.add_option("--ranks", arguments.ranks,
                  "Predict the step on so many ranks, from decompositions for each: 64,128,1024")
      ->delimiter(',')
      ->check(CLI::Range(1, 65536));
  plan.add_option("--machine", arguments.machines,
                  "Machine that the prediction is for: here, tflops (1997), cluster, or a YAML file with latency, "
                  "bandwidth, slowness; a list is allowed (default: here)")
      ->delimiter(',');
  plan.add_option("--decomposition", arguments.decompositions,
                  "Of contact and particles, to compare: auto, own, slices, static; a list is allowed (default: auto)")
      ->delimiter(',');
  plan.add_option("--csv", arguments.csv, "Write the prediction, a row per phase");
  plan.add_option("--after", arguments.after, "Run so many steps first, for a state that stands for the run")
      ->check(CLI::NonNegativeNumber);
  plan.add_option("--until", arguments.until, "Run to this time first, as '0.1 ms'");
  plan.add_option("--trial", arguments.trial, "Measure so many steps (default: as many as fit in a second)")
      ->check(CLI::NonNegativeNumber);
  plan.add_option("--measure-until", arguments.measure_until, "Measure all steps to this time instead, as '0.1 ms'");
  plan.footer(
      "Example, the scaling of a scene from 64 to 1024 ranks of today's cluster:\n"
      "  tenon plan scene.yaml --ranks 64,128,256,512,1024 --machine cluster --after 100 --csv scaling.csv");
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

void add_transfer_options(CLI::App& command, tenon::TransferArguments& a) {
  command.add_option("source", a.source, "Result with the fields: .pvd, .pvtu, .vtu, or Exodus with variables")
      ->required();
  command.add_option("target", a.target, "Mesh that takes them: Exodus, Gmsh, .vtu")->required();
  command
      .add_option("--fields", a.fields,
                  "Fields, each NAME or NAME:METHOD, as temperature,plastic_heat:conserve (default: all of the source)")
      ->delimiter(',')
      ->allow_extra_args(false);
  command.add_option("--method", a.method, "Method of fields that name none: " + tenon::method_names())
      ->capture_default_str();
  command
      .add_option("--kind", a.kinds, "What a field is, as heat:total; point_value, density or total; may be repeated")
      ->delimiter(',')
      ->allow_extra_args(false);
  command.add_option("--at", a.at, "Where the target has them: nodes or elements (default: as the source)");
  command
      .add_option("--outside", a.outside,
                  "What a point outside the source receives: nearest, extrapolate, value=X; or error, to refuse")
      ->capture_default_str();
  command.add_option("--greatest-distance", a.greatest_distance,
                     "Refuse points farther from the source than this, as '2 mm'");
  command.add_option("--time", a.time, "State of the source nearest to this time, as '10 us', or last")
      ->capture_default_str();
  command.add_option("--part", a.part, "Component, if the source is a run's all.pvd");
  command.add_option("--source-unit", a.source_unit, "Length of one unit of the source's coordinates, as mm")
      ->capture_default_str();
  command.add_option("--target-unit", a.target_unit, "Length of one unit of the target's coordinates, as mm")
      ->capture_default_str();
  command.add_option("-o,--output", a.output,
                     "File for ParaView: .vtu, or .pvtu for a piece of each rank (default: TARGET's name .fields.vtu)");
  command.add_option("--blocks", a.blocks, "Seek points in these blocks of the source only")
      ->delimiter(',')
      ->allow_extra_args(false);
  command.add_option("--sides", a.sides,
                     "Side set of the source that nearest_projection projects to (default: its skin)");
  command.add_flag("--bounded", a.bounded, "Of project: no value beyond those of the source around it");
  command.add_option("--neighbours", a.neighbours, "Of moving_least_squares: points that each fit looks at")
      ->capture_default_str();
  command.add_flag("--status", a.status,
                   "Write transfer_status (0 inside, 1 nearest, 2 extrapolated, 3 value) and transfer_distance, too");
  command.add_flag(
      "--report", a.report,
      "Say more of each field: all digits of the integrals, the farthest point, the error of a round trip");
  command.footer(
      "Fields with standard names are densities (density ...) or totals (mass, force, plastic_heat ...), which are "
      "conserved; others are point values, which are interpolated. Coordinates are those in the files. In parallel: "
      "mpirun -n 4 tenon transfer ...; the result is the same to the last bit.\n"
      "Examples:\n"
      "  tenon transfer out/bar/mechanics.pvd fine.exo --fields temperature,stress\n"
      "  tenon transfer result.exo new.msh --fields heat --kind heat:total --greatest-distance '1 mm' -o heat.vtu");
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
  tenon::PlanArguments plan_arguments;
  add_plan_options(plan, plan_arguments);
  tenon::StudyArguments study_arguments;
  CLI::App& study = *app.add_subcommand("study", "Run a scene for several values of its keys, and compare the errors");
  add_study_options(study, study_arguments);
  tenon::TransferArguments transfer_arguments;
  CLI::App& transfer = *app.add_subcommand("transfer", "Map fields of a result onto another mesh");
  add_transfer_options(transfer, transfer_arguments);
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
    if (transfer.parsed()) return tenon::transfer_results(comm, transfer_arguments);
    if (plan.parsed()) tenon::plan_scene(comm, plan_arguments);
    return ExitCode::done;
  });
}
