#include "meshing/discontinuity/merge_curves.h"

#include "tests/support/sound_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <tuple>
#include <vector>

namespace halfshade {
namespace {

using test::Random;

constexpr double tolerance = 1e-9;

EdgeTriple edge_triple(int a, int b, int c, int sign) {
  return {{EdgeId::edge(a), EdgeId::edge(b), EdgeId::edge(c)}, sign};
}

/// A curve that is known by a number: its source is vertex `id`, its triple the edges id to id + 2.
DiscontinuityCurve curve(int id, const ConicArc& arc, int order = 2, int sign = 1) {
  DiscontinuityCurve result;
  result.receiver = 3;
  result.emitter = 1;
  result.order = order;
  result.kind = arc.is_straight ? CurveKind::ev : CurveKind::eee;
  result.arc = arc;
  result.jump = {1, 2, 3};
  result.triples = {edge_triple(id + 2, id, id + 1, sign)};
  CurveSource source;
  source.kind = result.kind;
  source.features[0] = {Feature::Kind::vertex, id};
  source.feature_count = 1;
  result.sources = {source};
  return result;
}

DiscontinuityCurve segment(int id, const Vec2& from, const Vec2& to, int order = 2) {
  return curve(id, straight_arc(from, to), order);
}

ConicArc circle_arc(double start, double turn) {
  const auto at = [](double a) { return Vec2(2 + std::cos(a), 1 + std::sin(a)); };
  const auto along = [&](double a) {
    return Vec2((turn < 0 ? -1 : 1) * Vec2(-std::sin(a), std::cos(a)));
  };
  return *conic_arc(at(start), along(start), at(start + 0.4 * turn), at(start + turn),
                    along(start + turn), 1e-12);
}

std::set<int> ids(const DiscontinuityCurve& c) {
  std::set<int> result;
  for (const CurveSource& source : c.sources) result.insert(source.features[0].id);
  return result;
}

bool covers(const DiscontinuityCurve& c, const Vec2& p) {
  return distance(c.arc, p) < 3 * tolerance;
}

/// Ids with the sign of their triple for the direction `along`.
using Cover = std::map<int, int>;

Cover cover_at(const std::vector<DiscontinuityCurve>& curves, const Vec2& p, const Vec2& along,
               int* count = nullptr) {
  Cover cover;
  for (const DiscontinuityCurve& c : curves) {
    const Vec2 t = tangent_at(c.arc, nearest_parameter(c.arc, p));
    if (!covers(c, p) || std::abs(t.dot(along)) < 1 - 1e-6) continue;
    if (count) ++*count;
    for (const EdgeTriple& triple : c.triples)
      cover[std::min_element(triple.edges.begin(), triple.edges.end())->id] =
          triple.sign * (t.dot(along) > 0 ? 1 : -1);
  }
  return cover;
}

/// Merges and compares with what covers random points of the curves.
std::vector<DiscontinuityCurve> merge_and_compare(const std::vector<DiscontinuityCurve>& before,
                                                  Random& random, int points_each) {
  std::vector<DiscontinuityCurve> after = before;
  merge_coincident(after, tolerance);
  for (const DiscontinuityCurve& c : before)
    for (int k = 0; k < points_each; ++k) {
      const double s = random(0, 1);
      const Vec2 p = point_at(c.arc, s), along = tangent_at(c.arc, s);
      int count = 0;
      EXPECT_EQ(cover_at(before, p, along), cover_at(after, p, along, &count));
      EXPECT_EQ(count, 1) << p.transpose();
    }
  return after;
}

double total_length(const std::vector<DiscontinuityCurve>& curves) {
  double sum = 0;
  for (const DiscontinuityCurve& c : curves) sum += length(c.arc);
  return sum;
}

std::string as_text(const std::vector<DiscontinuityCurve>& curves) {
  std::string text;
  for (const DiscontinuityCurve& c : curves) {
    for (const double x : {c.arc.from.x(), c.arc.from.y(), c.arc.to.x(), c.arc.to.y(),
                           c.arc.control.x(), c.arc.weight, c.jump[0]})
      text.append(reinterpret_cast<const char*>(&x), sizeof x);
    for (const int id : ids(c)) text += std::to_string(id) + " ";
  }
  return text;
}

TEST(MergeCurves, LeavesCurvesThatShareNothingBitByBit) {
  // Crossing, touching end to end, parallel, collinear with a gap; other surfaces and emitters.
  std::vector<DiscontinuityCurve> curves = {segment(0, {0, 0}, {1, 0.1}),
                                            segment(1, {1, 0.1}, {2, 0.2}),
                                            segment(2, {3, 0.3}, {4, 0.4}),
                                            segment(3, {0, 0.3}, {1, -.2}),
                                            segment(4, {0, 1e-6}, {1, 0.1 + 1e-6}),
                                            curve(5, circle_arc(0, 1)),
                                            curve(6, circle_arc(1, 1)),
                                            curve(7, circle_arc(2.5, 1)),
                                            segment(8, {0, 0}, {1, 0.1}),
                                            segment(9, {0, 0}, {1, 0.1})};
  curves[8].receiver = 4;
  curves[9].emitter = 0;
  const std::string before = as_text(curves);
  EXPECT_EQ(merge_coincident(curves, tolerance), 0u);
  EXPECT_EQ(as_text(curves), before);
}

TEST(MergeCurves, TwoThatOverlapBecomeThree) {
  std::vector<DiscontinuityCurve> curves = {segment(0, {0, 0}, {2, 2}, 2),
                                            segment(9, {3, 3}, {1, 1}, 1)};
  curves[1].kind = CurveKind::face;
  EXPECT_EQ(merge_coincident(curves, tolerance), 1u);
  ASSERT_EQ(curves.size(), 3u);
  EXPECT_EQ(curves[0].arc.from, Vec2(0, 0));
  EXPECT_EQ(curves[0].arc.to, Vec2(1, 1));
  EXPECT_EQ(curves[1].arc.to, Vec2(2, 2));
  EXPECT_EQ(curves[2].arc.to, Vec2(3, 3));
  EXPECT_EQ(ids(curves[0]), (std::set<int>{0}));
  EXPECT_EQ(ids(curves[1]), (std::set<int>{0, 9}));
  EXPECT_EQ(ids(curves[2]), (std::set<int>{9}));
  EXPECT_EQ(curves[0].order, 2);
  EXPECT_EQ(curves[1].order, 1);
  EXPECT_EQ(curves[0].kind, CurveKind::ev);
  EXPECT_EQ(curves[1].kind, CurveKind::face);
  // The second one ran the other way: what was on its left is on its right now.
  ASSERT_EQ(curves[1].triples.size(), 2u);
  EXPECT_EQ(curves[1].triples[0], edge_triple(0, 1, 2, 1));
  EXPECT_EQ(curves[1].triples[1], edge_triple(9, 10, 11, -1));
  EXPECT_EQ(curves[1].jump, (std::array<double, 3>{0, 0, 0}));
}

TEST(MergeCurves, EqualTriplesCountOnceAndOppositeOnesTwice) {
  const auto merged = [](int sign, bool reversed) {
    std::vector<DiscontinuityCurve> curves = {segment(0, {0, 0}, {1, 0}),
                                              segment(7, {0, 0}, {1, 0})};
    if (reversed) curves[1].arc = straight_arc({1, 0}, {0, 0});
    curves[1].triples = {edge_triple(0, 1, 2, sign)};
    merge_coincident(curves, tolerance);
    EXPECT_EQ(curves.size(), 1u);
    EXPECT_EQ(curves[0].sources.size(), 2u);
    return curves[0].triples.size();
  };
  EXPECT_EQ(merged(1, false), 1u);
  EXPECT_EQ(merged(-1, false), 2u);
  EXPECT_EQ(merged(1, true), 2u);
  EXPECT_EQ(merged(-1, true), 1u);
}

TEST(MergeCurves, PiecesOfTheSameProvenanceAreJoinedAgain) {
  // The same source found in three overlapping pieces, as neighbouring generators do.
  std::vector<DiscontinuityCurve> curves = {segment(4, {0, 0}, {2, 0}), segment(4, {1, 0}, {3, 0}),
                                            segment(4, {2.5, 0}, {2.7, 0})};
  EXPECT_EQ(merge_coincident(curves, tolerance), 2u);
  ASSERT_EQ(curves.size(), 1u);
  EXPECT_EQ(curves[0].arc.from, Vec2(0, 0));
  EXPECT_EQ(curves[0].arc.to, Vec2(3, 0));
  EXPECT_EQ(curves[0].sources.size(), 1u);
  EXPECT_EQ(curves[0].triples.size(), 1u);
}

TEST(MergeCurves, SightPlaneIsTheOneOfTheLowestOrderOrNone) {
  const auto merged = [](int order_b, const Vec3& plane_b) {
    std::vector<DiscontinuityCurve> curves = {segment(0, {0, 0}, {1, 0}, 1),
                                              segment(1, {1, 0}, {0, 0}, order_b)};
    curves[0].sight_plane = Vec3::UnitX();
    curves[1].sight_plane = plane_b;
    merge_coincident(curves, tolerance);
    EXPECT_EQ(curves.size(), 1u);
    return curves[0].sight_plane;
  };
  EXPECT_EQ(merged(1, -Vec3::UnitX()), Vec3::UnitX());
  EXPECT_EQ(merged(1, Vec3::UnitY()), Vec3::Zero());
  EXPECT_EQ(merged(2, Vec3::UnitY()), Vec3::UnitX());
  EXPECT_EQ(merged(0, Vec3::UnitY()), Vec3::UnitY());
}

TEST(MergeCurves, AxisAlignedBundlesByTheHundred) {
  // Twenty grid lines each way, each with a hundred curves that end at multiples of 1/8.
  Random random(1);
  std::vector<DiscontinuityCurve> curves;
  for (int line = 0; line < 40; ++line)
    for (int k = 0; k < 100; ++k) {
      const double a = std::floor(random(0, 80)) / 8, b = std::floor(random(0, 80)) / 8;
      if (a == b) continue;
      const double at = line / 2 * 0.25;
      const int id = static_cast<int>(curves.size());
      curves.push_back(line % 2 ? segment(3 * id, {a, at}, {b, at})
                                : segment(3 * id, {at, a}, {at, b}));
    }
  std::vector<DiscontinuityCurve> merged = curves;
  merge_coincident(merged, tolerance);
  EXPECT_LE(merged.size(), 40u * 79);
  EXPECT_LE(total_length(merged), 40 * 79. / 8);
  for (const DiscontinuityCurve& c : merged) {  // exactly on the grid still
    EXPECT_TRUE(c.arc.from.x() == c.arc.to.x() || c.arc.from.y() == c.arc.to.y());
    EXPECT_EQ(std::floor(8 * c.arc.from.sum()), 8 * c.arc.from.sum());
    // All that covered its middle, by their ids.
    const Vec2 p = point_at(c.arc, 0.5), along = tangent_at(c.arc, 0.5);
    std::set<int> expected;
    for (const auto& [id, sign] : cover_at(curves, p, along)) expected.insert(id);
    EXPECT_EQ(ids(c), expected);
  }
}

TEST(MergeCurves, RandomOverlapsInAnyDirectionAreThoseOfBruteForce) {
  Random random(2);
  for (int round = 0; round < 30; ++round) {
    std::vector<DiscontinuityCurve> curves;
    for (int line = 0; line < 12; ++line) {
      // Some through one point, some of them almost axis-aligned, or on the diagonal.
      const double angle = line < 4   ? random(0, 3.2)
                           : line < 8 ? line * std::numbers::pi / 4 + random(-1, 1) * 1e-12
                                      : line * std::numbers::pi / 4;
      const Vec2 along(std::cos(angle), std::sin(angle));
      const Vec2 origin = line % 2 ? Vec2(1, 2) : Vec2(random(0, 3), random(0, 3));
      for (int k = 0; k < 8; ++k) {
        const auto noise = [&]() -> Vec2 {
          return Vec2(random(-1, 1), random(-1, 1)) * 1e-3 * tolerance;
        };
        const double a = random(-5, 5), b = a + random(-2, 2);
        curves.push_back(segment(3 * static_cast<int>(curves.size()), origin + a * along + noise(),
                                 origin + b * along + noise()));
      }
    }
    std::shuffle(curves.begin(), curves.end(), std::mt19937(7));
    merge_and_compare(curves, random, 4);
  }
}

TEST(MergeCurves, ShortCurvesOnLongLinesAreFound) {
  // A segment a million times shorter than the line it lies on, at any angle.
  Random random(3);
  for (int round = 0; round < 300; ++round) {
    const double angle = random(0, 7);
    const Vec2 along(std::cos(angle), std::sin(angle));
    const Vec2 p = random(-900, 900) * along;
    std::vector<DiscontinuityCurve> curves = {segment(0, p, p + 1e-3 * along),
                                              segment(3, -1000 * along, 1000 * along)};
    EXPECT_EQ(merge_coincident(curves, tolerance), 1u);
    EXPECT_EQ(curves.size(), 3u);
  }
}

TEST(MergeCurves, LinesJustApartStayApart) {
  Random random(4);
  for (int round = 0; round < 300; ++round) {
    const double angle = random(0, 7);
    const Vec2 along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
    const double off = random(-3, 3) * tolerance;
    std::vector<DiscontinuityCurve> curves = {segment(0, -3 * along, 5 * along),
                                              segment(3, off * across, off * across + along)};
    if (std::abs(std::abs(off) - tolerance) < 1e-3 * tolerance) continue;
    EXPECT_EQ(merge_coincident(curves, tolerance), std::abs(off) < tolerance ? 1u : 0u) << off;
  }
}

TEST(MergeCurves, DoesNotDependOnTheOrderOfCurves) {
  Random random(5);
  std::vector<DiscontinuityCurve> curves;
  for (int k = 0; k < 60; ++k) {
    const double a = std::floor(random(0, 16)), b = a + 1 + std::floor(random(0, 5));
    const double y = std::floor(random(0, 3));
    curves.push_back(segment(3 * k, {a, y}, {b, y}));
  }
  const auto contents = [](std::vector<DiscontinuityCurve> c) {
    merge_coincident(c, tolerance);
    std::set<std::tuple<double, double, double, std::set<int>>> all;
    for (const DiscontinuityCurve& x : c)
      all.emplace(x.arc.from.y(), x.arc.from.x(), x.arc.to.x(), ids(x));
    return all;
  };
  const auto expected = contents(curves);
  for (unsigned seed = 0; seed < 5; ++seed) {
    std::shuffle(curves.begin(), curves.end(), std::mt19937(seed));
    EXPECT_EQ(contents(curves), expected);
  }
}

TEST(MergeCurves, MergingTwiceChangesNothing) {
  Random random(6);
  std::vector<DiscontinuityCurve> curves;
  for (int k = 0; k < 40; ++k) {
    const double a = random(0, 10), b = a + random(0.1, 3);
    curves.push_back(segment(3 * k, {a, a / 3}, {b, b / 3}));
    curves.push_back(curve(200 + 3 * k, circle_arc(random(0, 6), random(0.3, 2))));
  }
  merge_coincident(curves, tolerance);
  const std::string once = as_text(curves);
  EXPECT_EQ(merge_coincident(curves, tolerance), 0u);
  EXPECT_EQ(as_text(curves), once);
}

TEST(MergeCurves, TinyCurvesSurvive) {
  std::vector<DiscontinuityCurve> curves = {segment(0, {0, 0}, {1, 0}),
                                            segment(3, {0.5, 0}, {0.5 + 0.3 * tolerance, 0}),
                                            segment(6, {0.2, 0}, {0.2, 0})};
  EXPECT_EQ(merge_coincident(curves, tolerance), 0u);
  EXPECT_EQ(curves.size(), 3u);
  std::vector<DiscontinuityCurve> none;
  EXPECT_EQ(merge_coincident(none, tolerance), 0u);
}

TEST(MergeCurves, EqualArcsInEitherDirection) {
  std::vector<DiscontinuityCurve> curves = {curve(0, circle_arc(0.5, 1.5)),
                                            curve(3, circle_arc(2, -1.5)),
                                            curve(6, circle_arc(0.5, 1.5), 1)};
  EXPECT_EQ(merge_coincident(curves, tolerance), 2u);
  ASSERT_EQ(curves.size(), 1u);
  EXPECT_EQ(ids(curves[0]), (std::set<int>{0, 3, 6}));
  EXPECT_EQ(curves[0].order, 1);
  ASSERT_EQ(curves[0].triples.size(), 3u);
  EXPECT_EQ(curves[0].triples[0].sign, 1);
  EXPECT_EQ(curves[0].triples[1].sign, -1);
  EXPECT_EQ(curves[0].triples[2].sign, 1);
}

TEST(MergeCurves, OtherArcsBetweenTheSameEndsStay) {
  ConicArc flatter = circle_arc(0.5, 1.5);
  flatter.weight *= 0.99;
  std::vector<DiscontinuityCurve> curves = {curve(0, circle_arc(0.5, 1.5)), curve(3, flatter)};
  EXPECT_EQ(merge_coincident(curves, tolerance), 0u);
  EXPECT_EQ(curves.size(), 2u);
}

TEST(MergeCurves, ArcsOfOneConicAreCutAtEachOthersEnds) {
  Random random(8);
  for (int round = 0; round < 50; ++round) {
    std::vector<DiscontinuityCurve> curves;
    for (int k = 0; k < 6; ++k) {
      const double turn = random(0.2, 2) * (random(-1, 1) < 0 ? -1 : 1);
      curves.push_back(curve(3 * k, circle_arc(random(0, 6), turn)));
    }
    // Others that cross it, and one that touches it.
    curves.push_back(curve(50, {{2.5, 0.5}, {3.5, 1.5}, {2, 3}, 0.8, false}));
    curves.push_back(curve(60, {{3, 0.5}, {3, 1}, {3.5, 1.2}, 1, false}));
    const std::vector<DiscontinuityCurve> after = merge_and_compare(curves, random, 10);
    for (std::size_t k = 0; k < after.size(); ++k)
      for (std::size_t l = 0; l < k; ++l)
        for (const double s : {0.1, 0.5, 0.9})
          EXPECT_GT(distance(after[l].arc, point_at(after[k].arc, s)), tolerance) << k << " " << l;
  }
}

TEST(MergeCurves, ArcsOfTheSameProvenanceAreJoinedAgain) {
  std::vector<DiscontinuityCurve> curves = {curve(4, circle_arc(0, 2)),
                                            curve(4, circle_arc(0.5, 1))};
  EXPECT_EQ(merge_coincident(curves, tolerance), 1u);
  ASSERT_EQ(curves.size(), 1u);
  EXPECT_EQ(length(curves[0].arc), length(circle_arc(0, 2)));
}

}  // namespace
}  // namespace halfshade
