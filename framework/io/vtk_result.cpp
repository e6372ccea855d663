// SPDX-License-Identifier: BSD-3-Clause
#include "framework/io/vtk_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numeric>

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkExecutive.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include "framework/base/error.hpp"
#include "framework/io/pvd_file.hpp"
#include "framework/io/vtk_error.hpp"

namespace tenon {

namespace {

namespace fs = std::filesystem;
using Grid = vtkSmartPointer<vtkUnstructuredGrid>;

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw Error(ExitCode::file, fmt::format("{}: {}", path, what));
}

std::string beside(const std::string& path, const std::string& file) {
  return (fs::path(path).parent_path() / file).string();
}

Grid read_grid(const std::string& path) {
  if (!fs::exists(path)) refuse(path, "there is no such file; expected a ParaView file (.pvd, .pvtu, .vtu)");
  const vtkNew<vtkXMLUnstructuredGridReader> reader;
  const VtkErrorNote errors(reader), of_pipeline(reader->GetExecutive());
  reader->SetParserErrorObserver(errors.observer());
  reader->SetFileName(path.c_str());
  reader->Update();
  if (errors.any() || of_pipeline.any() || reader->GetErrorCode() != 0)
    refuse(path, "cannot be read: " + (errors.any() ? errors.text() : std::string("damaged, or of another kind")));
  return reader->GetOutput();
}

/// The file of the state and part, and its time.
std::string chosen_file(const std::string& path, const StateChoice& choice, const std::string& part, double& time) {
  std::vector<PvdEntry> entries = read_pvd(path);
  std::vector<std::string> parts;
  for (const PvdEntry& e : entries)
    if (std::ranges::find(parts, e.name) == parts.end()) parts.push_back(e.name);
  if (entries.empty()) refuse(path, "lists no state");
  if (parts.size() > 1 || !part.empty()) {
    if (std::ranges::find(parts, part) == parts.end())
      throw Error(ExitCode::usage, fmt::format("{}: {}; it has the parts {}", path,
                                               part.empty() ? std::string("say which part is meant, with --part")
                                                            : fmt::format("there is no part '{}'", part),
                                               fmt::join(parts, ", ")));
    std::erase_if(entries, [&](const PvdEntry& e) { return e.name != part; });
  }
  std::vector<double> times;
  for (const PvdEntry& e : entries) times.push_back(e.time);
  const PvdEntry& chosen = entries[chosen_state(times, choice)];
  time = chosen.time;
  return beside(path, chosen.file);
}

/// Ids of the points or cells of a piece; empty if it has none.
std::vector<GlobalId> ids_of(vtkDataSetAttributes& data, const char* name) {
  vtkDataArray* array = data.GetGlobalIds();
  if (array == nullptr) array = data.GetArray(name);
  std::vector<GlobalId> ids;
  for (vtkIdType i = 0; array != nullptr && i < array->GetNumberOfTuples(); ++i)
    ids.push_back(static_cast<GlobalId>(array->GetTuple1(i)));
  return ids;
}

bool is_bookkeeping(vtkDataSetAttributes& data, vtkDataArray* array) {
  const std::string name = array->GetName() != nullptr ? array->GetName() : "";
  return name.empty() || array == data.GetGlobalIds() || name == "GlobalNodeId" || name == "GlobalElementId" ||
         name == "rank" || name == "block" || name == "vtkGhostType" || name == "vtkOriginalPointIds" ||
         name == "vtkOriginalCellIds";
}

/// A cell of a piece, before cells have their final order.
struct Cell {
  std::size_t piece;
  vtkIdType cell;
  int block;
  ElementKind kind;
  GlobalId id;
};
struct Point {
  std::size_t piece;
  vtkIdType point;
};

class Joiner {
 public:
  Joiner(std::string path, std::vector<Grid> pieces) : path_(std::move(path)), pieces_(std::move(pieces)) {}

  ResultData join() {
    result_.mesh.source = path_;
    number_points();
    find_cells();
    add_blocks();
    if (cells_.empty()) refuse(path_, "has no elements");
    for (const Grid& piece : pieces_) {
      find_fields(*piece->GetPointData(), Location::node, *piece);
      find_fields(*piece->GetCellData(), Location::element, *piece);
    }
    for (FieldData& field : result_.fields) fill(field);
    return std::move(result_);
  }

