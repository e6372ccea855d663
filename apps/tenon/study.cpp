// SPDX-License-Identifier: BSD-3-Clause
// Runs the scenes of a study one after the other.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "apps/tenon/build_simulation.hpp"
#include "apps/tenon/commands.hpp"
#include "apps/tenon/study_picture.hpp"
#include "apps/tenon/study_table.hpp"
#include "framework/io/posix_file.hpp"

namespace tenon {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// FNV-1a of a file's bytes; only told apart from another state of the same file. 0 if it cannot be read.
std::uint64_t digest(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return 0;
  std::uint64_t hash = 14695981039346656037ULL;
  std::vector<char> part(std::size_t{1} << 20);
  while (file.read(part.data(), static_cast<std::streamsize>(part.size())) || file.gcount() > 0)
    for (std::streamsize i = 0; i < file.gcount(); ++i)
      hash = (hash ^ static_cast<unsigned char>(part[static_cast<std::size_t>(i)])) * 1099511628211ULL;
  return hash;
}

/// Collective. All that the result and the time of a run depend on, and what is written. Equal texts mean that it need
/// not be repeated. The version alone would not tell a program that was built again.
std::string identity(const Communicator& comm, const LoadedScene& scene, const StudyPlan& plan, const StudyRun& run) {
  Json all{{"version", version_text()}, {"ranks", comm.size()}, {"settings", run.settings}, {"frames", plan.frames}};
  all["scene"] = read_scene_text(comm, scene.path);
  comm.vote_on_root([&] {
    all["program"] = digest("/proc/self/exe");
    for (const auto& [name, block] : scene.value.entries("meshes"))
      if (block.text("type") == "file") {
        const std::string path = (fs::path(scene.folder) / block.text("file")).string();
        all["files"][path] = digest(path);
      }
  });
  std::string text = all.dump();
  comm.broadcast(text);
  return text;
}

class Study {
 public:
  Study(const Communicator& comm, StudyPlan plan) : comm_(comm), plan_(std::move(plan)), log_(comm.rank() == 0) {
    rows_.resize(plan_.runs.size());
    for (StudyRow& row : rows_) row.values.resize(plan_.quantities.size());
  }

  ExitCode run() {
    make_folder();
    log_.print("{}\n{}: {} runs on {} ranks, in {}", version_text(), plan_.title, rows_.size(), comm_.size(),
               plan_.folder);
    ExitCode first_failure = ExitCode::done;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const ExitCode code = one(r);
      if (code == ExitCode::stopped) return code;
      if (first_failure == ExitCode::done) first_failure = code;
      write_table();
    }
    finish();
    return first_failure;
  }

 private:
  std::string folder(std::size_t r) const { return plan_.folder + "/" + plan_.runs[r].folder; }

  void make_folder() {
    comm_.vote_on_root([&] {
      std::error_code problem;
      fs::create_directories(plan_.folder, problem);
      if (problem)
        throw Error(ExitCode::file,
                    plan_.folder + ": cannot be made: " + problem.message() + "; choose another with -o");
    });
  }

  /// One run, whose failure is kept in its row. Mistakes in the study itself end it.
  ExitCode one(std::size_t r) {
    StudyRow& row = rows_[r];
    const std::string name = plan_.runs[r].folder;
    log_.print("run {} of {}: {}", r + 1, rows_.size(), name);
    try {
      const LoadedScene scene = load_scene(comm_, plan_.scene, parse_overrides(plan_.runs[r].settings));
      const std::string wanted = identity(comm_, scene, plan_, plan_.runs[r]);
      const bool again = reuse(r, scene, wanted);
      if (!again && execute(r, wanted) == ExitCode::stopped) {
        log_.print("stopped on request; the same command goes on with run {}", r + 1);
        return ExitCode::stopped;
      }
      if (!again) measure_columns(r);
      row.done = true;
      row.status = "done";
      tell(r, again);
      return ExitCode::done;
    } catch (const Error& error) {
      row.status = error.what();
      if (mistaken_) throw;
      log_.print("  failed (exit code {}): {}", static_cast<int>(error.code()), row.status);
      return error.code();
    }
  }

  ExitCode execute(std::size_t r, const std::string& wanted) {
    RunArguments arguments{plan_.scene, folder(r), plan_.runs[r].settings, ""};
    RunHooks hooks;
    hooks.to_terminal = false;
    hooks.frames = plan_.frames;
    comm_.vote_on_root([&] { fs::remove(record(r)); });
    hooks.started = [&](Simulation& simulation) {
      mistaken_ = true;
      check_fields(plan_, simulation);
      check_columns(comm_, plan_, folder(r) + "/history.csv");
      mistaken_ = false;
    };
    hooks.finished = [&](Simulation& simulation, double set_up, double stepping) {
      StudyRow& row = rows_[r];
      row.set_up = set_up, row.seconds = stepping;
      row.steps = static_cast<double>(simulation.steps());
      std::int64_t work = 0;
      for (const auto& component : simulation.components()) work += comm_.sum(component->work_done());
      row.work = static_cast<double>(work);
      row.size = size_of(r, mean_element_size(simulation));
      measure_fields(r, simulation);
    };
    const ExitCode code = run_scene(comm_.duplicate(), arguments, hooks);
    if (code == ExitCode::done) keep(r, wanted);
    return code;
  }

  std::string record(std::size_t r) const { return folder(r) + "/run.json"; }

  void keep(std::size_t r, const std::string& wanted) {
    comm_.vote_on_root([&] {
      const StudyRow& row = rows_[r];
      const Json record_of_run{{"identity", wanted},
                               {"set_up_seconds", row.set_up},
                               {"seconds", row.seconds},
                               {"steps", row.steps},
                               {"element_steps", row.work}};
      write_and_rename(record(r), record_of_run.dump(1) + "\n");
    });
  }

