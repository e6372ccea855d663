// SPDX-License-Identifier: BSD-3-Clause
#include "framework/io/vtk_piece.hpp"

#include <fmt/format.h>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkExecutive.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include "framework/io/posix_file.hpp"
#include "framework/io/pvd_file.hpp"
#include "framework/io/vtk_error.hpp"

namespace tenon {

namespace {

constexpr const char* node_id_name = "GlobalNodeId";
constexpr const char* element_id_name = "GlobalElementId";

/// Name of component c of a field, as ParaView shows it; the order of tensors is the same in both.
const char* component_name(int components, int c) {
  static constexpr const char* vector[] = {"X", "Y", "Z"};
  static constexpr const char* tensor[] = {"XX", "YY", "ZZ", "XY", "YZ", "XZ"};
  if (components == 3) return vector[c];
  return components == 6 ? tensor[c] : nullptr;
}

bool shown_at_nodes(const OutputField& field) {
  return field.description.location == Location::node;
}

/// The nodes and elements of a piece: local indices, ascending.
struct Selection {
  std::vector<LocalIndex> nodes;
  std::vector<LocalIndex> node_in_piece;  // by local node
  std::vector<LocalIndex> elements;       // counted through all blocks
};

Selection select(const Mesh& mesh) {
  Selection s;
  s.node_in_piece.assign(static_cast<std::size_t>(mesh.nodes()), no_index);
  LocalIndex first = 0;
  for (const ElementBlock& block : mesh.blocks) {
    for (LocalIndex e = 0; e < block.size(); ++e) {
      if (block.owners[static_cast<std::size_t>(e)] != mesh.comm.rank()) continue;
      s.elements.push_back(first + e);
      for (const LocalIndex n : block.nodes(e)) s.node_in_piece[static_cast<std::size_t>(n)] = 0;
    }
    first += block.size();
  }
  for (LocalIndex n = 0; n < mesh.nodes(); ++n) {
    if (s.node_in_piece[static_cast<std::size_t>(n)] == no_index) continue;
    s.node_in_piece[static_cast<std::size_t>(n)] = static_cast<LocalIndex>(s.nodes.size());
    s.nodes.push_back(n);
  }
  return s;
}

void add_cells(vtkUnstructuredGrid& grid, const Mesh& mesh, const Selection& selection) {
  const vtkNew<vtkIdTypeArray> offsets, connectivity, ids;
  const vtkNew<vtkUnsignedCharArray> types;
  const vtkNew<vtkIntArray> ranks, blocks;
  offsets->InsertNextValue(0);
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
    const ElementBlock& block = mesh.blocks[b];
    const auto type = static_cast<unsigned char>(topology(block.kind).vtk_type);
    for (LocalIndex e = 0; e < block.size(); ++e) {
      if (block.owners[static_cast<std::size_t>(e)] != mesh.comm.rank()) continue;
      for (const LocalIndex n : block.nodes(e))
        connectivity->InsertNextValue(selection.node_in_piece[static_cast<std::size_t>(n)]);
      offsets->InsertNextValue(connectivity->GetNumberOfValues());
      types->InsertNextValue(type);
      ids->InsertNextValue(block.ids[static_cast<std::size_t>(e)]);
      ranks->InsertNextValue(mesh.comm.rank());
      blocks->InsertNextValue(static_cast<int>(b));
    }
  }
  const vtkNew<vtkCellArray> cells;
  cells->SetData(offsets, connectivity);
  grid.SetCells(types, cells);
  ids->SetName(element_id_name);
  grid.GetCellData()->SetGlobalIds(ids);
  ranks->SetName("rank");
  grid.GetCellData()->AddArray(ranks);
  blocks->SetName("block");
  if (mesh.blocks.size() > 1) grid.GetCellData()->AddArray(blocks);
}

void add_points(vtkUnstructuredGrid& grid, const OutputPart& part, const Selection& selection) {
  const vtkNew<vtkDoubleArray> coordinates;
  coordinates->SetNumberOfComponents(3);
  coordinates->SetNumberOfTuples(static_cast<vtkIdType>(selection.nodes.size()));
  const vtkNew<vtkIdTypeArray> ids;
  ids->SetNumberOfValues(static_cast<vtkIdType>(selection.nodes.size()));
  for (std::size_t i = 0; i < selection.nodes.size(); ++i) {
    const auto n = static_cast<std::size_t>(selection.nodes[i]);
    coordinates->SetTypedTuple(static_cast<vtkIdType>(i), part.coordinates[n].data());
    ids->SetValue(static_cast<vtkIdType>(i), part.mesh->node_ids[n]);
  }
  const vtkNew<vtkPoints> points;
  points->SetData(coordinates);
  grid.SetPoints(points);
  ids->SetName(node_id_name);
  grid.GetPointData()->SetGlobalIds(ids);
}

void add_field(vtkUnstructuredGrid& grid, const OutputField& field, const Selection& selection) {
  const bool nodal = shown_at_nodes(field);
  const std::vector<LocalIndex>& items = nodal ? selection.nodes : selection.elements;
  const int components = field.description.components;
  const vtkNew<vtkDoubleArray> array;
  array->SetName(field.description.name.c_str());
  array->SetNumberOfComponents(components);
  for (int c = 0; c < components; ++c)
    if (component_name(components, c) != nullptr) array->SetComponentName(c, component_name(components, c));
  array->SetNumberOfTuples(static_cast<vtkIdType>(items.size()));
  for (std::size_t i = 0; i < items.size(); ++i)
    array->SetTypedTuple(static_cast<vtkIdType>(i), field.values.data() + static_cast<std::size_t>(items[i]) *
                                                                              static_cast<std::size_t>(components));
  if (nodal)
    grid.GetPointData()->AddArray(array);
  else
    grid.GetCellData()->AddArray(array);
}

void add_texts(vtkUnstructuredGrid& grid, const OutputPart& part) {
  for (const OutputField& field : part.fields) {
    const vtkNew<vtkStringArray> unit;
    unit->SetName(("unit_" + field.description.name).c_str());
    unit->InsertNextValue(field.description.unit);
    grid.GetFieldData()->AddArray(unit);
  }
  if (part.mesh->blocks.size() < 2) return;
  const vtkNew<vtkStringArray> names;
  names->SetName("block_names");
  for (const ElementBlock& block : part.mesh->blocks) names->InsertNextValue(block.name);
  grid.GetFieldData()->AddArray(names);
}

std::string array_line(const char* type, const std::string& name, int components) {
  std::string line = fmt::format("      <PDataArray type=\"{}\" Name=\"{}\"", type, xml_escape(name));
  if (components != 1) line += fmt::format(" NumberOfComponents=\"{}\"", components);
  for (int c = 0; c < components; ++c)
    if (component_name(components, c) != nullptr)
      line += fmt::format(" ComponentName{}=\"{}\"", c, component_name(components, c));
  return line + "/>\n";
}

}  // namespace

