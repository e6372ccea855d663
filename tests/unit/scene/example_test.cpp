// SPDX-License-Identifier: BSD-3-Clause
// How a room declares its part of the scene and reads it; copied by authors of components.
#include <gtest/gtest.h>

#include "framework/scene/schema.hpp"

namespace tenon {
namespace {

scene::Schema heat_schema() {
  using scene::Range;
  scene::Schema boundary("A condition on a set of sides.");
  boundary.texts("sideset", "sets of sides")
      .required()
      .function("temperature", "K", "prescribed temperature")
      .function("flux", "W/m^2", "heat flowing in")
      .exactly_one({"temperature", "flux"});
  scene::Schema heat("Heat conduction.");
  heat.text("mesh", "name of a mesh")
      .required()
      .required_quantity("conductivity", "W/(m K)", "thermal conductivity", Range::positive())
      .quantity("initial_temperature", "K", "temperature at the start", "20 degC", Range::positive())
      .choice("scheme", {"explicit", "implicit"}, "time integration", "explicit")
      .list("boundary", boundary, "conditions on the surface");
  return scene::Schema("A simulation.")
      .variants("components", scene::Key::Type::named, {{"heat", heat}}, "physics components by name")
      .required();
}

TEST(SceneExample, DeclaresAndReads) {
  const std::string text =
      "components:\n"
      "  bar:\n"
      "    type: heat\n"
      "    mesh: fine\n"
      "    conductivity: 386 W/(m K)\n"
      "    boundary:\n"
      "      - {sideset: [left, right], flux: 10 kW/m^2}\n";
  scene::Diagnostics diagnostics;
  const scene::Value root = scene::parse_scene(text, "scene.yaml", {}, heat_schema(), diagnostics);
  diagnostics.throw_if_any();
  for (const auto& [name, component] : root.entries("components")) {
    EXPECT_EQ(name, "bar");
    EXPECT_EQ(component.text("type"), "heat");
    EXPECT_EQ(component.real("conductivity"), 386.0);
    EXPECT_EQ(component.real("initial_temperature"), 293.15);
    EXPECT_EQ(component.text("scheme"), "explicit");
    for (const scene::Value& boundary : component.items("boundary")) {
      EXPECT_EQ(boundary.texts("sideset"), (std::vector<std::string>{"left", "right"}));
      ASSERT_TRUE(boundary.has("flux"));
      EXPECT_EQ(boundary.function("flux")(0.0), 10000.0);
    }
    if (component.text("mesh") != "coarse")
      diagnostics.error(component.where("mesh"),
                        "there is no mesh '" + component.text("mesh") + "'" + scene::suggestion("fine", {"coarse"}));
  }
  EXPECT_EQ(diagnostics.errors(),
            (std::vector<std::string>{"scene.yaml:4:11: there is no mesh 'fine'; valid: coarse"}));
}

}  // namespace
}  // namespace tenon
