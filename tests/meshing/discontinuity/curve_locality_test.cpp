#include "meshing/discontinuity/discontinuity.h"
#include "tests/support/discontinuity_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

// What is far away or large takes no curve from what lies elsewhere, and adds none.

namespace halfshade {
namespace {

using test::SceneMaker;

struct FoundCurve {
  CurveKind kind;
  int order;
  Vec3 middle;
  double length;
};

std::vector<FoundCurve> curves_of(const SceneMaker& maker) {
  const SoundScene scene = maker.sound();
  const OpaqueScene opaque(scene);
  const Discontinuities found = find_discontinuities(scene, opaque, light_sources(scene));
  std::vector<FoundCurve> curves;
  for (const DiscontinuityCurve& curve : found.curves) {
    const PlaneFrame& plane = scene.surfaces[at(curve.receiver)].frame;
    curves.push_back({curve.kind, curve.order, plane.to_space(point_at(curve.arc, 0.5)),
                      (curve.arc.to - curve.arc.from).norm()});
  }
  return curves;
}

/// The same curves, wherever they stand in the list.
void expect_same(const std::vector<FoundCurve>& expected, const std::vector<FoundCurve>& got,
                 double tolerance, const std::string& what) {
  EXPECT_EQ(got.size(), expected.size()) << what;
  for (const FoundCurve& curve : expected)
    EXPECT_TRUE(std::any_of(got.begin(), got.end(),
                            [&](const FoundCurve& other) {
                              return other.kind == curve.kind && other.order == curve.order &&
                                     (other.middle - curve.middle).norm() < tolerance &&
                                     std::abs(other.length - curve.length) < tolerance;
                            }))
        << what << ": a curve of order " << curve.order << " and length " << curve.length
        << " through " << curve.middle.transpose() << " is missing";
}

/// Two boxes on a floor, one leaning over the other's shadow.
SceneMaker& furnish(SceneMaker& maker) {
  return maker.floor()
      .standing_box({-0.8, -0.6, 0}, {-0.3, 0.1, 0.45})
      .turned_box({-0.2, -0.5, 0.6}, {0.5, 0.4, 0.8}, 0.4);
}

TEST(CurveLocality, AFarTriangleChangesNoCurve) {
  SceneMaker room;
  furnish(room.square_light());
  const std::vector<FoundCurve> expected = curves_of(room);
  ASSERT_GT(expected.size(), 100u);
  for (const double far : {1e3, 1e6, 1e9, 1e12}) {
    SceneMaker with_triangle = room;
    with_triangle.polygon({{far, 0, 0}, {1.001 * far, 0, 0}, {far, 0.001 * far, 1}});
    expect_same(expected, curves_of(with_triangle), 1e-9, "triangle at " + std::to_string(far));
  }
}

/// A square sun of half a degree, at a distance and a slant.
SceneMaker under_a_sun(double distance) {
  const PlaneFrame disc =
      make_frame(distance * Vec3(0.3, -0.2, 0.9).normalized(), -Vec3(0.3, -0.2, 0.9).normalized());
  const double half = 0.00465 * distance;
  std::vector<Vec3> corners;
  for (const Vec2& p : {Vec2(-half, -half), Vec2(half, -half), Vec2(half, half), Vec2(-half, half)})
    corners.push_back(disc.to_space(p));
  SceneMaker maker;
  furnish(maker).polygon(corners, test::white_light);
  return maker;
}

TEST(CurveLocality, ASunDrawsTheSameCurvesFromAnyDistance) {
  const std::vector<FoundCurve> expected = curves_of(under_a_sun(1e8));
  EXPECT_EQ(expected.size(), 86u);
  for (const double distance : {1e9, 1e10, 1.5e11})
    expect_same(expected, curves_of(under_a_sun(distance)), 1e-6,
                "sun at " + std::to_string(distance));
}

}  // namespace
}  // namespace halfshade
