#include "meshing/core/light_source.h"
#include "tests/support/lit_scene.h"
#include "tests/support/outline_pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

// The border of what of an emitter can be seen, and its corners.

namespace halfshade {
namespace {

using test::is_cut;
using test::is_own;
using test::is_same;
using test::LitScene;
using test::outline_length;
using test::SceneMaker;

int corners_at(const EmitterScene& emitter_scene, const Vec3& place) {
  return static_cast<int>(
      std::count_if(emitter_scene.corners.begin(), emitter_scene.corners.end(),
                    [&](const OutlinePoint& corner) { return is_same(corner.position, place); }));
}

const OutlinePoint* corner_at(const EmitterScene& emitter_scene, const Vec3& place) {
  for (const OutlinePoint& corner : emitter_scene.corners)
    if (is_same(corner.position, place)) return &corner;
  return nullptr;
}

TEST(Outline, OfALightWithAHoleHasBothRings) {
  const SoundScene scene = test::light_with_a_hole();
  const OpaqueScene opaque(scene);
  const EmitterScene emitter_scene(scene, opaque, light_sources(scene)[0].surface);
  ASSERT_EQ(emitter_scene.outline.size(), 8u);
  EXPECT_NEAR(outline_length(emitter_scene, is_own), 2 * (1.4 + 1.2) + 2 * (0.5 + 0.4), 1e-9);
  ASSERT_EQ(emitter_scene.corners.size(), 8u);
  std::set<EdgeId> ids;
  for (const OutlinePiece& piece : emitter_scene.outline) ids.insert(piece.id);
  std::set<EdgeId> expected;
  for (int k = 0; k < 8; ++k) expected.insert(EdgeId::emitter_edge(k));
  EXPECT_EQ(ids, expected);
  for (const OutlinePoint& corner : emitter_scene.corners) {
    ASSERT_EQ(corner.edges.size(), 2u);
    EXPECT_LT(corner.edges[0], corner.edges[1]);
    for (const OutlinePiece& piece : emitter_scene.outline) {
      const bool ends_here =
          is_same(piece.span.from, corner.position) || is_same(piece.span.to, corner.position);
      const bool is_listed =
          std::find(corner.edges.begin(), corner.edges.end(), piece.id) != corner.edges.end();
      EXPECT_EQ(ends_here, is_listed);
    }
  }
}

/// Whether a point lies on the border of [−.2, .2]² at z = 2.
bool is_on_square(const Vec3& p) {
  return std::abs(p.z() - 2) < 1e-9 &&
         std::abs(std::max(std::abs(p.x()), std::abs(p.y())) - 0.2) < 1e-9;
}

TEST(Outline, GoesRoundWhatHangsFromTheLight) {
  SceneMaker maker;
  maker.square_light();
  const auto faces = test::box_faces({-0.2, -0.2, 1.6}, {0.2, 0.2, 2}, false);
  for (std::size_t f = 0; f < 5; ++f) maker.polygon(faces[f]);
  const LitScene lit(maker);
  EXPECT_NEAR(outline_length(lit.emitter_scene, is_own), 4, 1e-9);
  EXPECT_NEAR(outline_length(lit.emitter_scene, [](const OutlinePiece& p) { return !is_own(p); }),
              1.6, 1e-9);
  for (const OutlinePiece& piece : lit.emitter_scene.outline) {
    if (is_own(piece)) continue;
    EXPECT_TRUE(is_on_square(piece.span.from) && is_on_square(piece.span.at(0.5)));
    EXPECT_EQ(piece.feature.kind, Feature::Kind::edge);
  }
  for (const double x : {-0.2, 0.2})
    for (const double y : {-0.2, 0.2}) {
      const OutlinePoint* corner = corner_at(lit.emitter_scene, {x, y, 2});
      ASSERT_TRUE(corner);
      EXPECT_GE(corner->edges.size(), 3u) << "two in the plane and the one that leads away";
    }
}

TEST(Outline, FollowsWhatPiercesTheLight) {
  const SceneMaker maker = SceneMaker().square_light().box({-0.2, -0.2, 1.6}, {0.2, 0.2, 2.3});
  // The repair gives the sides corners in the light's plane, between which there may be edges.
  const LitScene repaired(maker), lit(test::as_it_is(maker.scene));
  EXPECT_NEAR(outline_length(repaired.emitter_scene, is_own), 4, 1e-9);
  EXPECT_NEAR(
      outline_length(repaired.emitter_scene, [](const OutlinePiece& p) { return !is_own(p); }), 1.6,
      1e-9);
  EXPECT_NEAR(outline_length(lit.emitter_scene, is_own), 4, 1e-9);
  EXPECT_NEAR(outline_length(lit.emitter_scene, is_cut), 1.6, 1e-9);
  for (const OutlinePiece& piece : lit.emitter_scene.outline)
    if (!is_own(piece)) {
      EXPECT_TRUE(is_on_square(piece.span.from) && is_on_square(piece.span.at(0.5)));
      EXPECT_EQ(piece.feature.kind, Feature::Kind::face);
    }
  for (const double x : {-0.2, 0.2})
    for (const double y : {-0.2, 0.2}) {
      const OutlinePoint* corner = corner_at(lit.emitter_scene, {x, y, 2});
      ASSERT_TRUE(corner);
      // Two triangles of the sides that meet here, and the edge between them.
      EXPECT_EQ(std::count_if(corner->edges.begin(), corner->edges.end(),
                              [](EdgeId id) { return id.kind == EdgeId::Kind::cut; }),
                2);
      EXPECT_EQ(std::count_if(corner->edges.begin(), corner->edges.end(),
                              [](EdgeId id) { return id.kind == EdgeId::Kind::edge; }),
                1);
    }
}

TEST(Outline, HasCornersWhereWhatPiercesItCrossesTheBorder) {
  const LitScene lit(
      test::as_it_is(SceneMaker().square_light().box({0.3, -0.2, 1.6}, {0.7, 0.1, 2.3}).scene));
  for (const double y : {-0.2, 0.1}) {
    bool found = false;
    for (const OutlinePoint& corner : lit.emitter_scene.corners)
      if (is_same(corner.position, {0.5, y, 2}))
        found = found || (corner.edges.front().kind == EdgeId::Kind::emitter_edge &&
                          corner.edges.back().kind == EdgeId::Kind::cut);
    EXPECT_TRUE(found) << y;
    EXPECT_GE(corners_at(lit.emitter_scene, {0.3, y, 2}), 1);
    EXPECT_EQ(corners_at(lit.emitter_scene, {0.7, y, 2}), 0) << "outside the light";
  }
}

TEST(Outline, AThingThatTouchesTheBorderMakesNoCornerOfTheLightsOwn) {
  const LitScene lit(
      SceneMaker().square_light().polygon({{-0.1, 0.5, 2}, {0.2, 0.5, 2}, {0, 0.5, 1.5}}));
  EXPECT_NEAR(outline_length(lit.emitter_scene, is_own), 4, 1e-9);
  std::set<EdgeId> own;
  for (const OutlinePiece& piece : lit.emitter_scene.outline)
    if (is_own(piece)) own.insert(piece.id);
  EXPECT_EQ(own.size(), 4u) << "pieces of one edge share its id";
  for (const double x : {-0.1, 0.2}) {
    ASSERT_GE(corners_at(lit.emitter_scene, {x, 0.5, 2}), 1);
    EXPECT_NE(corner_at(lit.emitter_scene, {x, 0.5, 2})->feature.kind,
              Feature::Kind::emitter_vertex);
  }
  EXPECT_EQ(std::count_if(lit.emitter_scene.corners.begin(), lit.emitter_scene.corners.end(),
                          [](const OutlinePoint& corner) {
                            return corner.feature.kind == Feature::Kind::emitter_vertex;
                          }),
            4);
}

}  // namespace
}  // namespace halfshade
