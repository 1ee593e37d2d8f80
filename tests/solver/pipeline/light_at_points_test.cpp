#include "solver/pipeline/light_at_points.h"

#include "meshing/core/error.h"
#include "solver/pipeline/prepared_scene.h"
#include "solver/pipeline/surface_finder.h"
#include "tests/support/expect_error.h"
#include "tests/support/own_corners.h"
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

TEST(OnSurfaces, PointsThatRoundingPutsBehindTheirSurfaceAreMovedOntoIt) {
  const PreparedScene prepared(test::lit_cube({.5, .5, .5, .5, .5, .5}));
  const SoundScene& scene = prepared.scene();
  const std::vector<SurfacePoint> points = {{{0.3, 0.4, -1e-7}, Vec3::UnitZ()},
                                            {{0.3, 0.4, 1e-7}, Vec3::UnitZ()},
                                            {{0.3, 0.4, -1e-5}, Vec3::UnitZ()},
                                            {{0.3, 0.4, 0}, -Vec3::UnitZ()}};
  const std::vector<FieldPoint> found = on_surfaces(prepared, points);
  ASSERT_EQ(found.size(), 4U);
  EXPECT_EQ(found[0].surface, found[1].surface);
  EXPECT_EQ(scene.surfaces[at(found[0].surface)].frame.normal, Vec3::UnitZ());
  EXPECT_EQ(found[0].point.position, Vec3(0.3, 0.4, 0));
  for (const int same : {1, 2, 3})
    EXPECT_EQ(found[at(same)].point.position, points[at(same)].position);
  for (const int none : {2, 3}) EXPECT_EQ(found[at(none)].surface, -1);
}

TEST(OnSurfaces, FacesAsSmallAsTheyAreHavePointsThatDigitsPutBehindThem) {
  Scene scene = test::lit_cube({.5, .5, .5, .5, .5, .5});
  test::add_polygon(scene, {{.2, .2, .5}, {.213, .2, .503}, {.21, .217, .508}}, 0);
  const PreparedScene prepared(scene);
  const Surface& small = prepared.scene().surfaces.back();
  const Vec3 on = small.frame.to_space(small.rings.front()[0]) * 0.4 +
                  small.frame.to_space(small.rings.front()[1]) * 0.3 +
                  small.frame.to_space(small.rings.front()[2]) * 0.3;
  const std::vector<SurfacePoint> points = {{on - 4e-7 * small.frame.normal, small.frame.normal}};
  const FieldPoint found = on_surfaces(prepared, points).front();
  EXPECT_EQ(found.surface, static_cast<int>(prepared.scene().surfaces.size()) - 1);
  EXPECT_LT((found.point.position - on).norm(), 1e-12);
}

// Corners that lie off their plane turn small elements, and what is made of them has their normals.
TEST(OnSurfaces, NormalsOfElementsMayBeTurned) {
  Scene scene;
  const int grey = test::add_material(scene, 0.5, 1);
  // A flat roof, whose ridge is at x = 1.
  test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0.02}, {1, 1, 0.02}, {0, 1, 0}}, grey);
  test::add_polygon(scene, {{1, 0, 0.02}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0.02}}, grey);
  const PreparedScene prepared(scene);
  const SoundScene& sound = prepared.scene();
  const auto turned = [](const Vec3& normal, double by) {
    return Vec3((normal + by * Vec3::UnitY()).normalized());
  };
  const Vec3 left = sound.surfaces[0].frame.normal, right = sound.surfaces[1].frame.normal;
  const std::vector<SurfacePoint> points = {{{0.5, 0.5, 0.01}, turned(left, 0.003)},
                                            {{1.5, 0.5, 0.01}, turned(right, 0.003)},
                                            {{1, 0.5, 0.02}, turned(left, 0.001)},
                                            {{1, 0.5, 0.02}, turned(right, 0.001)},
                                            {{0.5, 0.5, 0.01}, turned(left, 0.2)}};
  const std::vector<FieldPoint> found = on_surfaces(prepared, points);
  for (const int k : {0, 1, 2, 3}) EXPECT_EQ(found[at(k)].surface, k % 2) << k;
  EXPECT_EQ(found[4].surface, -1);
}

/// Points of the planes that faces had before each got corners of its own: direct light of a cube,
/// and all light where it is closed and 1.
TEST(OnSurfaces, LightIsAllThereWhereCornersDiffer) {
  Scene exact = test::lit_cube({.5, .5, .5, .5, .5, .5});
  for (Material& material : exact.materials) material.exitance = 1 - material.rho;
  const PreparedScene scene(exact);
  std::vector<SurfacePoint> points;
  for (const Surface& surface : scene.scene().surfaces)
    for (const Vec2& q : {Vec2(0.2, 0.3), Vec2(-0.3, 0.1), Vec2(-0.2, -0.4), Vec2(0, 0)})
      points.push_back({surface.frame.to_space(q), surface.frame.normal});
  const std::vector<DirectLight> expected = scene.direct_light().irradiance(points);
  SolveOptions options;
  options.tolerance = 0.01;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const PreparedScene rounded(test::with_own_corners(exact, 1e-7, seed));
    const std::vector<FieldPoint> places = on_surfaces(rounded, points);
    std::vector<SurfacePoint> moved;
    for (const FieldPoint& place : places) moved.push_back(place.point);
    std::vector<DirectLight> light = rounded.direct_light().irradiance(moved);
    for (std::size_t k = 0; k < points.size(); ++k)
      EXPECT_LT((light[k].irradiance - expected[k].irradiance).abs().maxCoeff(), 1e-5)
          << "seed " << seed;
    const SolveResult result = solve(rounded, options);
    ASSERT_TRUE(add_gathered_light(result, options.tolerance, places, light));
    for (const DirectLight& here : light)
      EXPECT_LT((here.irradiance - 1).abs().maxCoeff(), 0.01) << "seed " << seed;
  }
}

}  // namespace
}  // namespace halfshade
