#include "meshing/events/emitter_scene.h"

#include "meshing/backprojection/opaque_topology.h"
#include "meshing/core/error.h"
#include "meshing/core/light_source.h"
#include "tests/support/lit_scene.h"
#include "tests/support/visible_part_oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

namespace halfshade {
namespace {

using test::LitScene;
using test::Random;
using test::SceneMaker;

bool is_same(const Vec3& a, const Vec3& b) { return (a - b).norm() < 1e-9; }

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

int corners_at(const EmitterScene& emitter_scene, const Vec3& place) {
  return static_cast<int>(
      std::count_if(emitter_scene.corners.begin(), emitter_scene.corners.end(),
                    [&](const OutlinePoint& corner) { return is_same(corner.position, place); }));
}

const OutlinePoint* corner_at(const EmitterScene& emitter_scene, const Vec3& place) {
  for (const OutlinePoint& corner : emitter_scene.corners)
    if (is_same(corner.position, place)) return &corner;
  return nullptr;
}

template <class Keep>
double outline_length(const EmitterScene& emitter_scene, const Keep& keep) {
  double sum = 0;
  for (const OutlinePiece& piece : emitter_scene.outline)
    if (keep(piece)) sum += piece.span.direction().norm();
  return sum;
}

bool is_own(const OutlinePiece& piece) { return piece.id.kind == EdgeId::Kind::emitter_edge; }
bool is_cut(const OutlinePiece& piece) { return piece.id.kind == EdgeId::Kind::cut; }

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

TEST(Outline, OfALightWithAHoleHasBothRings) {
  const SoundScene scene = test::light_with_a_hole();
  const OpaqueScene opaque(scene);
  const EmitterScene emitter_scene(scene, opaque, light_sources(scene)[0].surface);
  ASSERT_EQ(emitter_scene.outline.size(), 8u);
  EXPECT_NEAR(outline_length(emitter_scene, is_own), 2 * (1.4 + 1.2) + 2 * (0.5 + 0.4), 1e-9);
  ASSERT_EQ(emitter_scene.corners.size(), 8u);
  std::set<EdgeId> ids;
  for (const OutlinePiece& piece : emitter_scene.outline) ids.insert(piece.id);
  std::set<EdgeId> expected;
  for (int k = 0; k < 8; ++k) expected.insert(EdgeId::emitter_edge(k));
  EXPECT_EQ(ids, expected);
  for (const OutlinePoint& corner : emitter_scene.corners) {
    ASSERT_EQ(corner.edges.size(), 2u);
    EXPECT_LT(corner.edges[0], corner.edges[1]);
    for (const OutlinePiece& piece : emitter_scene.outline) {
      const bool ends_here =
          is_same(piece.span.from, corner.position) || is_same(piece.span.to, corner.position);
      const bool is_listed =
          std::find(corner.edges.begin(), corner.edges.end(), piece.id) != corner.edges.end();
      EXPECT_EQ(ends_here, is_listed);
    }
  }
}

/// Whether a point lies on the border of [−.2, .2]² at z = 2.
bool is_on_square(const Vec3& p) {
  return std::abs(p.z() - 2) < 1e-9 &&
         std::abs(std::max(std::abs(p.x()), std::abs(p.y())) - 0.2) < 1e-9;
}

TEST(Outline, GoesRoundWhatHangsFromTheLight) {
  SceneMaker maker;
  maker.square_light();
  const auto faces = test::box_faces({-0.2, -0.2, 1.6}, {0.2, 0.2, 2}, false);
  for (std::size_t f = 0; f < 5; ++f) maker.polygon(faces[f]);
  const LitScene lit(maker);
  EXPECT_NEAR(outline_length(lit.emitter_scene, is_own), 4, 1e-9);
  EXPECT_NEAR(outline_length(lit.emitter_scene, [](const OutlinePiece& p) { return !is_own(p); }),
              1.6, 1e-9);
  for (const OutlinePiece& piece : lit.emitter_scene.outline) {
    if (is_own(piece)) continue;
    EXPECT_TRUE(is_on_square(piece.span.from) && is_on_square(piece.span.at(0.5)));
    EXPECT_EQ(piece.feature.kind, Feature::Kind::edge);
  }
  for (const double x : {-0.2, 0.2})
    for (const double y : {-0.2, 0.2}) {
      const OutlinePoint* corner = corner_at(lit.emitter_scene, {x, y, 2});
      ASSERT_TRUE(corner);
      EXPECT_GE(corner->edges.size(), 3u) << "two in the plane and the one that leads away";
    }
}

TEST(Outline, FollowsWhatPiercesTheLight) {
  const SceneMaker maker = SceneMaker().square_light().box({-0.2, -0.2, 1.6}, {0.2, 0.2, 2.3});
  // The repair gives the sides corners in the light's plane, between which there may be edges.
  const LitScene repaired(maker), lit(test::as_it_is(maker.scene));
  EXPECT_NEAR(outline_length(repaired.emitter_scene, is_own), 4, 1e-9);
  EXPECT_NEAR(
      outline_length(repaired.emitter_scene, [](const OutlinePiece& p) { return !is_own(p); }), 1.6,
      1e-9);
  EXPECT_NEAR(outline_length(lit.emitter_scene, is_own), 4, 1e-9);
  EXPECT_NEAR(outline_length(lit.emitter_scene, is_cut), 1.6, 1e-9);
  for (const OutlinePiece& piece : lit.emitter_scene.outline)
    if (!is_own(piece)) {
      EXPECT_TRUE(is_on_square(piece.span.from) && is_on_square(piece.span.at(0.5)));
      EXPECT_EQ(piece.feature.kind, Feature::Kind::face);
    }
  for (const double x : {-0.2, 0.2})
    for (const double y : {-0.2, 0.2}) {
      const OutlinePoint* corner = corner_at(lit.emitter_scene, {x, y, 2});
      ASSERT_TRUE(corner);
      // Two triangles of the sides that meet here, and the edge between them.
      EXPECT_EQ(std::count_if(corner->edges.begin(), corner->edges.end(),
                              [](EdgeId id) { return id.kind == EdgeId::Kind::cut; }),
                2);
      EXPECT_EQ(std::count_if(corner->edges.begin(), corner->edges.end(),
                              [](EdgeId id) { return id.kind == EdgeId::Kind::edge; }),
                1);
    }
}

TEST(Outline, HasCornersWhereWhatPiercesItCrossesTheBorder) {
  const LitScene lit(
      test::as_it_is(SceneMaker().square_light().box({0.3, -0.2, 1.6}, {0.7, 0.1, 2.3}).scene));
  for (const double y : {-0.2, 0.1}) {
    bool found = false;
    for (const OutlinePoint& corner : lit.emitter_scene.corners)
      if (is_same(corner.position, {0.5, y, 2}))
        found = found || (corner.edges.front().kind == EdgeId::Kind::emitter_edge &&
                          corner.edges.back().kind == EdgeId::Kind::cut);
    EXPECT_TRUE(found) << y;
    EXPECT_GE(corners_at(lit.emitter_scene, {0.3, y, 2}), 1);
    EXPECT_EQ(corners_at(lit.emitter_scene, {0.7, y, 2}), 0) << "outside the light";
  }
}

TEST(Outline, AThingThatTouchesTheBorderMakesNoCornerOfTheLightsOwn) {
  const LitScene lit(
      SceneMaker().square_light().polygon({{-0.1, 0.5, 2}, {0.2, 0.5, 2}, {0, 0.5, 1.5}}));
  EXPECT_NEAR(outline_length(lit.emitter_scene, is_own), 4, 1e-9);
  std::set<EdgeId> own;
  for (const OutlinePiece& piece : lit.emitter_scene.outline)
    if (is_own(piece)) own.insert(piece.id);
  EXPECT_EQ(own.size(), 4u) << "pieces of one edge share its id";
  for (const double x : {-0.1, 0.2}) {
    ASSERT_GE(corners_at(lit.emitter_scene, {x, 0.5, 2}), 1);
    EXPECT_NE(corner_at(lit.emitter_scene, {x, 0.5, 2})->feature.kind,
              Feature::Kind::emitter_vertex);
  }
  EXPECT_EQ(std::count_if(lit.emitter_scene.corners.begin(), lit.emitter_scene.corners.end(),
                          [](const OutlinePoint& corner) {
                            return corner.feature.kind == Feature::Kind::emitter_vertex;
                          }),
            4);
}

TEST(LineOf, RunsThroughEdgesOfTheSceneAndPiecesOfTheOutline) {
  const LitScene lit(
      test::as_it_is(SceneMaker().square_light().box({0.3, -0.2, 1.6}, {0.7, 0.1, 2.3}).scene));
  const auto is_on = [](const Line3& line, const Vec3& p) {
    return line.direction.cross(p - line.point).norm() < 1e-12;
  };
  for (int e = 0; e < lit.opaque.edge_count(); ++e) {
    const Line3 line = line_of(lit.emitter_scene, lit.opaque.topology(), EdgeId::edge(e));
    for (const Vec3& p : lit.opaque.edge_ends(e)) EXPECT_TRUE(is_on(line, p));
  }
  for (const OutlinePiece& piece : lit.emitter_scene.outline) {
    const Line3 line = line_of(lit.emitter_scene, lit.opaque.topology(), piece.id);
    EXPECT_TRUE(is_on(line, piece.span.from) && is_on(line, piece.span.to));
  }
}

TEST(LineOf, FindsCutsThatAreNoPieceOfTheOutline) {
  LitScene lit(
      test::as_it_is(SceneMaker().square_light().box({0.3, -0.2, 1.6}, {0.7, 0.1, 2.3}).scene));
  const std::vector<OutlinePiece> outline = std::move(lit.emitter_scene.outline);
  lit.emitter_scene.outline.clear();
  int cuts = 0;
  for (const OutlinePiece& piece : outline) {
    if (!is_cut(piece)) continue;
    ++cuts;
    const Line3 line = line_of(lit.emitter_scene, lit.opaque.topology(), piece.id);
    for (const Vec3& p : {piece.span.from, piece.span.to})
      EXPECT_LT(line.direction.cross(p - line.point).norm(), 1e-12);
    EXPECT_GT(line.direction.norm(), 0);
  }
  EXPECT_GT(cuts, 0);
}

TEST(LineOf, RefusesWhatIsNoEdge) {
  const LitScene lit(SceneMaker().square_light().floor());
  const int edges = lit.opaque.edge_count();
  for (const EdgeId id : {EdgeId::horizon(), EdgeId::edge(edges), EdgeId::edge(-1),
                          EdgeId::emitter_edge(4), EdgeId::cut(0), EdgeId::cut(1000)})
    EXPECT_THROW(line_of(lit.emitter_scene, lit.opaque.topology(), id), Error);
}

TEST(EmitterScene, ContainsWhatACountOfCrossingsSays) {
  Random random(3);
  for (const SoundScene& scene :
       {test::light_with_a_hole(), test::l_shaped_light(), test::tilted_light()}) {
    const OpaqueScene opaque(scene);
    const int light = light_sources(scene)[0].surface;
    const EmitterScene emitter_scene(scene, opaque, light);
    const Surface& receiver = scene.surfaces[static_cast<std::size_t>(light)];
    for (int k = 0; k < 1000; ++k) {
      const Vec2 p(random(-1, 1), random(-1, 1));
      const auto depth = test::depth_inside(receiver.rings, p.cast<long double>());
      if (std::abs(depth) < 1e-6L) continue;
      EXPECT_EQ(emitter_scene.contains(receiver.frame.to_space(p)), depth > 0);
    }
    for (const Ring& ring : receiver.rings)
      for (std::size_t k = 0; k < ring.size(); ++k) {
        const Vec2 &a = ring[k], &b = ring[(k + 1) % ring.size()];
        const Vec2 out = Vec2((b - a).y(), (a - b).x()).normalized();  // the inside is left
        const Vec2 p = a + random(0, 1) * (b - a);
        EXPECT_TRUE(
            emitter_scene.contains(receiver.frame.to_space(p + 0.5 * emitter_scene.slack * out)));
        EXPECT_FALSE(
            emitter_scene.contains(receiver.frame.to_space(p + 4 * emitter_scene.slack * out)));
      }
  }
}

}  // namespace
}  // namespace halfshade
