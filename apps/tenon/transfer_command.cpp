// SPDX-License-Identifier: BSD-3-Clause
// `tenon transfer`: rank 0 reads, both meshes are distributed each in its own way, fields that share a way share a map.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>

#include "apps/tenon/commands.hpp"
#include "apps/tenon/transfer_table.hpp"
#include "framework/fields/root_order.hpp"
#include "framework/io/vtk_output.hpp"
#include "framework/io/vtk_piece.hpp"
#include "framework/io/vtk_result.hpp"
#include "framework/mesh/mesh.hpp"
#include "framework/mesh_files/readers.hpp"
#include "framework/scene/value.hpp"

namespace tenon {

namespace {

using transfer::Grid;
using transfer::GridTransfer;

MeshData scaled(MeshData&& mesh, double unit) {
  if (unit != 1)
    for (Vec3& x : mesh.coordinates) x = unit * x;
  return std::move(mesh);
}

ResultData read_source(const TransferArguments& arguments, const TransferSettings& settings) {
  const std::string& path = arguments.source;
  ResultData result =
      is_vtk_result(path) ? read_vtk_result(path, settings.state, arguments.part) : read_result(path, settings.state);
  if (settings.state.time && !result.time)
    throw Error(ExitCode::usage, fmt::format("--time: {} holds no states with times", path));
  result.mesh = scaled(std::move(result.mesh), settings.source_unit);
  return result;
}

MeshData read_target(const TransferArguments& arguments, const TransferSettings& settings) {
  const std::string& path = arguments.target;
  return scaled(is_vtk_result(path) ? read_vtk_result(path, {}, "").mesh : read_mesh(path), settings.target_unit);
}

/// Collective. What rank 0 knows of the source's fields, without values.
std::vector<FieldData> broadcast_fields(const Communicator& comm, const std::vector<FieldData>& fields) {
  struct Numbers {
    Location location;
    int components;
  };
  std::vector<Numbers> numbers;
  std::string texts;
  for (const FieldData& f : fields) {
    numbers.push_back({f.description.location, f.description.components});
    for (const std::string& text : {f.description.name, f.description.unit, f.missing}) texts += text + '\0';
  }
  comm.broadcast(numbers);
  comm.broadcast(texts);
  std::vector<FieldData> same;
  std::size_t at = 0;
  const auto next = [&] {
    const std::size_t begin = at, end = texts.find('\0', at);
    at = end + 1;
    return texts.substr(begin, end - begin);
  };
  for (const Numbers& n : numbers) {
    FieldData field;
    field.description.location = n.location, field.description.components = n.components;
    field.description.name = next(), field.description.unit = next(), field.missing = next();
    same.push_back(std::move(field));
  }
  return same;
}

void check_finite(const FieldData& field, const std::string& path) {
  for (const double value : field.values)
    if (!std::isfinite(value))
      throw Error(ExitCode::file,
                  fmt::format("{}: field '{}' has values that are not finite numbers", path, field.description.name));
}

/// A field at the target, of all local items.
struct Arrived {
  TransferredField said;
  std::vector<double> values;
};

/// What became of the points at nodes or elements of the target.
struct Status {
  Location to;
  bool tells;  ///< of a map that seeks points outside
  std::vector<double> status, distance;
};

/// Names that the command line takes for granted.
void check_names(const TransferArguments& arguments, const MeshSummary& mesh) {
  const auto check = [&](const std::string& option, const std::string& what, const std::string& name,
                         const std::vector<MeshSummary::Entry>& entries) {
    std::vector<std::string> names;
    for (const MeshSummary::Entry& entry : entries) names.push_back(entry.name);
    if (std::ranges::find(names, name) == names.end())
      throw Error(ExitCode::usage, fmt::format("{}: {} has no {} '{}'{}", option, arguments.source, what, name,
                                               scene::suggestion(name, names)));
  };
  for (const std::string& block : arguments.blocks) check("--blocks", "block", block, mesh.blocks);
  if (!arguments.sides.empty()) check("--sides", "side set", arguments.sides, mesh.side_sets);
}

class TransferRun {
 public:
  TransferRun(const Communicator& comm, const TransferArguments& arguments)
      : comm_(comm), arguments_(arguments), settings_(transfer_settings(arguments)) {}

