// SPDX-License-Identifier: BSD-3-Clause
#include "framework/io/picture_window.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <vtkPNGWriter.h>
#include <vtkWindowToImageFilter.h>

#include "framework/base/error.hpp"
#include "framework/io/posix_file.hpp"
#include "framework/io/vtk_error.hpp"

namespace tenon {

PictureWindow::PictureWindow(int width, int height)
    : width_(width), height_(height), window_(vtkSmartPointer<vtkRenderWindow>::New()) {
  window_->SetOffScreenRendering(1);
  window_->SetSize(width, height);
  window_->SetMultiSamples(4);
  window_->SetNumberOfLayers(3);
  sheet_->SetLayer(2);
  sheet_->InteractiveOff();
  window_->AddRenderer(sheet_);
}

int PictureWindow::font_size(double thousandths) const {
  // A narrow window has no room for the text of a high one.
  return std::max(9, static_cast<int>(std::lround(thousandths / 1000 * std::min<double>(height_, 0.75 * width_))));
}

vtkSmartPointer<vtkTextActor> PictureWindow::add_text(double x, double y, double thousandths, bool bold) {
  auto text = vtkSmartPointer<vtkTextActor>::New();
  text->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
  text->SetPosition(x, y);
  set_ink(*text->GetTextProperty(), font_size(thousandths), bold);
  sheet_->AddActor2D(text);
  return text;
}

void PictureWindow::save(const std::string& path) {
  window_->Render();
  save_png(*window_, path);
}

void save_png(vtkRenderWindow& window, const std::string& path) {
  const vtkNew<vtkWindowToImageFilter> image;
  image->SetInput(&window);
  image->ReadFrontBufferOff();
  image->ShouldRerenderOff();
  const vtkNew<vtkPNGWriter> writer;
  const VtkErrorNote errors(writer);
  const std::string aside = path + ".part";
  writer->SetInputConnection(image->GetOutputPort());
  writer->SetFileName(aside.c_str());
  writer->SetCompressionLevel(3);
  writer->Write();
  if (errors.any() || writer->GetErrorCode() != 0)
    throw Error(ExitCode::file, fmt::format("{}: picture cannot be written: {}", path, errors.text()));
  rename_file(aside, path);
}

void set_ink(vtkTextProperty& text, int size, bool bold) {
  // VTK's own Arial draws brackets like parentheses; DejaVu comes with Debian's VTK.
  const std::string file = std::string("/usr/share/fonts/truetype/dejavu/DejaVuSans") + (bold ? "-Bold.ttf" : ".ttf");
  text.SetFontFamilyToArial();
  if (std::filesystem::exists(file)) {
    text.SetFontFamily(VTK_FONT_FILE);
    text.SetFontFile(file.c_str());
  }
  text.SetFontSize(size);
  text.SetBold(bold);
  text.SetItalic(false);
  text.SetShadow(false);
  text.SetColor(ink[0], ink[1], ink[2]);
}

}  // namespace tenon
