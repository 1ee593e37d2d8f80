#include "meshing/repair/repair.h"
#include "solver/direct/direct_light.h"
#include "tests/support/analytic.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

// What is far away, large or narrow takes nothing from the light elsewhere.

namespace halfshade {
namespace {

const Vec3 upwards = Vec3::UnitZ(), downwards = -Vec3::UnitZ();

/// A square in a horizontal plane, seen from above or below.
std::vector<Vec3> square(double half, double z, bool faces_up, const Vec2& centre = {0, 0}) {
  const double x = centre.x(), y = centre.y();
  std::vector<Vec3> corners = {{x - half, y - half, z},
                               {x + half, y - half, z},
                               {x + half, y + half, z},
                               {x - half, y + half, z}};
  if (!faces_up) std::reverse(corners.begin(), corners.end());
  return corners;
}

/// Black surfaces and a light of unit exitance.
struct Layout {
  Scene scene;
  int black = test::add_material(scene, 0, 0), light = test::add_material(scene, 0, 1);

  void add(const std::vector<Vec3>& polygon, int material) {
    test::add_polygon(scene, polygon, material);
  }
  double irradiance(const Vec3& point, const Vec3& normal) const {
    return DirectLightIndex(make_sound(scene)).irradiance({point, normal}).irradiance[0];
  }
};

double above_centre(double half, double height) {
  return 4 * test::point_parallel_rectangle(half, half, height);
}

TEST(Locality, PlatesExchangeLightAcrossAnyGapInWhateverOrder) {
  for (const double gap : {1e-7, 1e-6, 1e-3, 1., 1e3})
    for (const bool light_first : {false, true}) {
      Layout plates;
      if (light_first) plates.add(square(0.5, 0, true), plates.light);
      plates.add(square(0.5, gap, false), plates.black);
      if (!light_first) plates.add(square(0.5, 0, true), plates.light);
      EXPECT_NEAR(plates.irradiance({0, 0, gap}, downwards) / above_centre(0.5, gap), 1, 1e-9)
          << gap;
    }
}

TEST(Locality, AFarTriangleChangesNothing) {
  for (const double far : {1e3, 1e6, 1e9}) {
    Layout plates;
    plates.add(square(0.5, 0, true), plates.light);
    plates.add(square(0.5, 1, false), plates.black);
    plates.add({{far, 0, 0}, {1.000001 * far, 0, 0}, {far, 1, 1}}, plates.black);
    EXPECT_NEAR(plates.irradiance({0.2, 0.1, 1}, downwards),
                test::point_parallel_rectangle(0.7, 0.6, 1) +
                    test::point_parallel_rectangle(0.3, 0.6, 1) +
                    test::point_parallel_rectangle(0.7, 0.4, 1) +
                    test::point_parallel_rectangle(0.3, 0.4, 1),
                1e-12)
        << far;
  }
}

TEST(Locality, ALightMuchWiderThanItsFloorIsSeenWhole) {
  Layout wide;
  wide.add(square(0.5, 0, true), wide.black);
  wide.add(square(5e5, 1, false), wide.light);
  EXPECT_NEAR(wide.irradiance({0.1, 0.2, 0}, upwards), 1, 1e-9);
}

TEST(Locality, ATableUnderADistantSunThrowsItsShadow) {
  for (const double height : {0.1, 0.05})
    for (const double distance : {1e5, 1e7, 1e9}) {
      const double half = 4.65e-3 * distance;
      Layout sun;
      sun.add(square(2, 0, true), sun.black);
      sun.add(square(0.5, height, true), sun.black);
      sun.add(square(half, distance, false), sun.light);
      EXPECT_NEAR(sun.irradiance({1.5, 0, 0}, upwards) / above_centre(half, distance), 1, 1e-9)
          << height << " " << distance;
      EXPECT_EQ(sun.irradiance({0.1, 0.2, 0}, upwards), 0) << height << " " << distance;
    }
}

}  // namespace
}  // namespace halfshade
