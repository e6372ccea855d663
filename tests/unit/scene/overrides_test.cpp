// SPDX-License-Identifier: BSD-3-Clause
// Values from the command line: --set path=value.
#include <gtest/gtest.h>

#include "rich_schema.hpp"

namespace tenon::testing {
namespace {

using Errors = std::vector<std::string>;

scene::Value with(const std::vector<scene::Override>& overrides) {
  scene::Diagnostics diagnostics;
  scene::Value root = scene::parse_scene(good_scene, "s", overrides, rich_schema(), diagnostics);
  EXPECT_EQ(diagnostics.errors(), Errors{});
  return root;
}

TEST(Overrides, ReplaceValues) {
  const scene::Value root = with({{"end_time", "5 ms"},
                                  {"components.body.initial_velocity", "[1, 2, 3 km/s]"},
                                  {"components.body.initial_velocity.1", "7"},
                                  {"components.body.boundary.0.nodeset", "[x, y]"},
                                  {"materials.soft.density", "1"}});
  EXPECT_EQ(root.real("end_time"), 5e-3);
  const scene::Value body = root.entries("components")[0].second;
  EXPECT_EQ(body.vector("initial_velocity"), (Vec3{1, 7, 3000}));
  EXPECT_EQ(body.items("boundary")[0].texts("nodeset"), (std::vector<std::string>{"x", "y"}));
  // The anchor that the block was copied from keeps its value.
  EXPECT_EQ(root.entries("materials")[0].second.real("density"), 8930.0);
  EXPECT_EQ(root.entries("materials")[1].second.real("density"), 1.0);
}

TEST(Overrides, CreateKeysAndTheBlocksAround) {
  const scene::Value root = with({{"materials.copper.poissons_ratio", "0.34"},
                                  {"output.checkpoint", "{}"},
                                  {"output.checkpoint.interval", "1 us"},
                                  {"components.body.boundary.5", "{nodeset: z}"},
                                  {"components.body.boundary.5.velocity", "{sine: {amplitude: 1, period: 2}}"},
                                  {"components.extra.type", "idle"}});
  EXPECT_EQ(root.entries("materials")[0].second.real("poissons_ratio"), 0.34);
  EXPECT_EQ(root.child("output").child("checkpoint").real("interval"), 1e-6);
  EXPECT_EQ(root.entries("components")[0].second.items("boundary").size(), 6U);
  EXPECT_EQ(root.entries("components").back().first, "extra");
  EXPECT_EQ(scene::to_string(root.entries("materials")[0].second.where("poissons_ratio")),
            "--set materials.copper.poissons_ratio");
}

TEST(Overrides, TheLastOneWins) {
  EXPECT_EQ(with({{"end_time", "1"}, {"end_time", "2"}}).real("end_time"), 2.0);
}

TEST(Overrides, WorkOnAnEmptyScene) {
  EXPECT_EQ(complaints("", {{"end_time", "1"}, {"components.a.type", "idle"}}), Errors{});
}

TEST(Overrides, ComplaintsNameThePath) {
  EXPECT_EQ(complaints(good_scene, {{"end_time", "5 m"}}),
            (Errors{"--set end_time: '5 m': it is a length; expected a time such as 80 us"}));
  EXPECT_EQ(complaints(good_scene, {{"end_tme", "5"}}),
            (Errors{"--set end_tme: unknown key 'end_tme', did you mean 'end_time'?"}));
  EXPECT_EQ(
      complaints(good_scene, {{"components.body.quadratur", "full"}}),
      (Errors{
          "--set components.body.quadratur: components.body: unknown key 'quadratur', did you mean 'quadrature'?"}));
  EXPECT_EQ(complaints(good_scene, {{"component.body.mesh", "x"}}),
            (Errors{"--set component.body.mesh: unknown key 'component', did you mean 'components'?"}));
  EXPECT_EQ(complaints(good_scene, {{"components.boddy.mesh", "x"}}),
            (Errors{"--set components.boddy.mesh: components.boddy: missing key 'type'; valid: mechanics, idle",
                    "--set components.boddy.mesh: components: the scene has no 'boddy', did you mean 'body'?"}));
  EXPECT_EQ(complaints(good_scene, {{"output.checkpoint.every", "0"}}),
            (Errors{"--set output.checkpoint.every: '0' is out of range; it must be at least 1 and at most 1000000"}));
  EXPECT_EQ(complaints(good_scene, {{"end_time", ""}}),
            (Errors{"--set end_time: has no value; expected a time such as 80 us"}));
}

TEST(Overrides, PathsThatLeadNowhere) {
  EXPECT_EQ(complaints(good_scene, {{"end_time.x", "5"}}),
            (Errors{"--set end_time.x: there is nothing inside the value '80 us' (s:2:11); shorten the path"}));
  EXPECT_EQ(
      complaints(good_scene, {{"components.body.boundary.9.nodeset", "x"}}),
      (Errors{
          "--set components.body.boundary.9.nodeset: the list (s:26:7) has 5 elements; expected a number from 0 to 5 "
          "(the last one adds to the list)"}));
  EXPECT_EQ(
      complaints(good_scene, {{"components.body.boundary.foot.nodeset", "x"}}),
      (Errors{
          "--set components.body.boundary.foot.nodeset: 'foot' is not a place in the list (s:26:7); expected a number "
          "from 0 to 5 (the last one adds to the list)"}));
  for (const char* path : {"", ".", "a..b", "end_time.", ".end_time"}) {
    const Errors errors = complaints(good_scene, {{path, "5"}});
    ASSERT_EQ(errors.size(), 1U) << path;
    EXPECT_NE(errors[0].find("is not a path"), std::string::npos) << errors[0];
  }
}

TEST(Overrides, ValuesThatAreNoYaml) {
  EXPECT_EQ(complaints(good_scene, {{"components.body.initial_velocity", "[1, 2"}}),
            (Errors{"--set components.body.initial_velocity: YAML syntax: a '[' without its ']' or ','"}));
  EXPECT_EQ(complaints(good_scene, {{"end_time", std::string(1000, '[')}}),
            (Errors{"--set end_time: more than 50 brackets open at once"}));
}

constexpr const char* parametrised = R"(parameters:
  n: 2
  size: 3 mm
  half: $(size/2)
end_time: $(10*(n + 1)) us
components:
  body:
    type: mechanics
    mesh: bar$(n)
    initial_velocity: [$(half), 0, "$(-max(n, 5)) km/s"]
output: {checkpoint: {every: $(1e5*n)}}
)";

TEST(Parameters, StandForNumbersAnywhere) {
  for (const int n : {2, 7}) {
    scene::Diagnostics diagnostics;
    const scene::Value root =
        scene::parse_scene(parametrised, "s", {{"parameters.n", std::to_string(n)}}, rich_schema(), diagnostics);
    ASSERT_EQ(diagnostics.errors(), Errors{});
    EXPECT_DOUBLE_EQ(root.real("end_time"), 1e-5 * (n + 1));
    const scene::Value body = root.entries("components")[0].second;
    EXPECT_EQ(body.text("mesh"), "bar" + std::to_string(n));
    EXPECT_EQ(body.vector("initial_velocity"), (Vec3{1.5e-3, 0, n == 2 ? -5000.0 : -7000.0}));
    EXPECT_EQ(root.child("output").child("checkpoint").integer("every"), n * 100000);
  }
}

TEST(Parameters, ComplaintsNameTheFormula) {
  EXPECT_EQ(complaints(parametrised, {{"parameters.n", "many"}}),
            (Errors{"--set parameters.n: parameters.n: found 'many', expected a number or a quantity such as 2 mm"}));
  EXPECT_EQ(complaints(parametrised, {{"parameters", "[1]"}}).size(), 6u);  // and the five formulas that know none
  const Errors unknown = complaints(parametrised, {{"end_time", "$(2*m) us"}});
  ASSERT_EQ(unknown.size(), 1u);
  EXPECT_EQ(unknown[0].find("--set end_time: $(2*m): "), 0u) << unknown[0];
  EXPECT_EQ(complaints(parametrised, {{"end_time", "$((2) us"}}),
            (Errors{"--set end_time: '$((2) us': '$(' has no ')' that closes it"}));
  EXPECT_EQ(complaints(parametrised, {{"end_time", "$(1/0) us"}}),
            (Errors{"--set end_time: $(1/0) is inf, expected a finite number"}));
  EXPECT_EQ(complaints(parametrised, {{"end_time", "$(2) bananas"}}).size(), 1u);
  EXPECT_EQ(complaints(parametrised, {{"parameters.haf", "3"}}),
            (Errors{"--set parameters.haf: parameters.haf: no formula uses it, did you mean 'half'?"}));
  EXPECT_EQ(complaints(parametrised, {{"parameters.q_1", "3"}}),
            (Errors{"--set parameters.q_1: parameters.q_1: no formula uses it; valid: n, size, half"}));
}

}  // namespace
}  // namespace tenon::testing
