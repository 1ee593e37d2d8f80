#include "tests/support/discontinuity_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

// Contact lines where polygons cut through each other.

namespace halfshade {
namespace {

using test::Random;
using test::SceneMaker;

using Segment3 = std::array<Vec3, 2>;

std::vector<Segment3> contacts_of(const SoundScene& scene, std::size_t surface) {
  std::vector<Segment3> segments;
  const Surface& r = scene.surfaces.at(surface);
  for (const Segment2& s : r.contacts)
    segments.push_back({r.frame.to_space(s[0]), r.frame.to_space(s[1])});
  return segments;
}

double total_length(const std::vector<Segment3>& segments) {
  double sum = 0;
  for (const Segment3& s : segments) sum += (s[1] - s[0]).norm();
  return sum;
}

std::size_t contact_count(const SoundScene& scene) {
  std::size_t count = 0;
  for (const Surface& surface : scene.surfaces) count += surface.contacts.size();
  return count;
}

/// The surface that an input face became.
std::size_t surface_of(const SoundScene& scene, int face) {
  for (std::size_t r = 0; r < scene.surfaces.size(); ++r) {
    const auto& faces = scene.surfaces[r].faces;
    if (std::find(faces.begin(), faces.end(), face) != faces.end()) return r;
  }
  return scene.surfaces.size();
}

/// A rectangle about the middle of a frame.
struct Rectangle {
  PlaneFrame frame;
  Vec2 half;

