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

std::vector<PvdEntry> read_pvd(const std::string& path) {
  std::istringstream text(read_text(path));
  const vtkNew<vtkXMLDataParser> parser;
  const VtkErrorNote errors(parser);
  parser->SetStream(&text);
  const bool parsed = parser->Parse() != 0;
  vtkXMLDataElement* const root = parsed ? parser->GetRootElement() : nullptr;
  vtkXMLDataElement* const list = root != nullptr ? root->FindNestedElementWithName("Collection") : nullptr;
  if (list == nullptr) throw Error(ExitCode::file, fmt::format("{}: not a .pvd file; remove it to start anew", path));

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
