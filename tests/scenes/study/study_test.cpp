// SPDX-License-Identifier: BSD-3-Clause
// The arithmetic of studies: extrapolation, orders, command line, runs.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "apps/tenon/study_arguments.hpp"
#include "apps/tenon/study_table.hpp"
#include "tests/support/test_communicator.hpp"

namespace tenon {
namespace {

TEST(Richardson, FindsOrderAndLimitForAnyRatioOfSizes) {
  for (const double order : {0.5, 1.0, 2.0, 3.7})
    for (const double middle : {0.5, 0.7, 0.9}) {
      const double size[3] = {1.0, middle, 0.4};
      double value[3];
      for (int i = 0; i < 3; ++i) value[i] = 7.0 - 0.3 * std::pow(size[i], order);
      const Extrapolation e = richardson(size, value);
      ASSERT_TRUE(e.monotone) << order << " " << middle;
      EXPECT_NEAR(e.order, order, 1e-8);
      EXPECT_NEAR(e.value, 7.0, 1e-9);
    }
}

TEST(Richardson, SaysWhenTheRunsDoNotConverge) {
  const double size[3] = {4, 2, 1};
  EXPECT_FALSE(richardson(size, {1.0, 2.0, 1.5}).monotone);  // turns back
  EXPECT_FALSE(richardson(size, {1.0, 2.0, 3.5}).monotone);  // runs away
  EXPECT_FALSE(richardson(size, {1.0, 1.0, 1.0}).monotone);  // says nothing
  EXPECT_FALSE(richardson({1, 2, 4}, {1.0, 1.5, 1.75}).monotone);
  EXPECT_TRUE(std::isnan(richardson(size, {1.0, 2.0, 1.5}).order));
}

StudyPlan plan_of(std::vector<double> sizes, bool with_reference) {
  StudyPlan plan;
  plan.vary = {{"a.b", "b", {}}};
  StudyQuantity q;
  q.name = "q", q.column = "c";
  if (with_reference) q.reference = scene::Expression("7", {"t"});
  plan.quantities = {q};
  for (const double h : sizes) plan.runs.push_back({{std::to_string(h)}, {}, "b-" + std::to_string(h)});
  return plan;
}

std::vector<StudyRow> rows_of(const std::vector<double>& sizes, double order) {
  std::vector<StudyRow> rows;
  for (const double h : sizes) {
    StudyRow row;
    row.done = true, row.size = h, row.status = "done", row.seconds = 2, row.work = 8;
    const double value = 7 + std::pow(h, order);
    row.values = {{value, std::abs(value - 7) / 7, unknown}};
    rows.push_back(row);
  }
  return rows;
}

TEST(StudyTable, OrdersBetweenSuccessiveSizesWhateverTheOrderOfTheRuns) {
  const std::vector<double> sizes{0.25, 1, 0.5};
  const StudyPlan plan = plan_of(sizes, true);
  std::vector<StudyRow> rows = rows_of(sizes, 2);
  EXPECT_TRUE(analyse(plan, rows).empty());
  EXPECT_NEAR(rows[0].orders[0], 2.0, 1e-9);
  EXPECT_TRUE(std::isnan(rows[1].orders[0]));
  EXPECT_NEAR(rows[2].orders[0], 2.0, 1e-9);
}

TEST(StudyTable, ExtrapolatesWithoutAReferenceAndLeavesFailedRunsOut) {
  const std::vector<double> sizes{1, 0.5, 0.25, 0.125};
  const StudyPlan plan = plan_of(sizes, false);
  std::vector<StudyRow> rows = rows_of(sizes, 3);
  for (StudyRow& row : rows) row.values[0].error = unknown;
  const std::vector<std::string> notes = analyse(plan, rows);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("extrapolated to 7"), std::string::npos) << notes[0];
  EXPECT_NE(notes[0].find("order 3.00"), std::string::npos) << notes[0];
  EXPECT_NEAR(rows[0].values[0].error, 1.0 / 7, 1e-8);
  rows[3].done = false, rows[3].status = "broke, badly \"so\"";
  rows[2].done = false;
  EXPECT_NE(analyse(plan, rows)[0].find("needs three"), std::string::npos);
  const std::string csv = study_csv(plan, rows);
  EXPECT_EQ(csv.substr(0, csv.find('\n')),
            "run,b,size,q,q_error,q_order,seconds,set_up_seconds,steps,element_steps,element_steps_per_second,status");
  EXPECT_NE(csv.find("\"broke, badly \"\"so\"\"\""), std::string::npos) << csv;
}

TEST(StudyTable, ErrorsAreAgainstTheFinestRunIfTheRunsDoNotConverge) {
  const std::vector<double> sizes{1, 0.5, 0.25};
  const StudyPlan plan = plan_of(sizes, false);
  std::vector<StudyRow> rows = rows_of(sizes, 1);
  rows[1].values[0].value = 100;
  const std::vector<std::string> notes = analyse(plan, rows);
  EXPECT_NE(notes[0].find("do not converge monotonically"), std::string::npos) << notes[0];
  EXPECT_NEAR(rows[1].values[0].error, (100 - 7.25) / 7.25, 1e-12);
}

TEST(StudyTable, SizesThatAreEqualGiveNoErrorAndAnOldOneGoes) {
  const std::vector<double> sizes{1, 0.5, 0.25};
  const StudyPlan plan = plan_of(sizes, false);
  std::vector<StudyRow> rows = rows_of(sizes, 2);
  analyse(plan, rows);
  EXPECT_TRUE(std::isfinite(rows[0].values[0].error));
  rows[2].size = rows[1].size * (1 - 1e-15);  // mean element sizes of one mesh
  const std::vector<std::string> notes = analyse(plan, rows);
  EXPECT_NE(notes[0].find("have the same size"), std::string::npos) << notes[0];
  for (const StudyRow& row : rows) EXPECT_TRUE(std::isnan(row.values[0].error) && std::isnan(row.orders[0]));
  const StudyPlan referred = plan_of(sizes, true);
  rows = rows_of(sizes, 2);
  rows[2].size = rows[1].size * (1 - 1e-15);
  EXPECT_TRUE(analyse(referred, rows).empty());
  EXPECT_NEAR(rows[1].orders[0], 2.0, 1e-9);
  EXPECT_TRUE(std::isnan(rows[2].orders[0]));
}

TEST(StudyMeasure, ATimeOutsideTheHistoryAndAReferenceThatIsNoneAreRefused) {
  std::ofstream("short.csv") << "step,time,q\n0,0,1\n1,1e-6,2\n2,2e-6,4\n";
  StudyQuantity q;
  q.name = q.column = "q", q.take = StudyQuantity::Take::at, q.time = 1.5e-6;
  EXPECT_NEAR(measure_history(testing::communicator(), "short.csv", q, {}).value, 3.0, 1e-12);
  q.time = 5e-6;
  EXPECT_THROW(measure_history(testing::communicator(), "short.csv", q, {}), Error);
  q.take = StudyQuantity::Take::last, q.reference = scene::Expression("1/N", {"t", "N"});
  EXPECT_NEAR(measure_history(testing::communicator(), "short.csv", q, {0.5}).error, 1.0, 1e-12);
  EXPECT_THROW(measure_history(testing::communicator(), "short.csv", q, {0.0}), Error);
}

TEST(StudyArguments, ValuesPartAtCommasOutsideBrackets) {
  using Values = std::vector<std::string>;
  EXPECT_EQ(split_values("20,40, 80"), (Values{"20", "40", "80"}));
  EXPECT_EQ(split_values("[1, 2, 3],[4,5,6]"), (Values{"[1, 2, 3]", "[4,5,6]"}));
  EXPECT_EQ(split_values("'a,b',{x: 1, y: 2}"), (Values{"'a,b'", "{x: 1, y: 2}"}));
  EXPECT_EQ(split_values("5 mm"), (Values{"5 mm"}));
}

const char* const small_scene = TENON_SOURCE_DIR "/tests/scenes/fuzz/small.yaml";

StudyArguments arguments(std::vector<std::string> vary) {
  StudyArguments a;
  a.file = small_scene;
  a.vary = std::move(vary);
  a.quantities = {"max_eqps:maximum", "kinetic_energy:at 1 us"};
  return a;
}

std::string refusal(const StudyArguments& a) {
  try {
    load_study(testing::communicator(), a);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::usage);
    return error.what();
  }
  return "";
}

