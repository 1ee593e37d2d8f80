#include "meshing/discontinuity/swath_tracer.h"

#include "meshing/core/planar.h"
#include "meshing/discontinuity/margins.h"
#include "meshing/events/events.h"
#include "tests/support/critical_conic.h"
#include "tests/support/discontinuity_scenes.h"
#include "tests/support/lit_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

// One swath at a time, against where its lines must end.

namespace halfshade {
namespace {

using test::SceneMaker;
using Stretch = std::array<double, 2>;

struct Traced : test::LitScene {
  explicit Traced(SoundScene sound)
      : LitScene(std::move(sound)), tracer(scene, opaque, emitter_scene) {}
  explicit Traced(const SceneMaker& maker) : Traced(maker.sound()) {}

  int edge_between(const Vec3& a, const Vec3& b) const {
    for (std::size_t e = 0; e < emitter_scene.edges.size(); ++e) {
      const Span3& span = emitter_scene.edges[e].whole;
      if (((span.from - a).norm() < 1e-9 && (span.to - b).norm() < 1e-9) ||
          ((span.from - b).norm() < 1e-9 && (span.to - a).norm() < 1e-9))
        return static_cast<int>(e);
    }
    ADD_FAILURE() << "no edge from " << a.transpose() << " to " << b.transpose();
    return 0;
  }

  /// Curves of the swaths through an edge and a point.
  std::vector<DiscontinuityCurve> edge_and_point(int edge, const Vec3& apex) {
    std::vector<DiscontinuityCurve> curves;
    edge_swaths(emitter_scene, edge, [&](const Swath& swath) {
      if ((swath.apex - apex).norm() < 1e-9) tracer.trace(swath, curves);
    });
    return curves;
  }

  /// At heights [low, high], the pieces of curves as ranges of one coordinate, joined. All must lie
  /// where `is_right` holds.
  template <class IsRight>
  std::vector<Stretch> ranges(const std::vector<DiscontinuityCurve>& curves, double low,
                              double high, int axis, const IsRight& is_right) const {
    std::vector<Stretch> all;
    for (const DiscontinuityCurve& curve : curves) {
      const PlaneFrame& frame = scene.surfaces[static_cast<std::size_t>(curve.receiver)].frame;
      const Vec3 a = frame.to_space(curve.arc.from), b = frame.to_space(curve.arc.to);
      if (std::min(a.z(), b.z()) < low || std::max(a.z(), b.z()) > high) continue;
      EXPECT_TRUE(is_right(a) && is_right(b)) << a.transpose() << " to " << b.transpose();
      all.push_back({std::min(a[axis], b[axis]), std::max(a[axis], b[axis])});
    }
    std::sort(all.begin(), all.end());
    std::vector<Stretch> joined;
    for (const Stretch& s : all)
      if (!joined.empty() && s[0] <= joined.back()[1] + 1e-9)
        joined.back()[1] = std::max(joined.back()[1], s[1]);
      else
        joined.push_back(s);
    return joined;
  }

