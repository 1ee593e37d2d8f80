#include "meshing/core/error.h"
#include "meshing/triangulation/curve_mesh.h"
#include "tests/support/mesh_invariants.h"
#include "tests/support/rings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

/// Polygons without curves.
namespace halfshade {
namespace {

using test::angle_and_length;
using test::expect_sound;
using test::square_hole;
using test::unit_square;

Ring rectangle(double width, double height) {
  return {{0, 0}, {width, 0}, {width, height}, {0, height}};
}

/// The shortest edge is 1/4000 of the size, or given.
PlanarMesh refine(const std::vector<Ring>& rings, const std::vector<Segment2>& contacts,
                  const PlanarMeshOptions& quality, double size = 1) {
  CurveMeshOptions options;
  options.quality = quality;
  options.snap = 1e-9 * size;
  options.shortest = size / 4000;
  CurveMesh mesh = mesh_with_curves(rings, contacts, {}, options);
  EXPECT_TRUE(mesh.curves.empty());
  EXPECT_EQ(std::count(mesh.is_d0.begin(), mesh.is_d0.end(), false), 0);
  return mesh.mesh;
}

class PlainMeshLength : public testing::TestWithParam<double> {};

TEST_P(PlainMeshLength, ReachesAngleAndLength) {
  const double h = GetParam();
  const std::vector<Ring> rings = {unit_square, square_hole};
  const std::vector<Segment2> contacts = {{Vec2(0.1, 0.1), Vec2(0.3, 0.8)}};
  const PlanarMesh mesh = refine(rings, contacts, {.max_length = h});
  expect_sound(mesh, rings, contacts);
  const auto [angle, length] = angle_and_length(mesh);
  EXPECT_GE(angle, 20.7);
  EXPECT_LE(length, h);
  EXPECT_TRUE(mesh.complete);
  EXPECT_LE(mesh.triangles.size(), 30 + 6 / (h * h)) << "nor many more than it takes";
  // No triangle with edges up to h is larger than the equilateral one.
  EXPECT_GE(static_cast<double>(mesh.triangles.size()), 0.96 / (std::sqrt(3.0) / 4 * h * h));
}

INSTANTIATE_TEST_SUITE_P(Lengths, PlainMeshLength, testing::Values(1.0, 0.3, 0.1, 0.03));

TEST(PlainMesh, WithoutLimitsLeavesAGoodPolygonAlone) {
  const std::vector<Ring> rings = {unit_square};
  EXPECT_EQ(refine(rings, {}, {}).triangles.size(), 2u);
}

TEST(PlainMesh, ScalesWithPowersOfTwoExactly) {
  const std::vector<Ring> rings = {unit_square, square_hole};
  const PlanarMesh mesh = refine(rings, {}, {.max_length = 0.125});
  for (const double scale : {0x1p-150, 0x1p-20, 0x1p30, 0x1p150}) {
    std::vector<Ring> scaled = rings;
    for (Ring& ring : scaled)
      for (Vec2& p : ring) p *= scale;
    const PlanarMesh other = refine(scaled, {}, {.max_length = 0.125 * scale}, scale);
    ASSERT_EQ(other.triangles, mesh.triangles) << scale;
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
      EXPECT_EQ(other.points[i], scale * mesh.points[i]);
  }
}

TEST(PlainMesh, SmallInputAnglesEnd) {
  for (const double degrees : {10.0, 1.0, 0.01}) {
    const double slope = std::tan(degrees * M_PI / 180);
    const std::vector<Ring> rings = {{{0, 0}, {1, 0}, {1, slope}}};
    const PlanarMesh mesh = refine(rings, {}, {.max_length = 0.2});
    expect_sound(mesh, rings);
    EXPECT_LE(angle_and_length(mesh).second, 0.2);
    EXPECT_LE(mesh.triangles.size(), 30000u);
  }
}

TEST(PlainMesh, ThinPolygonsDoNotExplode) {
  for (const double width : {1e-2, 1e-3, 1e-4, 1e-6, 1e-9}) {
    for (const Ring& ring : {rectangle(1, width), Ring{{0, 0}, {1, 0}, {0.3, width}}}) {
      const PlanarMesh mesh = refine({ring}, {}, {.max_length = 0.1});
      expect_sound(mesh, {ring});
      EXPECT_LE(angle_and_length(mesh).second, 0.1);
      EXPECT_LE(mesh.triangles.size(), 20000u) << width;
    }
  }
}

TEST(PlainMesh, StopsAtTheTriangleLimitWithASoundMesh) {
  const std::vector<Ring> rings = {unit_square, square_hole};
  const PlanarMesh mesh = refine(rings, {}, {.max_length = 0.01, .max_triangles = 500});
  EXPECT_FALSE(mesh.complete);
  EXPECT_LE(mesh.triangles.size(), 502u);
  expect_sound(mesh, rings);
}

TEST(PlainMesh, RandomStarsWithContactsAreSound) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int trial = 0; trial < 25; ++trial) {
    Ring star;
    const int n = 5 + trial;
    for (int k = 0; k < n; ++k) {
      const double angle = 2 * M_PI * (k + 0.5 * uniform(random)) / n;
      const double radius = 0.5 + uniform(random);
      star.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    std::vector<Segment2> contacts;
    for (int k = 0; k < 3; ++k)
      contacts.push_back({0.3 * Vec2(uniform(random) - 0.5, uniform(random) - 0.5),
                          0.3 * Vec2(uniform(random) - 0.5, uniform(random) - 0.5)});
    const PlanarMesh mesh = refine({star}, contacts, {.max_length = 0.2});
    expect_sound(mesh, {star}, contacts);
    EXPECT_LE(angle_and_length(mesh).second, 0.2);
  }
}

TEST(PlainMesh, RejectsOptionsOutOfRange) {
  const std::vector<Ring> rings = {unit_square};
  for (const PlanarMeshOptions& options :
       {PlanarMeshOptions{.max_length = -1}, PlanarMeshOptions{.max_length = NAN},
        PlanarMeshOptions{.min_angle = 30}, PlanarMeshOptions{.min_angle = -1}}) {
    try {
      refine(rings, {}, options);
      ADD_FAILURE() << "accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::contract);
    }
  }
}

TEST(PlainMesh, CountsFollowTheLengthSteadily) {
  // Right-angled halves of squares, bisected together, would come in powers of two.
  for (const double h : {0.2, 0.17, 0.14, 0.12, 0.1, 0.085, 0.07, 0.06, 0.05}) {
    const auto count =
        static_cast<double>(refine({unit_square}, {}, {.max_length = h}).triangles.size());
    EXPECT_NEAR(0.2 * h * h * count, 1, 0.2) << h;
  }
}

TEST(PlainMesh, LengthAloneDividesTheBorderIntoAsFewEqualPartsAsMayBe) {
  const Ring quadrangle = {{0, 0}, {1, 0}, {1.2, 0.9}, {-0.1, 1.1}};
  for (const double h : {0.3, 0.13, 0.09, 0.041}) {
    const PlanarMesh mesh = refine({quadrangle}, {}, {.max_length = h});
    std::size_t parts = 0;
    for (std::size_t k = 0; k < 4; ++k)
      parts +=
          static_cast<std::size_t>(std::ceil((quadrangle[(k + 1) % 4] - quadrangle[k]).norm() / h));
    EXPECT_EQ(mesh.constrained_edges.size(), parts) << h;
  }
}

TEST(PlainMesh, FeaturesDownToTheShortestEdgeGetGoodAngles) {
  for (const double gap : {0.1, 0.01, 0.001}) {
    const Ring near_border = {{0.3, gap}, {0.3, 0.4}, {0.6, 0.4}, {0.6, gap}};
    const Ring short_edge = {{0, 0}, {0.5, 0}, {0.5 + gap, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (const std::vector<Ring>& rings :
         {std::vector<Ring>{rectangle(1, gap)}, {unit_square, near_border}, {short_edge}}) {
      const PlanarMesh mesh = refine(rings, {}, {.max_length = 0.2});
      expect_sound(mesh, rings);
      EXPECT_GE(angle_and_length(mesh).first, 20.7) << gap;
    }
  }
}

}  // namespace
}  // namespace halfshade
