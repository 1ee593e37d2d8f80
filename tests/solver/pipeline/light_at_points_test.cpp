#include "solver/pipeline/light_at_points.h"

#include "meshing/core/error.h"
#include "tests/support/expect_error.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

TEST(LightAtPoints, IsThatOfTheElements) {
  SolveOptions options;
  options.tolerance = 1e-3;
  options.radiosity.bounces = 0;
  const Scene scene = test::table_scene();
  const SolveResult result = solve(scene, options);
  const DirectLightIndex exact(result.scene);
  const std::vector<SurfacePoint> points = {{{0.9, 0.1, 0}, Vec3::UnitZ()},
                                            {{0.1, -0.05, 1}, Vec3::UnitZ()},
                                            {{-0.77, 0.6, 1e-8}, Vec3::UnitZ()}};
  const auto light = light_at_points(result, points);
  ASSERT_EQ(light.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(light[k].irradiance[0], exact.irradiance(points[k]).irradiance[0], 2e-3) << k;
    EXPECT_GT(light[k].irradiance[0], 0.02);
    EXPECT_TRUE((light[k].irradiance == light[k].direct_irradiance).all());
  }
}

TEST(LightAtPoints, OfConstantElementsAreTheirMeans) {
  SolveOptions options;
  options.method = SolveMethod::matrix;
  options.elements = 200;
  const SolveResult result = solve(test::lit_cube({.5, .5, .5, .5, .5, .5}), options);
  std::vector<SurfacePoint> points;
  for (int e = 0; e < result.elements.count(); ++e) {
    const auto t = result.elements.triangle(e);
    points.push_back({(t[0] + t[1] + t[2]) / 3, result.elements.normal[at(e)]});
  }
  const auto light = light_at_points(result, points);
  for (int e = 0; e < result.elements.count(); ++e) {
    EXPECT_TRUE((light[at(e)].irradiance.transpose() == result.solution.irradiance.row(e)).all());
    EXPECT_TRUE(
        (light[at(e)].direct_irradiance.transpose() == result.solution.direct_irradiance.row(e))
            .all());
  }
}

TEST(LightAtPoints, MustLieOnSurfaces) {
  SolveOptions options;
  options.tolerance = 0.1;
  options.radiosity.bounces = 0;
  const SolveResult result = solve(test::table_scene(), options);
  for (const SurfacePoint& wrong :
       {SurfacePoint{{0.5, 0.5, 0.1}, Vec3::UnitZ()}, SurfacePoint{{0.5, 0.5, 0}, -Vec3::UnitZ()},
        SurfacePoint{{1.5, 0, 0}, Vec3::UnitZ()}})
    test::expect_error([&] { light_at_points(result, std::vector{wrong}); },
                       ErrorCode::invalid_input, {"point 1", "no surface"});
}

}  // namespace
}  // namespace halfshade
