#include "meshing/discontinuity/border_events.h"

#include "tests/support/discontinuity_scenes.h"
#include "tests/support/lit_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace halfshade {
namespace {

using test::SceneMaker;

const Vec3 up = Vec3::UnitZ();

struct BorderScene : test::LitScene {
  using LitScene::LitScene;

  /// The receiver that an input face became.
  int surface_of(int face) const {
    for (std::size_t r = 0; r < scene.surfaces.size(); ++r) {
      const auto& faces = scene.surfaces[r].faces;
      if (std::find(faces.begin(), faces.end(), face) != faces.end()) return static_cast<int>(r);
    }
    return -1;
  }
  std::vector<DiscontinuityCurve> plane_curves(int face) const {
    std::vector<DiscontinuityCurve> curves;
    BorderSearch(scene, opaque, emitter_scene).add_plane_curves(surface_of(face), 1000000, curves);
    return curves;
  }
  std::vector<DiscontinuityCurve> contacts(int face) const {
    std::vector<DiscontinuityCurve> curves;
    BorderSearch(scene, opaque, emitter_scene)
        .add_contact_curves(surface_of(face), 1000000, curves);
    return curves;
  }
  Span3 ends(const DiscontinuityCurve& curve) const {
    const PlaneFrame& frame = scene.surfaces[static_cast<std::size_t>(curve.receiver)].frame;
    return {frame.to_space(curve.arc.from), frame.to_space(curve.arc.to)};
  }
};

/// A wall in x = 1.5 beside the light [−.5,.5]² at z = 2; face 1.
SceneMaker lamp_and_wall(double top) {
  return SceneMaker().square_light().polygon(
      {{1.5, -1, 0}, {1.5, -1, top}, {1.5, 1, top}, {1.5, 1, 0}});
}

TEST(EmitterPlaneCurves, RunWhereAWallCrossesThePlaneOfALamp) {
  const BorderScene lit(lamp_and_wall(3));
  const auto curves = lit.plane_curves(1);
  ASSERT_EQ(curves.size(), 1u);
  EXPECT_EQ(curves[0].order, 1);
  EXPECT_EQ(curves[0].kind, CurveKind::face);
  EXPECT_EQ(curves[0].emitter, lit.emitter_scene.emitter);
  EXPECT_NEAR(std::abs(curves[0].sight_plane.z()), 1, 1e-12);
  const Span3 ends = lit.ends(curves[0]);
  EXPECT_NEAR(ends.direction().norm(), 2, 1e-9);
  for (const Vec3& p : {ends.from, ends.to})
    EXPECT_NEAR((p - Vec3(1.5, p.y() < 0 ? -1 : 1, 2)).norm(), 0, 1e-9);
}

TEST(EmitterPlaneCurves, AreWhereTheIrradianceStartsToGrow) {
  const BorderScene lit(lamp_and_wall(3));
  const Vec3 normal = -Vec3::UnitX();
  double before = 0;
  for (const double depth : {1e-4, 1e-3, 1e-2}) {
    EXPECT_EQ(lit.factor({1.5, 0.3, 2 + depth}, normal), 0);
    const double slope = lit.factor({1.5, 0.3, 2 - depth}, normal) / depth;
    EXPECT_GT(slope, 0.01) << "of order one";
    if (before > 0) {
      EXPECT_NEAR(slope / before, 1, 0.02);
    }
    before = slope;
  }
}

TEST(EmitterPlaneCurves, AreNoneOnWhatDoesNotReachThePlaneOrLooksAway) {
  EXPECT_TRUE(BorderScene(lamp_and_wall(1.9)).plane_curves(1).empty());
  const BorderScene away(
      SceneMaker().square_light().polygon({{1.5, -1, 0}, {1.5, 1, 0}, {1.5, 1, 3}, {1.5, -1, 3}}));
  EXPECT_TRUE(away.plane_curves(1).empty());
  const BorderScene parallel(SceneMaker().square_light().floor().down({1, 1}, {2, 2}, 2));
  for (const int face : {0, 1, 2}) EXPECT_TRUE(parallel.plane_curves(face).empty());
}

TEST(EmitterPlaneCurves, EndWhereAnOccluderHidesTheWholeLamp) {
  // The sheet in x = 1 ends at y = 0. The lamp's corner (.5, .5) is the last that is seen past it:
  // on the line through (1, 0), which meets the wall at y = −.5.
  const BorderScene lit(lamp_and_wall(3).polygon({{1, -3, 1}, {1, -3, 3}, {1, 0, 3}, {1, 0, 1}}));
  const auto curves = lit.plane_curves(1);
  ASSERT_EQ(curves.size(), 1u);
  const Span3 ends = lit.ends(curves[0]);
  const auto [low, high] = std::minmax({ends.from.y(), ends.to.y()});
  EXPECT_NEAR(low, -0.5, 1e-9);
  EXPECT_NEAR(high, 1, 1e-9);
}

TEST(EmitterPlaneCurves, GoOnBehindAnOccluderThatHidesOnlySomeOfTheLamp) {
  // Less wide than the lamp: from no point of the wall does it hide all of it.
  const BorderScene lit(
      lamp_and_wall(3).polygon({{1, -0.1, 1}, {1, -0.1, 3}, {1, 0.1, 3}, {1, 0.1, 1}}));
  double length = 0;
  for (const DiscontinuityCurve& curve : lit.plane_curves(1))
    length += lit.ends(curve).direction().norm();
  EXPECT_NEAR(length, 2, 1e-9);
}

TEST(EmitterPlaneCurves, HaveAGapBehindAnOccluderInTheMiddle) {
  // The sheet in x = 1.25 reaches over |y| ≤ .4; the line from (.5, ±.5) past its end (1.25, ±.4)
  // meets the wall at |y| = .4 − .1/3, and the one from (−.5, ±.5) at .4 − .1/7.
  const BorderScene lit(
      lamp_and_wall(3).polygon({{1.25, -0.4, 1}, {1.25, -0.4, 3}, {1.25, 0.4, 3}, {1.25, 0.4, 1}}));
  auto curves = lit.plane_curves(1);
  ASSERT_EQ(curves.size(), 2u);
  for (const DiscontinuityCurve& curve : curves) {
    const Span3 ends = lit.ends(curve);
    const auto [near, far] = std::minmax({std::abs(ends.from.y()), std::abs(ends.to.y())});
    EXPECT_NEAR(near, 0.4 - 0.1 / 3, 1e-9);
    EXPECT_NEAR(far, 1, 1e-9);
  }
}

bool lies_on(const Vec3& p, int axis, double value) { return std::abs(p[axis] - value) < 1e-9; }

TEST(ContactCurves, RunAllRoundABoxBelowTheLight) {
  const BorderScene lit(
      SceneMaker().square_light().floor().standing_box({-0.2, -0.3, 0}, {0.3, 0.1, 0.4}));
  const auto curves = lit.contacts(1);
  double length = 0;
  for (const DiscontinuityCurve& curve : curves) {
    EXPECT_EQ(curve.order, 0);
    EXPECT_EQ(curve.kind, CurveKind::contact);
    EXPECT_EQ(curve.receiver, lit.surface_of(1));
    EXPECT_TRUE(curve.arc.is_straight);
    length += lit.ends(curve).direction().norm();
  }
  EXPECT_NEAR(length, 2 * (0.5 + 0.4), 1e-9);
}

TEST(ContactCurves, AreNoneOnSidesThatLookAwayFromTheLight) {
  // The light begins at x, y = −.5, on this side of the planes of the box's far sides.
  const BorderScene lit(
      SceneMaker().square_light().floor().standing_box({-0.9, -0.8, 0}, {-0.3, -0.2, 0.7}));
  const auto curves = lit.contacts(1);
  double along_x = 0, along_y = 0;
  for (const DiscontinuityCurve& curve : curves) {
    const Span3 ends = lit.ends(curve);
    const double length = ends.direction().norm();
    if (lies_on(ends.from, 0, -0.3) && lies_on(ends.to, 0, -0.3))
      along_y += length;
    else if (lies_on(ends.from, 1, -0.2) && lies_on(ends.to, 1, -0.2))
      along_x += length;
    else
      ADD_FAILURE() << ends.from.transpose() << " to " << ends.to.transpose();
  }
  EXPECT_NEAR(along_x, 0.6, 1e-9);
  EXPECT_NEAR(along_y, 0.6, 1e-9);
}

TEST(ContactCurves, AreNoneUnderARoof) {
  const BorderScene lit(SceneMaker()
                            .square_light()
                            .floor()
                            .standing_box({-0.2, -0.3, 0}, {0.3, 0.1, 0.4})
                            .up({-3, -3}, {3, 3}, 1));
  ASSERT_FALSE(lit.scene.surfaces[static_cast<std::size_t>(lit.surface_of(1))].contacts.empty());
  EXPECT_TRUE(lit.contacts(1).empty());
}

TEST(ContactCurves, RunOnBothOfTwoSheetsThatCrossInTheLight) {
  const BorderScene lit(SceneMaker()
                            .square_light()
                            .up({-0.4, -0.4}, {0.3, 0.4}, 0.5)
                            .polygon({{-1, -0.1, 0}, {1, -0.1, 0}, {1, -0.1, 1}, {-1, -0.1, 1}}));
  // Of the sheet that looks along −y the upper part sees some of the light, the lower one none.
  // That which looks up sees the light's parts on either side of the other, which are not equal.
  for (const int face : {1, 2}) {
    const auto curves = lit.contacts(face);
    ASSERT_EQ(curves.size(), 1u);
    EXPECT_NEAR(lit.ends(curves[0]).direction().norm(), 0.7, 1e-9);
  }
}

}  // namespace
}  // namespace halfshade
