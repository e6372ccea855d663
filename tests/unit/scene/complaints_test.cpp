// SPDX-License-Identifier: BSD-3-Clause
// Every refusal of a value or key: exact place and words.
#include <gtest/gtest.h>

#include "rich_schema.hpp"

namespace tenon::testing {
namespace {

using Errors = std::vector<std::string>;

/// A scene with a component of mechanics that has these further lines, from line 6 on.
std::string body(const std::string& lines) {
  return "end_time: 1 s\ncomponents:\n  b:\n    type: mechanics\n    mesh: m\n" + lines;
}

/// A scene with an elastic material that has these further lines, from line 6 on.
std::string material(const std::string& lines) {
  return "end_time: 1 s\ncomponents: {i: {type: idle}}\nmaterials:\n  c:\n    type: elastic\n" + lines;
}

const std::string rest = "    density: 1\n    youngs_modulus: 1\n";

TEST(Complaints, AGoodSceneHasNone) {
  EXPECT_EQ(complaints(good_scene), Errors{});
  EXPECT_EQ(complaints(body("")), Errors{});
}

TEST(Complaints, UnknownKeys) {
  EXPECT_EQ(complaints(material(rest + "    poisons_ratio: 0.3\n")),
            (Errors{"8:5: materials.c: unknown key 'poisons_ratio', did you mean 'poissons_ratio'?"}));
  EXPECT_EQ(complaints(material(rest + "    colour: red\n")),
            (Errors{"8:5: materials.c: unknown key 'colour'; valid: type, density, youngs_modulus, poissons_ratio"}));
  EXPECT_EQ(complaints("end_time: 1\ncomponents: {i: {type: idle}}\nmateriels: {}\n"),
            (Errors{"3:1: unknown key 'materiels', did you mean 'materials'?"}));
}

TEST(Complaints, MissingKeys) {
  EXPECT_EQ(complaints("{}"), (Errors{"1:1: missing key 'end_time' (when the run ends), a time such as 80 us",
                                      "1:1: missing key 'components' (physics components by name)"}));
  EXPECT_EQ(complaints(material("    youngs_modulus: 1\n")),
            (Errors{"4:3: materials.c: missing key 'density' (mass density), a density such as 8930 kg/m^3"}));
  // A misspelt key is one mistake, not two.
  EXPECT_EQ(complaints(material("    youngs_modulus: 1\n    densty: 1\n")),
            (Errors{"7:5: materials.c: unknown key 'densty', did you mean 'density'?"}));
}

TEST(Complaints, WrongDimensionAndUnit) {
  EXPECT_EQ(
      complaints(material("    density: 5 m\n    youngs_modulus: 117 Gpa\n")),
      (Errors{"6:14: materials.c.density: '5 m': it is a length; expected a density such as 8930 kg/m^3",
              "7:21: materials.c.youngs_modulus: '117 Gpa': there is no unit 'Gpa' (did you mean 'GPa'?); expected a "
              "pressure, stress or modulus such as 117 GPa"}));
  EXPECT_EQ(complaints(body("    initial_velocity: [0, 3 kg, -227 m/s]\n")),
            (Errors{"6:27: components.b.initial_velocity: '3 kg': it is a mass; expected a velocity such as 227 m/s"}));
}

TEST(Complaints, OutOfRangeInTheUnitOfTheUser) {
  EXPECT_EQ(
      complaints(material("    density: -5 g/cm^3\n    youngs_modulus: 1\n    poissons_ratio: 50 %\n")),
      (Errors{
          "6:14: materials.c.density: '-5 g/cm^3' is out of range; it must be greater than 0 g/cm^3",
          "8:21: materials.c.poissons_ratio: '50 %' is out of range; it must be greater than -100 % and less than 50 "
          "%"}));
  EXPECT_EQ(
      complaints(body("    boundary: [{nodeset: a, temperature: -300 degC}]\n")),
      (Errors{"6:42: components.b.boundary.0.temperature: '-300 degC' is out of range; it must be greater than -273.15 "
              "degC"}));
  EXPECT_EQ(complaints(body("") + "output: {checkpoint: {every: 0}}\n"),
            (Errors{"6:30: output.checkpoint.every: '0' is out of range; it must be at least 1 and at most 1000000"}));
}

TEST(Complaints, WrongTypes) {
  EXPECT_EQ(
      complaints(body("    initial_velocity: 3 m/s\n")),
      (Errors{
          "6:23: components.b.initial_velocity: found '3 m/s', expected three quantities such as [0, 0, 227 m/s]"}));
  EXPECT_EQ(
      complaints(body("    initial_velocity: [1, 2]\n")),
      (Errors{"6:23: components.b.initial_velocity: found 2 components, expected three quantities such as [0, 0, 227 "
              "m/s]"}));
  EXPECT_EQ(
      complaints(body("    quadrature: Ful\n    erosion: treu\n    boundary: 3\n")),
      (Errors{"6:17: components.b.quadrature: 'Ful' is none of the choices; valid: reduced, full; did you mean 'full'?",
              "7:14: components.b.erosion: found 'treu', expected true or false, did you mean 'true'?",
              "8:15: components.b.boundary: found '3', expected a list of mappings, each after a '-'"}));
  EXPECT_EQ(
      complaints(body("") + "output: {times: 3 s, fields: [[a]], checkpoint: {every: 1.5}}\n"),
      (Errors{"6:17: output.times: found '3 s', expected a list of quantities such as [80 us]",
              "6:31: output.fields: found a list in a list of words, expected a word",
              "6:57: output.checkpoint.every: found '1.5', expected a whole number without a unit, such as 100"}));
  EXPECT_EQ(
      complaints("[1, 2]"),
      (Errors{"1:1: found a list, expected a mapping with the keys end_time, meshes, materials, components, output"}));
  EXPECT_EQ(complaints("end_time: [1 s]\ncomponents: [a]\n"),
            (Errors{"1:11: end_time: found a list, expected a time such as 80 us",
                    "2:13: components: found a list, expected named blocks, one mapping below each name"}));
}

TEST(Complaints, TooLargeWholeNumbers) {
  EXPECT_EQ(complaints(body("") + "output: {checkpoint: {every: 99999999999999999999}}\n"),
            (Errors{"6:30: output.checkpoint.every: '99999999999999999999' is too large for a whole number"}));
}

TEST(Complaints, EmptyValuesStandAtTheirKey) {
  EXPECT_EQ(complaints("end_time:\ncomponents:\nmaterials:\n  c:\n"),
            (Errors{"1:1: end_time: has no value; expected a time such as 80 us",
                    "2:1: components: has no value; expected named blocks, one mapping below each name",
                    "4:3: materials.c: found nothing, expected a mapping with the key 'type'; valid types: elastic, "
                    "johnson_cook"}));
  EXPECT_EQ(
      complaints(body("    boundary: [{nodeset: '', velocity: 1}]\noutput:\n")),
      (Errors{"6:17: components.b.boundary.0.nodeset: has no value; expected a word or a list of words",
              "7:1: output: has no value; expected a mapping with the keys of the block, or {} for all defaults"}));
  EXPECT_EQ(complaints("end_time: 1\ncomponents: {}\n"),
            (Errors{"2:13: components: is empty, expected at least one named block"}));
}

TEST(Complaints, DuplicateKeys) {
  EXPECT_EQ(complaints(material(rest + "    density: 2\n")),
            (Errors{"8:5: key 'density' is given twice (first in line 6); keep one"}));
  EXPECT_EQ(complaints("end_time: 1\nend_time: 2\ncomponents: {i: {type: idle}, i: {type: mechanics}}\n"),
            (Errors{"2:1: key 'end_time' is given twice (first in line 1); keep one",
                    "3:31: key 'i' is given twice (first in line 3); keep one"}));
}

TEST(Complaints, Groups) {
  EXPECT_EQ(
      complaints(body("") + "meshes:\n  a: {}\n  b: {file: x, generate: y}\n"),
      (Errors{"7:3: meshes.a: missing key: one of 'file', 'generate' must be given",
              "8:16: meshes.b: 'generate' and 'file' exclude each other; give exactly one of 'file', 'generate'"}));
  EXPECT_EQ(complaints(body("") + "output: {checkpoint: {interval: 1 s, every: 3}}\n"),
            (Errors{"6:38: output.checkpoint: 'every' and 'interval' exclude each other; give at most one of 'every', "
                    "'interval'"}));
}

TEST(Complaints, TypesOfVariants) {
  EXPECT_EQ(
      complaints("end_time: 1\ncomponents:\n  a: {type: mecanics}\n  b: {mesh: x}\n  c: {type: [1]}\n  d: 3\n"),
      (Errors{"3:13: components.a: unknown type 'mecanics', did you mean 'mechanics'?",
              "4:3: components.b: missing key 'type'; valid: mechanics, idle",
              "5:13: components.c: type: found a list, expected one of mechanics, idle",
              "6:6: components.d: found '3', expected a mapping with the key 'type'; valid types: mechanics, idle"}));
}

TEST(Complaints, NamesOfBlocks) {
  EXPECT_EQ(
      complaints(
          "end_time: 1\ncomponents: {9a: {type: idle}, 'a b': {type: idle}, a-b_9: {type: idle}, ä: {type: idle}}\n"),
      (Errors{"2:14: components: '9a' is not a name; a name is a letter, then letters, digits, '_' and '-'",
              "2:32: components: 'a b' is not a name; a name is a letter, then letters, digits, '_' and '-'",
              "2:74: components: 'ä' is not a name; a name is a letter, then letters, digits, '_' and '-'"}));
}

TEST(Complaints, Functions) {
  const auto velocity = [](const std::string& function) {
    return complaints(body("    boundary:\n      - nodeset: a\n        velocity: " + function + "\n"));
  };
  const std::string at = "components.b.boundary.0.velocity";
  EXPECT_EQ(velocity("{table: [[0, 1], [2 us, 3], [2 us, 4]]}"),
            (Errors{"8:48: " + at + ".table: time '2 us' does not come after 2e-06 s; times must ascend"}));
  EXPECT_EQ(velocity("{table: []}"),
            (Errors{"8:27: " + at + ".table: found an empty list, expected points such as [[0 s, 227 m/s], ...]"}));
  EXPECT_EQ(velocity("{table: [[0, 1, 2], 3, [1 m, 2 s]]}"),
            (Errors{"8:28: " + at + ".table: found a list of 3, expected a point [time, value]",
                    "8:39: " + at + ".table: found '3', expected a point [time, value]",
                    "8:43: " + at + ".table: '1 m': it is a length; expected a time such as 80 us",
                    "8:48: " + at + ".table: '2 s': it is a time; expected a velocity such as 227 m/s"}));
  EXPECT_EQ(velocity("{sin: {}}"),
            (Errors{"8:9: " + at + ": missing key: one of 'table', 'sine', 'smooth_step', 'expression' must be given",
                    "8:20: " + at + ": unknown key 'sin', did you mean 'sine'?"}));
  EXPECT_EQ(velocity("{sine: {amplitude: 1, period: 0 ms}}"),
            (Errors{"8:49: " + at + ".sine.period: '0 ms' is out of range; it must be greater than 0 ms"}));
  EXPECT_EQ(velocity("{smooth_step: {from: 0, to: 1, start: 2, end: 1}}"),
            (Errors{"8:20: " + at + ".smooth_step: 'end' must come after 'start'"}));
  EXPECT_EQ(velocity("{table: [[0, 1]], sine: {amplitude: 1, period: 1}}"),
            (Errors{"8:37: " + at +
                    ": 'sine' and 'table' exclude each other; give exactly one of 'table', 'sine', "
                    "'smooth_step', 'expression'"}));
}

TEST(Complaints, TheAmplitudeOfATemperatureIsADifference) {
  EXPECT_EQ(
      complaints(
          body("    boundary:\n      - nodeset: a\n        temperature: {sine: {amplitude: 5 degC, period: 1}}\n")),
      (Errors{
          "8:23: components.b.boundary.0.temperature.sine: missing key 'offset' (mean value), a temperature such as "
          "20 degC",
          "8:41: components.b.boundary.0.temperature.sine.amplitude: '5 degC': it is a point on a temperature scale, "
          "not a difference; write the difference in K; expected a temperature difference such as 5 K"}));
}

TEST(Complaints, AllMistakesAreReportedTogetherInTheOrderOfTheFile) {
  const Errors errors = complaints(
      "materials:\n  c: {type: elastc}\nend_time: 5 m\noutput: {feilds: a}\ncomponents:\n  b: {type: mechanics}\n");
  ASSERT_EQ(errors.size(), 4U);
  EXPECT_EQ(errors[0], "2:13: materials.c: unknown type 'elastc', did you mean 'elastic'?");
  EXPECT_EQ(errors[1], "3:11: end_time: '5 m': it is a length; expected a time such as 80 us");
  EXPECT_EQ(errors[2], "4:10: output: unknown key 'feilds', did you mean 'fields'?");
  EXPECT_EQ(errors[3], "6:3: components.b: missing key 'mesh' (name of a mesh)");
}

TEST(Complaints, LongAndOddTextIsShortened) {
  const Errors errors = complaints("end_time: \"" + std::string(5000, 'x') + "\\n\"\ncomponents: {i: {type: idle}}\n");
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_LT(errors[0].size(), 250U);
  EXPECT_EQ(errors[0].find('\n'), std::string::npos);
}

}  // namespace
}  // namespace tenon::testing
