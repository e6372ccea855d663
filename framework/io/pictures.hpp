// SPDX-License-Identifier: BSD-3-Clause
// PNG pictures of a run's output, off-screen.
#pragma once

#include <string>
#include <vector>

namespace tenon {

struct PictureOptions {
  std::string component;            ///< empty: all components, side by side
  std::vector<std::string> fields;  ///< empty: the most telling ones that exist (eqps, von_mises, temperature, ...)
  int width = 1600, height = 900;
  bool every_frame = true;
};

/// Draws `FOLDER/pictures/COMPONENT_FIELD_NNNN.png` per frame, `FOLDER/pictures/last.png` (all components and their
/// main field in the last frame, with colour bars in the field's unit) and `FOLDER/pictures/history.png` (energies,
/// ledger error and extrema of history.csv). Serial. Colour range of a field is that of all frames. A body whose
/// outside hides the greatest values is cut open, and its title says so. Returns the paths.
/// Needs an X display; where there is none, call `ensure_display` first (before MPI is started). Throws Error(file).
std::vector<std::string> draw_pictures(const std::string& folder, const PictureOptions& options);

/// Whether DISPLAY names one. Without, VTK would end the program.
bool has_display();

/// Re-runs this program under xvfb-run if there is no display (does not return then); throws Error(file) with the
/// package to install if xvfb-run is missing.
void ensure_display(int argc, char** argv);

}  // namespace tenon