  void run() {
    read();
    for (std::size_t first = 0; first < plan_.size(); ++first) {
      std::vector<const PlannedField*> together;
      const auto same = [&](const PlannedField& p) { return p.shares_map(plan_[first]); };
      if (std::ranges::find_if(plan_, same) != plan_.begin() + static_cast<std::ptrdiff_t>(first)) continue;
      for (const PlannedField& field : plan_)
        if (same(field)) together.push_back(&field);
      carry(together);
    }
    write();
    if (comm_.rank() == 0) print();
  }

 private:
  void read() {
    MeshData target;
    comm_.vote_on_root([&] {
      result_ = read_source(arguments_, settings_);
      target = read_target(arguments_, settings_);
      time_ = result_.time;
      for (const auto* mesh : {&result_.mesh, &target})
        for (const std::string& warning : mesh->warnings)
          fmt::print(stderr, "{}: warning: {}\n", mesh->source, warning);
    });
    plan_ = plan_fields(arguments_, broadcast_fields(comm_, result_.fields));
    comm_.vote_on_root([&] {
      for (const PlannedField& field : plan_) check_finite(result_.fields[field.stored], arguments_.source);
      const auto projects = [](const PlannedField& f) { return f.method == transfer::Method::nearest_projection; };
      if (std::ranges::any_of(plan_, projects)) add_derived_sets(result_.mesh);
      check_names(arguments_, summarise(result_.mesh));
    });
    if (comm_.rank() == 0) whole_target_ = target;
    source_ = distribute(comm_, std::move(result_.mesh), {.cost = {}, .method = {}, .name = "source"});
    target_ = distribute(comm_, std::move(target), {.cost = {}, .method = {}, .name = "target"});
  }

  /// Collective. Fields that share a map: built for the first, applied to all at once.
  void carry(const std::vector<const PlannedField*>& fields) {
    const PlannedField& first = *fields.front();
    Grid from{source_.get(), source_->coordinates, first.description.location};
    from.blocks = arguments_.blocks, from.sides = arguments_.sides;
    Grid to{target_.get(), target_->coordinates, first.to};
    transfer::TransferOptions options = settings_.options;
    options.method = first.method;
    const GridTransfer map(from, to, first.description, options, first.description.name);
    const RootOrder order(*source_, first.description.location);
    const auto items = static_cast<std::size_t>(first.to == Location::node ? target_->nodes() : target_->elements());
    std::vector<std::vector<double>> sent;
    std::vector<transfer::TransferItem> travelling;
    std::vector<Arrived> arrived(fields.size());
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const PlannedField& field = *fields[i];
      const int components = field.description.components;
      const std::vector<double> whole =
          comm_.rank() == 0 ? std::move(result_.fields[field.stored].values) : std::vector<double>();
      sent.push_back(order.to_local(whole, components));
      arrived[i].said = {field.description, field.to, method_name(map.method()), {}};
      arrived[i].values.resize(items * static_cast<std::size_t>(components));
    }
    for (std::size_t i = 0; i < fields.size(); ++i)
      travelling.push_back({sent[i], arrived[i].values, fields[i]->description.components});
    // A projection tells of its last application only: those go one by one, each with its report.
    const bool together = map.method() != transfer::Method::project;
    if (together) map.apply(travelling);
    if (arguments_.status) take_status(map, first.to);
    const std::optional<GridTransfer> back = arguments_.report ? way_back(from, to, first) : std::nullopt;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (!together) map.apply(std::span(travelling).subspan(i, 1));
      arrived[i].said.report = map.report(sent[i], arrived[i].values, fields[i]->description.components);
      if (back) arrived[i].said.round_trip = map.round_trip_error(*back, sent[i], fields[i]->description.components);
      arrived_.push_back(std::move(arrived[i]));
    }
  }

