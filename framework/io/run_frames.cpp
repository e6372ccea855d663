// SPDX-License-Identifier: BSD-3-Clause
#include "framework/io/run_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <unordered_map>

#include <vtkAppendFilter.h>
#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkCellData.h>
#include <vtkDataArraySelection.h>
#include <vtkDataSetSurfaceFilter.h>
#include <vtkDoubleArray.h>
#include <vtkExecutive.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLUnstructuredGridReader.h>

#include "framework/base/error.hpp"
#include "framework/io/pvd_file.hpp"
#include "framework/io/vtk_error.hpp"

namespace tenon {

namespace {

constexpr const char* node_ids = "GlobalNodeId";
constexpr const char* active = "active";  // of particles: 0 while they are not there yet
constexpr std::size_t kept_bytes = std::size_t{1} << 30;

/// Fields of a file that are for bookkeeping, not for pictures.
bool is_bookkeeping(const std::string& name) {
  return name == node_ids || name == "GlobalElementId" || name == "rank" || name == "block";
}

void select_only(vtkDataArraySelection& selection, const std::vector<std::string>& names) {
  selection.DisableAllArrays();
  for (const std::string& name : names)
    if (selection.ArrayExists(name.c_str()) != 0) selection.EnableArray(name.c_str());
  for (const char* const always : {node_ids, active})
    if (selection.ArrayExists(always) != 0) selection.EnableArray(always);
}

/// With only these fields; with all if `names` is null.
vtkSmartPointer<vtkUnstructuredGrid> read_piece(const std::string& path, const std::vector<std::string>* names) {
  const vtkNew<vtkXMLUnstructuredGridReader> reader;
  const VtkErrorNote errors(reader), of_pipeline(reader->GetExecutive());
  reader->SetFileName(path.c_str());
  reader->UpdateInformation();
  if (names != nullptr) {
    select_only(*reader->GetPointDataArraySelection(), *names);
    select_only(*reader->GetCellDataArraySelection(), *names);
  }
  reader->Update();
  if (errors.any() || reader->GetErrorCode() != 0)
    throw Error(ExitCode::file, fmt::format("{}: frame cannot be read: {}", path,
                                            errors.any() ? errors.text() : std::string("damaged, or not there")));
  return reader->GetOutput();
}

// Pieces of several ranks meet in doubled nodes, and the faces between them would pass for outside: give each cell the
// first copy of its nodes.
void merge_nodes(vtkUnstructuredGrid& grid, const std::vector<long long>& ids) {
  std::unordered_map<long long, vtkIdType> first;
  first.reserve(ids.size());
  std::vector<vtkIdType> copy(ids.size());
  for (std::size_t n = 0; n < ids.size(); ++n)
    copy[n] = first.try_emplace(ids[n], static_cast<vtkIdType>(n)).first->second;
  vtkDataArray* const connectivity = grid.GetCells()->GetConnectivityArray();
  for (vtkIdType i = 0; i < connectivity->GetNumberOfTuples(); ++i)
    connectivity->SetTuple1(i, static_cast<double>(copy[static_cast<std::size_t>(connectivity->GetTuple1(i))]));
}

vtkSmartPointer<vtkUnstructuredGrid> join(const std::vector<vtkSmartPointer<vtkUnstructuredGrid>>& pieces) {
  if (pieces.size() == 1) return pieces.front();
  const vtkNew<vtkAppendFilter> append;
  std::vector<long long> ids;
  for (const auto& piece : pieces) {
    vtkDataArray* const own = piece->GetPointData()->GetArray(node_ids);
    for (vtkIdType n = 0; own != nullptr && n < own->GetNumberOfTuples(); ++n)
      ids.push_back(static_cast<long long>(own->GetTuple1(n)));
    append->AddInputData(piece);
  }
  append->Update();
  vtkSmartPointer<vtkUnstructuredGrid> whole = append->GetOutput();
  if (static_cast<vtkIdType>(ids.size()) == whole->GetNumberOfPoints()) merge_nodes(*whole, ids);
  return whole;
}

void replace_by_magnitude(vtkDataSetAttributes& data, const std::string& name) {
  vtkDataArray* const array = data.GetArray(name.c_str());
  if (array == nullptr || array->GetNumberOfComponents() == 1) return;
  const vtkNew<vtkDoubleArray> magnitude;
  magnitude->SetName(name.c_str());
  magnitude->SetNumberOfTuples(array->GetNumberOfTuples());
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i) {
    double sum = 0;
    for (int c = 0; c < array->GetNumberOfComponents(); ++c)
      sum += array->GetComponent(i, c) * array->GetComponent(i, c);
    magnitude->SetValue(i, std::sqrt(sum));
  }
  data.RemoveArray(name.c_str());
  data.AddArray(magnitude);
}

void replace_by_magnitudes(vtkPolyData& surface, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    replace_by_magnitude(*surface.GetPointData(), name);
    replace_by_magnitude(*surface.GetCellData(), name);
  }
}

