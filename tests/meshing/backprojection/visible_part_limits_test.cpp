#include "meshing/backprojection/visible_part.h"
#include "tests/support/surfaces.h"
#include "tests/support/visible_part_oracle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

// Degenerate placements: contacts, coincidences, points in planes; and changes of scale and place.

namespace halfshade {
namespace {

using test::facing_down;
using test::factor;
using test::find_visible;
using test::Polygon;
using test::Random;

const Vec3 unit_z = Vec3::UnitZ();

double exact_factor(const Polygon& light, const std::vector<Polygon>& occluders, const Vec3& point,
                    const Vec3& normal = unit_z) {
  return static_cast<double>(test::visible_factor(light, occluders, point, normal));
}

const Polygon light = facing_down(-.5, .5, -.5, .5, 2);
const Polygon ground = {{-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0}};

SoundScene with_light(const std::vector<Polygon>& occluders) {
  SoundScene scene;
  test::add_lit_surface(scene, light, 1);
  for (const Polygon& polygon : occluders) test::add_lit_surface(scene, polygon);
  test::finish(scene);
  return scene;
}

TEST(VisiblePartLimits, TheSurfaceDoesNotHideWhatItSees) {
  const SoundScene scene = with_light({ground});
  const double hair = std::numeric_limits<double>::epsilon();
  for (const double z : {0., hair, -hair, 4 * hair, -4 * hair, 1e-9, -1e-9})
    EXPECT_EQ(find_visible(scene, {.3, .2, z}).region, Region::lit) << z;
  EXPECT_EQ(find_visible(scene, {.3, .2, -1e-3}).region, Region::umbra);
}

TEST(VisiblePartLimits, ASlantedSurfaceDoesNotHideWhatItSees) {
  Random random(4);
  for (int round = 0; round < 50; ++round) {
    const Vec3 normal = Vec3(random(-.5, .5), random(-.5, .5), 1).normalized();
    const PlaneFrame plane =
        make_frame({random(-.1, .1), random(-.1, .1), random(-.1, .1)}, normal);
    Polygon surface;
    for (const Vec2& q : {Vec2(-1, -1), Vec2(1, -1), Vec2(1, 1), Vec2(-1, 1)})
      surface.push_back(plane.to_space(q));
    const SoundScene scene = with_light({surface});
    for (int k = 0; k < 20; ++k) {
      const Vec3 point = plane.to_space({random(-1, 1), random(-1, 1)});
      EXPECT_EQ(find_visible(scene, point, plane.normal).region, Region::lit);
    }
  }
}

TEST(VisiblePartLimits, ABoxOnTheFloorBlocksUpToTheContactLine) {
  SoundScene scene = with_light({ground});
  test::add_box(scene, {.5, -9, 0}, {.6, 9, 9});
  test::finish(scene);
  const std::vector<Polygon> wall = {{{.6, -9, -9}, {.6, 9, -9}, {.6, 9, 9}, {.6, -9, 9}}};
  for (const double gap : {.5, 1e-3, 1e-6, 1e-9, 1e-12}) {
    // The wall's near side passes through an edge of the light.
    EXPECT_EQ(find_visible(scene, {.5 - gap, .1, 0}).region, Region::lit) << gap;
    const Vec3 behind(.6 + gap, .1, 0);
    EXPECT_NEAR(factor(find_visible(scene, behind), behind), 0, 1e-16) << gap;
    EXPECT_EQ(find_visible(scene, behind).region, Region::umbra) << gap;
  }
}

TEST(VisiblePartLimits, AFenceThroughTheFloorBlocksOnlyWhatItStandsBefore) {
  const Polygon fence = {{.2, -1, -1}, {.2, 1, -1}, {.2, 1, .8}, {.2, -1, .8}};
  const SoundScene scene = with_light({ground, fence});
  Random random(8);
  for (int k = 0; k < 200; ++k) {
    const Vec3 point(random(-1, 1), random(-.9, .9), 0);
    const double whole = exact_factor(light, {}, point);
    EXPECT_NEAR(factor(find_visible(scene, point), point), exact_factor(light, {fence}, point),
                1e-13 * whole);
  }
}

TEST(VisiblePartLimits, OccludersThatTouchOrPierceTheEmitterBlockUpToItsPlane) {
  for (const double top : {2., 2.7}) {
    const Polygon baffle = {{.1, -.3, 1.5}, {.1, .3, 1.5}, {.1, .3, top}, {.1, -.3, top}};
    const Polygon upto = {{.1, -.3, 1.5}, {.1, .3, 1.5}, {.1, .3, 2}, {.1, -.3, 2}};
    const SoundScene scene = with_light({ground, baffle});
    Random random(5);
    for (int k = 0; k < 200; ++k) {
      const Vec3 point(random(-2, 2), random(-2, 2), 0);
      EXPECT_NEAR(factor(find_visible(scene, point), point), exact_factor(light, {upto}, point),
                  1e-14);
    }
    EXPECT_EQ(find_visible(scene, {.1, 0, 0}).region, Region::lit);  // seen edge-on
  }
}

TEST(VisiblePartLimits, ABoxHangingFromTheEmitterCountsLikeItsFacesBelow) {
  SoundScene scene = with_light({ground});
  test::add_box(scene, {-.2, -.1, 1.6}, {.3, .2, 2});
  test::finish(scene);
  // The box is convex: its shadow is that of the hull of its bottom and top.
  Random random(6);
  for (int k = 0; k < 100; ++k) {
    const Vec3 point(random(-.2, .3), random(-.1, .2), 0);  // sees the bottom only
    EXPECT_NEAR(factor(find_visible(scene, point), point),
                exact_factor(light, {facing_down(-.2, .3, -.1, .2, 1.6)}, point), 1e-14);
  }
}

TEST(VisiblePartLimits, ACeilingRoundTheLampHidesNothing) {
  SoundScene scene;
  test::add_lit_surface(scene, light, 1);
  test::add_lit_surface(scene, {facing_down(-2, 2, -2, 2, 2), test::reversed(light)});
  test::add_lit_surface(scene, facing_down(-.2, .2, -.2, .2, 2));  // a label stuck on the lamp
  test::finish(scene);
  for (const double x : {0., .5, 1., -2.})
    EXPECT_EQ(find_visible(scene, {x, .3, 0}).region, Region::lit) << x;
}

TEST(VisiblePartLimits, CoplanarOverlappingAndRepeatedOccludersCountOnce) {
  const Polygon left = facing_down(-.4, .1, -.3, .3, 1), right = facing_down(-.2, .4, -.3, .3, 1);
  const SoundScene scene = with_light({left, right, left, test::reversed(right)});
  const Polygon both = facing_down(-.4, .4, -.3, .3, 1);
  Random random(7);
  for (int k = 0; k < 200; ++k) {
    // Every other point lies in a plane of occluder and light edges.
    const Vec3 point(k % 2 == 0 ? random(-1.5, 1.5) : .25 * random.below(7) - .75, random(-1, 1),
                     0);
    EXPECT_NEAR(factor(find_visible(scene, point), point), exact_factor(light, {both}, point),
                1e-14);
  }
}

TEST(VisiblePartLimits, AbuttingTilesLeaveNoGap) {
  // 8 × 8 tiles of different sizes per row, so that corners meet edges.
  SoundScene scene = with_light({});
  for (int row = 0; row < 8; ++row)
    for (int k = 0; k <= 8; ++k) {
      const double x0 = std::max(-1., -1 + .25 * k - .03 * row),
                   x1 = -1 + .25 * (k + 1) - .03 * row;
      if (x0 >= 1) continue;
      test::add_lit_surface(
          scene, facing_down(x0, std::min(1., x1), -1 + .25 * row, -1 + .25 * (row + 1), 1));
    }
  test::finish(scene);
  Random random(9);
  for (int k = 0; k < 300; ++k) {
    const Vec3 point(k % 3 == 0 ? .125 * random.below(9) - .5 : random(-1, 1),
                     k % 2 == 0 ? .125 * random.below(9) - .5 : random(-1, 1), 0);
    EXPECT_EQ(find_visible(scene, point).region, Region::umbra) << point.transpose();
  }
}

TEST(VisiblePartLimits, PointsInPlanesOfEdgesGetTheirNeighboursLimit) {
  const std::vector<Polygon> occluders = {facing_down(-.375, .375, -.375, .375, 1),
                                          facing_down(0, .5, 0, .5, 1.5)};
  const SoundScene scene = with_light(occluders);
  for (int i = -12; i <= 12; ++i)
    for (int j = -12; j <= 12; ++j) {
      const Vec3 point(.125 * i, .125 * j, 0);
      const VisiblePart part = find_visible(scene, point);
      const double exact = exact_factor(light, occluders, point);
      EXPECT_NEAR(factor(part, point), exact, 1e-14) << point.transpose();
      EXPECT_EQ(part.pieces.empty(), factor(part, point) == 0) << point.transpose();
    }
}

TEST(VisiblePartLimits, EdgeOnOccludersHideNothing) {
  const SoundScene scene = with_light({{{.2, -1, .5}, {.2, 1, .5}, {.2, 1, 1.5}, {.2, -1, 1.5}},
                                       {{-1, .1, .5}, {1, .1, .5}, {0, .1, 1.7}}});
  EXPECT_EQ(find_visible(scene, {.2, .1, 0}).region, Region::lit);
}

TEST(VisiblePartLimits, TheInsideOfAClosedRoomSeesItsLampWhole) {
  SoundScene scene;
  const Polygon lamp = facing_down(1, 2, 1, 2, 3);
  test::add_lit_surface(scene, lamp, 1);
  auto faces = test::box_faces({0, 0, 0}, {4, 5, 3}, true);
  for (std::size_t f = 0; f < 5; ++f) test::add_lit_surface(scene, faces[f]);
  test::add_lit_surface(scene, {faces[5], test::reversed(lamp)});
  test::finish(scene);
  Random random(12);
  for (int k = 0; k < 100; ++k) {
    const Vec3 point(random(0, 4), random(0, 5), 0);
    const VisiblePart part = find_visible(scene, point);
    EXPECT_EQ(part.region, Region::lit);
    EXPECT_EQ(part.pieces.size(), 4u);
  }
  EXPECT_EQ(find_visible(scene, {0, 2, 1}, Vec3::UnitX()).region, Region::lit);
  EXPECT_EQ(find_visible(scene, {0, 0, 0}).region, Region::lit);
}

TEST(VisiblePartLimits, AWallThatIsTheLightSharesItsEdgesWithItsNeighbours) {
  SoundScene scene;
  auto faces = test::box_faces({0, 0, 0}, {4, 5, 3}, true);
  for (std::size_t f = 0; f < 6; ++f) test::add_lit_surface(scene, faces[f]);
  test::finish(scene);
  Random random(13);
  for (int k = 0; k < 100; ++k) {
    const Vec3 point(random(.01, 4), random(0, 5), 0);
    const VisiblePart part = find_visible(scene, point, unit_z, 0);
    EXPECT_EQ(part.region, Region::lit);
    const double exact = exact_factor(faces[0], {}, point);
    EXPECT_NEAR(factor(part, point), exact, 1e-14);
  }
}

TEST(VisiblePartLimits, AWallWithAWindowHidesAllButTheWindow) {
  const Polygon window = {{.5, -.2, .8}, {.5, .3, .8}, {.5, .3, 1.4}, {.5, -.2, 1.4}};
  const Polygon wall = {{.5, -9, -1}, {.5, 9, -1}, {.5, 9, 9}, {.5, -9, 9}};
  SoundScene scene = with_light({ground});
  test::add_lit_surface(scene, {wall, test::reversed(window)});
  test::finish(scene);
  Random random(15);
  int partly = 0;
  for (int k = 0; k < 200; ++k) {
    const Vec3 point(random(.6, 2), random(-1, 1), 0);
    // What the window shows is what it would hide.
    const double exact = exact_factor(light, {}, point) - exact_factor(light, {window}, point);
    const VisiblePart part = find_visible(scene, point);
    EXPECT_NEAR(factor(part, point), exact, 1e-14);
    EXPECT_EQ(part.region == Region::umbra, exact < 1e-17) << exact;
    partly += part.region == Region::penumbra ? 1 : 0;
  }
  EXPECT_GT(partly, 50);
}

/// Boxes, plates and triangles on a coarse grid: most edges are parallel, many lie on one line or
/// meet in a point, as seen from anywhere or from points on the grid.
SoundScene grid_scene(Random& random, double step) {
  const auto grid = [&](double low, double high) {
    return step * std::round(random(low, high) / step);
  };
  SoundScene scene = with_light({ground});
  for (int count = 1 + random.below(12); count > 0; --count) {
    const double x = grid(-1.5, 1), y = grid(-1.5, 1), z = grid(0, 1.75);
    const Vec3 low(x, y, z),
        high = low + step * Vec3(1 + random.below(3), 1 + random.below(3), 1 + random.below(3));
    Polygon triangle;
    for (int k = 0; k < 3; ++k) {
      const double u = grid(-1.5, 1.5), v = grid(-1.5, 1.5);
      triangle.emplace_back(u, v, step + grid(0, 1.75));
    }
    const int kind = random.below(3);
    if (kind == 0)
      test::add_box(scene, low, high);
    else if (kind == 1)
      test::add_lit_surface(scene, facing_down(x, high.x(), y, high.y(), z + step));
    else if (area_vector(triangle).norm() > 1e-3)
      test::add_lit_surface(scene, triangle);
  }
  test::finish(scene);
  return scene;
}

TEST(VisiblePartLimits, GridScenesSeenFromTheGridAgreeWithSampledSightLines) {
  int tested = 0, partly = 0;
  for (unsigned seed = 0; seed < 80; ++seed) {
    Random random(seed);
    const double step = seed % 2 == 0 ? .25 : .3;
    const SoundScene scene = grid_scene(random, step);
    const OpaqueScene opaque(scene);
    VisiblePartFinder finder(opaque);
    VisiblePart part;
    for (int k = 0; k < 20; ++k) {
      const Vec3 point(step * (random.below(13) - 6), step * (random.below(13) - 6), 0);
      finder.find(point, unit_z, 0, part);
      EXPECT_EQ(test::wrong_samples(scene, 0, point, unit_z, part, 10, 1e-9, tested), 0)
          << "seed " << seed << ", point " << point.transpose();
      const double visible = factor(part, point),
                   whole = test::lambert(part.unobstructed, point, unit_z);
      EXPECT_GE(visible, -1e-15);
      EXPECT_LE(visible, whole + 1e-15);
      partly += part.region == Region::penumbra ? 1 : 0;
    }
  }
  EXPECT_GT(partly, 600);
  EXPECT_GT(tested, 100000);
}

/// Largest relative error of the form factor over some points of a scene that is scaled, then
/// moved.
double largest_error(double scale, const Vec3& shift) {
  const std::vector<Polygon> occluders = {facing_down(-.375, .375, -.375, .375, 1),
                                          {{.3, -.2, .4}, {.4, .5, .6}, {.1, .3, .7}}};
  const auto moved = [&](Polygon polygon) {
    for (Vec3& p : polygon) p = scale * p + shift;
    return polygon;
  };
  std::vector<Polygon> images;
  for (const Polygon& polygon : occluders) images.push_back(moved(polygon));
  SoundScene scene;
  test::add_lit_surface(scene, moved(light), 1);
  for (const Polygon& polygon : images) test::add_lit_surface(scene, polygon);
  test::finish(scene);
  double worst = 0;
  Random random(14);
  for (int k = 0; k < 100; ++k) {
    const Vec3 point(random(-1.5, 1.5), random(-1.5, 1.5), 0);
    const Vec3 image = scale * point + shift;
    const double whole = exact_factor(light, {}, point);
    const double error =
        factor(find_visible(scene, image), image) - exact_factor(light, occluders, point);
    worst = std::max(worst, std::abs(error) / whole);
  }
  return worst;
}

TEST(VisiblePartLimits, ScaleDoesNotMatter) {
  for (const double scale : {1., 1e-6, 1e6}) EXPECT_LT(largest_error(scale, Vec3::Zero()), 1e-14);
}

TEST(VisiblePartLimits, FarFromTheOriginOnlyTheRoundingOfTheInputShows) {
  // Coordinates at distance D carry an absolute error of D times 1e-16; visible parts change by
  // about ten times as much here.
  const Vec3 direction(1, -.7, .3);
  for (const double distance : {1e3, 1e6})
    EXPECT_LT(largest_error(1, distance * direction), 30 * distance * 1.2e-16);
}

TEST(VisiblePartLimits, TinyHugeNearAndFarLightsKeepTheirPrecision) {
  for (const double size : {1e-6, 1e-3, 1e3, 1e6}) {
    const Polygon lamp = facing_down(-size, size, -size, size, 2);
    const Polygon screen = facing_down(0, 9, -9, 9, 1);
    SoundScene scene;
    test::add_lit_surface(scene, lamp, 1);
    test::add_lit_surface(scene, screen);
    test::finish(scene);
    for (const double x : {0., -.4 * std::min(size, 1.), .25 * std::min(size, 1.)}) {
      const Vec3 point(x, .01, 0);
      const double whole = exact_factor(lamp, {}, point);
      EXPECT_NEAR(factor(find_visible(scene, point), point), exact_factor(lamp, {screen}, point),
                  1e-9 * whole)
          << size << " " << x;
    }
  }
}

}  // namespace
}  // namespace halfshade