  /// Collective. The map of the opposite direction, if there is one: points outside take the nearest value.
  std::optional<GridTransfer> way_back(Grid from, Grid to, const PlannedField& field) const {
    from.blocks.clear(), from.sides.clear();
    FieldDescription description = field.description;
    description.location = field.to;
    transfer::TransferOptions options;
    options.method = field.method == transfer::Method::copy ? transfer::Method::automatic : field.method;
    try {
      return std::optional<GridTransfer>(std::in_place, to, from, description, options, description.name + " back");
    } catch (const Error&) {  // on all ranks
      return std::nullopt;
    }
  }

  /// What became of the points of a map; of several maps to the same place, the first that seeks them in the source
  /// tells.
  void take_status(const GridTransfer& map, Location to) {
    const bool tells = map.method() != transfer::Method::conserve && map.method() != transfer::Method::copy;
    const auto known = std::ranges::find(status_, to, &Status::to);
    if (known != status_.end() && (known->tells || !tells)) return;
    const auto items = static_cast<std::size_t>(to == Location::node ? target_->nodes() : target_->elements());
    std::vector<transfer::PointStatus> status(items);
    Status told{to, tells, {}, std::vector<double>(items)};
    map.status(status, told.distance);
    for (const transfer::PointStatus s : status) told.status.push_back(static_cast<double>(s));
    if (known != status_.end())
      *known = std::move(told);
    else
      status_.push_back(std::move(told));
  }

  /// All that is written: the fields, and what became of their points.
  std::vector<OutputField> outputs() const {
    std::vector<OutputField> all;
    for (const Arrived& a : arrived_) {
      all.push_back({a.said.description, a.values});
      all.back().description.location = a.said.to;
    }
    for (const Status& s : status_) {
      all.push_back({{"transfer_status", s.to, FieldKind::point_value, 1, "1"}, s.status});
      all.push_back({{"transfer_distance", s.to, FieldKind::point_value, 1, "m"}, s.distance});
    }
    return all;
  }

  /// Collective.
  void write() {
    const bool pieces = std::filesystem::path(settings_.output).extension() == ".pvtu";
    OutputPart part{"target", target_.get(), target_->coordinates, outputs()};
    if (pieces) {
      write_pvtu(comm_, settings_.output, part);
      return;
    }
    std::vector<std::vector<double>> whole;
    for (const OutputField& field : part.fields)
      whole.push_back(
          RootOrder(*target_, field.description.location).to_root(field.values, field.description.components));
    comm_.vote_on_root([&] {
      // One file, the same bytes whatever the ranks.
      const auto mesh = distribute(Communicator::self(), std::move(whole_target_), {});
      part.mesh = mesh.get(), part.coordinates = mesh->coordinates;
      for (std::size_t i = 0; i < whole.size(); ++i) part.fields[i].values = whole[i];
      check_fields(part);
      write_piece(settings_.output, part);
    });
  }

  void print() const {
    const auto size = [](const Mesh& mesh) {
      return fmt::format("{} nodes, {} elements", mesh.global_nodes, mesh.global_elements);
    };
    const std::string state = time_ ? fmt::format(", state at {:.9g} s", *time_) : "";
    fmt::print("source  {}: {}{}\ntarget  {}: {}\n\n", arguments_.source, size(*source_), state, arguments_.target,
               size(*target_));
    std::vector<TransferredField> said;
    for (const Arrived& a : arrived_) said.push_back(a.said);
    const bool solid =
        std::ranges::any_of(target_->blocks, [](const ElementBlock& b) { return topology(b.kind).dimension == 3; });
    fmt::print("{}", transfer_table(said, solid));
    if (arguments_.report) fmt::print("\n{}", transfer_details(said));
    fmt::print("\nwritten: {}\n", settings_.output);
  }

  const Communicator& comm_;
  const TransferArguments& arguments_;
  const TransferSettings settings_;
  ResultData result_;      // rank 0
  MeshData whole_target_;  // rank 0
  std::optional<double> time_;
  std::vector<PlannedField> plan_;
  std::shared_ptr<const Mesh> source_, target_;
  std::vector<Arrived> arrived_;
  std::vector<Status> status_;
};

}  // namespace

ExitCode transfer_results(const Communicator& comm, const TransferArguments& arguments) {
  TransferRun(comm, arguments).run();
  return ExitCode::done;
}

}  // namespace tenon
