// SPDX-License-Identifier: BSD-3-Clause
// An off-screen window on white paper and its PNG.
#pragma once

#include <string>

#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>

namespace tenon {

/// All text is of this colour.
inline constexpr double ink[3] = {0.13, 0.13, 0.15};

class PictureWindow {
 public:
  PictureWindow(int width, int height);

  vtkRenderWindow& window() { return *window_; }
  int width() const { return width_; }
  int height() const { return height_; }
  /// Pixels of a text of this many thousandths of the window's height.
  int font_size(double thousandths) const;

  /// The layer of texts and colour bars, above the whole window.
  vtkRenderer& sheet() { return *sheet_; }
  /// A text at (x, y) in parts of the window; moves with its justification.
  vtkSmartPointer<vtkTextActor> add_text(double x, double y, double thousandths, bool bold);

  /// Draws and writes aside, then renames. Throws Error(file).
  void save(const std::string& path);

 private:
  int width_, height_;
  vtkSmartPointer<vtkRenderWindow> window_;
  vtkNew<vtkRenderer> sheet_;
};

/// Writes what a window shows.
void save_png(vtkRenderWindow& window, const std::string& path);
void set_ink(vtkTextProperty& text, int size, bool bold);

}  // namespace tenon