  SwathTracer tracer;
};

TEST(SwathTracer, DoesNotCutWhatOneFaceHidesAllAlong) {
  SceneMaker maker = SceneMaker().square_light().floor();
  for (int k = 0; k < 20; ++k) {
    const double x = 0.04 * (k - 10);
    maker.box({x, -0.3, 0.2}, {x + 0.02, 0.3, 0.3});
  }
  Traced seen(maker), hidden(maker.up({-3, -3}, {3, 3}, 1.5));
  const auto pieces = [](Traced& traced) {
    std::vector<DiscontinuityCurve> curves;
    const int edge = traced.edge_between({0, -0.3, 0.3}, {0, 0.3, 0.3});
    edge_swaths(traced.emitter_scene, edge, [&](const Swath& swath) {
      if (swath.ends_on_outline) traced.tracer.trace(swath, curves);
    });
    return traced.tracer.counts().pieces;
  };
  EXPECT_GT(pieces(seen), 4u);
  EXPECT_EQ(pieces(hidden), 0u);
  EXPECT_GT(hidden.tracer.counts().swaths, 0u);
}

void expect_ranges(const std::vector<Stretch>& found, const std::vector<Stretch>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    EXPECT_NEAR(found[k][0], expected[k][0], 1e-8) << k;
    EXPECT_NEAR(found[k][1], expected[k][1], 1e-8) << k;
  }
}

SceneMaker s1_maker() {
  return SceneMaker().square_light().up({-0.375, -0.375}, {0.375, 0.375}, 1).floor();
}

// Lines from the light's corner (.5, .5, 2) through (.375, y, 1) end in (.25, 2y − .5, 0).
const Vec3 corner(0.5, 0.5, 2);

std::vector<DiscontinuityCurve> inner_limit(Traced& traced) {
  const int edge = traced.edge_between({0.375, -0.375, 1}, {0.375, 0.375, 1});
  return traced.edge_and_point(edge, corner);
}

bool lies_in(const Vec3& p, double x) { return std::abs(p.x() - x) < 1e-9; }

TEST(SwathTracer, FollowsASwathOfS1ToWhereSimilarTrianglesPutIt) {
  Traced traced(s1_maker());
  const auto curves = inner_limit(traced);
  expect_ranges(traced.ranges(curves, -1, 0.1, 1, [](const Vec3& p) { return lies_in(p, 0.25); }),
                {{-1.25, 0.25}});
  for (const DiscontinuityCurve& curve : curves) {
    EXPECT_EQ(curve.kind, CurveKind::ev);
    EXPECT_EQ(curve.order, 1) << "the light's side is parallel to the edge";
    EXPECT_TRUE(curve.arc.is_straight);
    EXPECT_EQ(curve.emitter, traced.emitter_scene.emitter);
    EXPECT_EQ(traced.scene.surfaces[static_cast<std::size_t>(curve.receiver)].frame.origin.z(), 0);
    // Normal to the plane of sight: of (−.125, ·, −1) and y.
    EXPECT_NEAR(std::abs(curve.sight_plane.dot(Vec3(1, 0, -0.125).normalized())), 1, 1e-12);
  }
}

TEST(SwathTracer, FollowsTheOuterLimitFromTheOtherCorner) {
  // From (−.5, .5, 2) through (.375, y, 1) to (1.25, 2y − .5, 0).
  Traced traced(s1_maker());
  const int edge = traced.edge_between({0.375, -0.375, 1}, {0.375, 0.375, 1});
  const auto curves = traced.edge_and_point(edge, {-0.5, 0.5, 2});
  expect_ranges(traced.ranges(curves, -1, 0.1, 1, [](const Vec3& p) { return lies_in(p, 1.25); }),
                {{-1.25, 0.25}});
}

TEST(SwathTracer, IsBlockedByASheetBelowTheEdgeWhichGetsTheCurveInstead) {
  // At z = .5 the lines are at x = .3125 and y = .75 Y + .125 for Y on the floor.
  Traced traced(s1_maker().up({0.2, -0.4}, {0.6, -0.1}, 0.5));
  const auto curves = inner_limit(traced);
  expect_ranges(traced.ranges(curves, -1, 0.1, 1, [](const Vec3& p) { return lies_in(p, 0.25); }),
                {{-1.25, -0.7}, {-0.3, 0.25}});
  expect_ranges(
      traced.ranges(curves, 0.4, 0.6, 1, [](const Vec3& p) { return lies_in(p, 0.3125); }),
      {{-0.4, -0.1}});
}

TEST(SwathTracer, IsBlockedByASheetBetweenTheLightAndTheEdge) {
  // At z = 1.5 the lines are at x = .4375 and y = .25 Y + .375 for Y on the floor.
  Traced traced(s1_maker().up({0.3, 0.1}, {0.6, 0.3}, 1.5));
  const auto curves = inner_limit(traced);
  expect_ranges(traced.ranges(curves, -1, 0.1, 1, [](const Vec3& p) { return lies_in(p, 0.25); }),
                {{-1.25, -1.1}, {-0.3, 0.25}});
  EXPECT_TRUE(traced.ranges(curves, 1.4, 1.6, 1, [](const Vec3&) { return true; }).empty());
}

TEST(SwathTracer, EndsAtTheBorderOfTheSurface) {
  Traced traced(SceneMaker()
                    .square_light()
                    .up({-0.375, -0.375}, {0.375, 0.375}, 1)
                    .up({-1, -0.8123}, {1, 0.1234}, 0));
  expect_ranges(traced.ranges(inner_limit(traced), -1, 0.1, 1,
                              [](const Vec3& p) { return lies_in(p, 0.25); }),
                {{-0.8123, 0.1234}});
}

TEST(SwathTracer, FindsNothingUnderARoofOrBehindTheSurface) {
  Traced roofed(s1_maker().up({-3, -3}, {3, 3}, 1.9));
  EXPECT_TRUE(inner_limit(roofed).empty());
  Traced turned(SceneMaker()
                    .square_light()
                    .up({-0.375, -0.375}, {0.375, 0.375}, 1)
                    .down({-2, -2}, {2, 2}, 0));
  EXPECT_TRUE(inner_limit(turned).empty()) << "the only floor looks down";
}

TEST(SwathTracer, ChangesSurfaceWhereTheFloorMeetsAWall) {
  // A wall in y = −.6 that looks along +y: below it the lines end at a height of
  // z = 2 − 2 · 1.1/(.5 − Y) for the Y they would have on the floor, −1.25 at most: .7429.
  Traced traced(s1_maker().polygon({{-2, -0.6, 0}, {-2, -0.6, 1.5}, {2, -0.6, 1.5}, {2, -0.6, 0}}));
  const auto curves = inner_limit(traced);
  std::vector<DiscontinuityCurve> on_floor, on_wall;
  for (const DiscontinuityCurve& curve : curves) {
    const PlaneFrame& frame = traced.scene.surfaces[static_cast<std::size_t>(curve.receiver)].frame;
    (std::abs(frame.normal.z()) > 0.5 ? on_floor : on_wall).push_back(curve);
  }
  expect_ranges(traced.ranges(on_floor, -1, 0.1, 1, [](const Vec3& p) { return lies_in(p, 0.25); }),
                {{-0.6, 0.25}});
  expect_ranges(traced.ranges(on_wall, -1, 2, 2,
                              [](const Vec3& p) {
                                return std::abs(p.y() + 0.6) < 1e-9 &&
                                       std::abs(p.x() - 0.25 - 0.125 * p.z()) < 1e-9;
                              }),
                {{0, 2 - 2.2 / 1.75}});
}

TEST(SwathTracer, FollowsALineOfSecondOrder) {
  Traced traced(test::one_triangle());
  const int edge = traced.edge_between({.9, .2, 1}, {.2, .7, 1});
  const auto curves = traced.edge_and_point(edge, {-0.5, -0.5, 2});
  // Lines from the corner through (x, y, 1) end in (2x + .5, 2y + .5): from (2.3, .9) to (.9, 1.9).
  const Vec2 from(2.3, 0.9), to(0.9, 1.9), along = (to - from).normalized();
  expect_ranges(traced.ranges(curves, -1, 0.1, 0,
                              [&](const Vec3& p) {
                                const Vec2 off = Vec2(p.x(), p.y()) - from;
                                return std::abs(cross_2d(off, along)) < 1e-9;
                              }),
                {{0.9, 2.3}});
  for (const DiscontinuityCurve& curve : curves) {
    EXPECT_EQ(curve.order, 2) << "no side of the light is parallel to the edge";
    ASSERT_EQ(curve.triples.size(), 1u);
  }
}

TEST(SwathTracer, CurvesOfThreeEdgesLieOnTheirCriticalConic) {
  Traced traced(test::three_skew_slats());
  const auto count = static_cast<int>(traced.emitter_scene.edges.size());
  int found = 0;
  for (int a = 0; a < count; ++a)
    for (int b = a + 1; b < count; ++b)
      for (int c = b + 1; c < count; ++c) {
        std::vector<DiscontinuityCurve> curves;
        bool is_planar = false;
        triple_swath(traced.emitter_scene, a, b, c, [&](const Swath& swath) {
          is_planar = is_planar || swath.is_planar;
          traced.tracer.trace(swath, curves);
        });
        if (is_planar) continue;
        std::array<Line3, 3> lines;
        for (std::size_t k = 0; k < 3; ++k) {
          const auto e = static_cast<std::size_t>(std::array{a, b, c}[k]);
          lines[k] = {traced.emitter_scene.edges[e].whole.from,
                      traced.emitter_scene.edges[e].whole.direction()};
        }
        for (const DiscontinuityCurve& curve : curves) {
          const PlaneFrame& plane =
              traced.scene.surfaces[static_cast<std::size_t>(curve.receiver)].frame;
          const test::Conic conic = test::critical_conic(lines, plane);
          for (const double s : {0., 0.2, 0.5, 0.9, 1.}) {
            const Vec2 p = point_at(curve.arc, s);
            EXPECT_NEAR(value(conic, p) / (1e-3 + gradient(conic, p).norm()), 0, 1e-7);
          }
          EXPECT_EQ(curve.order, 2);
          EXPECT_EQ(curve.triples.size(), 1u);
          ++found;
        }
      }
  EXPECT_GT(found, 0);
}

TEST(SwathTracer, KeepsOnlyLinesAcrossWhichWhatIsSeenDiffers) {
  // A sheet hangs from the light along y = 0 and reaches beyond its border x = .5. Lines from
  // (x, 0, 2) through the vertex end in (1.2 − x, .2, 0); those from outside the light are nothing.
  Traced traced(SceneMaker()
                    .square_light()
                    .floor()
                    .polygon({{0.2, 0, 2}, {1.2, 0, 2}, {0.7, 0, 1.7}}, test::two_sided_grey)
                    .polygon({{0.6, 0.1, 1}, {1.4, 0.5, 1}, {1.3, 0.9, 1}}));
  std::vector<DiscontinuityCurve> curves;
  for (std::size_t v = 0; v < traced.emitter_scene.vertices.size(); ++v)
    if ((traced.emitter_scene.vertices[v].position - Vec3(0.6, 0.1, 1)).norm() < 1e-9)
      vertex_swaths(traced.emitter_scene, static_cast<int>(v), [&](const Swath& swath) {
        if (swath.base.from.y() == 0 && swath.base.to.y() == 0) traced.tracer.trace(swath, curves);
      });
  expect_ranges(
      traced.ranges(curves, -1, 0.1, 0, [](const Vec3& p) { return std::abs(p.y() - 0.2) < 1e-9; }),
      {{0.7, 1}});
}

TEST(SwathTracer, CountsWhatItDoes) {
  Traced traced(s1_maker());
  EXPECT_EQ(traced.tracer.counts().swaths, 0u);
  inner_limit(traced);
  EXPECT_EQ(traced.tracer.counts().swaths, 1u);
  EXPECT_GE(traced.tracer.counts().pieces, 1u);
}

TEST(SwathTracer, GivesTheSameCurvesAgain) {
  Traced traced(test::one_triangle()), other(test::one_triangle());
  const int edge = traced.edge_between({.9, .2, 1}, {.2, .7, 1});
  std::vector<DiscontinuityCurve> rest;
  for (std::size_t e = 0; e < other.emitter_scene.edges.size();
       ++e)  // what it did before does not matter
    edge_swaths(other.emitter_scene, static_cast<int>(e),
                [&](const Swath& swath) { other.tracer.trace(swath, rest); });
  for (const Vec3& apex : {Vec3(-0.5, -0.5, 2), Vec3(0.5, 0.5, 2)}) {
    const auto a = traced.edge_and_point(edge, apex), b = other.edge_and_point(edge, apex);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k) {
      EXPECT_EQ(a[k].receiver, b[k].receiver);
      EXPECT_EQ(a[k].arc.from, b[k].arc.from);
      EXPECT_EQ(a[k].arc.to, b[k].arc.to);
      EXPECT_EQ(a[k].triples, b[k].triples);
    }
  }
}

