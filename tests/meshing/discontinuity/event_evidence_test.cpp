#include "meshing/discontinuity/event_evidence.h"

#include "meshing/core/planar.h"
#include "tests/support/sound_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

// Visible parts made by hand, on the plane z = 1 seen from the origin. Seen from there they lie on
// the left of their border, which therefore runs clockwise in x and y.

namespace halfshade {
namespace {

using test::Random;

const Vec3 eye = Vec3::Zero();

/// Negative numbers stand for the light's edges.
EdgeId id(int edge) { return edge < 0 ? EdgeId::emitter_edge(-1 - edge) : EdgeId::edge(edge); }

EdgeTriple triple(int a, int b, int c, int sign) { return {{id(a), id(b), id(c)}, sign}; }

/// What of the plane lies where normal·p ≤ offset, bounded by an edge.
struct Half {
  Vec2 normal;
  double offset;
  int edge;
};

/// A convex part with the edge that each side lies on.
struct Part {
  std::vector<Vec2> corners;  // counter-clockwise
  std::vector<int> edges;     // from corner k to the next
};

Part everything() { return {{{-5, -5}, {5, -5}, {5, 5}, {-5, 5}}, {-101, -102, -103, -104}}; }

Part clip(const Part& part, const Half& half) {
  Part kept;
  const std::size_t n = part.corners.size();
  for (std::size_t k = 0; k < n; ++k) {
    const Vec2 &a = part.corners[k], &b = part.corners[(k + 1) % n];
    const double u = half.offset - half.normal.dot(a), v = half.offset - half.normal.dot(b);
    if (u >= 0) {
      kept.corners.push_back(a);
      kept.edges.push_back(part.edges[k]);
    }
    if ((u < 0) == (v < 0)) continue;
    kept.corners.push_back(a + u / (u - v) * (b - a));
    kept.edges.push_back(u >= 0 ? half.edge : part.edges[k]);
  }
  return kept;
}

Part cut(const std::vector<Half>& halves) {
  Part part = everything();
  for (const Half& half : halves) part = clip(part, half);
  return part;
}

double area(const Part& part) {
  double twice = 0;
  for (std::size_t k = 0; k < part.corners.size(); ++k) {
    const Vec2 &a = part.corners[k], &b = part.corners[(k + 1) % part.corners.size()];
    twice += cross_2d(a, b);
  }
  return 0.5 * twice;
}

Vec3 on_plane(const Vec2& p) { return {p.x(), p.y(), 1}; }

/// Adds a part as a chain; a hole if counter-clockwise.
void add_chain(VisiblePart& out, const Part& part, bool is_hole = false) {
  const std::size_t n = part.corners.size();
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t k = is_hole ? i : n - 1 - i;
    const Vec3 a = on_plane(part.corners[k]), b = on_plane(part.corners[(k + 1) % n]);
    out.pieces.push_back({is_hole ? a : b, is_hole ? b : a, id(part.edges[k])});
  }
  out.chain_ends.push_back(static_cast<int>(out.pieces.size()));
}

VisiblePart visible(const Part& part) {
  VisiblePart out;
  if (!part.corners.empty()) add_chain(out, part);
  return out;
}

EventEvidence compare(const VisiblePart& left, const VisiblePart& right,
                      const std::vector<int>& group) {
  std::vector<EdgeId> edges;
  for (const int edge : group) edges.push_back(id(edge));
  std::sort(edges.begin(), edges.end());
  return compare_sides({eye, left}, {eye, right}, edges);
}

const Half below = {Vec2(0, 1), 1, -1}, beside = {Vec2(1, 0), 1, -2};

TEST(EventEvidence, OfTwoEqualSidesIsNone) {
  const VisiblePart part = visible(cut({below, beside}));
  const EventEvidence evidence = compare(part, part, {-1, -2});
  EXPECT_FALSE(evidence.differs);
  EXPECT_TRUE(evidence.triples.empty());
}

TEST(EventEvidence, ACornerThatIsCutOffIsATriangleThatIsHidden) {
  const VisiblePart whole = visible(cut({below, beside}));
  const VisiblePart less = visible(cut({below, beside, {Vec2(1, 1), 1.99, 7}}));
  const EdgeTriple on_left = triple(-2, -1, 7, -1), on_right = triple(-2, -1, 7, 1);
  const EventEvidence left = compare(less, whole, {-1, -2, 7});
  EXPECT_TRUE(left.differs);
  EXPECT_EQ(left.triples, std::vector{on_left});
  EXPECT_EQ(compare(whole, less, {-1, -2, 7}).triples, std::vector{on_right});
}

TEST(EventEvidence, ATriangleOfLightThatAppearsIsVisible) {
  const Half last = {Vec2(-1, -1), -1.99, 7};
  const VisiblePart triangle = visible(cut({below, beside, last})), nothing;
  const EdgeTriple on_left = triple(-2, -1, 7, 1), on_right = triple(-2, -1, 7, -1);
  EXPECT_EQ(compare(triangle, nothing, {-1, -2, 7}).triples, std::vector{on_left});
  EXPECT_EQ(compare(nothing, triangle, {-1, -2, 7}).triples, std::vector{on_right});
}

TEST(EventEvidence, AnOccludersCornerOverTheBorderHidesATriangle) {
  const Part whole = cut({below, beside});
  // The side y = 1 runs from (1, 1) to (−5, 1); a notch goes down to (0, .99).
  Part notched = whole;
  const auto side = static_cast<std::size_t>(std::find(whole.edges.begin(), whole.edges.end(), -1) -
                                             whole.edges.begin());
  const auto after = static_cast<std::ptrdiff_t>(side) + 1;
  notched.corners.insert(notched.corners.begin() + after, {{0.01, 1}, {0, 0.99}, {-0.01, 1}});
  notched.edges.insert(notched.edges.begin() + after, {5, 6, -1});
  const EdgeTriple hidden = triple(-1, 5, 6, -1), back = triple(-1, 5, 6, 1);
  EXPECT_EQ(compare(visible(notched), visible(whole), {-1, 5, 6}).triples, std::vector{hidden});
  EXPECT_EQ(compare(visible(whole), visible(notched), {-1, 5, 6}).triples, std::vector{back});
}

TEST(EventEvidence, IgnoresEdgesThatAreNotInTheGroup) {
  const VisiblePart whole = visible(cut({below, beside}));
  const VisiblePart less = visible(cut({below, beside, {Vec2(1, 1), 1.99, 7}}));
  EXPECT_FALSE(compare(less, whole, {-1, -103, 8}).differs);
  EXPECT_FALSE(compare(less, whole, {}).differs);
}

TEST(EventEvidence, AnEdgeThatTakesOverFromAParallelOneDiffersWithoutTriangles) {
  const VisiblePart before = visible(cut({below, beside}));
  const VisiblePart after = visible(cut({below, {Vec2(1, 0), 0.99, 7}}));
  const EventEvidence evidence = compare(before, after, {-1, -2, 7});
  EXPECT_TRUE(evidence.differs);
  EXPECT_TRUE(evidence.triples.empty());
}

TEST(EventEvidence, OrderOfPiecesAndChainsDoesNotMatter) {
  const Part big = cut({below, beside, {Vec2(1, 1), 1.99, 7}});
  const Part small = cut({{Vec2(0, 1), -3, 20}, {Vec2(1, 0), -3, 21}, {Vec2(-1, -1), 7, 22}});
  const Part hole = {{{-1, -1}, {0, -1}, {-1, 0}}, {30, 31, 32}};
  VisiblePart part;
  add_chain(part, big);
  add_chain(part, small);
  add_chain(part, hole, true);
  const VisiblePart whole = visible(cut({below, beside}));
  const std::vector<int> group = {-1, -2, 7, 20, 21, 22, 31, 32};
  const EventEvidence expected = compare(part, whole, group);
  ASSERT_FALSE(expected.triples.empty());
  for (std::size_t turn = 0; turn < 5; ++turn) {
    const auto turned = [&](Part p) {
      const auto by = static_cast<std::ptrdiff_t>(turn % p.edges.size());
      std::rotate(p.corners.begin(), p.corners.begin() + by, p.corners.end());
      std::rotate(p.edges.begin(), p.edges.begin() + by, p.edges.end());
      return p;
    };
    VisiblePart other;
    add_chain(other, turned(hole), true);
    add_chain(other, turned(big));
    add_chain(other, turned(small));
    const EventEvidence evidence = compare(other, whole, group);
    EXPECT_EQ(evidence.differs, expected.differs);
    EXPECT_EQ(evidence.triples, expected.triples) << turn;
    EXPECT_FALSE(compare(other, part, group).differs) << turn;
  }
}

/// A line that runs through the corner (1, 1) at t = 0 and moves on.
struct Moving {
  Vec2 normal;
  double speed;
  int edge;
  Half at(double t) const { return {normal, normal.dot(Vec2(1, 1)) + speed * t, edge}; }
};

/// Area of the triangle between three lines.
double triangle_area(const Half& a, const Half& b, const Half& c) {
  const auto meet = [](const Half& u, const Half& v) {
    Eigen::Matrix2d m;
    m << u.normal.x(), u.normal.y(), v.normal.x(), v.normal.y();
    return Vec2(m.inverse() * Vec2(u.offset, v.offset));
  };
  const Vec2 p = meet(a, b), q = meet(b, c) - p, r = meet(c, a) - p;
  return 0.5 * std::abs(cross_2d(q, r));
}

TEST(EventEvidence, TriplesAddUpToTheJumpOfTheAreasSecondDerivative) {
  // All sides pass through one point at t = 0, so that the area is a constant minus c±·t².
  Random random(1);
  int several = 0;
  for (int round = 0; round < 1000; ++round) {
    std::vector<Moving> lines;
    const int count = random.integer(3, 5);
    std::vector<int> slot(static_cast<std::size_t>(count));  // none is parallel to another
    std::iota(slot.begin(), slot.end(), 0);
    for (std::size_t k = slot.size() - 1; k > 0; --k)
      std::swap(slot[k], slot[static_cast<std::size_t>(random.integer(0, static_cast<int>(k)))]);
    for (int k = 0; k < count; ++k) {
      const double angle =
          0.1 + (slot[static_cast<std::size_t>(k)] + random(0.1, 0.9)) * 1.8 / count;
      lines.push_back(
          {{std::cos(angle), std::sin(angle)}, k < 2 ? 0 : random(-1, 1), k < 2 ? -1 - k : 10 + k});
    }
    const double t = 1e-3;
    const auto part_at = [&](double time) {
      std::vector<Half> halves;
      for (const Moving& line : lines) halves.push_back(line.at(time));
      return cut(halves);
    };
    const Part left = part_at(t), right = part_at(-t);
    std::vector<int> group;
    for (const Moving& line : lines) group.push_back(line.edge);
    const EventEvidence evidence = compare(visible(left), visible(right), group);
    const auto line_of = [&](EdgeId edge, double time) {
      return std::find_if(lines.begin(), lines.end(),
                          [&](const Moving& l) { return id(l.edge) == edge; })
          ->at(time);
    };
    // At t = 0 the outermost lines make the corner; what they bound is smooth.
    const auto [first, last] = std::minmax_element(
        lines.begin(), lines.end(),
        [](const Moving& a, const Moving& b) { return a.normal.x() > b.normal.x(); });
    const std::array<Moving, 2> outer = {*first, *last};
    const auto smooth = [&](double time) {
      return area(cut({outer[0].at(time), outer[1].at(time)}));
    };
    const double jump = (area(left) - smooth(t)) - (area(right) - smooth(-t));
    double sum = 0;
    for (const EdgeTriple& triple : evidence.triples)
      sum += triple.sign * triangle_area(line_of(triple.edges[0], t), line_of(triple.edges[1], t),
                                         line_of(triple.edges[2], t));
    EXPECT_NEAR(sum, jump, 1e-12 + 1e-6 * std::abs(jump)) << round;
    EXPECT_TRUE(evidence.differs || std::abs(jump) < 1e-13) << round;
    EXPECT_EQ(evidence.differs, !evidence.triples.empty()) << round;
    several += evidence.triples.size() > 1;
  }
  EXPECT_GT(several, 50);
}

}  // namespace
}  // namespace halfshade
