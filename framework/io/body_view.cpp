// SPDX-License-Identifier: BSD-3-Clause
#include "framework/io/body_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include <vtkAxesActor.h>
#include <vtkCamera.h>
#include <vtkCaptionActor2D.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkLeaderActor2D.h>
#include <vtkLight.h>
#include <vtkPointData.h>
#include <vtkPolyDataNormals.h>
#include <vtkProperty.h>
#include <vtkProperty2D.h>
#include <vtkTextProperty.h>

#include "framework/io/color_bar.hpp"

namespace tenon {

namespace {

constexpr double least_face_with_edges = 9;  // pixels across; below, edges would hide the colours
constexpr double least_point = 2;            // pixels
constexpr double bar_thickness = 0.028;      // of the height of the window

}  // namespace

BodyView::BodyView(PictureWindow& window, const RunFrames& frames, const std::string& field, const Box& box,
                   Place place)
    : window_(window), frames_(frames), field_(field), place_(place) {
  const ValueRange stored = frames.range(field);
  unit_ = shown_unit(frames.find(field)->unit, std::max(std::abs(stored.low), std::abs(stored.high)));
  range_ = {stored.low * unit_.scale, stored.high * unit_.scale};
  // A field that is the same everywhere still needs a bar with two ends.
  if (!(range_.high - range_.low > 1e-12 * std::max(std::abs(range_.high), std::abs(range_.low)))) {
    const double half = range_.low == 0 ? 0.5 : 0.05 * std::abs(range_.low);
    range_ = {range_.low - half, range_.high + half};
  }
  set_up_body();
  set_up_lights();
  set_up_camera(box);
  set_up_edges();
  set_up_length();
  set_up_bar();
  set_up_triad();

  const double middle = 0.5 * (place.left + place.right);
  const auto title = window.add_text(middle, place.top - 0.105, 30, true);
  title->SetInput((frames.component() + ": " + field + (frames.is_cut() ? " (cut open)" : "")).c_str());
  title->GetTextProperty()->SetJustificationToCentered();
  extrema_ = window.add_text(middle, place.bottom + 0.03, 22, false);
  extrema_->GetTextProperty()->SetJustificationToCentered();
}

BodyView::~BodyView() {
  window_.window().RemoveRenderer(body_layer_);
  window_.window().RemoveRenderer(triad_layer_);
}

void BodyView::set_up_body() {
  colors_ = make_color_map(field_, range_.low, range_.high);
  mapper_->SetLookupTable(colors_);
  mapper_->SetUseLookupTableScalarRange(true);
  mapper_->SetScalarVisibility(true);
  mapper_->SetInterpolateScalarsBeforeMapping(true);
  body_->SetMapper(mapper_);
  // Mostly ambient light, so that shading shows the shape and does not falsify the colour.
  vtkProperty& look = *body_->GetProperty();
  look.SetAmbient(0.42);
  look.SetDiffuse(0.6);
  look.SetSpecular(0);
  body_layer_->AddActor(body_);
  body_layer_->SetBackground(1, 1, 1);
  body_layer_->SetLayer(0);
  body_layer_->SetViewport(place_.left, place_.bottom, place_.right, place_.top);
  window_.window().AddRenderer(body_layer_);
}

// One light at the eye and a weaker one from above, left, so that tops and sides of a body differ.
void BodyView::set_up_lights() {
  const vtkNew<vtkLight> eye, above;
  for (vtkLight* light : {eye.Get(), above.Get()}) {
    light->SetLightTypeToCameraLight();
    light->SetFocalPoint(0, 0, 0);
    body_layer_->AddLight(light);
  }
  eye->SetPosition(0, 0, 1);
  eye->SetIntensity(0.7);
  above->SetPosition(-0.5, 1, 0.5);
  above->SetIntensity(0.45);
  body_layer_->SetAutomaticLightCreation(false);
}

// Thin, half-transparent lines, where faces are large enough to be told apart.
void BodyView::set_up_edges() {
  const double across = frames_.face_width() * pixels_per_metre_;
  if (frames_.is_points()) {
    body_->GetProperty()->SetRenderPointsAsSpheres(true);
    body_->GetProperty()->SetPointSize(static_cast<float>(std::max(across, least_point)));
    return;
  }
  if (across < least_face_with_edges) return;
  mapper_->SetResolveCoincidentTopologyToPolygonOffset();
  mapper_->SetRelativeCoincidentTopologyPolygonOffsetParameters(4, 40);
  edge_mapper_->ScalarVisibilityOff();
  edges_->SetMapper(edge_mapper_);
  edges_->GetProperty()->SetRepresentationToWireframe();
  edges_->GetProperty()->LightingOff();
  edges_->GetProperty()->SetColor(0.06, 0.06, 0.08);
  edges_->GetProperty()->SetOpacity(across < 2 * least_face_with_edges ? 0.35 : 0.5);
  body_layer_->AddActor(edges_);
}

// A line of a round length in the corner below the colour bar.
void BodyView::set_up_length() {
  const double widest = 0.13 * (place_.right - place_.left) * window_.width() / pixels_per_metre_;
  const double power = std::pow(10, std::floor(std::log10(widest)));
  const double length = widest >= 5 * power ? 5 * power : widest >= 2 * power ? 2 * power : power;
  const double part = length * pixels_per_metre_ / window_.width(),
               right = place_.right - 0.03 * (place_.right - place_.left);
  const vtkNew<vtkLeaderActor2D> line;
  line->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
  line->GetPosition2Coordinate()->SetCoordinateSystemToNormalizedViewport();
  line->GetPositionCoordinate()->SetReferenceCoordinate(nullptr);
  line->GetPosition2Coordinate()->SetReferenceCoordinate(nullptr);
  line->SetPosition(right - part, place_.bottom + 0.075);
  line->SetPosition2(right, place_.bottom + 0.075);
  line->SetArrowPlacementToNone();
  line->GetProperty()->SetColor(ink[0], ink[1], ink[2]);
  line->GetProperty()->SetLineWidth(2);
  window_.sheet().AddActor2D(line);
  const ShownUnit unit = shown_unit("m", length);
  const auto label = window_.add_text(right - 0.5 * part, place_.bottom + 0.03, 21, false);
  label->SetInput(fmt::format("{:g} {}", length * unit.scale, unit.name).c_str());
  label->GetTextProperty()->SetJustificationToCentered();
}

void BodyView::set_up_camera(const Box& box) {
  // z is up, except where it points to the eye.
  const Vec3 eye = eye_direction(box), up = eye[2] > 0.99 ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
  Vec3 right = cross(up, eye);
  right = (1 / norm(right)) * right;
  const Vec3 high = cross(eye, right), centre = 0.5 * (box.low + box.high);
  double half_width = 0, half_height = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p{(corner & 1 ? box.high : box.low)[0], (corner & 2 ? box.high : box.low)[1],
                 (corner & 4 ? box.high : box.low)[2]};
    half_width = std::max(half_width, std::abs(dot(p - centre, right)));
    half_height = std::max(half_height, std::abs(dot(p - centre, high)));
  }
  // The body takes the part of the view that title, extrema and colour bar leave.
  const double width = (place_.right - place_.left) * window_.width(),
               height = (place_.top - place_.bottom) * window_.height();
  constexpr double free_width = 0.70, free_height = 0.75, bar_shift = 0.07;
  const double scale = std::max({half_height / free_height, half_width / free_width * height / width, 1e-12});
  pixels_per_metre_ = height / (2 * scale);
  const Vec3 focus = centre + (2 * bar_shift * scale * width / height) * right;
  const double distance = 2 * box.diagonal() + 1e-9;
  const Vec3 position = focus + distance * eye;
  vtkCamera& camera = *body_layer_->GetActiveCamera();
  camera.ParallelProjectionOn();
  camera.SetFocalPoint(focus.data());
  camera.SetPosition(position.data());
  camera.SetViewUp(up.data());
  camera.SetParallelScale(scale);
  // No wider than the body, or the edges sink into the faces for lack of digits in the depth.
  camera.SetClippingRange(distance - 0.55 * box.diagonal() - 1e-10, distance + 0.55 * box.diagonal() + 1e-10);
}

