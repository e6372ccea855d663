// SPDX-License-Identifier: BSD-3-Clause
// One body in a picture: its surface coloured by a field, with colour bar, title and extrema.
#pragma once

#include <string>

#include <vtkActor.h>
#include <vtkNew.h>
#include <vtkPolyDataMapper.h>
#include <vtkRenderer.h>
#include <vtkTextActor.h>

#include "framework/base/box.hpp"
#include "framework/io/color_map.hpp"
#include "framework/io/picture_window.hpp"
#include "framework/io/run_frames.hpp"

namespace tenon {

/// Where a view stands in its window, in parts of it.
struct Place {
  double left = 0, bottom = 0, right = 1, top = 1;
};

class BodyView {
 public:
  /// A view of `field` of `frames` (scanned, with this field); the camera fits `box`, so that a body does not jump.
  BodyView(PictureWindow& window, const RunFrames& frames, const std::string& field, const Box& box, Place place);
  ~BodyView();
  BodyView(const BodyView&) = delete;
  BodyView& operator=(const BodyView&) = delete;

  void show(std::size_t frame);

 private:
  void set_up_body();
  void set_up_lights();
  void set_up_camera(const Box& box);
  void set_up_edges();
  void set_up_length();
  void set_up_bar();
  void set_up_triad();

  PictureWindow& window_;
  const RunFrames& frames_;
  std::string field_;
  Place place_;
  ValueRange range_;  // as shown
  double pixels_per_metre_ = 0;
  ShownUnit unit_;
  vtkNew<vtkRenderer> body_layer_, triad_layer_;
  vtkNew<vtkPolyDataMapper> mapper_, edge_mapper_;
  vtkNew<vtkActor> body_, edges_;
  vtkSmartPointer<vtkLookupTable> colors_;
  vtkSmartPointer<vtkTextActor> extrema_;
};

}  // namespace tenon