  /// Collective. Set-up seconds, seconds, steps and element-steps of a run that was done before; empty if it was not,
  /// or if the record of it is damaged.
  std::vector<double> recorded(std::size_t r, const std::string& wanted) const {
    std::vector<double> kept;
    comm_.vote_on_root([&] {
      if (!fs::exists(record(r)) || !fs::exists(folder(r) + "/final.h5")) return;
      std::ifstream file(record(r));
      try {
        const Json old = Json::parse(file);
        if (old.at("identity") == wanted)
          for (const char* key : {"set_up_seconds", "seconds", "steps", "element_steps"})
            kept.push_back(old.at(key).get<double>());
      } catch (const Json::exception&) {
        kept.clear();
      }
    });
    comm_.broadcast(kept);
    return kept;
  }

  /// Collective. Whether the run was done before; its times are then those of its record, and its fields are measured
  /// in its final state. What is damaged is made again.
  bool reuse(std::size_t r, const LoadedScene& scene, const std::string& wanted) {
    const std::vector<double> kept = recorded(r, wanted);
    if (kept.empty()) return false;
    try {
      measure_again(r, scene, kept);
      return true;
    } catch (const Error& error) {
      if (mistaken_ && error.code() == ExitCode::usage) throw;
      mistaken_ = false;
      log_.print("  its folder holds the same run, but cannot be used: {}", error.what());
      rows_[r] = {};
      rows_[r].values.resize(plan_.quantities.size());
      return false;
    }
  }

  void measure_again(std::size_t r, const LoadedScene& scene, const std::vector<double>& kept) {
    StudyRow& row = rows_[r];
    row.set_up = kept[0], row.seconds = kept[1], row.steps = kept[2], row.work = kept[3];
    Log silent(false);
    const Communicator own = comm_.duplicate();
    BuiltScene built = build_simulation(own, silent, scene);
    const CheckpointReader reader(own, folder(r) + "/final.h5");
    built.simulation->initialize(&reader);
    mistaken_ = true;
    check_fields(plan_, *built.simulation);
    check_columns(comm_, plan_, folder(r) + "/history.csv");
    mistaken_ = false;
    row.size = size_of(r, mean_element_size(*built.simulation));
    measure_fields(r, *built.simulation);
    measure_columns(r);
  }

  double size_of(std::size_t r, double mean) const { return plan_.size ? (*plan_.size)(plan_.runs[r].numbers) : mean; }

  void measure_fields(std::size_t r, const Simulation& simulation) {
    for (std::size_t q = 0; q < plan_.quantities.size(); ++q)
      if (plan_.quantities[q].is_field) rows_[r].values[q] = measure_field(simulation, plan_.quantities[q]);
  }
  void measure_columns(std::size_t r) {
    for (std::size_t q = 0; q < plan_.quantities.size(); ++q)
      if (!plan_.quantities[q].is_field)
        rows_[r].values[q] =
            measure_history(comm_, folder(r) + "/history.csv", plan_.quantities[q], plan_.runs[r].numbers);
  }

  void tell(std::size_t r, bool again) {
    const StudyRow& row = rows_[r];
    std::string text;
    for (std::size_t q = 0; q < plan_.quantities.size(); ++q) {
      const Measured& m = row.values[q];
      text += fmt::format("  {} {:.6g}", plan_.quantities[q].name, m.value);
      if (std::isfinite(m.error)) text += fmt::format(" (error {:.3e})", m.error);
    }
    log_.print("  h {:.4g},{}, {:.0f} steps, {:.2f} s{}", row.size, text, row.steps, row.seconds,
               again ? " (not repeated: its folder holds the same run)" : "");
  }

  void write_table() {
    analyse(plan_, rows_);
    comm_.vote_on_root([&] { write_and_rename(plan_.folder + "/study.csv", study_csv(plan_, rows_)); });
  }

  void finish() {
    const std::vector<std::string> notes = analyse(plan_, rows_);
    log_.line("");
    for (const std::string& note : notes) log_.line(note);
    for (std::size_t q = 0; q < plan_.quantities.size(); ++q) {
      log_.print("\n{:<40} {:>12} {:>14} {:>11} {:>6} {:>10} {:>9}", plan_.quantities[q].name, "size", "value", "error",
                 "order", "seconds", "steps");
      for (std::size_t r = 0; r < rows_.size(); ++r) {
        const StudyRow& row = rows_[r];
        if (!row.done) {
          log_.print("{:<40} failed", plan_.runs[r].folder);
          continue;
        }
        const std::string order = std::isfinite(row.orders[q]) ? fmt::format("{:.2f}", row.orders[q]) : "";
        log_.print("{:<40} {:>12.5g} {:>14.7g} {:>11.3e} {:>6} {:>10.3f} {:>9.0f}", plan_.runs[r].folder, row.size,
                   row.values[q].value, row.values[q].error, order, row.seconds, row.steps);
      }
    }
    std::string picture;
    if (plan_.picture) comm_.vote_on_root([&] { picture = draw_in_process_of_its_own(plan_.folder); });
    log_.print("\nresults in {}: study.csv{}", plan_.folder, picture);
  }

  Communicator comm_;
  StudyPlan plan_;
  Log log_;
  std::vector<StudyRow> rows_;
  bool mistaken_ = false;  ///< while the names in the study are compared with the scene
};

}  // namespace

ExitCode study_scene(const Communicator& comm, const StudyArguments& arguments) {
  return Study(comm, load_study(comm, arguments)).run();
}

}  // namespace tenon