void BodyView::set_up_bar() {
  const double width = place_.right - place_.left, height = place_.top - place_.bottom;
  const double left = place_.right - 0.15 * width, bottom = place_.bottom + 0.17 * height;
  const double right = left + bar_thickness * window_.height() / window_.width();
  add_color_bar(window_, *colors_, title_of(field_, unit_.name), left, bottom, right, bottom + 0.62 * height,
                place_.right - 0.02 * width);
}

void BodyView::set_up_triad() {
  const vtkNew<vtkAxesActor> axes;
  axes->SetTotalLength(1, 1, 1);
  axes->SetShaftTypeToCylinder();
  axes->SetCylinderRadius(0.03);
  axes->SetConeRadius(0.22);
  axes->SetNormalizedTipLength(0.24, 0.24, 0.24);
  axes->SetNormalizedShaftLength(0.76, 0.76, 0.76);
  axes->SetNormalizedLabelPosition(1.25, 1.25, 1.25);
  const auto paint = [](vtkProperty* shaft, vtkProperty* tip, double r, double g, double b) {
    shaft->SetColor(r, g, b);
    tip->SetColor(r, g, b);
  };
  // Muted, and grey enough not to be read as values.
  paint(axes->GetXAxisShaftProperty(), axes->GetXAxisTipProperty(), 0.70, 0.25, 0.22);
  paint(axes->GetYAxisShaftProperty(), axes->GetYAxisTipProperty(), 0.30, 0.55, 0.28);
  paint(axes->GetZAxisShaftProperty(), axes->GetZAxisTipProperty(), 0.25, 0.36, 0.66);
  for (vtkCaptionActor2D* caption :
       {axes->GetXAxisCaptionActor2D(), axes->GetYAxisCaptionActor2D(), axes->GetZAxisCaptionActor2D()}) {
    caption->GetTextActor()->SetTextScaleModeToNone();
    set_ink(*caption->GetCaptionTextProperty(), window_.font_size(20), false);
  }
  const double side = 0.17 * (place_.top - place_.bottom),
               aspect = static_cast<double>(window_.height()) / window_.width();
  triad_layer_->SetViewport(place_.left, place_.bottom, place_.left + side * aspect, place_.bottom + side);
  triad_layer_->SetLayer(1);
  triad_layer_->AddActor(axes);
  vtkCamera& from = *body_layer_->GetActiveCamera();
  vtkCamera& camera = *triad_layer_->GetActiveCamera();
  double out[3];
  from.GetDirectionOfProjection(out);
  camera.ParallelProjectionOn();
  camera.SetFocalPoint(0.35, 0.2, 0.35);
  camera.SetPosition(0.35 - 10 * out[0], 0.2 - 10 * out[1], 0.35 - 10 * out[2]);
  camera.SetViewUp(from.GetViewUp());
  camera.SetParallelScale(1.15);
  camera.SetClippingRange(1, 20);
  window_.window().AddRenderer(triad_layer_);
}

