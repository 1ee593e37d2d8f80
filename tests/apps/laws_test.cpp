#include "meshing/core/planar.h"
#include "meshing/patches/patch_mesh.h"
#include "meshing/repair/repair.h"
#include "solver/direct/direct_light.h"
#include "solver/pipeline/mesh_scene.h"
#include "solver/pipeline/solve.h"
#include "tests/support/named_scene.h"
#include "tests/support/own_corners.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

// What must not depend on units, on the order of a file, or on what is elsewhere, in all scenes of
// data/ with a light in them, and in random ones.

namespace halfshade {
namespace {

const std::vector<std::string> data_scenes = {
    "bars",         "cornell_box", "furnace_cube", "holed_light",      "l_room",
    "reading_room", "s1",          "skew_bars",    "table_and_chairs", "thermal_furnace"};
/// For fewer places and fewer units; their meshes take minutes.
const std::vector<std::string> large_scenes = {"dining_room", "hundred_lights", "sphere"};

std::vector<std::string> random_names() {
  std::vector<std::string> names;
  for (int seed = 0; seed < 50; ++seed) names.push_back("random_" + std::to_string(seed));
  return names;
}

std::string name_of(const testing::TestParamInfo<std::string>& scene) { return scene.param; }

Scene scaled(Scene scene, double factor) {
  for (Vec3& p : scene.vertices) p *= factor;
  for (Camera& camera : scene.cameras) camera.position *= factor;
  return scene;
}

Scene with_exitance(Scene scene, double factor) {
  for (Material& material : scene.materials) material.exitance *= factor;
  return scene;
}

/// Receiving points spread over the scene, at most so many, and a little inside their surfaces.
std::vector<SurfacePoint> places(const Scene& scene, std::size_t most) {
  PlanarMeshOptions coarse;
  coarse.max_length = diagonal(scene) / 8;
  const std::vector<SurfacePoint> all =
      element_centres(PatchMesh(make_sound(scene), coarse).elements());
  std::vector<SurfacePoint> some;
  const std::size_t step = all.size() / most + 1;
  for (std::size_t i = 0; i < all.size(); i += step) some.push_back(all[i]);
  return some;
}

std::vector<SurfacePoint> scaled(std::vector<SurfacePoint> points, double factor) {
  for (SurfacePoint& point : points) point.position *= factor;
  return points;
}

std::vector<Rgb> direct_light(const Scene& scene, const std::vector<SurfacePoint>& points) {
  std::vector<Rgb> irradiance;
  for (const DirectLight& light : DirectLightIndex(make_sound(scene)).irradiance(points, {}))
    irradiance.push_back(light.irradiance);
  return irradiance;
}

void expect_same(const std::vector<Rgb>& expected, const std::vector<Rgb>& got, double tolerance,
                 const std::string& what) {
  ASSERT_EQ(expected.size(), got.size()) << what;
  double worst = 0;
  for (std::size_t i = 0; i < got.size(); ++i) {
    const double off = (expected[i] - got[i]).abs().maxCoeff();
    worst = std::isnan(off) ? HUGE_VAL : std::max(worst, off);
  }
  EXPECT_LE(worst, tolerance) << what;
}

class Laws : public testing::TestWithParam<std::string> {
 protected:
  /// So much of the strongest exitance, W/m².
  double share(double part) const {
    double exitance = 0;
    for (const Material& material : scene_.materials)
      exitance = std::max(exitance, material.exitance.maxCoeff());
    return part * exitance;
  }

  bool is_large() const {
    return std::find(large_scenes.begin(), large_scenes.end(), GetParam()) != large_scenes.end();
  }

  /// Some of the factors where trying all takes minutes.
  std::vector<double> some(std::vector<double> factors) const {
    if (is_large()) factors.resize(1);
    return factors;
  }

  std::vector<SurfacePoint> places() const {
    return halfshade::places(scene_, is_large() ? 200 : 10000);
  }

