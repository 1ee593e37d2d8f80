#include "solver/exchange/gather.h"

#include "solver/pipeline/solve.h"
#include "tests/support/sound_scenes.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

TEST(Gather, MakesUpTheFurnaceTogetherWithDirectLight) {
  // Every face of a closed scene with E = 1 and rho = 0.5: B = 2 everywhere and H = 2, whatever is
  // in the way.
  Scene scene = test::l_room(true);
  for (Material& m : scene.materials) m.exitance = Rgb::Ones();
  SolveOptions options;
  options.method = SolveMethod::matrix;
  options.elements = 600;
  const SolveResult solved = solve(scene, options);
  const VisibilityIndex visibility(occluders(solved.scene));
  const DirectLightIndex direct(solved.scene);
  std::vector<SurfacePoint> points = {{{0.3, 0.3, 0.5}, Vec3::UnitX()},    // in the air
                                      {{1.5, 0.5, 0}, Vec3::UnitZ()},      // on the floor
                                      {{0.45, 0.6, 0.4}, -Vec3::UnitX()},  // on the box
                                      {{0.2, 1.7, 0.8}, Vec3(1, 1, 1).normalized()}};
  const auto reflected =
      reflected_irradiance({solved.scene, solved.elements, solved.solution}, visibility, points);
  const auto light = direct.irradiance(points);
  for (std::size_t k = 0; k < points.size(); ++k) {
    EXPECT_NEAR(light[k].irradiance[0], 1, 1e-12) << "direct light closes exactly";
    EXPECT_NEAR(reflected[k][0], 1, 0.02);
  }
}

TEST(Gather, IsZeroWhereNothingReflects) {
  Scene scene = test::room({1, 1, 1}, {{{0, 1}, {0, 0}, {0, 0}, {0, 0}, {0, 0}, {0, 0}}});
  SolveOptions options;
  options.method = SolveMethod::matrix;
  options.elements = 100;
  const SolveResult solved = solve(scene, options);
  const VisibilityIndex visibility(occluders(solved.scene));
  const std::vector<SurfacePoint> points = {{{0.5, 0.5, 0.5}, Vec3::UnitZ()}};
  EXPECT_TRUE((reflected_irradiance({solved.scene, solved.elements, solved.solution}, visibility,
                                    points)[0] == 0)
                  .all());
}

}  // namespace
}  // namespace halfshade