TEST(StudyPlan, KeysInStepAndAllCombinations) {
  StudyArguments a = arguments({"meshes.solid.axial=3,6", "meshes.solid.core=2,4"});
  const StudyPlan zipped = load_study(testing::communicator(), a);
  ASSERT_EQ(zipped.runs.size(), 2U);
  EXPECT_EQ(zipped.runs[1].folder, "axial-6_core-4");
  EXPECT_EQ(zipped.runs[1].settings, (std::vector<std::string>{"meshes.solid.axial=6", "meshes.solid.core=4"}));
  EXPECT_EQ(zipped.quantities[1].time, 1e-6);
  a.grid = true;
  const StudyPlan grid = load_study(testing::communicator(), a);
  ASSERT_EQ(grid.runs.size(), 4U);
  EXPECT_EQ(grid.runs[1].folder, "axial-3_core-4");
  EXPECT_EQ(grid.runs[2].folder, "axial-6_core-2");
}

TEST(StudyPlan, MistakesAreNamedBeforeAnythingRuns) {
  EXPECT_NE(refusal(arguments({"meshes.solid.axal=3,6"})).find("unknown key 'axal', did you mean 'axial'?"),
            std::string::npos);
  EXPECT_NE(refusal(arguments({"meshes.solid.axial=3,no"})).find("expected a whole number"), std::string::npos);
  EXPECT_NE(refusal(arguments({"meshes.solid.axial=3,6", "meshes.solid.core=2"})).find("as many values"),
            std::string::npos);
  EXPECT_NE(refusal(arguments({"meshes.solid.axial"})).find("expected key.path=value"), std::string::npos);
  EXPECT_NE(refusal(arguments({})).find("is not a study"), std::string::npos);
  StudyArguments a = arguments({"meshes.solid.axial=3,6"});
  a.size = "1/axal";
  EXPECT_NE(refusal(a).find("unknown name 'axal', did you mean 'axial'?"), std::string::npos) << refusal(a);
  a.size = "";
  a.quantities = {"max_eqps:maximal"};
  EXPECT_NE(refusal(a).find("did you mean 'maximum'?"), std::string::npos) << refusal(a);
}