  const Scene scene_ = test::named_scene(GetParam());
};

/// Of scenes whose mesh takes seconds.
class MeshLaws : public Laws {};

TEST_P(Laws, DirectLightDoesNotDependOnTheUnit) {
  const std::vector<SurfacePoint> points = places();
  const std::vector<Rgb> expected = direct_light(scene_, points);
  for (const double factor : some({0x1p-90, 0x1p7, 0x1p90}))
    expect_same(expected, direct_light(scaled(scene_, factor), scaled(points, factor)), 0,
                "times " + std::to_string(std::log2(factor)) + " powers of two");
  for (const double factor : some({1e-9, 1e-30, 1e-3, 1e3, 1e9, 1e30}))
    expect_same(expected, direct_light(scaled(scene_, factor), scaled(points, factor)),
                share(1e-12), "times 10^" + std::to_string(std::log10(factor)));
}

/// The curves on one surface, in its frame and in units of the scene as it was.
struct DrawnCurves {
  std::vector<std::vector<Vec2>> polylines;
  std::vector<Vec2> samples;
};

std::vector<DrawnCurves> drawn(const MeshResult& mesh, double factor) {
  std::vector<DrawnCurves> on_surface(mesh.scene.surfaces.size());
  for (const DiscontinuityCurve& curve : mesh.found.curves) {
    DrawnCurves& drawn = on_surface[at(curve.receiver)];
    std::vector<Vec2>& polyline = drawn.polylines.emplace_back();
    const double fine = 1e-6 * (curve.arc.to - curve.arc.from).norm();
    for (const double s : flatten(curve.arc, fine))
      polyline.push_back(point_at(curve.arc, s) / factor);
    for (const double s : {0.1, 0.3, 0.5, 0.7, 0.9})
      drawn.samples.push_back(point_at(curve.arc, s) / factor);
  }
  return on_surface;
}

/// How far a curve of the first leaves all curves of the second.
double distance(const std::vector<DrawnCurves>& first, const std::vector<DrawnCurves>& second) {
  double worst = 0;
  for (std::size_t r = 0; r < first.size(); ++r)
    for (const Vec2& p : first[r].samples) {
      double least = HUGE_VAL;
      for (const auto& polyline : second[r].polylines)
        for (std::size_t k = 1; k < polyline.size(); ++k)
          least = std::min(least, distance_to_segment(p, polyline[k - 1], polyline[k]));
      worst = std::max(worst, least);
    }
  return worst;
}

TEST_P(MeshLaws, TheMeshDoesNotDependOnTheUnit) {
  const auto mesh = [&](double factor) {
    MeshOptions options;
    options.tolerance = 0.02;
    options.max_length = factor * diagonal(scene_) / 10;
    return mesh_scene(scaled(scene_, factor), options).elements;
  };
  const ElementTable expected = mesh(1);
  for (const double factor : {0x1p-90, 0x1p-3, 0x1p90}) {
    const ElementTable got = mesh(factor);
    EXPECT_TRUE(got.corners == expected.corners) << "times " << factor;
    for (std::size_t i = 0; i < std::min(got.points.size(), expected.points.size()); ++i)
      ASSERT_EQ(got.points[i], factor * expected.points[i]) << "times " << factor;
  }
  // Other factors round all coordinates anew, so that of triangulations that are equally good
  // another may be taken.
  for (const double factor : {1e-30, 1e-3, 1e3, 1e30})
    EXPECT_NEAR(mesh(factor).count(), expected.count(), 0.1 * expected.count())
        << "times " << factor;
}

TEST_P(MeshLaws, CurvesDoNotDependOnTheUnit) {
  const auto curves = [&](double factor) {
    MeshOptions options;
    options.with_elements = false;
    return drawn(mesh_scene(scaled(scene_, factor), options), factor);
  };
  const std::vector<DrawnCurves> expected = curves(1);
  for (const double factor : {1e-30, 1e-3, 1e3, 1e30}) {
    const std::vector<DrawnCurves> got = curves(factor);
    EXPECT_LT(distance(expected, got), 2e-6 * diagonal(scene_)) << "times " << factor;
    EXPECT_LT(distance(got, expected), 2e-6 * diagonal(scene_)) << "times " << factor;
  }
}

TEST_P(Laws, DirectLightFollowsExitance) {
  const std::vector<SurfacePoint> points = places();
  const std::vector<Rgb> expected = direct_light(scene_, points);
  for (const double factor : some({1e-150, 0x1p-500, 1e150, 0x1p500})) {
    std::vector<Rgb> got = direct_light(with_exitance(scene_, factor), points);
    for (Rgb& irradiance : got) irradiance /= factor;
    expect_same(expected, got, share(1e-14),
                "times " + std::to_string(std::log10(factor)) + " decades");
  }
}

TEST_P(Laws, TheOrderOfFacesAndVerticesDoesNotMatter) {
  const std::vector<SurfacePoint> points = places();
  expect_same(direct_light(scene_, points), direct_light(test::turned_round(scene_), points),
              share(1e-12), "turned round");
}

TEST_P(Laws, WhatIsElsewhereDoesNotMatter) {
  const std::vector<SurfacePoint> points = places();
  const std::vector<Rgb> expected = direct_light(scene_, points);
  for (const auto& [distance, extent] :
       {std::pair{3., 1e-9}, {10., 1.}, {1e6, 1.}, {1e6, 1e5}, {1e12, 1e9}})
    expect_same(
        expected, direct_light(test::with_black_triangle(scene_, distance, extent), points),
        share(1e-12),
        "a triangle " + std::to_string(extent) + " wide " + std::to_string(distance) + " away");
}

/// The scene and another like it, light and all, a million times its size away: lights as large as
/// the scene are seen there under 1e-12 of the hemisphere.
TEST_P(Laws, AnotherSceneFarAwayDoesNotMatter) {
  const std::vector<SurfacePoint> points = places();
  Scene both = scene_;
  const int first = static_cast<int>(both.vertices.size());
  const Vec3 away = 1e6 * diagonal(scene_) * Vec3(0.6, -0.5, -0.62);
  for (const Vec3& p : scene_.vertices) both.vertices.push_back(p + away);
  for (Face face : scene_.faces) {
    for (int& v : face.vertices) v += first;
    both.faces.push_back(std::move(face));
  }
  expect_same(direct_light(scene_, points), direct_light(both, points), share(2e-12), "far away");
}

/// Every face has corners of its own, off by what single precision comes to. Light changes by as
/// little a little above surfaces.
TEST_P(Laws, RoundingOfCornersHardlyMatters) {
  std::vector<SurfacePoint> points = places();
  for (SurfacePoint& point : points) point.position += 1e-5 * diagonal(scene_) * point.normal;
  const Scene rounded = test::with_own_corners(scene_, 1e-7, 7);
  expect_same(direct_light(scene_, points), direct_light(rounded, points), share(1e-4), "rounded");
}

INSTANTIATE_TEST_SUITE_P(Data, Laws, testing::ValuesIn(data_scenes), name_of);
INSTANTIATE_TEST_SUITE_P(Large, Laws, testing::ValuesIn(large_scenes), name_of);
INSTANTIATE_TEST_SUITE_P(Random, Laws, testing::ValuesIn(random_names()), name_of);
INSTANTIATE_TEST_SUITE_P(Data, MeshLaws, testing::ValuesIn(data_scenes), name_of);
INSTANTIATE_TEST_SUITE_P(Random, MeshLaws, testing::ValuesIn(random_names()), name_of);

}  // namespace
}  // namespace halfshade
