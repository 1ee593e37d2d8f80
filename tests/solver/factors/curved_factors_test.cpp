#include "solver/factors/factor_matrix.h"
#include "tests/solver/factors/curved_closed_forms.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

namespace halfshade {
namespace {

constexpr double pi = std::numbers::pi;

/// Surfaces of revolution round the z axis as polygons whose corners lie on them.
class Turner {
 public:
  explicit Turner(int sides) : sides_(sides) { test::add_material(scene, 0.5, 0); }

  /// What follows belongs to a group of its own.
  Turner& group() {
    scene.groups.push_back("group " + std::to_string(scene.groups.size()));
    return *this;
  }

  Turner& polygon(std::vector<Vec3> corners, bool turned = false) {
    if (turned) std::reverse(corners.begin(), corners.end());
    test::add_polygon(scene, corners, 0);
    scene.faces.back().group = static_cast<int>(scene.groups.size()) - 1;
    return *this;
  }

  /// Looks along +z or −z.
  Turner& disk(double radius, double z, bool up, double x = 0) {
    std::vector<Vec3> corners;
    for (int k = 0; k < sides_; ++k) corners.push_back(corner(radius, z, k) + Vec3(x, 0, 0));
    return polygon(corners, !up);
  }

  /// The side of a cone's frustum between two heights; a radius of 0 is its apex. Looks away from
  /// the axis or towards it.
  Turner& side(const Vec2& low, const Vec2& high, bool outwards, double lift = 0) {
    for (int k = 0; k < sides_; ++k) {
      std::vector<Vec3> corners;
      const auto add = [&](const Vec2& at, int of) {
        corners.push_back(corner(at.x(), at.y() + lift, of));
      };
      add(low, k);
      if (low.x() > 0) add(low, k + 1);
      add(high, k + 1);
      if (high.x() > 0) add(high, k);
      polygon(corners, !outwards);
    }
    return *this;
  }

  /// A sphere's zone from the pole at +z to an angle from it, in rings as high as they are wide.
  Turner& zone(double radius, double angle, bool outwards, double lift = 0) {
    const int rings = std::max(1, static_cast<int>(std::lround(sides_ * angle / (2 * pi))));
    const auto at = [&](int ring) {
      const double from_pole = angle * ring / rings;
      const bool is_pole = ring == 0 || (ring == rings && angle == pi);
      return Vec2(is_pole ? 0 : radius * std::sin(from_pole), radius * std::cos(from_pole));
    };
    for (int ring = 0; ring < rings; ++ring) side(at(ring + 1), at(ring), outwards, lift);
    return *this;
  }
  Turner& sphere(double radius, bool outwards, double lift = 0) {
    return zone(radius, pi, outwards, lift);
  }

  /// A square so small that it is nearly a point, at the origin, tilted from +z towards +x.
  Turner& point(double tilt) {
    constexpr double half = 5e-4;
    const Vec3 u = half * Vec3(std::cos(tilt), 0, -std::sin(tilt)), v(0, half, 0);
    return polygon({-u - v, u - v, u + v, v - u});
  }

  Scene scene;

 private:
  Vec3 corner(double radius, double z, int k) const {
    const double angle = 2 * pi * k / sides_;
    return {radius * std::cos(angle), radius * std::sin(angle), z};
  }

