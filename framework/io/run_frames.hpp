// SPDX-License-Identifier: BSD-3-Clause
// The frames of a run as surfaces, read back from its folder.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include "framework/io/body_section.hpp"

namespace tenon {

/// A field as stored.
struct StoredField {
  std::string name, unit;
  int components = 1;
};

/// Smallest and greatest value over all frames; of the magnitude where there are several components.
struct ValueRange {
  double low = 0, high = 0;
};

/// One component of a run.
class RunFrames {
 public:
  /// The component of this name in `folder`/all.pvd. Throws Error(file), as the other functions do.
  RunFrames(std::string folder, std::string component);
  /// Names of all components in a run's folder, in order.
  static std::vector<std::string> components(const std::string& folder);

  const std::string& component() const { return component_; }
  std::size_t size() const { return files_.size(); }
  double time(std::size_t frame) const { return times_[frame]; }
  const std::vector<StoredField>& fields() const { return fields_; }
  const StoredField* find(const std::string& field) const;

  /// Cuts all frames open if the outside of the last one hides the greatest values of `field`. Call before `scan`.
  void cut_if_hidden(const std::string& field);
  bool is_cut() const { return cut_.has_value(); }

  /// Reads every frame once: the box around all of them (uncut) and the ranges of `fields`. Surfaces are kept while
  /// memory lasts.
  void scan(const std::vector<std::string>& fields);
  const Box& box() const { return box_; }
  ValueRange range(const std::string& field) const { return ranges_.at(field); }
  /// Faces of the surface in the first frame, and their typical width, m: 4 area / perimeter, so that thin ones count
  /// as thin.
  long long faces() const { return faces_; }
  double face_width() const { return face_width_; }
  /// The body consists of particles; then the width is that between neighbours.
  bool is_points() const { return is_points_; }

  /// The outside of the body in a frame, with the scanned fields; several components as their magnitude.
  vtkSmartPointer<vtkPolyData> surface(std::size_t frame) const;

 private:
  vtkSmartPointer<vtkPolyData> load(std::size_t frame, Box* whole = nullptr) const;
  vtkSmartPointer<vtkUnstructuredGrid> body(std::size_t frame) const;
  std::vector<std::string> pieces(std::size_t frame) const;
  void find_fields();

  std::string folder_, component_;
  std::vector<double> times_;
  std::vector<std::string> files_;
  std::vector<StoredField> fields_;
  std::vector<std::string> wanted_;
  std::map<std::string, ValueRange> ranges_;
  Box box_;
  std::optional<Cut> cut_;
  long long faces_ = 0;
  double face_width_ = 0;
  bool is_points_ = false;
  std::vector<vtkSmartPointer<vtkPolyData>> kept_;
};

}  // namespace tenon
