// SPDX-License-Identifier: BSD-3-Clause
// One small mesh of every generator and both kinds, for the tests of this room.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "framework/mesh/generators.hpp"

namespace tenon::testing {

struct MeshSample {
  std::string name;
  std::function<MeshData()> make;
};

inline std::vector<MeshSample> mesh_samples() {
  std::vector<MeshSample> samples;
  for (const bool simplices : {false, true}) {
    const std::string kind = simplices ? " of simplices" : "";
    samples.push_back({"box" + kind, [=] {
                         BoxShape s;
                         s.low = {-1, 0, 2}, s.high = {1, 3, 2.5};
                         s.elements = {7, 5, 4}, s.grading = {1, 3, 0.5};
                         s.distortion = 0.15, s.tetrahedra = simplices;
                         return generate(s);
                       }});
    samples.push_back({"cylinder" + kind, [=] {
                         CylinderShape s;
                         s.radius = 0.5, s.length = 2, s.core = 3, s.shell = 2, s.axial = 5, s.axial_grading = 2;
                         s.tetrahedra = simplices;
                         return generate(s);
                       }});
    samples.push_back({"quarter cylinder" + kind, [=] {
                         CylinderShape s;
                         s.core = 4, s.shell = 3, s.axial = 4, s.fraction = 0.25, s.tetrahedra = simplices;
                         return generate(s);
                       }});
    samples.push_back({"sphere" + kind, [=] {
                         SphereShape s;
                         s.core = 3, s.shell = 2, s.radius = 2, s.tetrahedra = simplices;
                         return generate(s);
                       }});
    samples.push_back({"annulus" + kind, [=] {
                         AnnulusShape s;
                         s.radial = 2, s.circumferential = 13, s.axial = 3, s.radial_grading = 2;
                         s.tetrahedra = simplices;
                         return generate(s);
                       }});
    samples.push_back({"plate" + kind, [=] {
                         PlateShape s;
                         s.length_x = 3, s.elements_x = 9, s.elements_y = 6, s.grading_x = 4, s.triangles = simplices;
                         return generate(s);
                       }});
  }
  return samples;
}

}  // namespace tenon::testing