vtkSmartPointer<vtkPolyData> outside_of(vtkUnstructuredGrid* body) {
  const vtkNew<vtkDataSetSurfaceFilter> skin;
  skin->SetInputData(body);
  skin->Update();
  return skin->GetOutput();
}

Box box_of(vtkPolyData& surface) {
  Box box;
  if (surface.GetNumberOfPoints() == 0) return box;
  const double* const b = surface.GetBounds();
  box.add(Vec3{b[0], b[2], b[4]});
  box.add(Vec3{b[1], b[3], b[5]});
  return box;
}

double typical_width(vtkPolyData& surface) {
  double area = 0, perimeter = 0;
  const auto cells = vtk::TakeSmartPointer(surface.GetPolys()->NewIterator());
  for (cells->GoToFirstCell(); !cells->IsDoneWithTraversal(); cells->GoToNextCell()) {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    cells->GetCurrentCell(count, ids);
    const auto corner = [&](vtkIdType i) {
      Vec3 p{};
      surface.GetPoint(ids[i], p.data());
      return p;
    };
    for (vtkIdType i = 2; i < count; ++i) area += 0.5 * norm(cross(corner(i - 1) - corner(0), corner(i) - corner(0)));
    for (vtkIdType i = 0; i < count; ++i) perimeter += norm(corner((i + 1) % count) - corner(i));
  }
  return perimeter > 0 ? 4 * area / perimeter : 0;
}

/// Median distance of some particles from their nearest neighbours.
double typical_distance(vtkPolyData& points) {
  constexpr vtkIdType looked_at = 65;
  const vtkIdType count = points.GetNumberOfPoints();
  std::vector<double> distances;
  for (vtkIdType k = 0; k < std::min(count, looked_at); ++k) {
    const vtkIdType i = k * count / std::min(count, looked_at);
    Vec3 x{}, other{};
    points.GetPoint(i, x.data());
    double nearest = std::numeric_limits<double>::infinity();
    for (vtkIdType j = 0; j < count; ++j) {
      points.GetPoint(j, other.data());
      const double d = norm(other - x);
      if (j != i && d > 0) nearest = std::min(nearest, d);
    }
    if (std::isfinite(nearest)) distances.push_back(nearest);
  }
  if (distances.empty()) return 0;
  std::ranges::sort(distances);
  return distances[distances.size() / 2];
}

/// Particles as points alone, without those that are not there yet.
vtkSmartPointer<vtkPolyData> present_points(vtkPolyData& all) {
  const vtkNew<vtkPolyData> present;
  const vtkNew<vtkPoints> places;
  const vtkNew<vtkCellArray> cells;
  vtkDataArray* const there = all.GetPointData()->GetArray(active);
  present->GetPointData()->CopyAllocate(all.GetPointData());
  for (vtkIdType n = 0; n < all.GetNumberOfPoints(); ++n) {
    if (there != nullptr && there->GetTuple1(n) == 0) continue;
    const vtkIdType to = places->InsertNextPoint(all.GetPoint(n));
    present->GetPointData()->CopyData(all.GetPointData(), n, to);
    cells->InsertNextCell(1, &to);
  }
  present->SetPoints(places);
  present->SetVerts(cells);
  return present;
}

void widen(ValueRange& range, vtkDataArray* values) {
  for (vtkIdType i = 0; values != nullptr && i < values->GetNumberOfTuples(); ++i) {
    const double value = values->GetTuple1(i);
    if (!std::isfinite(value)) continue;
    range.low = std::min(range.low, value);
    range.high = std::max(range.high, value);
  }
}

}  // namespace

std::vector<std::string> RunFrames::components(const std::string& folder) {
  if (!std::filesystem::exists(folder + "/all.pvd"))
    throw Error(ExitCode::file,
                fmt::format("{}: holds no frames (no all.pvd); give the output folder of a run", folder));
  std::vector<std::string> names;
  for (const PvdEntry& entry : read_pvd(folder + "/all.pvd"))
    if (std::ranges::find(names, entry.name) == names.end()) names.push_back(entry.name);
  return names;
}

RunFrames::RunFrames(std::string folder, std::string component)
    : folder_(std::move(folder)), component_(std::move(component)) {
  for (const PvdEntry& entry : read_pvd(folder_ + "/all.pvd")) {
    if (entry.name != component_) continue;
    times_.push_back(entry.time);
    files_.push_back(entry.file);
  }
  if (files_.empty()) throw Error(ExitCode::file, fmt::format("{}: no frame of component '{}'", folder_, component_));
  find_fields();
}

