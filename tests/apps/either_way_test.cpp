#include "solver/pipeline/solve.h"
#include "tests/support/named_scene.h"

#include <gtest/gtest.h>

// Direct light without curves and along them, where limits leave no room for the first.

namespace halfshade {
namespace {

SolveResult solved(SolveOptions options) {
  options.tolerance = 0.003;
  options.radiosity.bounces = 0;
  return solve(test::named_scene("table_and_chairs"), options);
}

TEST(EitherWay, IsTakenAlongCurvesWhereElementsWithoutThemGetTooMany) {
  SolveOptions options;
  options.max_unknowns = 3000;
  const SolveResult along = solved(options);
  options.discontinuities = false;
  const SolveResult without = solved(options);
  EXPECT_EQ(without.refinement.limit, FieldLimit::unknowns);
  EXPECT_GT(along.mesh.kept, 0u);
  EXPECT_LT(along.relative_error, 0.5 * without.relative_error);
}

TEST(EitherWay, IsTheOneThatComesCloser) {
  SolveOptions options;
  options.max_elements = 200;
  const SolveResult either = solved(options);
  EXPECT_GT(either.discontinuities.work, 0) << "curves were looked for";
  EXPECT_EQ(either.curves, 0u) << "elements along them are too many";
  EXPECT_EQ(either.refinement.limit, FieldLimit::elements);
  options.discontinuities = false;
  EXPECT_EQ(either.relative_error, solved(options).relative_error);
}

}  // namespace
}  // namespace halfshade
