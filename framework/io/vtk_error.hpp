// SPDX-License-Identifier: BSD-3-Clause
// Catches what a VTK object would print on an error.
#pragma once

#include <string>

#include <vtkCallbackCommand.h>
#include <vtkNew.h>
#include <vtkObject.h>

namespace tenon {

/// Notes the first error of `object` instead of printing it, for the life of this note.
class VtkErrorNote {
 public:
  explicit VtkErrorNote(vtkObject* object);
  ~VtkErrorNote();
  VtkErrorNote(const VtkErrorNote&) = delete;
  VtkErrorNote& operator=(const VtkErrorNote&) = delete;
  bool any() const { return !text_.empty(); }
  const std::string& text() const { return text_; }
  /// For objects that a VTK object makes itself, say the parser of a reader.
  vtkCommand* observer() const { return command_; }

 private:
  std::string text_;
  vtkNew<vtkCallbackCommand> command_;
  vtkObject* object_;
  unsigned long tags_[2];
};

}  // namespace tenon