std::vector<std::string> RunFrames::pieces(std::size_t frame) const {
  const std::string path = folder_ + "/" + files_[frame];
  if (!path.ends_with(".pvtu")) return {path};
  std::vector<std::string> found;
  for (const std::string& source : read_pieces(path))
    found.push_back((std::filesystem::path(path).parent_path() / source).string());
  return found;
}

void RunFrames::find_fields() {
  const auto grid = read_piece(pieces(files_.size() - 1).front(), nullptr);
  const auto unit_of = [&](const std::string& name) -> std::string {
    auto* const texts = vtkStringArray::SafeDownCast(grid->GetFieldData()->GetAbstractArray(("unit_" + name).c_str()));
    return texts != nullptr && texts->GetNumberOfValues() > 0 ? static_cast<std::string>(texts->GetValue(0)) : "";
  };
  const auto add = [&](vtkDataSetAttributes& data) {
    for (int i = 0; i < data.GetNumberOfArrays(); ++i) {
      vtkDataArray* const array = data.GetArray(i);
      if (array == nullptr || array->GetName() == nullptr || is_bookkeeping(array->GetName())) continue;
      fields_.push_back({array->GetName(), unit_of(array->GetName()), array->GetNumberOfComponents()});
    }
  };
  add(*grid->GetPointData());
  add(*grid->GetCellData());
}

const StoredField* RunFrames::find(const std::string& field) const {
  const auto found = std::ranges::find(fields_, field, &StoredField::name);
  return found == fields_.end() ? nullptr : &*found;
}

vtkSmartPointer<vtkUnstructuredGrid> RunFrames::body(std::size_t frame) const {
  std::vector<vtkSmartPointer<vtkUnstructuredGrid>> read;
  for (const std::string& piece : pieces(frame)) read.push_back(read_piece(piece, &wanted_));
  return join(read);
}

vtkSmartPointer<vtkPolyData> RunFrames::load(std::size_t frame, Box* whole) const {
  const vtkSmartPointer<vtkUnstructuredGrid> grid = body(frame);
  vtkSmartPointer<vtkPolyData> surface = outside_of(grid);
  if (surface->GetNumberOfPolys() == 0) surface = present_points(*surface);
  if (whole != nullptr) *whole = box_of(*surface);
  if (cut_) surface = cut_open(surface, section(grid, *cut_), *cut_);
  replace_by_magnitudes(*surface, wanted_);
  return surface;
}

void RunFrames::cut_if_hidden(const std::string& field) {
  wanted_ = {field};
  const vtkSmartPointer<vtkUnstructuredGrid> grid = body(files_.size() - 1);
  const vtkSmartPointer<vtkPolyData> outside = outside_of(grid);
  const Box box = box_of(*outside);
  if (box.empty() || outside->GetNumberOfPolys() == 0) return;
  const Cut cut = middle_cut(box);
  const vtkSmartPointer<vtkPolyData> inside = section(grid, cut);
  replace_by_magnitudes(*outside, wanted_);
  replace_by_magnitudes(*inside, wanted_);
  if (outside_hides(*outside, *inside, field, eye_direction(box))) cut_ = cut;
}

void RunFrames::scan(const std::vector<std::string>& fields) {
  wanted_ = fields;
  kept_.assign(files_.size(), nullptr);
  ranges_.clear();
  box_ = Box{};
  constexpr double inf = std::numeric_limits<double>::infinity();
  for (const std::string& name : fields) ranges_[name] = {inf, -inf};
  std::size_t bytes = 0;
  for (std::size_t frame = 0; frame < files_.size(); ++frame) {
    Box whole;
    const vtkSmartPointer<vtkPolyData> surface = load(frame, &whole);
    if (faces_ == 0) {
      faces_ = surface->GetNumberOfCells();
      is_points_ = surface->GetNumberOfPolys() == 0;
      face_width_ = is_points_ ? typical_distance(*surface) : typical_width(*surface);
    }
    box_.add(whole);
    for (auto& [name, range] : ranges_) {
      widen(range, surface->GetPointData()->GetArray(name.c_str()));
      widen(range, surface->GetCellData()->GetArray(name.c_str()));
    }
    bytes += surface->GetActualMemorySize() * 1024;
    if (bytes < kept_bytes) kept_[frame] = surface;
  }
  for (auto& [name, range] : ranges_)
    if (range.low > range.high) range = {0, 0};
}

vtkSmartPointer<vtkPolyData> RunFrames::surface(std::size_t frame) const {
  return kept_[frame] != nullptr ? kept_[frame] : load(frame);
}

}  // namespace tenon
