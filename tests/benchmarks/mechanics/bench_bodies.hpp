// SPDX-License-Identifier: BSD-3-Clause
// Bodies whose steps are timed: boxes and plates of one kind of element under a uniform velocity gradient.
#pragma once

#include <memory>
#include <string>

#include "components/mechanics/mechanics.hpp"
#include "framework/mesh/renumber.hpp"

namespace tenon::bench {

enum class Kind { hex8, hex8_full, tet4, wedge6, quad4 };
enum class Law { elastic, j2, johnson_cook };

struct Case {
  std::string name;
  Kind kind = Kind::hex8;
  Law law = Law::elastic;
  HourglassOptions::Form hourglass = HourglassOptions::Form::viscous;
};

/// Collective. A unit cube of 64^3 cells (tet4: 35^3 of six each, wedge6: 51^3 of two each), or a plate of 512^2; each
/// about 262,000 elements.
MeshData make_mesh(Kind kind);
std::shared_ptr<const Mesh> distributed(MeshData&& mesh);

/// Collective. Ready for its first step. The step is a fifth to a tenth of the stable one, so that the body yields
/// everywhere within the first steps and is still sound after hundreds.
std::unique_ptr<Mechanics> make_body(std::shared_ptr<const Mesh> mesh, const Case& c);

/// Advances by so many steps.
void take_steps(Mechanics& body, int steps);

}  // namespace tenon::bench