std::int64_t owned_elements(const OutputPart& part) {
  std::int64_t owned = 0;
  for (const ElementBlock& block : part.mesh->blocks)
    for (const int owner : block.owners) owned += owner == part.mesh->comm.rank();
  return owned;
}

void check_fields(const OutputPart& part) {
  const auto refuse = [&](const std::string& what, std::size_t found, std::size_t expected) {
    throw Error(ExitCode::file, fmt::format("output of component {}: {}: {} values instead of {}", part.component, what,
                                            found, expected));
  };
  const auto nodes = static_cast<std::size_t>(part.mesh->nodes()),
             elements = static_cast<std::size_t>(part.mesh->elements());
  if (part.coordinates.size() != nodes) refuse("coordinates", part.coordinates.size(), nodes);
  for (const OutputField& field : part.fields) {
    const Location at = field.description.location;
    if (at != Location::node && at != Location::element)
      throw Error(ExitCode::file,
                  fmt::format("output of component {}: field {} belongs to a {}, which a mesh cannot show",
                              part.component, field.description.name, to_string(at)));
    const std::size_t expected =
        (at == Location::node ? nodes : elements) * static_cast<std::size_t>(field.description.components);
    if (field.values.size() != expected) refuse("field " + field.description.name, field.values.size(), expected);
  }
}

void write_piece(const std::string& path, const OutputPart& part) {
  const Selection selection = select(*part.mesh);
  const vtkNew<vtkUnstructuredGrid> grid;
  add_points(*grid, part, selection);
  add_cells(*grid, *part.mesh, selection);
  for (const OutputField& field : part.fields) add_field(*grid, field, selection);
  add_texts(*grid, part);

  const std::string aside = path + ".part";
  const vtkNew<vtkXMLUnstructuredGridWriter> writer;
  const VtkErrorNote errors(writer), of_pipeline(writer->GetExecutive());
  writer->SetInputData(grid);
  writer->SetFileName(aside.c_str());
  writer->SetDataModeToBinary();
  writer->SetCompressorTypeToLZ4();
  writer->SetHeaderTypeToUInt64();
  if (writer->Write() == 0 || errors.any() || writer->GetErrorCode() != 0)
    throw Error(ExitCode::file,
                fmt::format("{}: cannot be written: {}", path,
                            errors.any() ? errors.text() : "is the disk full, or the folder not writable?"));
  rename_file(aside, path);
}

std::string format_pvtu(const OutputPart& part, std::span<const std::string> pieces) {
  std::string points = array_line("Int64", node_id_name, 1), cells = array_line("Int64", element_id_name, 1);
  cells += array_line("Int32", "rank", 1);
  if (part.mesh->blocks.size() > 1) cells += array_line("Int32", "block", 1);
  for (const OutputField& field : part.fields)
    (shown_at_nodes(field) ? points : cells) +=
        array_line("Float64", field.description.name, field.description.components);

  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\" compressor=\"vtkLZ4DataCompressor\">\n  <PUnstructuredGrid GhostLevel=\"0\">\n"
      "    <PPointData GlobalIds=\"{}\">\n{}    </PPointData>\n    <PCellData GlobalIds=\"{}\">\n{}    </PCellData>\n"
      "    <PPoints>\n      <PDataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"/>\n    </PPoints>\n",
      node_id_name, points, element_id_name, cells);
  for (const std::string& piece : pieces) text += fmt::format("    <Piece Source=\"{}\"/>\n", xml_escape(piece));
  return text + "  </PUnstructuredGrid>\n</VTKFile>\n";
}

}  // namespace tenon
