#include "io/read/read_scene.h"
#include "meshing/core/planar.h"
#include "meshing/repair/repair.h"
#include "solver/direct/direct_light.h"
#include "solver/pipeline/mesh_scene.h"
#include "solver/pipeline/solve.h"
#include "tests/support/files.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

// What must not depend on units, on the order of a file, or on what is elsewhere, in all scenes of
// data/ that a test has time for.

namespace halfshade {
namespace {

// With the larger ones, dining_room, hundred_lights and sphere, this takes minutes.
const std::vector<std::string> data_scenes = {"bars",        "cornell_box",     "furnace_cube",
                                              "holed_light", "l_room",          "s1",
                                              "skew_bars",   "table_and_chairs"};

std::vector<std::string> random_names() {
  std::vector<std::string> names;
  for (int seed = 0; seed < 50; ++seed) names.push_back("random_" + std::to_string(seed));
  return names;
}

/// A floor, one or two lights, and boxes and triangles between that may stand on the floor, touch
/// and cut each other.
Scene random_scene(std::uint64_t seed) {
  test::Random random(seed);
  Scene scene;
  scene.groups = {"all"};
  const int grey = test::add_material(scene, 0.5, 0), light = test::add_material(scene, 0.2, 3);
  test::add_polygon(scene, {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}}, grey);
  for (int k = random.integer(1, 2); k > 0; --k) {
    const Vec3 at = random.in_box({-1.5, -1.5, 1.8}, {1, 1, 2.2});
    const double x = random(0.2, 0.8), y = random(0.2, 0.8), tilt = random(-0.1, 0.1);
    test::add_polygon(scene, {at, at + Vec3(0, y, 0), at + Vec3(x, y, tilt), at + Vec3(x, 0, tilt)},
                      light);
  }
  for (int k = random.integer(1, 4); k > 0; --k) {
    const Vec3 low = random.in_box({-1.5, -1.5, 0}, {1, 1, 1});
    const Vec3 bottom(low.x(), low.y(), random.below(2) == 0 ? 0 : low.z());
    const Vec3 high = bottom + random.in_box({0.1, 0.1, 0.1}, {0.6, 0.6, 0.6});
    for (const auto& face : test::box_faces(bottom, high, false))
      test::add_polygon(scene, face, grey);
  }
  for (int k = random.integer(0, 3); k > 0; --k) {
    const Vec3 at = random.in_box({-1.5, -1.5, 0.2}, {1, 1, 1.5});
    test::add_polygon(scene, {at, at + random.point(-0.7, 0.7), at + random.point(-0.7, 0.7)},
                      grey);
  }
  return scene;
}

Scene load(const std::string& name) {
  if (name.starts_with("random_")) return random_scene(std::stoul(name.substr(7)));
  return read_scene(test::data_file(name + ".obj")).scene;
}

Scene scaled(Scene scene, double factor) {
  for (Vec3& p : scene.vertices) p *= factor;
  for (Camera& camera : scene.cameras) camera.position *= factor;
  return scene;
}

Scene with_exitance(Scene scene, double factor) {
  for (Material& material : scene.materials) material.exitance *= factor;
  return scene;
}

/// Receiving points spread over the scene, and a little inside their surfaces.
std::vector<SurfacePoint> places(const Scene& scene) {
  MeshOptions coarse;
  coarse.tolerance = 1;
  coarse.max_length = diagonal(scene) / 8;
  return element_centres(mesh_scene(scene, coarse).elements);
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

  const Scene scene_ = load(GetParam());
};

TEST_P(Laws, DirectLightDoesNotDependOnTheUnit) {
  const std::vector<SurfacePoint> points = places(scene_);
  const std::vector<Rgb> expected = direct_light(scene_, points);
  for (const double factor : {0x1p-90, 0x1p7, 0x1p90})
    expect_same(expected, direct_light(scaled(scene_, factor), scaled(points, factor)), 0,
                "times " + std::to_string(std::log2(factor)) + " powers of two");
  for (const double factor : {1e-30, 1e-9, 1e-3, 1e3, 1e9, 1e30})
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

TEST_P(Laws, TheMeshDoesNotDependOnTheUnit) {
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

TEST_P(Laws, CurvesDoNotDependOnTheUnit) {
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
  const std::vector<SurfacePoint> points = places(scene_);
  const std::vector<Rgb> expected = direct_light(scene_, points);
  for (const double factor : {0x1p-500, 1e-150, 1e150, 0x1p500}) {
    std::vector<Rgb> got = direct_light(with_exitance(scene_, factor), points);
    for (Rgb& irradiance : got) irradiance /= factor;
    expect_same(expected, got, share(1e-14),
                "times " + std::to_string(std::log10(factor)) + " decades");
  }
}

TEST_P(Laws, TheOrderOfFacesAndVerticesDoesNotMatter) {
  const std::vector<SurfacePoint> points = places(scene_);
  Scene other = scene_;
  std::reverse(other.faces.begin(), other.faces.end());
  const int last = static_cast<int>(other.vertices.size()) - 1;
  std::reverse(other.vertices.begin(), other.vertices.end());
  for (Face& face : other.faces) {
    for (int& v : face.vertices) v = last - v;
    std::rotate(face.vertices.begin(), face.vertices.begin() + 1, face.vertices.end());
  }
  expect_same(direct_light(scene_, points), direct_light(other, points), share(1e-12),
              "turned round");
}

TEST_P(Laws, WhatIsElsewhereDoesNotMatter) {
  const std::vector<SurfacePoint> points = places(scene_);
  const std::vector<Rgb> expected = direct_light(scene_, points);
  const double size = diagonal(scene_);
  const auto with_triangle = [&](double distance, double extent) {
    Scene scene = scene_;
    const int first = static_cast<int>(scene.vertices.size());
    const Vec3 from = scene.vertices.front() + distance * size * Vec3(0.6, -0.5, -0.62);
    for (const Vec3& way : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.3, 0.1, 1)})
      scene.vertices.push_back(from + extent * size * way);
    Material black;
    black.name = "elsewhere";
    black.rho.setZero();
    scene.materials.push_back(black);
    Face face;
    face.vertices = {first, first + 1, first + 2};
    face.material = static_cast<int>(scene.materials.size()) - 1;
    scene.faces.push_back(face);
    return scene;
  };
  for (const auto& [distance, extent] :
       {std::pair{3., 1e-9}, {10., 1.}, {1e6, 1.}, {1e6, 1e5}, {1e12, 1e9}})
    expect_same(
        expected, direct_light(with_triangle(distance, extent), points), share(1e-12),
        "a triangle " + std::to_string(extent) + " wide " + std::to_string(distance) + " away");
}

INSTANTIATE_TEST_SUITE_P(Data, Laws, testing::ValuesIn(data_scenes),
                         [](const auto& instance) { return instance.param; });
INSTANTIATE_TEST_SUITE_P(Random, Laws, testing::ValuesIn(random_names()),
                         [](const auto& instance) { return instance.param; });

}  // namespace
}  // namespace halfshade
