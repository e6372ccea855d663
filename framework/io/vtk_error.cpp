// SPDX-License-Identifier: BSD-3-Clause
#include "framework/io/vtk_error.hpp"

namespace tenon {

VtkErrorNote::VtkErrorNote(vtkObject* object) : object_(object) {
  command_->SetClientData(&text_);
  command_->SetCallback([](vtkObject*, unsigned long event, void* text, void* said) {
    auto& first = *static_cast<std::string*>(text);
    if (event != vtkCommand::ErrorEvent || !first.empty()) return;
    // VTK says "ERROR: In file, line n\nclass (address): reason\n\n": only the reason is for the user.
    const std::string all = said != nullptr ? static_cast<const char*>(said) : "unknown reason";
    const std::size_t reason = all.find("): ");
    first = reason == std::string::npos ? all : all.substr(reason + 3);
    while (!first.empty() && first.back() == '\n') first.pop_back();
  });
  tags_[0] = object_->AddObserver(vtkCommand::ErrorEvent, command_);
  tags_[1] = object_->AddObserver(vtkCommand::WarningEvent, command_);
}

VtkErrorNote::~VtkErrorNote() {
  for (const unsigned long tag : tags_) object_->RemoveObserver(tag);
}

}  // namespace tenon
