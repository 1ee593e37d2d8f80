#include "io/study/study_pictures.h"

#include "io/study/study_run.h"
#include "io/write/write_result.h"
#include "tests/support/files.h"
#include "tests/support/sample_result.h"

#include <gtest/gtest.h>

#include <gmock/gmock.h>

namespace halfshade {
namespace {

using testing::HasSubstr;

/// A folder with the results of three methods: the first is the most exact, the second is meshed
/// otherwise, and the third of something else.
class StudyPictures : public testing::Test {
 protected:
  StudyPictures() {
    options_.folder = folder_.path();
    std::filesystem::create_directory(folder_.path() / "cases");
    add("fields", 0.001, test::sample_result(4));
    add("uniform", 0.02, test::sample_result(8));
    SolveResult aside = test::sample_result(4);
    for (Vec3& p : aside.elements.points) p.z() -= 0.5;
    add("matrix", 0.03, aside);
  }
  void add(const char* method, double error, const SolveResult& result) {
    StudyRow& row = study_.rows.emplace_back();
    row.one = {method, 0.1};
    row.total.l2 = error;
    write_result(result, {}, result_of(row.one, options_));
  }
  bool exists(const char* name) const { return std::filesystem::exists(folder_.path() / name); }

  test::TempDir folder_;
  StudyOptions options_;
  Study study_;
};

TEST_F(StudyPictures, ShowDifferencesFromTheMostExactResult) {
  const std::string html = study_pictures(study_, options_);
  EXPECT_THAT(html, HasSubstr("the most exact of them, <code>fields</code> at 0.1"));
  EXPECT_THAT(html, HasSubstr("<code>uniform</code> minus <code>fields</code>: "));
  for (const char* name : {"fields.png", "uniform.png", "matrix.png", "uniform_difference.png"})
    EXPECT_TRUE(exists(name)) << name;
  EXPECT_FALSE(exists("fields_difference.png")) << "from itself";
}

TEST_F(StudyPictures, SayWhereADifferenceHasNoMeaning) {
  const std::string html = study_pictures(study_, options_);
  EXPECT_THAT(html, HasSubstr("<code>matrix</code> and <code>fields</code> do not show the same"));
  EXPECT_FALSE(exists("matrix_difference.png"));
  study_.rows.clear();
  EXPECT_EQ(study_pictures(study_, options_), "") << "nothing to show";
}

}  // namespace
}  // namespace halfshade