 private:
  /// A node for each id, or for each point of pieces without ids.
  void number_points() {
    std::map<GlobalId, Point> first;
    std::vector<std::vector<GlobalId>> ids;
    GlobalId next = 0;
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      ids.push_back(ids_of(*pieces_[p]->GetPointData(), "GlobalNodeId"));
      if (ids[p].empty() != ids[0].empty() && pieces_[p]->GetNumberOfPoints() > 0)
        refuse(path_, "some pieces have global node ids and some do not");
      for (vtkIdType n = 0; n < pieces_[p]->GetNumberOfPoints(); ++n) {
        if (ids[p].size() <= static_cast<std::size_t>(n)) ids[p].push_back(next++);
        first.try_emplace(ids[p][static_cast<std::size_t>(n)], Point{p, n});
      }
    }
    std::map<GlobalId, GlobalId> number;
    for (const auto& [id, point] : first) {
      number.emplace_hint(number.end(), id, static_cast<GlobalId>(points_.size()));
      points_.push_back(point);
      Vec3 x{};
      pieces_[point.piece]->GetPoint(point.point, x.data());
      if (!std::isfinite(x[0] + x[1] + x[2]))
        refuse(path_, fmt::format("node {} has a coordinate that is not finite", id));
      result_.mesh.coordinates.push_back(x);
      result_.mesh.node_labels.push_back(id);
    }
    for (const std::vector<GlobalId>& of_piece : ids) {
      node_of_.emplace_back();
      for (const GlobalId id : of_piece) node_of_.back().push_back(number.at(id));
    }
  }

