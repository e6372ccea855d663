// SPDX-License-Identifier: BSD-3-Clause
#include <H5public.h>
#include <fmt/core.h>
#include <vtkVersion.h>
#include <zoltan.h>

#include "apps/tenon/commands.hpp"

namespace tenon {

std::string version_text() {
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  return fmt::format("tenon {} (g++ {}, {}, HDF5 {}.{}.{}, VTK {}, Zoltan {:.3g})", TENON_VERSION, __VERSION__,
                     MpiEnvironment::library_version(), major, minor, release, vtkVersion::GetVTKVersion(),
                     ZOLTAN_VERSION_NUMBER);
}

}  // namespace tenon
