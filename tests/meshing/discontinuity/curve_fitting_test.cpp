#include "meshing/discontinuity/curve_fitting.h"

#include "tests/support/critical_conic.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace halfshade {
namespace {

const PlaneFrame ground = make_frame({0.3, -0.2, 0}, Vec3::UnitZ());
constexpr double flat = 1e-10;

TEST(FitArcs, OfAPlanarSwathIsOneStraightArc) {
  Swath swath;
  swath.apex = {0, 0, 2};
  swath.base = {{-1, 0.5, 1}, {1, 0.5, 1}};
  const std::vector<ConicArc> arcs = fit_arcs(swath, 0.25, 0.75, ground, flat);
  ASSERT_EQ(arcs.size(), 1u);
  EXPECT_TRUE(arcs[0].is_straight);
  EXPECT_LT((ground.to_space(arcs[0].from) - Vec3(-1, 1, 0)).norm(), 1e-14);
  EXPECT_LT((ground.to_space(arcs[0].to) - Vec3(1, 1, 0)).norm(), 1e-14);
}

TEST(FitArcs, OfThreeEdgesRunAlongTheirCriticalConicWithoutGaps) {
  const std::array<Span3, 3> edges = {Span3{{-1, 0.2, 1.6}, {1, -0.1, 1.7}},
                                      Span3{{-1, -1, 1}, {1, 1, 1.2}},
                                      Span3{{-1, 1, 0.5}, {1, -1, 0.4}}};
  Swath swath;
  set_edges(swath, edges);
  std::array<Line3, 3> lines;
  for (std::size_t k = 0; k < 3; ++k) lines[k] = {edges[k].from, edges[k].direction()};
  const test::Conic conic = test::critical_conic(lines, ground);
  const double t0 = 0.4, t1 = 0.6;
  const std::vector<ConicArc> arcs = fit_arcs(swath, t0, t1, ground, flat);
  ASSERT_FALSE(arcs.empty());
  EXPECT_FALSE(arcs[0].is_straight);
  const auto end = [&](double t) { return ground.to_plane(trace_at(swath, ground, t)->point); };
  EXPECT_LT((arcs.front().from - end(t0)).norm(), 1e-12);
  EXPECT_LT((arcs.back().to - end(t1)).norm(), 1e-12);
  for (std::size_t k = 1; k < arcs.size(); ++k) EXPECT_EQ(arcs[k - 1].to, arcs[k].from);
  for (const ConicArc& arc : arcs)
    for (const double s : {0., 0.1, 0.5, 0.8, 1.}) {
      const Vec2 p = point_at(arc, s);
      EXPECT_NEAR(value(conic, p) / gradient(conic, p).norm(), 0, 1e-9);
    }
}

}  // namespace
}  // namespace halfshade
