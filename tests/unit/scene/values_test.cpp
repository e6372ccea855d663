// SPDX-License-Identifier: BSD-3-Clause
// What a good scene becomes: values, defaults, functions, aliases, places.
#include <gtest/gtest.h>

#include <stdexcept>

#include "rich_schema.hpp"

namespace tenon::scene {
namespace {

Value parse(const std::string& text, const Schema& schema) {
  Diagnostics diagnostics;
  Value root = parse_scene(text, "s", {}, schema, diagnostics);
  EXPECT_EQ(diagnostics.errors(), std::vector<std::string>{});
  return root;
}

Value good() {
  return parse(testing::good_scene, testing::rich_schema());
}

Value entry(const Value& value, const std::string& key, const std::string& name) {
  for (const auto& [n, v] : value.entries(key))
    if (n == name) return v;
  throw std::out_of_range(name);
}

TEST(Values, QuantitiesVectorsListsWords) {
  const Value root = good();
  EXPECT_EQ(root.real("end_time"), 80e-6);
  EXPECT_EQ(entry(root, "materials", "steel").real("density"), 7850.0);
  EXPECT_EQ(entry(root, "materials", "steel").real("melting_temperature"), 1773.15);
  const Value body = entry(root, "components", "body");
  EXPECT_EQ(body.text("type"), "mechanics");
  EXPECT_EQ(body.vector("initial_velocity"), (Vec3{0, 0, -227}));
  EXPECT_EQ(root.child("output").reals("times"), (std::vector<double>{0, 10e-6, 20e-6}));
  EXPECT_EQ(root.child("output").texts("fields"), (std::vector<std::string>{"displacement"}));
  EXPECT_EQ(root.child("output").child("checkpoint").integer("every"), 50);
}

TEST(Values, DefaultsAreFilledIn) {
  const Value root = good();
  EXPECT_EQ(entry(root, "materials", "copper").real("poissons_ratio"), 0.3);
  EXPECT_FALSE(entry(root, "materials", "copper").given("poissons_ratio"));
  EXPECT_TRUE(entry(root, "materials", "copper").has("poissons_ratio"));
  EXPECT_EQ(entry(root, "materials", "steel").integer("exponent"), 1);
  EXPECT_EQ(entry(root, "materials", "steel").real("softening_width"), 5.0);
  const Value body = entry(root, "components", "body");
  EXPECT_EQ(body.text("quadrature"), "reduced");
  EXPECT_FALSE(body.flag("erosion"));
  EXPECT_EQ(body.items("boundary")[0].vector("direction"), (Vec3{0, 0, 1}));
}

TEST(Values, AnAbsentBlockStandsForItsDefaults) {
  const Value root = parse("{end_time: 1, components: {a: {type: idle}}}", testing::rich_schema());
  EXPECT_FALSE(root.has("output"));
  EXPECT_EQ(root.child("output").child("checkpoint").integer("every"), 100);
  EXPECT_TRUE(root.child("output").reals("times").empty());
  EXPECT_TRUE(root.entries("materials").empty());
  EXPECT_FALSE(root.has("materials"));
}

TEST(Values, VariantsOfAMappingAndAList) {
  EXPECT_EQ(entry(good(), "components", "body").child("time_step").text("type"), "stable");
  EXPECT_EQ(entry(good(), "components", "body").child("time_step").real("safety"), 0.5);
  const Schema schema = Schema("s").variants(
      "outputs", Key::Type::list,
      {{"history", Schema("h").text("file", "f")}, {"frames", Schema("f").integer("every", "steps", "3")}}, "outputs");
  const auto outputs = parse("outputs:\n  - type: frames\n  - {type: history, file: x}\n", schema).items("outputs");
  ASSERT_EQ(outputs.size(), 2U);
  EXPECT_EQ(outputs[0].text("type"), "frames");
  EXPECT_EQ(outputs[0].integer("every"), 3);
  EXPECT_EQ(outputs[1].text("file"), "x");
  EXPECT_EQ(outputs[1].where().line, 3);
}

TEST(Values, FunctionsOfTime) {
  const auto boundary = entry(good(), "components", "body").items("boundary");
  ASSERT_EQ(boundary.size(), 5U);
  const TimeFunction table = boundary[0].function("velocity");
  EXPECT_DOUBLE_EQ(table(1e-6), 2.0);
  EXPECT_DOUBLE_EQ(table(1.0), 1 / 3.6);
  const TimeFunction sine = boundary[1].function("temperature");
  EXPECT_DOUBLE_EQ(sine(0), 293.15);
  EXPECT_DOUBLE_EQ(sine(0.25e-3), 298.15);
  const TimeFunction step = boundary[2].function("velocity");
  EXPECT_DOUBLE_EQ(step(-1), 0.0);
  EXPECT_DOUBLE_EQ(step(0.5e-3), 1.5);
  EXPECT_DOUBLE_EQ(step(2e-3), 3.0);
  const Schema schema = Schema("s").function("f", "m", "f");
  EXPECT_TRUE(parse("f: 3 mm", schema).function("f").is_constant());
  EXPECT_EQ(parse("f: 3 mm", schema).function("f")(7.0), 3e-3);
  EXPECT_EQ(parse("f: {sine: {amplitude: 2, period: 1, phase: 90 deg}}", schema).function("f")(0.0), 2.0);
}

TEST(Values, AliasesAndMergeKeysCopy) {
  const Value soft = entry(good(), "materials", "soft");
  EXPECT_EQ(soft.real("density"), 8930.0);
  EXPECT_EQ(soft.real("youngs_modulus"), 1.5e9);
  EXPECT_EQ(entry(good(), "materials", "copper").real("youngs_modulus"), 117e9);
  const Schema schema = Schema("s").reals("a", "m", "a").reals("b", "m", "b");
  EXPECT_EQ(parse("a: &x [1, 2]\nb: *x", schema).reals("b"), (std::vector<double>{1, 2}));
}

TEST(Values, NamedBlocksKeepTheOrderOfTheFile) {
  std::vector<std::string> names;
  for (const auto& [name, value] : good().entries("materials")) names.push_back(name);
  EXPECT_EQ(names, (std::vector<std::string>{"copper", "soft", "steel"}));
}

TEST(Values, KnowTheirPlaces) {
  const Value root = good();
  EXPECT_EQ(to_string(root.where("end_time")), "s:2:11");
  EXPECT_EQ(to_string(root.where_name("materials", "steel")), "s:15:3");
  const Value steel = entry(root, "materials", "steel");
  EXPECT_EQ(to_string(steel.where()), "s:15:3");
  EXPECT_EQ(to_string(steel.where("density")), "s:17:14");
  EXPECT_EQ(to_string(steel.where("exponent")), "s:15:3");  // absent: the block
  EXPECT_EQ(to_string(steel.where("type")), "s:16:11");
}

TEST(Values, ColumnsCountLettersNotBytes) {
  const Schema schema = Schema("s").reals("a", "m", "a");
  Diagnostics diagnostics;
  parse_scene("a: [1 µm, 2 s]", "s", {}, schema, diagnostics);
  ASSERT_EQ(diagnostics.errors().size(), 1U);
  EXPECT_EQ(diagnostics.errors()[0].substr(0, 7), "s:1:11:");
}

TEST(Values, AskingForWhatTheSchemaLacksIsAProgrammingError) {
  const Value root = good();
  EXPECT_THROW(root.has("nonsense"), std::logic_error);
  EXPECT_THROW(root.real("output"), std::logic_error);
  EXPECT_THROW(root.child("end_time"), std::logic_error);
  const Value boundary = entry(root, "components", "body").items("boundary")[0];
  EXPECT_FALSE(boundary.has("temperature"));
  EXPECT_THROW(boundary.function("temperature"), std::logic_error);
}

TEST(Values, MistakesInASchemaAreFoundWhenItIsBuilt) {
  EXPECT_THROW(Schema("s").quantity("a", "m", "a", "5 s"), std::logic_error);
  EXPECT_THROW(Schema("s").quantity("a", "m", "a", "-5 m", Range::positive()), std::logic_error);
  EXPECT_THROW(Schema("s").choice("a", {"x", "y"}, "a", "z"), std::logic_error);
  EXPECT_THROW(Schema("s").vector("a", "m", "a", "[0, 0]"), std::logic_error);
  EXPECT_THROW(Schema("s").flag("a", "a", "false").text("a", "again"), std::logic_error);
  EXPECT_THROW(Schema("s").variants("a", Key::Type::text, {{"x", Schema("x")}}, "a"), std::logic_error);
}

}  // namespace
}  // namespace tenon::scene