TEST(StudyPlan, ValuesWithUnitsCountInSi) {
  StudyArguments a = arguments({"meshes.solid.length=6 mm,12 mm", "end_time=2 us,1e-6"});
  a.size = "1/length";
  const StudyPlan plan = load_study(testing::communicator(), a);
  EXPECT_EQ(plan.runs[0].numbers, (std::vector<double>{0.006, 2e-6}));
  EXPECT_EQ(plan.runs[1].numbers, (std::vector<double>{0.012, 1e-6}));
  a.size = "length - 6e-3";
  EXPECT_NE(refusal(a).find("expected more than 0"), std::string::npos) << refusal(a);
  a = arguments({"components.conduction.stepper=crank_nicolson,backward_euler"});
  EXPECT_EQ(refusal(a), "");  // a word, which no formula uses
  a.size = "1/stepper";
  EXPECT_NE(refusal(a).find("uses 'stepper', whose value 'crank_nicolson' is not a number"), std::string::npos)
      << refusal(a);
  a.size = "", a.reference = "2*stepper";
  EXPECT_NE(refusal(a).find("reference: uses 'stepper'"), std::string::npos) << refusal(a);
}

TEST(StudyPlan, AMisspeltKeyOfTheFileIsNamed) {
  std::ofstream("misspelt.yaml") << "scene: x.yaml\nvary: [{kee: a, values: [1]}]\nquantities: {q: {type: history, "
                                    "colum: a}}\n";
  StudyArguments a;
  a.file = "misspelt.yaml";
  const std::string text = refusal(a);
  EXPECT_NE(text.find("misspelt.yaml:2:9: vary.0: unknown key 'kee', did you mean 'key'?"), std::string::npos) << text;
  EXPECT_NE(text.find("unknown key 'colum', did you mean 'column'?"), std::string::npos) << text;
}

}  // namespace
}  // namespace tenon
