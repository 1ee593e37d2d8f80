#include "meshing/rays/scale_clusters.h"

#include "meshing/rays/visibility.h"
#include "tests/support/soups.h"

#include <algorithm>
#include <cmath>
#include <gmock/gmock.h>
#include <set>

namespace halfshade {
namespace {

using test::Random;
using testing::ElementsAre;
using testing::SizeIs;

void add(TriangleSoup& soup, const TriangleSoup& other, double scale, const Vec3& shift) {
  for (std::size_t t = 0; t < other.triangles.size(); ++t) {
    const auto c = test::corners(other, t);
    test::add_triangle(soup, scale * c[0] + shift, scale * c[1] + shift, scale * c[2] + shift);
  }
}

/// Random triangles about so far apart as they are large, and others a thousand of their sizes and
/// more away or larger.
TriangleSoup nested(double far) {
  Random random(5);
  const TriangleSoup part = test::random_soup(60, 0.3, random);
  TriangleSoup soup = part;
  test::add_triangle(soup, far * Vec3(3, 1, 2), far * Vec3(4, 1, 2), far * Vec3(3, 2, 1));
  // A plain under them, that reaches as far.
  test::add_triangle(soup, far * Vec3(-1, -1, 0) - Vec3(0, 0, 1),
                     far * Vec3(2, -1, 0) - Vec3(0, 0, 1), far * Vec3(-1, 2, 0) - Vec3(0, 0, 1));
  add(soup, part, 1, far * Vec3(-0.7, 0.6, 0.5));
  add(soup, part, 1e-7, Vec3(0.5, 0.5, 1.6));
  return soup;
}

TEST(ScaleClusters, OrdinaryScenesAreOne) {
  Random random(1);
  EXPECT_THAT(scale_clusters(test::random_soup(500, 0.2, random)), ElementsAre(SizeIs(500)));
  EXPECT_THAT(scale_clusters(test::random_soup(500, 0.002, random)), ElementsAre(SizeIs(500)));
  EXPECT_THAT(scale_clusters(test::sphere(12, 24)), SizeIs(1));
  EXPECT_TRUE(scale_clusters(TriangleSoup{}).empty());
}

TEST(ScaleClusters, SmallOnesThatStayTogetherAreSetApart) {
  const TriangleSoup soup = nested(1e7);
  const auto clusters = scale_clusters(soup);
  std::multiset<std::size_t> sizes;
  std::vector<int> seen(soup.triangles.size(), 0);
  for (const auto& cluster : clusters) {
    sizes.insert(cluster.size());
    EXPECT_TRUE(std::is_sorted(cluster.begin(), cluster.end()));
    for (const int t : cluster) ++seen[at(t)];
  }
  // The two large ones; those here, those far away, the tiny ones.
  EXPECT_THAT(sizes, ElementsAre(2, 60, 60, 60));
  EXPECT_THAT(seen, testing::Each(1));
}

TEST(ScaleClusters, DustIsNotHeldInMoreThanSixtyFour) {
  Random random(3);
  TriangleSoup soup = test::random_soup(20, 0.5, random);
  for (int k = 0; k < 1000; ++k) {
    const Vec3 p = random.point(0, 1);
    test::add_triangle(soup, p, p + random.point(0, 1e-9), p + random.point(0, 1e-9));
  }
  std::size_t held = 0;
  for (const auto& cluster : scale_clusters(soup)) held += cluster.size();
  EXPECT_EQ(held, soup.triangles.size());
  EXPECT_THAT(scale_clusters(soup), SizeIs(64));
}

TEST(ScaleClusters, PacketsGoPastNoneThatOneOfTheirRaysMeets) {
  Random random(4);
  TriangleSoup soup = test::random_soup(20, 0.5, random);
  std::vector<Vec3> places;
  for (int k = 0; k < 40; ++k) {
    places.push_back(random.point(0, 1));
    add(soup, test::random_soup(20, 0.5, random), 1e-5, places.back());
  }
  ASSERT_GT(scale_clusters(soup).size(), 30u);
  const VisibilityIndex index(soup);
  std::vector<Segment> segments;
  std::vector<HalfLine> rays;
  for (int k = 0; k < 3000; ++k) {
    const Vec3 from = random.point(-0.5, 1.5);
    const Vec3 aim = k % 2 == 0 ? Vec3(places[at(k) % places.size()] + random.point(0, 1e-5))
                                : random.point(0, 1);
    segments.push_back({from, from + random(0.5, 1.5) * (aim - from)});
    rays.push_back({from, (aim - from).normalized()});
  }
  std::vector<std::uint8_t> blocked(segments.size());
  index.blocked(segments, blocked);
  std::vector<Hit> hits(rays.size());
  index.first_hits(rays, Sides::both, hits);
  int small = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    EXPECT_EQ(blocked[k] != 0, index.blocked(segments[k]));
    const auto hit = index.first_hit(rays[k].origin, rays[k].direction);
    ASSERT_EQ(hits[k].triangle, hit ? hit->triangle : -1);
    small += hit && hit->triangle >= 20;
  }
  EXPECT_GT(small, 200);
}

/// The nearest triangle ahead, by brute force in extended precision; −1 if a border is near.
int nearest(const TriangleSoup& soup, const Vec3& from, const Vec3& to, bool& clear) {
  int found = -1;
  double least = HUGE_VAL;
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    const auto c = test::corners(soup, t);
    const double margin = test::clearance(from, to, c);
    if (std::abs(margin) < 1e-5) clear = false;
    if (margin < 0) continue;
    const Vec3 normal = (c[1] - c[0]).cross(c[2] - c[0]);
    const double distance = normal.dot(c[0] - from) / normal.dot(to - from);
    if (distance < least) found = static_cast<int>(t);
    least = std::min(least, distance);
  }
  return found;
}