/// On the floor of s1, along a line from the light's corner past one of the table's.
double step_on_floor(const SceneMaker& maker, const Vec3& at = Vec3::Zero()) {
  const test::LitScene lit(maker);
  const Vec3 start = at + Vec3(-0.5, -0.5, 2), last = at + Vec3(0.375, 0.375, 1);
  return side_step(lit.scene.surfaces.back(), lit.emitter_scene,
                   {start, last, (last - start).normalized()}, last + (last - start));
}

TEST(SideStep, IsFarAboveRoundingAndFarBelowWhatLightDraws) {
  const double here = step_on_floor(s1_maker());
  EXPECT_GT(here, 1e3 * 0x1p-52 * 2) << "well above the rounding of coordinates";
  EXPECT_LT(here, 1e-7 * std::sqrt(2.)) << "far below the width of the penumbra";
  const Vec3 far(1e6, 0, 0);
  const double away = step_on_floor(s1_maker().move(far), far);
  EXPECT_GT(away, 1e3 * 0x1p-52 * 1e6) << "well above the rounding of coordinates there";
  EXPECT_GE(away, here);
}

TEST(SideStep, DoesNotGrowWithWhatIsElsewhere) {
  SceneMaker maker;
  maker.polygon({{1e9, 0, 0}, {1e9, 1e6, 0}, {1e9, 0, 1e6}});
  const Scene s1 = s1_maker().scene;
  for (int f = 0; f < static_cast<int>(s1.faces.size()); ++f)
    maker.polygon(face_corners(s1, f), s1.faces[at(f)].material);
  EXPECT_EQ(step_on_floor(s1_maker()), step_on_floor(maker));
}

}  // namespace
}  // namespace halfshade
