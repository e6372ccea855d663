// SPDX-License-Identifier: BSD-3-Clause
#include "framework/io/pvd_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <sstream>

#include <vtkNew.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLDataParser.h>

#include "framework/base/error.hpp"
#include "framework/io/posix_file.hpp"
#include "framework/io/vtk_error.hpp"

namespace tenon {

std::string xml_escape(std::string_view text) {
  std::string escaped;
  for (const char c : text) switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  return escaped;
}

std::string format_pvd(std::span<const PvdEntry> entries) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n  "
      "<Collection>\n";
  for (const PvdEntry& e : entries)
    text += fmt::format("    <DataSet timestep=\"{:.17g}\" group=\"\" part=\"{}\" name=\"{}\" file=\"{}\"/>\n", e.time,
                        e.part, xml_escape(e.name), xml_escape(e.file));
  return text + "  </Collection>\n</VTKFile>\n";
}

namespace {

/// Parses a file, for as long as this object lives, and finds an element of this name below the root.
class XmlFile {
 public:
  XmlFile(const std::string& path, const char* element) : text_(read_text(path)), errors_(parser_) {
    parser_->SetStream(&text_);
    vtkXMLDataElement* const root = parser_->Parse() != 0 ? parser_->GetRootElement() : nullptr;
    list_ = root != nullptr ? root->FindNestedElementWithName(element) : nullptr;
    if (list_ == nullptr)
      throw Error(ExitCode::file, fmt::format("{}: damaged, or not of this kind (no {} in it)", path, element));
  }
  vtkXMLDataElement* list() const { return list_; }

 private:
  std::istringstream text_;
  vtkNew<vtkXMLDataParser> parser_;
  VtkErrorNote errors_;
  vtkXMLDataElement* list_ = nullptr;
};

}  // namespace

std::vector<std::string> read_pieces(const std::string& path) {
  const XmlFile file(path, "PUnstructuredGrid");
  std::vector<std::string> sources;
  for (int i = 0; i < file.list()->GetNumberOfNestedElements(); ++i) {
    vtkXMLDataElement* const element = file.list()->GetNestedElement(i);
    if (std::strcmp(element->GetName(), "Piece") != 0) continue;
    const char* const source = element->GetAttribute("Source");
    if (source == nullptr) throw Error(ExitCode::file, fmt::format("{}: a piece has no file", path));
    sources.emplace_back(source);
  }
  if (sources.empty()) throw Error(ExitCode::file, fmt::format("{}: lists no piece", path));
  return sources;
}

std::vector<PvdEntry> read_pvd(const std::string& path) {
  const XmlFile xml(path, "Collection");
  vtkXMLDataElement* const list = xml.list();
  std::vector<PvdEntry> entries;
  for (int i = 0; i < list->GetNumberOfNestedElements(); ++i) {
    vtkXMLDataElement* const element = list->GetNestedElement(i);
    const char* const file = element->GetAttribute("file");
    const char* const name = element->GetAttribute("name");
    PvdEntry entry;
    if (std::strcmp(element->GetName(), "DataSet") != 0 || file == nullptr ||
        element->GetScalarAttribute("timestep", entry.time) == 0 || !std::isfinite(entry.time))
      throw Error(ExitCode::file, fmt::format("{}: entry {} has no time or no file", path, i + 1));
    element->GetScalarAttribute("part", entry.part);
    entry.name = name != nullptr ? name : "";
    entry.file = file;
    entries.push_back(std::move(entry));
  }
  return entries;
}

}  // namespace tenon
