#include "meshing/core/light_source.h"
#include "tests/support/lit_scene.h"
#include "tests/support/outline_pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <vector>

// Which edges and vertices an emitter scene holds as possible silhouettes.

namespace halfshade {
namespace {

using test::is_own;
using test::is_same;
using test::LitScene;
using test::outline_length;
using test::Random;
using test::SceneMaker;

bool has_edge(const EmitterScene& emitter_scene, const Vec3& a, const Vec3& b) {
  return std::any_of(
      emitter_scene.edges.begin(), emitter_scene.edges.end(), [&](const SilhouetteEdge& edge) {
        const Span3& s = edge.whole;
        return (is_same(s.from, a) && is_same(s.to, b)) || (is_same(s.from, b) && is_same(s.to, a));
      });
}

bool has_id(const EmitterScene& emitter_scene, int id) {
  return std::any_of(emitter_scene.edges.begin(), emitter_scene.edges.end(),
                     [&](const SilhouetteEdge& edge) { return edge.id == id; });
}

TEST(SilhouetteEdges, OfABoxBelowTheLightAreAllOfThem) {
  // From somewhere on the light each side can be seen, and from elsewhere not.
  const LitScene lit(SceneMaker().square_light().box({-0.2, -0.2, 0.5}, {0.3, 0.1, 0.9}));
  EXPECT_EQ(lit.emitter_scene.edges.size(), 12u);
  EXPECT_EQ(lit.emitter_scene.vertices.size(), 8u);
}

TEST(SilhouetteEdges, OfABoxAsideAreItsOutline) {
  const Vec3 low(1, 0.7, 0.5), high(1.4, 1.1, 0.9);
  const LitScene lit(SceneMaker().square_light().box(low, high));
  const auto corner = [&](bool x, bool y, bool z) {
    return Vec3(x ? high.x() : low.x(), y ? high.y() : low.y(), z ? high.z() : low.z());
  };
  // Top, −x and −y can be seen, the others cannot: six edges part them.
  const std::vector<Vec3> outline = {corner(false, false, false), corner(true, false, false),
                                     corner(true, false, true),   corner(true, true, true),
                                     corner(false, true, true),   corner(false, true, false)};
  ASSERT_EQ(lit.emitter_scene.edges.size(), 6u);
  for (std::size_t k = 0; k < 6; ++k)
    EXPECT_TRUE(has_edge(lit.emitter_scene, outline[k], outline[(k + 1) % 6])) << k;
  ASSERT_EQ(lit.emitter_scene.vertices.size(), 6u);
  for (const SilhouetteVertex& vertex : lit.emitter_scene.vertices)
    EXPECT_EQ(vertex.edges.size(), 2u);
}

/// The outward normals of the two faces of a box, among all its faces, that share an edge.
std::vector<Vec3> normals_at(const std::array<std::vector<Vec3>, 6>& faces, const Span3& edge) {
  std::vector<Vec3> normals;
  for (const auto& face : faces) {
    const auto has = [&](const Vec3& p) {
      return std::any_of(face.begin(), face.end(), [&](const Vec3& q) { return is_same(p, q); });
    };
    if (has(edge.from) && has(edge.to)) normals.push_back(area_vector(face).normalized());
  }
  return normals;
}

TEST(SilhouetteEdges, AreThoseThatSomeSampleOfTheLightSeesAsSilhouettes) {
  Random random(1);
  int left_out = 0;
  for (int round = 0; round < 60; ++round) {
    const auto faces = test::random_box(random, random.in_box({-1, -1, 0.5}, {1, 1, 1.2}), 0.3);
    SceneMaker maker;
    maker.square_light();
    for (const auto& face : faces) maker.polygon(face);
    const LitScene lit(maker);
    for (int e = 0; e < lit.opaque.edge_count(); ++e) {
      const auto ends = lit.opaque.edge_ends(e);
      const std::vector<Vec3> normals = normals_at(faces, {ends[0], ends[1]});
      if (normals.size() != 2) continue;  // the light's, or a diagonal
      bool is_silhouette = false;
      for (int i = 0; i <= 20; ++i)
        for (int j = 0; j <= 20; ++j) {
          const Vec3 to = Vec3(0.05 * i - 0.5, 0.05 * j - 0.5, 2) - ends[0];
          is_silhouette = is_silhouette || (normals[0].dot(to) > 0) != (normals[1].dot(to) > 0);
        }
      const bool is_kept = has_id(lit.emitter_scene, e);
      EXPECT_TRUE(is_kept || !is_silhouette) << round << ": " << e;
      left_out += !is_kept;
    }
  }
  EXPECT_GT(left_out, 60);
}

TEST(SilhouetteEdges, MayBeSilhouettesForDirectionsThatPartTheirFaces) {
  Random random(2);
  int yes = 0, no = 0;
  for (int round = 0; round < 60; ++round) {
    const auto faces = test::random_box(random, random.in_box({-1, -1, 0.5}, {1, 1, 1.2}), 0.3);
    SceneMaker maker;
    maker.square_light();
    for (const auto& face : faces) maker.polygon(face);
    const LitScene lit(maker);
    for (const SilhouetteEdge& edge : lit.emitter_scene.edges) {
      const std::vector<Vec3> normals = normals_at(faces, edge.whole);
      ASSERT_EQ(normals.size(), 2u);
      for (int k = 0; k < 10; ++k) {
        const Vec3 direction = random.direction();
        const bool expected = (normals[0].dot(direction) > 0) != (normals[1].dot(direction) > 0);
        EXPECT_EQ(lit.emitter_scene.may_be_silhouette(edge, direction), expected);
        ++(expected ? yes : no);
      }
      // Along a face both may be.
      EXPECT_TRUE(lit.emitter_scene.may_be_silhouette(edge, normals[0].unitOrthogonal()));
    }
  }
  EXPECT_GT(yes, 1000);
  EXPECT_GT(no, 1000);
}

TEST(SilhouetteEdges, BetweenFacesOfOnePlaneAreLeftOut) {
  SceneMaker maker;
  const int other = test::add_material(maker.scene, 0.3, 0);
  maker.square_light().up({-0.4, -0.3}, {0, 0.3}, 1).up({0, -0.3}, {0.5, 0.3}, 1, other);
  const LitScene lit(maker);
  ASSERT_EQ(lit.scene.surfaces.size(), 3u) << "two materials stay two surfaces";
  EXPECT_EQ(lit.emitter_scene.edges.size(), 6u);
  EXPECT_FALSE(has_edge(lit.emitter_scene, {0, -0.3, 1}, {0, 0.3, 1}));
  EXPECT_TRUE(has_edge(lit.emitter_scene, {0, -0.3, 1}, {0.5, -0.3, 1}));
}

TEST(SilhouetteEdges, OfASheetThatBothSidesShareAreKept) {
  const LitScene lit(
      SceneMaker().square_light().up({-0.4, -0.3}, {0.2, 0.3}, 1, test::two_sided_grey));
  ASSERT_EQ(lit.scene.surfaces.size(), 3u);
  EXPECT_EQ(lit.emitter_scene.edges.size(), 4u);
}

TEST(SilhouetteEdges, AreCutAtTheLightsPlane) {
  const LitScene lit(SceneMaker().square_light().polygon({{1, 0, 1}, {1.5, 0.3, 1.5}, {1, 0, 4}}));
  int cut = 0;
  for (const SilhouetteEdge& edge : lit.emitter_scene.edges) {
    EXPECT_LE(std::max(edge.front.from.z(), edge.front.to.z()), 2 + 1e-12);
    EXPECT_NEAR(edge.front.direction().normalized().dot(edge.whole.direction().normalized()), 1,
                1e-12);
    if (is_same(edge.front.from, edge.whole.from) && is_same(edge.front.to, edge.whole.to))
      continue;
    EXPECT_NEAR(std::max(edge.front.from.z(), edge.front.to.z()), 2, 1e-12);
    ++cut;
  }
  EXPECT_EQ(lit.emitter_scene.edges.size(), 3u);
  EXPECT_EQ(cut, 2);
}

TEST(SilhouetteEdges, BehindTheLightAreNotThere) {
  const LitScene lit(SceneMaker()
                         .square_light()
                         .box({-1, -1, 2.3}, {1, 1, 3})
                         .box({-0.2, -0.2, 2}, {0.2, 0.2, 2.2}));
  EXPECT_TRUE(lit.emitter_scene.edges.empty());
  EXPECT_TRUE(lit.emitter_scene.vertices.empty());
  EXPECT_NEAR(outline_length(lit.emitter_scene, is_own), 4, 1e-9);
}

TEST(SilhouetteVertices, KnowTheEdgesThatEndAtThem) {
  for (const test::NamedScene& named : test::discontinuity_scenes()) {
    if (named.name.find("_1") == std::string::npos && named.name != "stacked_boxes") continue;
    const OpaqueScene opaque(named.scene);
    const EmitterScene emitter_scene(named.scene, opaque, light_sources(named.scene)[0].surface);
    std::size_t ends = 0, listed = 0;
    for (const SilhouetteEdge& edge : emitter_scene.edges)
      for (const Vec3& p : {edge.whole.from, edge.whole.to})
        ends += emitter_scene.frame.height(p) > 1e-6;
    for (const SilhouetteVertex& vertex : emitter_scene.vertices) {
      EXPECT_NEAR(vertex.height, emitter_scene.frame.height(vertex.position), 1e-12);
      listed += vertex.edges.size();
      for (const int e : vertex.edges) {
        const Span3& span = emitter_scene.edges[static_cast<std::size_t>(e)].whole;
        EXPECT_TRUE(is_same(span.from, vertex.position) || is_same(span.to, vertex.position));
      }
    }
    EXPECT_EQ(listed, ends) << named.name;
    std::set<int> ids;
    for (const SilhouetteEdge& edge : emitter_scene.edges) {
      const auto ends_of_id = opaque.edge_ends(edge.id);
      EXPECT_TRUE(ends_of_id[0] == edge.whole.from && ends_of_id[1] == edge.whole.to);
      EXPECT_TRUE(ids.insert(edge.id).second) << "an edge of the scene is there once";
    }
  }
}

}  // namespace
}  // namespace halfshade
