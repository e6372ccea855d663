// SPDX-License-Identifier: BSD-3-Clause
#include "apps/tenon/scene_schema.hpp"

#include <charconv>

#include "apps/tenon/scene_meshes.hpp"
#include "components/contact/scene_block.hpp"
#include "components/materials/read_material.hpp"
#include "components/mechanics/scene_block.hpp"
#include "components/sph/scene_block.hpp"
#include "components/thermal/scene_block.hpp"

namespace tenon {

namespace {

using scene::Range;
using scene::Schema;

Schema transfer_schema() {
  Schema s("A field that goes from one component to another, between meshes and decompositions of their own.");
  s.text("from", "Component and field that gives, as `mechanics.plastic_heat`.").required();
  s.text("to", "Component and field that takes, as `conduction.heat`.").required();
  s.choice(
      "method",
      {"automatic", "interpolate", "nearest_projection", "conserve", "project", "moving_least_squares", "copy"},
      "`interpolate`: shape functions of the source, linear fields exact (point values); `nearest_projection`: the "
      "same on surfaces that do not match; `conserve`: sums to round-off (totals, densities); `project`: the "
      "nearest field in the mean square, integrals kept (point values, densities); `moving_least_squares`: a fit "
      "to the nearest source points; `copy`: the meshes must match. `automatic` chooses by the kind of the field "
      "and of the meshes; matching meshes are copied by any method.",
      "automatic");
  s.flag("bounded", "Of `method: project`: no value beyond those of the source around it.", "false");
  s.integer("neighbours", "Of `method: moving_least_squares`: source points that each fit looks at.", "20",
            Range{4, 64, false, false});
  s.texts("blocks", "Blocks of the source mesh that points are sought in; all without it.");
  s.text("side_set",
         "Of `method: nearest_projection`: the source's side set that is projected to; without it surface "
         "elements, or the skin.");
  s.choice("outside", {"nearest", "extrapolate", "value", "error"},
           "What a point outside the source mesh receives; counted and reported in every case.", "nearest");
  s.quantity("outside_value", "1", "Value for `outside: value`, in the field's SI unit.", "0");
  s.quantity("greatest_distance", "m", "A point farther from the source than this is an error (exit code 5).", "",
             Range::positive());
  s.flag("show_outside",
         "Frames show, on the receiving mesh, `transfer_<name>_status` (0 inside, 1 nearest point, 2 extrapolated, 3 "
         "`outside_value`) and `transfer_<name>_distance` from the source.",
         "false");
  s.choice("report", {"sampled", "full"},
           "What the end of the log tells of it. `sampled`: integrals, points outside, and an error estimate from a "
           "thousand targets. `full`: from all of them, and how much values change on the way forth and back.",
           "sampled");
  s.choice("configuration", {"reference", "current"},
           "Where points are sought: in the undeformed meshes (one map for the whole run; right for meshes of the same "
           "material) or where they are now (the map follows as far as one moves against the other).",
           "reference");
  s.choice("every", {"slower_step", "source_step"},
           "Once per step of the slower of the two components, or after every step of the source. Totals accumulate in "
           "between, so nothing is lost either way.",
           "slower_step");
  s.choice(
      "between_samples", {"hold", "linear"},
      "What the receiver sees between two steps of a slower source. `hold`: the last value; amounts arrive at once. "
      "`linear`: values go on along the line through the last two (second order in time, but it may overshoot where "
      "the source turns); amounts arrive evenly over as long as they took to gather.",
      "hold");
  return s;
}

Schema point_schema() {
  Schema s("A point whose field values become columns of history.csv.");
  add_shown_field(s);
  s.vector("point", "m", "Place in the undeformed body; the nearest node or element is taken.").required();
  return s;
}

Schema output_schema() {
  Schema frames("Frames for ParaView (.pvd, .vtu).");
  frames.text("every", "Interval, as `2 us` or `500 steps`. Without it: twenty over the run.");
  frames.texts("fields", "Names of the fields to write; all without it.");
  Schema history("history.csv: energies, ledger error, extrema, point values.");
  history.text("every", "Interval, as `1 us` or `10 steps`. Without it: two hundred over the run.");
  history.named("points", point_schema(), "Point histories by name.");
  Schema checkpoint("Checkpoints (HDF5). The last two are kept, and the final state always stands as final.h5.");
  checkpoint.text(
      "every", "Interval, as `10 us` or `1000 steps`. Without it: ten over the run. One is also written on SIGTERM.");
  Schema log("Lines in the log.");
  log.text("every", "Interval, as `4 us` or `500 steps`. Without it: twenty over the run.");
  Schema s("What is written, and how often.");
  s.object("frames", frames, "Frames for ParaView.");
  s.object("history", history, "history.csv.");
  s.object("checkpoint", checkpoint, "Checkpoints for restart.");
  s.object("log", log, "Lines in the log.");
  return s;
}

}  // namespace

void add_shown_field(Schema& s) {
  s.text("component", "Component that shows the field; may be left out if there is only one.");
  s.text("field", "Field name, as `displacement` or `temperature`.").required();
}

Schema scene_schema() {
  Schema s("A Tenon scene.");
  s.text("title", "One line that says what is simulated.");
  s.quantity("start_time", "s", "Time at the start.", "0 s");
  s.required_quantity("end_time", "s", "Time at the end.");
  s.integer(
      "maximum_steps",
      "A run that would need more steps is refused (exit code 2), and one that has taken so many stops: an end time "
      "with a wrong unit would run for years.",
      "20000000", {1, 1e15, false, false});
  s.variants("meshes", scene::Key::Type::named, mesh_variants(), "Meshes by name: files or generated shapes.")
      .required();
  s.named("materials", material_schema(), "Materials by name.").required();
  s.variants("components", scene::Key::Type::named,
             {{"explicit_mechanics", mechanics_schema()}, {"sph", sph_schema()}, {"heat_conduction", thermal_schema()}},
             "Physics components by name. Each has a mesh, a decomposition and a time step of its own.")
      .required();
  s.object("contact", contact_schema(), "Contact between and within bodies.");
  s.named("transfers", transfer_schema(), "Exchanges between components by name.");
  s.object("output", output_schema(), "What is written, and how often.");
  return s;
}

Interval read_interval(const scene::Value& block, const std::string& key, scene::Diagnostics& diagnostics) {
  Interval interval;
  if (!block.has(key)) return interval;
  const std::string& text = block.text(key);
  const char* const end = text.data() + text.size();
  const auto [rest, status] = std::from_chars(text.data(), end, interval.steps);
  const std::string unit(rest, end);
  if (status == std::errc() && (unit == " steps" || unit == " step" || unit == "steps") && interval.steps > 0)
    return interval;
  interval.steps = 0;
  try {
    interval.time = scene::parse_quantity(text, "s");
    if (interval.time > 0) return interval;
    diagnostics.error(block.where(key),
                      key + ": '" + text + "' is not above zero; expected an interval as '2 us' or '500 steps'");
  } catch (const std::invalid_argument& problem) {
    diagnostics.error(block.where(key), key + ": " + problem.what() + ", or a number of steps as '500 steps'");
  }
  return interval;
}

}  // namespace tenon