  std::vector<Vec3> corners() const {
    std::vector<Vec3> list;
    for (const auto& [x, y] : {std::pair(-1., -1.), {1., -1.}, {1., 1.}, {-1., 1.}})
      list.push_back(frame.to_space({x * half.x(), y * half.y()}));
    return list;
  }
  /// Where a line in its plane runs inside it, as a range of parameters.
  std::array<double, 2> range(const Vec3& point, const Vec3& along) const {
    const Vec2 p = frame.to_plane(point), u = frame.to_plane(point + along) - p;
    std::array<double, 2> range = {-HUGE_VAL, HUGE_VAL};
    for (int k = 0; k < 2; ++k) {
      const double a = (-half[k] - p[k]) / u[k], b = (half[k] - p[k]) / u[k];
      range = {std::max(range[0], std::min(a, b)), std::min(range[1], std::max(a, b))};
    }
    return range;
  }
};

Rectangle random_rectangle(Random& random) {
  return {make_frame(random.in_box({-0.4, -0.4, -0.4}, {0.4, 0.4, 0.4}), random.direction()),
          {random(0.2, 1), random(0.2, 1)}};
}

/// A point of two planes.
Vec3 common_point(const PlaneFrame& a, const PlaneFrame& b) {
  Eigen::Matrix3d rows;
  rows << a.normal.transpose(), b.normal.transpose(), a.normal.cross(b.normal).transpose();
  return rows.inverse() * Vec3(a.normal.dot(a.origin), b.normal.dot(b.origin), 0);
}

TEST(Intersections, TwoCrossingRectanglesGetOneContactLineEach) {
  SceneMaker maker;
  maker.up({-1, -1}, {1, 1}, 0.3)
      .polygon({{-0.5, 0.2, -1}, {0.7, 0.2, -1}, {0.7, 0.2, 1}, {-0.5, 0.2, 1}});
  const SoundScene scene = maker.sound();
  ASSERT_EQ(scene.surfaces.size(), 2u);
  for (const std::size_t r : {0u, 1u}) {
    const auto contacts = contacts_of(scene, r);
    ASSERT_EQ(contacts.size(), 1u);
    const auto [low, high] = std::minmax({contacts[0][0].x(), contacts[0][1].x()});
    EXPECT_NEAR(low, -0.5, 1e-9);
    EXPECT_NEAR(high, 0.7, 1e-9);
    for (const Vec3& p : contacts[0]) EXPECT_NEAR((p - Vec3(p.x(), 0.2, 0.3)).norm(), 0, 1e-9);
  }
}

TEST(Intersections, TiltedRectanglesCutEachOtherOverTheirCommonStretch) {
  Random random(1);
  int crossed = 0, apart = 0;
  for (int round = 0; round < 300; ++round) {
    const Rectangle a = random_rectangle(random), b = random_rectangle(random);
    const Vec3 along = a.frame.normal.cross(b.frame.normal);
    if (along.norm() < 0.05) continue;
    const Vec3 unit = along.normalized(), origin = common_point(a.frame, b.frame);
    const auto s = a.range(origin, unit), t = b.range(origin, unit);
    const double from = std::max(s[0], t[0]), to = std::min(s[1], t[1]);
    if (std::abs(to - from) < 1e-3) continue;
    const SoundScene scene = SceneMaker().polygon(a.corners()).polygon(b.corners()).sound();
    ASSERT_EQ(scene.surfaces.size(), 2u);
    for (const std::size_t r : {0u, 1u}) {
      const auto contacts = contacts_of(scene, r);
      ASSERT_EQ(contacts.size(), to > from ? 1u : 0u) << round;
      if (contacts.empty()) continue;
      EXPECT_NEAR(total_length(contacts), to - from, 1e-8) << round;
      const Vec3 middle = 0.5 * (contacts[0][0] + contacts[0][1]);
      EXPECT_NEAR((middle - origin - 0.5 * (from + to) * unit).norm(), 0, 1e-8) << round;
    }
    ++(to > from ? crossed : apart);
  }
  EXPECT_GT(crossed, 100);
  EXPECT_GT(apart, 20);
}

TEST(Intersections, AreNoneWhereOneOnlyTouchesTheOther) {
  // An edge on the floor is a contact line of the floor, but the sheet itself is not cut.
  const SoundScene standing =
      SceneMaker()
          .up({-1, -1}, {1, 1}, 0)
          .polygon({{-0.5, 0.2, 0}, {0.7, 0.2, 0}, {0.6, 0.4, 1}, {-0.4, 0.4, 1}})
          .sound();
  EXPECT_EQ(contact_count(standing), 1u);
  EXPECT_TRUE(contacts_of(standing, surface_of(standing, 1)).empty());
  EXPECT_NEAR(total_length(contacts_of(standing, surface_of(standing, 0))), 1.2, 1e-9);
  const SoundScene on_a_corner = SceneMaker()
                                     .up({-1, -1}, {1, 1}, 0)
                                     .polygon({{0.1, 0.2, 0}, {0.7, 0.2, 1}, {0, 0.4, 1}})
                                     .sound();
  EXPECT_EQ(contact_count(on_a_corner), 0u);
  const SoundScene common_edge = SceneMaker()
                                     .up({-1, -1}, {1, 1}, 0)
                                     .polygon({{1, -1, 0}, {1, 1, 0}, {1.3, 1, 1}, {1.3, -1, 1}})
                                     .sound();
  EXPECT_EQ(contact_count(common_edge), 0u);
}

TEST(Intersections, AreNoneBetweenPolygonsWhosePlanesCrossBesideThem) {
  const SoundScene scene = SceneMaker()
                               .up({-1, -1}, {1, 1}, 0)
                               .polygon({{1.2, -1, -1}, {1.2, 1, -1}, {1.2, 1, 1}, {1.2, -1, 1}})
                               .polygon({{-0.5, 0, 0.2}, {0.5, 0, 0.2}, {0.5, 0, 1}, {-0.5, 0, 1}})
                               .sound();
  EXPECT_EQ(contact_count(scene), 0u);
}

TEST(Intersections, ASheetThroughAHoleIsCutOnBothSidesOfIt) {
  SceneMaker maker;
  const std::array<Vec2, 4> outer = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  const std::array<Vec2, 4> inner = {{{-.3, -.4}, {.2, -.4}, {.2, .5}, {-.3, .5}}};
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t n = (k + 1) % 4;
    const auto at = [](const Vec2& p) { return Vec3(p.x(), p.y(), 0); };
    maker.polygon({at(outer[k]), at(outer[n]), at(inner[n]), at(inner[k])});
  }
  maker.polygon({{-0.8, 0.1, -1}, {1.4, 0.1, -1}, {1.4, 0.1, 1}, {-0.8, 0.1, 1}});
  const SoundScene scene = maker.sound();
  ASSERT_EQ(scene.surfaces.size(), 2u);
  for (const std::size_t r : {0u, 1u}) {
    const auto contacts = contacts_of(scene, r);
    ASSERT_EQ(contacts.size(), 2u);
    EXPECT_NEAR(total_length(contacts), 0.5 + 0.8, 1e-9);
    for (const Segment3& s : contacts) {
      const double middle = 0.5 * (s[0].x() + s[1].x());
      EXPECT_NEAR(middle, middle < 0 ? -0.55 : 0.6, 1e-9);
    }
  }
}

TEST(Intersections, ABoxThroughASheetLeavesItsOutlineThere) {
  const SoundScene scene =
      SceneMaker().up({-1, -1}, {1, 1}, 0).box({-0.3, -0.2, -0.5}, {0.4, 0.6, 0.5}).sound();
  ASSERT_EQ(scene.surfaces.size(), 7u);
  EXPECT_NEAR(total_length(contacts_of(scene, surface_of(scene, 0))), 2 * (0.7 + 0.8), 1e-8);
  double sides = 0;
  for (int face = 1; face < 7; ++face)
    sides += total_length(contacts_of(scene, surface_of(scene, face)));
  EXPECT_NEAR(sides, 2 * (0.7 + 0.8), 1e-8);
}

TEST(Intersections, DoNotDependOnTheOrderOfTheFaces) {
  Random random(2);
  for (int round = 0; round < 30; ++round) {
    std::vector<Rectangle> rectangles;
    for (int k = 0; k < 4; ++k) rectangles.push_back(random_rectangle(random));
    SceneMaker forwards, backwards;
    for (std::size_t k = 0; k < 4; ++k) {
      forwards.polygon(rectangles[k].corners());
      backwards.polygon(rectangles[3 - k].corners());
    }
    const SoundScene a = forwards.sound(), b = backwards.sound();
    for (int k = 0; k < 4; ++k)
      EXPECT_NEAR(total_length(contacts_of(a, surface_of(a, k))),
                  total_length(contacts_of(b, surface_of(b, 3 - k))), 1e-8)
          << round;
  }
}

}  // namespace
}  // namespace halfshade