  void find_cells() {
    GlobalId next = 0;
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      vtkUnstructuredGrid& piece = *pieces_[p];
      const std::vector<GlobalId> ids = ids_of(*piece.GetCellData(), "GlobalElementId");
      vtkDataArray* const blocks = piece.GetCellData()->GetArray("block");
      vtkDataArray* const ghosts = piece.GetCellData()->GetArray("vtkGhostType");
      for (vtkIdType c = 0; c < piece.GetNumberOfCells(); ++c) {
        const auto kind = kind_of_vtk(piece.GetCellType(c));
        const GlobalId id = ids.empty() ? next++ : ids[static_cast<std::size_t>(c)];
        if (ghosts != nullptr && ghosts->GetTuple1(c) != 0) continue;
        if (!kind)
          refuse(path_, fmt::format("cell {} is of VTK's type {}, which Tenon does not read; read are hexahedra, "
                                    "tetrahedra, wedges, pyramids, quadrilaterals and triangles",
                                    id, piece.GetCellType(c)));
        cells_.push_back({p, c, blocks != nullptr ? static_cast<int>(blocks->GetTuple1(c)) : 0, *kind, id});
      }
    }
    std::stable_sort(cells_.begin(), cells_.end(), [](const Cell& a, const Cell& b) {
      return std::tuple(a.block, a.kind, a.id) < std::tuple(b.block, b.kind, b.id);
    });
    const auto twice = [](const Cell& a, const Cell& b) { return a.id == b.id && a.block == b.block; };
    if (const auto found = std::adjacent_find(cells_.begin(), cells_.end(), twice); found != cells_.end())
      refuse(path_, fmt::format("element {} stands in it twice", found->id));
  }

  std::string block_name(int block) const {
    auto* const names = vtkStringArray::SafeDownCast(pieces_[0]->GetFieldData()->GetAbstractArray("block_names"));
    if (names != nullptr && block >= 0 && block < names->GetNumberOfValues()) return names->GetValue(block);
    return fmt::format("block_{}", block + 1);
  }

  void add_blocks() {
    const vtkNew<vtkIdList> nodes;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      const Cell& cell = cells_[i];
      if (i == 0 || cell.block != cells_[i - 1].block || cell.kind != cells_[i - 1].kind) {
        std::string name = block_name(cell.block);
        if (i > 0 && cell.block == cells_[i - 1].block) name += fmt::format("_{}", topology(cell.kind).name);
        const auto label = static_cast<std::int64_t>(result_.mesh.blocks.size()) + 1;
        result_.mesh.blocks.push_back({name, label, cell.kind, {}, {}});
      }
      BlockData& block = result_.mesh.blocks.back();
      block.labels.push_back(cell.id);
      pieces_[cell.piece]->GetCellPoints(cell.cell, nodes);
      if (nodes->GetNumberOfIds() != topology(cell.kind).nodes)
        refuse(path_, fmt::format("element {} has {} nodes, which a {} has not", cell.id, nodes->GetNumberOfIds(),
                                  topology(cell.kind).name));
      for (vtkIdType n = 0; n < nodes->GetNumberOfIds(); ++n)
        block.connectivity.push_back(node_of_[cell.piece].at(static_cast<std::size_t>(nodes->GetId(n))));
    }
  }

  void find_fields(vtkDataSetAttributes& data, Location location, vtkUnstructuredGrid& piece) {
    for (int i = 0; i < data.GetNumberOfArrays(); ++i) {
      vtkDataArray* const array = data.GetArray(i);
      if (array == nullptr || is_bookkeeping(data, array)) continue;
      const std::string name = array->GetName();
      const bool known = std::ranges::any_of(result_.fields, [&](const FieldData& f) {
        return f.description.name == name && f.description.location == location;
      });
      if (known) continue;
      FieldData field;
      field.description.name = name;
      field.description.location = location;
      field.description.components = array->GetNumberOfComponents();
      auto* const unit = vtkStringArray::SafeDownCast(piece.GetFieldData()->GetAbstractArray(("unit_" + name).c_str()));
      if (unit != nullptr && unit->GetNumberOfValues() > 0) field.description.unit = unit->GetValue(0);
      result_.fields.push_back(std::move(field));
    }
  }

  void fill(FieldData& field) const {
    const bool nodal = field.description.location == Location::node;
    const auto width = static_cast<std::size_t>(field.description.components);
    const std::size_t count = nodal ? points_.size() : cells_.size();
    field.values.assign(count * width, 0.0);
    std::vector<double> tuple(width);
    for (std::size_t i = 0; i < count; ++i) {
      vtkUnstructuredGrid& piece = *pieces_[nodal ? points_[i].piece : cells_[i].piece];
      vtkDataSetAttributes* const data =
          nodal ? static_cast<vtkDataSetAttributes*>(piece.GetPointData()) : piece.GetCellData();
      vtkDataArray* const array = data->GetArray(field.description.name.c_str());
      if (array == nullptr || array->GetNumberOfComponents() != field.description.components) {
        field.missing = "one of the pieces";
        continue;
      }
      array->GetTuple(nodal ? points_[i].point : cells_[i].cell, tuple.data());
      std::copy(tuple.begin(), tuple.end(), field.values.begin() + static_cast<std::ptrdiff_t>(i * width));
    }
  }

  std::string path_;
  std::vector<Grid> pieces_;
  std::vector<Point> points_;                   // by node: the first copy
  std::vector<std::vector<GlobalId>> node_of_;  // by piece and point
  std::vector<Cell> cells_;                     // in their final order
  ResultData result_;
};

bool ends(const std::string& path, const char* extension) {
  return fs::path(path).extension() == extension;
}

}  // namespace

bool is_vtk_result(const std::string& path) {
  return ends(path, ".pvd") || ends(path, ".pvtu") || ends(path, ".vtu");
}

ResultData read_vtk_result(const std::string& path, const StateChoice& choice, const std::string& part) {
  std::string file = path;
  std::optional<double> time;
  if (!fs::exists(path)) refuse(path, "there is no such file; expected a ParaView file (.pvd, .pvtu, .vtu)");
  if (ends(path, ".pvd")) {
    double at = 0;
    file = chosen_file(path, choice, part, at);
    time = at;
  }
  std::vector<Grid> pieces;
  if (ends(file, ".pvtu"))
    for (const std::string& piece : read_pieces(file)) pieces.push_back(read_grid(beside(file, piece)));
  else
    pieces.push_back(read_grid(file));
  ResultData result = Joiner(file, std::move(pieces)).join();
  result.time = time;
  return result;
}

}  // namespace tenon