TEST(ScaleClusters, RaysAmongSmallTrianglesLoseNothingToFarAndLargeOnes) {
  for (const double far : {1e4, 1e6, 1e8}) {
    const TriangleSoup soup = nested(far);
    const VisibilityIndex index(soup);
    Random random(9);
    std::vector<Segment> segments;
    for (int k = 0; k < 600; ++k) {
      const Vec3 from = random.point(-0.2, 1.2), to = random.point(-0.2, 1.2);
      segments.push_back({from, from + 1.7 * (to - from)});
      // Among the tiny ones.
      const Vec3 middle(0.5, 0.5, 1.6);
      segments.push_back({middle + 1e-7 * from, middle + 1e-7 * (from + 1.7 * (to - from))});
    }
    std::vector<std::uint8_t> blocked(segments.size());
    index.blocked(segments, blocked);
    int compared = 0, met = 0;
    for (std::size_t k = 0; k < segments.size(); ++k) {
      const Segment& s = segments[k];
      bool clear = true;
      const int expected = nearest(soup, s.from, s.to, clear);
      if (!clear) continue;
      ++compared;
      met += expected >= 0 ? 1 : 0;
      EXPECT_EQ(blocked[k] != 0, expected >= 0) << "segment " << k << ", far " << far;
      EXPECT_EQ(index.blocked(s), expected >= 0) << "segment " << k << ", far " << far;
      const auto hit = index.first_hit(s.from, s.to - s.from);
      if (expected >= 0) {
        ASSERT_TRUE(hit) << "segment " << k << ", far " << far;
        EXPECT_EQ(hit->triangle, expected) << "segment " << k << ", far " << far;
        Hit together;
        const HalfLine ray{s.from, (s.to - s.from).normalized()};
        index.first_hits({&ray, 1}, Sides::both, {&together, 1});
        EXPECT_EQ(together.triangle, expected) << "segment " << k << ", far " << far;
      }
    }
    EXPECT_GT(compared, 1000);
    EXPECT_GT(met, 300);
    EXPECT_LT(met, compared - 100);
  }
}

}  // namespace
}  // namespace halfshade
