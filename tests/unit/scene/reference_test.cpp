// SPDX-License-Identifier: BSD-3-Clause
// The scene reference: complete, linked, and with examples that the schema accepts.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "framework/base/error.hpp"
#include "rich_schema.hpp"

namespace tenon::testing {
namespace {

using scene::scene_reference;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// The texts between "```yaml" and "```" from the first section on.
std::vector<std::string> examples(const std::string& reference) {
  std::vector<std::string> found;
  const std::string begin = "```yaml\n", end = "```\n";
  for (std::size_t at = reference.find("## The scene"); (at = reference.find(begin, at)) != std::string::npos;) {
    at += begin.size();
    const std::size_t stop = reference.find(end, at);
    found.push_back(reference.substr(at, stop - at));
    at = stop + end.size();
  }
  return found;
}

TEST(Reference, HasATableRowForEveryKey) {
  const std::string text = scene_reference(rich_schema());
  EXPECT_TRUE(contains(text, "| `end_time` | s |  | greater than 0 s | yes | when the run ends |"));
  EXPECT_TRUE(contains(text,
                       "| `poissons_ratio` | number | `0.3` | greater than -1 and less than 0.5 |  | ratio of lateral "
                       "to axial strain |"));
  EXPECT_TRUE(contains(text, "| `softening_width` | K (difference) | `5 K` |  |  | width of the transition |"));
  EXPECT_TRUE(contains(text, "| `exponent` | whole number | `1` | at least 1 and at most 9 |  | of the softening |"));
  EXPECT_TRUE(contains(text, "| `quadrature` | one of `reduced`, `full` | `reduced` |"));
  EXPECT_TRUE(contains(text, "| `nodeset` | word or list of words |  |  | yes | where it acts |"));
  EXPECT_TRUE(contains(text, "| `velocity` | function, m/s |"));
  EXPECT_TRUE(contains(text, "| `initial_velocity` | three components, m/s | `[0, 0, 0]` |"));
  EXPECT_TRUE(contains(text, "| `times` | list, s |  | at least 0 s |"));
  EXPECT_TRUE(contains(text, "| `erosion` | true or false | `false` |"));
  EXPECT_TRUE(contains(text, "| `materials` | [named blocks](#materials) |"));
  EXPECT_TRUE(contains(text, "| `boundary` | [list of blocks](#componentsmechanicsboundary) |"));
  EXPECT_TRUE(contains(text, "Exactly one of `velocity`, `temperature`, `pressure` must be given."));
  EXPECT_TRUE(contains(text, "At most one of `every`, `interval` can be given."));
  EXPECT_TRUE(contains(text, "Johnson-Cook \\| flow stress."));
}

TEST(Reference, SectionsFollowTheSchema) {
  std::vector<std::string> headings;
  for (const std::string& line : lines_of(scene_reference(rich_schema())))
    if (line.compare(0, 2, "##") == 0) headings.push_back(line);
  EXPECT_EQ(headings,
            (std::vector<std::string>{
                "## Contents", "## The scene", "## `meshes`", "## `materials`", "### `materials.elastic`",
                "### `materials.johnson_cook`", "## `components`", "### `components.mechanics`",
                "#### `components.mechanics.boundary`", "#### `components.mechanics.time_step`",
                "##### `components.mechanics.time_step.fixed`", "##### `components.mechanics.time_step.stable`",
                "### `components.idle`", "## `output`", "### `output.checkpoint`"}));
}

TEST(Reference, EveryLinkLeadsToAHeading) {
  const std::string text = scene_reference(rich_schema());
  std::vector<std::string> anchors;
  for (const std::string& line : lines_of(text)) {
    if (line.compare(0, 2, "##") != 0) continue;
    std::string anchor;
    for (const char c : line)
      if (c != '#' && c != '`' && c != '.' && !(c == ' ' && anchor.empty())) anchor += c;
    anchors.push_back(anchor);
  }
  int links = 0;
  for (std::size_t at = 0; (at = text.find("](#", at)) != std::string::npos; ++links) {
    at += 3;
    const std::string target = text.substr(at, text.find(')', at) - at);
    EXPECT_NE(std::find(anchors.begin(), anchors.end(), target), anchors.end()) << target;
  }
  EXPECT_EQ(links, 26);  // 13 in the contents, 6 of types, 7 of blocks
}

TEST(Reference, ExamplesAreAccepted) {
  const std::vector<std::string> found = examples(scene_reference(rich_schema()));
  ASSERT_EQ(found.size(), 11U);
  EXPECT_EQ(complaints(found.front()), std::vector<std::string>{}) << found.front();
  for (const std::string& example : found) {
    SCOPED_TRACE(example);
    // What surrounds the section is shown by its keys only, so other blocks' keys are missing; nothing else is wrong.
    for (const std::string& error : complaints(example)) EXPECT_TRUE(contains(error, "missing key '")) << error;
  }
}

TEST(Reference, ExamplesShowRequiredKeysAndTheirSurroundings) {
  EXPECT_TRUE(contains(scene_reference(rich_schema(), "components.mechanics.boundary"),
                       "```yaml\ncomponents:\n  my_component:\n    type: mechanics\n    boundary:\n"
                       "      - nodeset: [my_nodeset]\n        velocity: 227 m/s\n```\n"));
  EXPECT_TRUE(contains(scene_reference(rich_schema(), "output.checkpoint"),
                       "```yaml\noutput:\n  checkpoint:\n    every: 100\n```\n"));
  EXPECT_TRUE(contains(scene_reference(rich_schema(), "components.idle"),
                       "```yaml\ncomponents:\n  my_component:\n    type: idle\n```\n"));
}

TEST(Reference, ExamplesObeyRanges) {
  scene::Schema inner("i");
  inner.required_quantity("small", "m", "s", {0, 1e-6, true, true})
      .required_quantity("cold", "K", "c", {0, 100, false, false})
      .required_quantity("negative", "Pa", "n", {-std::numeric_limits<double>::infinity(), -1, false, false})
      .integer("many", "m", "", {1000, 2000, false, false})
      .required();
  const scene::Schema schema = scene::Schema("s").object("block", inner, "b").required();
  const std::vector<std::string> found = examples(scene_reference(schema));
  ASSERT_EQ(found.size(), 2U);
  for (const std::string& example : found) {
    scene::Diagnostics diagnostics;
    scene::parse_scene(example, "s", {}, schema, diagnostics);
    EXPECT_EQ(diagnostics.errors(), std::vector<std::string>{}) << example;
  }
}

TEST(Reference, OneSectionWithWhatIsInside) {
  const std::string text = scene_reference(rich_schema(), "materials");
  EXPECT_EQ(text.compare(0, 15, "## `materials`\n"), 0);
  EXPECT_TRUE(contains(text, "### `materials.elastic`"));
  EXPECT_FALSE(contains(text, "`components`"));
  EXPECT_EQ(scene_reference(rich_schema(), "boundary"),
            scene_reference(rich_schema(), "components.mechanics.boundary"));
}

TEST(Reference, UnknownSectionsGetASuggestion) {
  const auto refusal = [](const std::string& section) -> std::string {
    try {
      scene_reference(rich_schema(), section);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::usage);
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refusal("material"), "the scene reference has no section 'material', did you mean 'materials'?");
  EXPECT_EQ(refusal("components.mecanics"),
            "the scene reference has no section 'components.mecanics', did you mean 'components.mechanics'?");
  EXPECT_EQ(refusal("bondary"),
            "the scene reference has no section 'bondary', did you mean 'components.mechanics.boundary'?");
  EXPECT_TRUE(contains(refusal("zzzzzz"), "; valid: meshes, materials, materials.elastic, "));
}

TEST(Reference, IsTheSameEveryTime) {
  EXPECT_EQ(scene_reference(rich_schema()), scene_reference(rich_schema()));
}

TEST(Reference, IntroducesUnitsFunctionsNamesAndSet) {
  const std::string text = scene_reference(rich_schema());
  for (const char* part :
       {"# Scene reference", "**Units.**", "**Functions of time.**", "**Names.**", "--set end_time=", "smooth_step"})
    EXPECT_TRUE(contains(text, part)) << part;
}

}  // namespace
}  // namespace tenon::testing