void BodyView::show(std::size_t frame) {
  vtkSmartPointer<vtkPolyData> surface = frames_.surface(frame);
  vtkDataArray* const at_points = surface->GetPointData()->GetArray(field_.c_str());
  vtkDataArray* const stored = at_points != nullptr ? at_points : surface->GetCellData()->GetArray(field_.c_str());
  const vtkNew<vtkDoubleArray> shown;
  shown->SetName("shown");
  double low = INFINITY, high = -INFINITY;
  for (vtkIdType i = 0; stored != nullptr && i < stored->GetNumberOfTuples(); ++i) {
    const double value = stored->GetTuple1(i) * unit_.scale;
    shown->InsertNextValue(value);
    low = std::min(low, value);
    high = std::max(high, value);
  }
  const vtkNew<vtkPolyData> painted;
  painted->SetPoints(surface->GetPoints());
  painted->SetPolys(surface->GetPolys());
  if (frames_.is_points()) painted->SetVerts(surface->GetVerts());
  if (at_points != nullptr)
    painted->GetPointData()->SetScalars(shown);
  else
    painted->GetCellData()->SetScalars(shown);
  const vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputData(painted);
  normals->SetFeatureAngle(40);
  normals->SplittingOn();
  normals->ConsistencyOff();
  if (!frames_.is_points()) normals->Update();
  mapper_->SetInputData(frames_.is_points() ? painted.Get() : normals->GetOutput());
  edge_mapper_->SetInputData(painted);
  if (at_points != nullptr)
    mapper_->SetScalarModeToUsePointData();
  else
    mapper_->SetScalarModeToUseCellData();
  const std::string unit = unit_.name == "1" ? "" : " " + unit_.name;
  const std::string extrema = fmt::format("min {:.4g}{}   max {:.4g}{}", low, unit, high, unit);
  extrema_->SetInput(low <= high ? extrema.c_str() : frames_.is_points() ? "no particles" : "no faces");
}

}  // namespace tenon