  int sides_;
};

/// A closed frustum, seen from inside: bottom, top, side.
Scene closed_frustum(int sides, double low, double high, double height) {
  Turner turner(sides);
  turner.group();
  if (low > 0) turner.disk(low, 0, true);
  turner.group().disk(high, height, false);
  return turner.group().side({low, 0}, {high, height}, false).scene;
}

Scene cylinder_in_cylinder(int sides) {
  Turner turner(sides);
  turner.group().side({1, 0}, {1, 3}, true).group().side({2, 0}, {2, 3}, false);
  return turner.group().disk(1, 3, true).disk(1, 0, false).scene;
}

/// The outer one has half as many sides again, so that both are off by different shares.
Scene sphere_in_sphere(int sides) {
  Scene scene = Turner(sides).group().sphere(.5, true).scene;
  const Scene outer = Turner(sides * 3 / 2).group().sphere(1, false).scene;
  const auto first = static_cast<int>(scene.vertices.size());
  scene.vertices.insert(scene.vertices.end(), outer.vertices.begin(), outer.vertices.end());
  scene.groups.emplace_back("outer");
  for (Face face : outer.faces) {
    for (int& v : face.vertices) v += first;
    face.group = 1;
    scene.faces.push_back(face);
  }
  return scene;
}

struct CurvedCase {
  std::string name;
  std::function<Scene(int)> make;  ///< of so many sides
  std::string from, to;            ///< names of groups
  double expected;
  std::array<int, 3> sides;
  double tolerance;
};

std::vector<CurvedCase> curved_cases() {
  const std::string a = "group 0", b = "group 1", c = "group 2";
  constexpr std::array coarse = {8, 12, 16}, fine = {8, 16, 32};
  std::vector<CurvedCase> cases = {
      {"Disks", [](int n) { return closed_frustum(n, 1, 2, 1.5); }, a, b,
       test::coaxial_disks(1, 2, 1.5), fine, 1e-9},
      {"CylinderToItself", [](int n) { return closed_frustum(n, 1, 1, 2); }, c, c,
       test::inside_cylinder(1, 2), fine, 1e-9},
      {"ConeToItself", [](int n) { return closed_frustum(n, 0, 1, 1.5); }, c, c,
       1 - 1 / std::hypot(1, 1.5), fine, 1e-9},
      {"FrustumToItself", [](int n) { return closed_frustum(n, .5, 1, 1.2); }, c, c,
       test::inside_frustum(.5, 1, 1.2), fine, 1e-9},
      {"CapToItself",
       [](int n) {
         Turner turner(n);
         turner.group().zone(1, pi / 3, false);
         return turner.group().disk(std::sin(pi / 3), std::cos(pi / 3), true).scene;
       },
       a,
       a,
       .25,
       {12, 18, 24},
       1e-9},
      {"SphereToDisk",
       [](int n) { return Turner(n).group().sphere(.5, true).group().disk(1.5, 2, false).scene; },
       a, b, test::sphere_to_disk(1.5, 2), fine, 1e-5},
      {"SphereToRectangle",
       [](int n) {
         Turner turner(n);
         turner.group().sphere(.4, true).group();
         return turner.polygon({{0, 0, 1.1}, {0, .9, 1.1}, {1.2, .9, 1.1}, {1.2, 0, 1.1}}).scene;
       },
       a,
       b,
       test::sphere_to_rectangle(1.2, .9, 1.1),
       {12, 16, 24},
       4e-6},
      {"OuterCylinderToInner", cylinder_in_cylinder, b, a, test::outer_to_inner_cylinder(1, 2, 3),
       coarse, 1e-4},
      {"OuterCylinderToItself", cylinder_in_cylinder, b, b, test::outer_cylinder_to_itself(1, 2, 3),
       coarse, 1e-4},
      {"OuterSphereToInner", sphere_in_sphere, "outer", a, .25, coarse, 3e-4},
      {"OuterSphereToItself", sphere_in_sphere, "outer", "outer", .75, coarse, 3e-4},
      {"PointToDisk",
       [](int n) { return Turner(n).group().point(0).group().disk(1, 2, false).scene; }, a, b, .2,
       fine, 1e-7},
      {"PointToDiskAside",
       [](int n) { return Turner(n).group().point(0).group().disk(.5, 1, false, .7).scene; }, a, b,
       test::point_to_parallel_disk(.7, .5, 1), fine, 1e-7},
      {"PointToDiskAcross",
       [](int n) { return Turner(n).group().point(pi / 2).group().disk(.5, 1, false, .7).scene; },
       a, b, test::point_to_perpendicular_disk(.7, .5, 1), fine, 1e-7}};
  for (const double tilt : {.5, 1.3, 1.6, 1.9})
    cases.push_back(
        {"PointToSphere" + std::to_string(std::lround(10 * tilt)),
         [tilt](int n) { return Turner(n).group().point(tilt).group().sphere(.5, true, 1).scene; },
         a, b, test::point_to_sphere(2, tilt), fine, 1e-6});
  return cases;
}

class CurvedFactors : public testing::TestWithParam<CurvedCase> {};

/// Polygons whose corners lie on a curved surface are off by the square of their size: so is what
/// is computed, and what is left when that is taken out is off by the fourth power and the error.
TEST_P(CurvedFactors, ConvergeAtSecondOrder) {
  const CurvedCase& curved = GetParam();
  std::array<double, 3> off;
  for (std::size_t k = 0; k < 3; ++k) {
    FactorOptions options;
    options.unit = FactorUnit::group;
    options.tolerance = curved.tolerance;
    const FactorMatrix matrix = form_factor_matrix(curved.make(curved.sides[k]), options);
    const auto place = [&](const std::string& name) {
      return std::find(matrix.names.begin(), matrix.names.end(), name) - matrix.names.begin();
    };
    const auto from = place(curved.from), to = place(curved.to);
    ASSERT_LT(std::max(from, to), matrix.area.size());
    off[k] = matrix.factors(from, to) - curved.expected;
    EXPECT_LE(matrix.error.maxCoeff(), curved.tolerance);
    EXPECT_EQ(matrix.report.rows_not_reached, 0);
    EXPECT_LE((matrix.row_sum - 1).abs().maxCoeff(), 2 * curved.tolerance);
    EXPECT_GT(std::abs(off[k]), 8 * curved.tolerance) << "polygons matter more than tolerance";
    EXPECT_LT(std::abs(off[k]), pi * pi / 2 / std::pow(curved.sides[k], 2))
        << "what chords are off circles of radius one";
  }
  const auto ratio = [&](std::size_t k) {
    return static_cast<double>(curved.sides[k]) / curved.sides[k - 1];
  };
  for (const std::size_t k : {1, 2})
    EXPECT_NEAR(std::log(off[k - 1] / off[k]) / std::log(ratio(k)), 2, k == 1 ? 0.3 : 0.15);
  const double square = std::pow(ratio(2), 2);
  const double left = (square * off[2] - off[1]) / (square - 1);
  EXPECT_LT(std::abs(left), 0.1 * std::abs(off[2]) + 4 * curved.tolerance);
}

INSTANTIATE_TEST_SUITE_P(ClosedForms, CurvedFactors, testing::ValuesIn(curved_cases()),
                         [](const auto& param) { return param.param.name; });

}  // namespace
}  // namespace halfshade
