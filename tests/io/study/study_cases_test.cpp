#include "io/study/study.h"
#include "io/study/study_gains.h"
#include "io/study/study_page.h"
#include "io/study/study_run.h"
#include "tests/support/expect_error.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace halfshade {
namespace {

using testing::Contains;
using testing::Not;

TEST(StudyCases, GoFromLooseToTight) {
  StudyOptions options;
  options.tolerances = {0.01, 0.1, 0.01, 0.001};
  const auto cases = study_cases(options);
  EXPECT_EQ(cases.front(), (StudyCase{"fields", 0.1}));
  EXPECT_TRUE(std::is_sorted(cases.begin(), cases.end(), [](const auto& a, const auto& b) {
    return a.tolerance > b.tolerance;
  }));
  EXPECT_THAT(cases, Contains(StudyCase{"matrix", 0.01}));
  EXPECT_THAT(cases, Not(Contains(StudyCase{"matrix", 0.001}))) << "10⁶ elements";
  EXPECT_THAT(cases, Contains(StudyCase{"hemicube", 0.1})) << "how it began, to compare";
  EXPECT_EQ(cases.size(), 6u + 6 + 3);
  options.methods = {"adaptive-linear"};
  EXPECT_EQ(study_cases(options).size(), 3u);
  options.methods = {"guesswork"};
  test::expect_error([&] { study_cases(options); }, ErrorCode::usage, {"guesswork", "fields"});
}

TEST(StudyCases, AreCommandsOfTheirOwn) {
  StudyOptions options;
  options.folder = "there";
  options.solve = {"halfshade", "solve", "a.obj"};
  const auto words = case_command({"uniform", 0.01}, options);
  EXPECT_EQ(words[2], "a.obj");
  const auto after = [&](const char* word) {
    return *(std::find(words.begin(), words.end(), word) + 1);
  };
  EXPECT_EQ(after("--elements"), "400");
  EXPECT_EQ(after("--tolerance"), "0.01");
  EXPECT_EQ(after("-o"), "there/cases/uniform_0.01.vtu");
}

TEST(StudyCases, HaveEveryClassicSolver) {
  StudyOptions options;
  options.folder = "there";
  options.solve = {"halfshade", "solve", "a.obj"};
  for (const char* solver : {"jacobi", "gauss-seidel", "southwell", "southwell-ambient"}) {
    const auto words = case_command({solver, 0.1}, options);
    EXPECT_EQ(*(std::find(words.begin(), words.end(), "--solver") + 1), solver);
    EXPECT_THAT(words, Contains("matrix"));
    EXPECT_TRUE(study_method(solver).classic);
  }
}

Study some_study() {
  Study study;
  const auto add = [&](const char* method, double tolerance, double seconds, double error) {
    StudyRow row;
    row.one = {method, tolerance};
    row.seconds = row.cpu_seconds = seconds;
    row.total.l2 = error;
    row.estimated = 2 * error;
    row.unknowns = 10;
    study.rows.push_back(row);
  };
  add("fields", 0.1, 0.5, 0.05);
  add("fields", 0.01, 1, 0.005);
  add("uniform", 0.1, 0.25, 0.02);
  add("uniform", 0.01, 9, 0.004);
  add("hemicube", 0.1, 3, 0.03);
  add("hemicube", 0.01, 40, 0.011);
  study.rows[1].stages =
      "direct light 0.2/0.4; reflected light 0.7/1.1; values of reflected light "
      "0.1/0.1";
  study.rows[3].stages = "direct light 8.25/9; reflected light 0.75/1";
  study.reference.points = point_table({{{0, 0, 0}, Vec3::UnitZ()}});
  study.reference.direct = {Rgb::Ones()};
  study.reference.reflected = study.reference.reflected_error = {Rgb::Zero()};
  return study;
}

TEST(StudyPage, SaysWhoIsFasterWhere) {
  const Study study = some_study();
  EXPECT_EQ(seconds_to_reach(study, "fields", 0.1), 0.5);
  EXPECT_EQ(seconds_to_reach(study, "uniform", 0.02), 0.25);
  EXPECT_EQ(seconds_to_reach(study, "uniform", 0.001), 0);
  StudyOptions options;
  options.folder = "/none";
  options.solve = {"halfshade", "solve", "a<b>.obj"};
  const std::string page = study_page(study, options, {"a<b>.obj", "0.1", "halfshade study x"});
  for (const char* part :
       {"At 0.1, <code>uniform</code> is 2 times as fast as <code>fields</code>",
        "At 0.03, <code>uniform</code> is 4 times", "a&lt;b&gt;.obj", "<svg ", "exact"})
    EXPECT_THAT(page, testing::HasSubstr(part));
  EXPECT_THAT(page, Not(testing::HasSubstr("At 0.01, <code>uniform</code>")));
  EXPECT_THAT(page, Not(testing::HasSubstr("nan")));
  EXPECT_THAT(page, Not(testing::HasSubstr("src=\"http")));
  EXPECT_THAT(page, Not(testing::HasSubstr("href")));
}

TEST(StudyPage, SaysWhatTheDefaultGainsAndWhyItIsNotMore) {
  Study study = some_study();
  EXPECT_EQ(
      what_the_default_gains(study),
      "<p>What the default gains (classic are methods with constant elements and a matrix of "
      "form factors):</p>\n<ul>\n"
      "<li>At 0.01, <code>fields</code> takes 1 s; <code>uniform</code>, the fastest other "
      "one, 9 times as long (80 % is reflected light, which both find in the same way; without "
      "it they take 0.2 s and 8.2 s); no classic one gets there: <code>hemicube</code> is "
      "off by 0.011 after 40 s, 40 times as long.</li>\n</ul>\n");
  StudyRow slow;
  slow.one = {"hemicube", 0.003};
  slow.end = CaseEnd::time_limit;
  slow.process_seconds = 62;
  study.rows.push_back(slow);
  EXPECT_THAT(what_the_default_gains(study),
              testing::HasSubstr("off by 0.011 after 40 s, and at the next tolerance takes more "
                                 "than 62 s, 62 times as long."));
  study.rows[5].total.l2 = 0.009;
  study.rows[3].total.l2 = 0.02;
  EXPECT_THAT(what_the_default_gains(study),
              testing::HasSubstr("no other one gets there: <code>uniform</code> is off by 0.02"));
  EXPECT_THAT(
      what_the_default_gains(study),
      testing::HasSubstr("<code>hemicube</code>, the fastest classic one, 40 times as long"));
  study.rows.erase(study.rows.begin() + 2, study.rows.end());
  EXPECT_EQ(what_the_default_gains(study), "") << "nothing to compare with";
}

TEST(StudyPage, HasChartsOfAllThatIsMeasured) {
  const auto charts = study_charts(some_study(), "a.obj");
  std::vector<std::string> names;
  for (const StudyChart& chart : charts) names.push_back(chart.name);
  EXPECT_EQ(names, (std::vector<std::string>{"error_time", "error_cpu", "error_unknowns",
                                             "estimated_true"}));
  EXPECT_EQ(charts[0].chart.title, "a.obj: error against run time");
  EXPECT_EQ(charts[0].chart.series.size(), 3u);
  EXPECT_EQ(charts[0].chart.series[0].points[1], Vec2(1, 0.005));
  EXPECT_EQ(charts[3].chart.series[1].points[0], Vec2(0.02, 0.04));
}

}  // namespace
}  // namespace halfshade
