// SPDX-License-Identifier: BSD-3-Clause
#include "framework/io/color_map.hpp"

#include <array>
#include <cmath>
#include <span>

#include <vtkColorTransferFunction.h>
#include <vtkNew.h>

namespace tenon {

namespace {

// Ten equidistant points each of the maps viridis and plasma by S. van der Walt and N. Smith (CC0); between them in
// Lab.
constexpr std::array<unsigned, 10> viridis{0x440154, 0x482878, 0x3e4a89, 0x31688e, 0x26828e,
                                           0x1f9e89, 0x35b779, 0x6ece58, 0xb5de2b, 0xfde725};
constexpr std::array<unsigned, 10> plasma{0x0d0887, 0x46039f, 0x7201a8, 0x9c179e, 0xbd3786,
                                          0xd8576b, 0xed7953, 0xfb9f3a, 0xfdca26, 0xf0f921};

}  // namespace

vtkSmartPointer<vtkLookupTable> make_color_map(const std::string& field, double low, double high) {
  const std::span<const unsigned> points = field.find("temperature") != std::string::npos ? plasma : viridis;
  const vtkNew<vtkColorTransferFunction> between;
  between->SetColorSpaceToLab();
  for (std::size_t i = 0; i < points.size(); ++i)
    between->AddRGBPoint(static_cast<double>(i) / static_cast<double>(points.size() - 1), (points[i] >> 16) / 255.0,
                         (points[i] >> 8 & 255) / 255.0, (points[i] & 255) / 255.0);
  auto table = vtkSmartPointer<vtkLookupTable>::New();
  constexpr int colors = 256;
  table->SetNumberOfTableValues(colors);
  for (int i = 0; i < colors; ++i) {
    double rgb[3];
    between->GetColor(i / (colors - 1.0), rgb);
    table->SetTableValue(i, rgb[0], rgb[1], rgb[2], 1);
  }
  table->SetNanColor(0.75, 0.75, 0.75, 1);
  table->SetRange(low, high);
  return table;
}

ShownUnit shown_unit(const std::string& unit, double greatest) {
  static constexpr std::pair<double, const char*> prefixes[] = {{1e9, "G"}, {1e6, "M"},  {1e3, "k"},
                                                                {1, ""},    {1e-3, "m"}, {1e-6, "\xc2\xb5"}};
  const double size = std::abs(greatest);
  const bool prefixable = unit == "Pa" || unit == "J" || unit == "s" || unit == "m" || unit == "N" || unit == "W";
  if (!prefixable || !(size > 0) || !std::isfinite(size)) return {unit, 1};
  for (const auto& [factor, prefix] : prefixes)
    if (size >= 0.9999 * factor || factor == 1e-6) return {prefix + unit, 1 / factor};
  return {unit, 1};
}

std::string title_of(const std::string& quantity, const std::string& unit) {
  return unit.empty() ? quantity : quantity + " [" + unit + "]";
}

}  // namespace tenon
