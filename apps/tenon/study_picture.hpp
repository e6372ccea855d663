// SPDX-License-Identifier: BSD-3-Clause
// The picture of a study.
#pragma once

#include <string>

namespace tenon {

/// Serial. Draws FOLDER/study.png (error over size, error over run time) from FOLDER/study.csv; returns its path. Needs
/// a display. Throws Error(file).
std::string draw_study(const std::string& folder);

/// Local. Whether the folder is one of a study.
bool is_study_folder(const std::string& folder);

/// Local. Lets `tenon picture FOLDER` draw it, which finds itself a display. Returns ", study.png", or how to draw it
/// if that failed.
std::string draw_in_process_of_its_own(const std::string& folder);

}  // namespace tenon
