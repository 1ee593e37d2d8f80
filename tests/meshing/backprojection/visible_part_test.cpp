#include "meshing/backprojection/visible_part.h"

#include "meshing/core/error.h"
#include "solver/exchange/form_factor.h"
#include "tests/support/surfaces.h"
#include "tests/support/visible_part_oracle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

// What is visible, against independent computations.

namespace halfshade {
namespace {

using test::facing_down;
using test::factor;
using test::find_visible;
using test::Polygon;
using test::Random;

const Vec3 up = Vec3::UnitZ();

TEST(VisiblePart, SquareOverSquareHasThePublishedFactors) {
  const SoundScene scene = test::square_over_square();
  const std::vector<std::pair<Vec3, double>> expected = {{{.5, 0, 0}, 0.018916915317},
                                                         {{.75, .3, 0}, 0.033762803811},
                                                         {{1.25, 0, 0}, 0.040681704379},
                                                         {{1.5, .2, 0}, 0.032271304623}};
  for (const auto& [point, value] : expected)
    EXPECT_NEAR(factor(find_visible(scene, point), point), value, 1e-12) << point.transpose();
}

TEST(VisiblePart, SquareOverSquareHasItsRegionsWhereSimilarTrianglesPutThem) {
  const SoundScene scene = test::square_over_square();
  for (const double x : {-.2499999, -.1, 0., .0625, .2499999})
    for (const double y : {-.2499999, 0., .125}) {
      EXPECT_EQ(find_visible(scene, {x, y, 0}).region, Region::umbra);
      EXPECT_TRUE(find_visible(scene, {x, y, 0}).pieces.empty());
    }
  for (const double x : {1.2500001, 1.5, -1.7}) {
    EXPECT_EQ(find_visible(scene, {x, .3, 0}).region, Region::lit);
    EXPECT_EQ(find_visible(scene, {.3, x, 0}).region, Region::lit);
  }
  for (const double x : {.2500001, -.7, 1.2499999})
    EXPECT_EQ(find_visible(scene, {x, .1, 0}).region, Region::penumbra);
}

TEST(VisiblePart, PointsBehindBelowOrInTheEmittersPlaneSeeNothing) {
  const SoundScene scene = test::square_over_square();
  for (const Vec3& point : {Vec3(0, 0, 3), Vec3(3, 0, 2), Vec3(0, 0, 2)})
    EXPECT_EQ(find_visible(scene, point, -up).region, Region::away) << point.transpose();
  EXPECT_EQ(find_visible(scene, {3, 0, 0}, -up).region, Region::away);
  EXPECT_EQ(find_visible(scene, {3, 0, 1}, Vec3::UnitX()).region, Region::away);
}

TEST(VisiblePart, LitPartIsTheWholeOutlineToTheBit) {
  const SoundScene scene = test::square_over_square();
  const VisiblePart part = find_visible(scene, {1.7, 1.6, 0});
  ASSERT_EQ(part.region, Region::lit);
  ASSERT_EQ(part.pieces.size(), 4u);
  ASSERT_EQ(part.unobstructed.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(part.pieces[k].edge, EdgeId::emitter_edge(static_cast<int>(k)));
    EXPECT_EQ(part.pieces[k].from, part.unobstructed[k].from);
    EXPECT_EQ(part.pieces[k].to, part.unobstructed[k].to);
  }
}

/// Convex polygons strewn between the floor and the light, in front of the floor points.
std::vector<Polygon> strewn(Random& random, int count) {
  std::vector<Polygon> polygons;
  for (int i = 0; i < count; ++i)
    polygons.push_back(test::random_polygon(random,
                                            {random(-.7, .7), random(-.7, .7), random(.7, 1.3)},
                                            random(.2, .6), 3 + random.below(5)));
  return polygons;
}

TEST(VisiblePart, ConvexOccludersAgreeWithInclusionAndExclusion) {
  Random random(3);
  int partly = 0;
  for (int round = 0; round < 100; ++round) {
    const std::vector<Polygon> occluders = strewn(random, 1 + random.below(3));
    const Polygon light = facing_down(-.5, .5, -.4, .6, 2);
    SoundScene scene;
    test::add_lit_surface(scene, light, 1);
    for (const Polygon& polygon : occluders) test::add_lit_surface(scene, polygon);
    test::finish(scene);
    const OpaqueScene opaque(scene);
    VisiblePartFinder finder(opaque);
    VisiblePart part;
    for (int k = 0; k < 20; ++k) {
      const Vec3 point(random(-1.5, 1.5), random(-1.5, 1.5), 0);
      const Vec3 normal = (k % 2 == 0 ? up : Vec3(random(-1, 1), random(-1, 1), .5)).normalized();
      finder.find(point, normal, 0, part);
      const auto exact = static_cast<double>(test::visible_factor(light, occluders, point, normal));
      const double whole = static_cast<double>(test::visible_factor(light, {}, point, normal));
      EXPECT_NEAR(factor(part, point, normal), exact, 1e-13 * whole + 1e-15)
          << "round " << round << ", point " << point.transpose();
      partly += part.region == Region::penumbra ? 1 : 0;
    }
  }
  EXPECT_GT(partly, 500);
}

/// A light with a notch and a hole.
std::vector<Polygon> notched_light(double z) {
  return {{{-1, -1, z},
           {-1, 1, z},
           {0, 1, z},
           {0, .25, z},
           {.5, .25, z},
           {.5, 1, z},
           {1, 1, z},
           {1, -1, z}},
          {{-.75, -.75, z}, {-.25, -.75, z}, {-.25, -.25, z}, {-.75, -.25, z}}};
}

/// A light that stands on edge and reaches below the floor.
Polygon sunken_light() {
  return {{3, -1, 2},  {3, -.5, 1.5}, {3, 0, .25}, {3, .25, 1.5},
          {3, 1, 1.5}, {3, 1, -1},    {3, -1, -1}};
}

void add_random_object(SoundScene& scene, Random& random) {
  const Vec3 centre(random(-1.2, 1.2), random(-1.2, 1.2), random(.3, 2.2));
  switch (random.below(4)) {
    case 0: {
      Vec3 low = random.point(-1.5, 1.2);
      low.z() = random.below(2) == 0 ? 0 : random(0, 1.7);
      test::add_box(scene, low, low + random.point(.1, .8));
      break;
    }
    case 1:
      test::add_sphere(scene, centre, random(.1, .6), 1 + random.below(2));
      break;
    case 2:
      test::add_lit_surface(
          scene, test::random_polygon(random, centre, random(.2, 1), 3 + random.below(5)));
      break;
    default:
      test::add_lit_surface(scene, notched_light(random(.3, 1.9)));
  }
}

TEST(VisiblePart, RandomScenesAgreeWithSampledSightLines) {
  int tested = 0, wrong = 0, partly = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    Random random(seed);
    SoundScene scene;
    if (seed % 3 == 0)
      test::add_lit_surface(scene, sunken_light(), 1);
    else
      test::add_lit_surface(scene, notched_light(2), 1);
    ASSERT_LT(scene.surfaces[0].frame.normal.sum(), 0);
    test::add_lit_surface(scene, Polygon{{-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0}});
    for (int count = 1 + random.below(5); count > 0; --count) add_random_object(scene, random);
    test::finish(scene);
    const OpaqueScene opaque(scene);
    VisiblePartFinder finder(opaque);
    VisiblePart part;
    for (int k = 0; k < 12; ++k) {
      Vec3 point(random(-2, 2), random(-2, 2), 0), normal = up;
      if (k % 4 == 3) {
        point.z() = random(0, 1.9);
        normal = random.point(-1, 1).normalized();
      }
      finder.find(point, normal, 0, part);
      const int bad = test::wrong_samples(scene, 0, point, normal, part, 12, 1e-9, tested);
      EXPECT_EQ(bad, 0) << "seed " << seed << ", point " << point.transpose();
      wrong += bad;
      partly += part.region == Region::penumbra ? 1 : 0;
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(partly, 200);
  EXPECT_GT(tested, 80000);
}

TEST(VisiblePart, WithoutOccludersTheOutlineGivesTheClosedForm) {
  for (const bool sunken : {false, true}) {
    SoundScene scene;
    const std::vector<Polygon> rings =
        sunken ? std::vector<Polygon>{sunken_light()} : notched_light(2);
    test::add_lit_surface(scene, rings, 1);
    test::finish(scene);
    Random random(11);
    for (int k = 0; k < 100; ++k) {
      const Vec3 point(random(-2, 2), random(-2, 2), random(-.5, .5));
      const Vec3 normal = Vec3(random(-1, 1), random(-1, 1), random(.2, 1)).normalized();
      const VisiblePart part = find_visible(scene, point, normal);
      // Sutherland and Hodgman's overlapping edges cancel in the sum; a hole counts negative.
      double exact = 0;
      for (const Polygon& ring : rings)
        exact += static_cast<double>(test::visible_factor(ring, {}, point, normal));
      EXPECT_NEAR(factor(part, point, normal), exact, 1e-14);
      EXPECT_NE(part.region, Region::penumbra);
      EXPECT_NE(part.region, Region::umbra);
    }
  }
}

TEST(VisiblePart, ChainsAreClosedAndRunOneAfterTheOther) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    Random random(seed);
    SoundScene scene;
    test::add_lit_surface(scene, notched_light(2), 1);
    for (int count = 0; count < 4; ++count) add_random_object(scene, random);
    test::finish(scene);
    for (int k = 0; k < 10; ++k) {
      const Vec3 point(random(-2, 2), random(-2, 2), 0);
      const VisiblePart part = find_visible(scene, point);
      int first = 0;
      for (const int end : part.chain_ends) {
        ASSERT_GE(end, first + 3);
        for (int i = first; i < end; ++i) {
          const BoundaryPiece& piece = part.pieces[static_cast<std::size_t>(i)];
          const int follower = i + 1 < end ? i + 1 : first;
          const BoundaryPiece& next = part.pieces[static_cast<std::size_t>(follower)];
          const Vec3 a = (piece.to - point).normalized(), b = (next.from - point).normalized();
          EXPECT_LT((a - b).norm(), 1e-13);
        }
        first = end;
      }
      EXPECT_EQ(static_cast<std::size_t>(first), part.pieces.size());
    }
  }
}

TEST(VisiblePart, PiecesLieOnTheEdgesTheyName) {
  const SoundScene scene = test::square_over_square();
  const OpaqueScene opaque(scene);
  const VisiblePart part = find_visible(scene, {.75, .3, 0});
  int occluded = 0;
  for (const BoundaryPiece& piece : part.pieces) {
    std::array<Vec3, 2> ends;
    if (piece.edge.kind == EdgeId::Kind::emitter_edge) {
      const Ring& ring = scene.surfaces[0].rings[0];
      const std::size_t k = at(piece.edge.id);
      ends = {scene.surfaces[0].frame.to_space(ring[k]),
              scene.surfaces[0].frame.to_space(ring[(k + 1) % ring.size()])};
    } else {
      ASSERT_EQ(piece.edge.kind, EdgeId::Kind::edge);
      ends = opaque.edge_ends(piece.edge.id);
      ++occluded;
    }
    for (const Vec3& p : {piece.from, piece.to})
      EXPECT_LT((p - ends[0]).cross(ends[1] - ends[0]).norm(), 1e-15);
  }
  EXPECT_EQ(occluded, 2);
}

TEST(VisiblePart, BrokenRequestsAreRefused) {
  const SoundScene scene = test::square_over_square();
  EXPECT_THROW(find_visible(scene, {0, 0, 0}, up, 2), Error);
  EXPECT_THROW(find_visible(scene, {0, 0, 0}, up, -1), Error);
  EXPECT_THROW(find_visible(scene, {0, 0, 0}, 2 * up), Error);
  EXPECT_THROW(find_visible(scene, {NAN, 0, 0}), Error);
}

}  // namespace
}  // namespace halfshade
