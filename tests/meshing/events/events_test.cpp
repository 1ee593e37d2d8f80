#include "meshing/events/events.h"

#include "tests/support/lit_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

// Which swaths there are.

namespace halfshade {
namespace {

using test::LitScene;
using test::Random;
using test::SceneMaker;

template <class Generate>
std::vector<Swath> collect(const Generate& generate) {
  std::vector<Swath> swaths;
  generate([&](const Swath& swath) { swaths.push_back(swath); });
  return swaths;
}

std::vector<Swath> of_edge(const EmitterScene& emitter_scene, int edge) {
  return collect([&](const SwathSink& sink) { edge_swaths(emitter_scene, edge, sink); });
}

std::vector<Swath> of_vertex(const EmitterScene& emitter_scene, int vertex) {
  return collect([&](const SwathSink& sink) { vertex_swaths(emitter_scene, vertex, sink); });
}

std::vector<Swath> of_face(const LitScene& lit, int receiver) {
  return collect([&](const SwathSink& sink) {
    face_swaths(lit.scene, lit.emitter_scene, lit.opaque, receiver, sink);
  });
}

std::vector<Swath> of_triple(const EmitterScene& emitter_scene, int a, int b, int c) {
  return collect([&](const SwathSink& sink) { triple_swath(emitter_scene, a, b, c, sink); });
}

int count(const std::vector<SilhouetteEdge>& edges) { return static_cast<int>(edges.size()); }

double distance_to_segment(const Vec3& p, const Span3& span) {
  const Vec3 along = span.direction();
  const double t = std::clamp(along.dot(p - span.from) / along.squaredNorm(), 0., 1.);
  return (p - span.at(t)).norm();
}

/// Where the line from b through a meets the light's plane; a is nearer to it.
Vec3 onto_light(const EmitterScene& emitter_scene, const Vec3& a, const Vec3& b) {
  const double h = emitter_scene.frame.height(a), g = emitter_scene.frame.height(b);
  return b + g / (g - h) * (a - b);
}

/// Lights with all kinds of outline.
std::vector<SoundScene> scenes() {
  return {test::random_polygons(1, 4), test::random_tetrahedra(2, 3), test::random_boxes(3, 2),
          test::light_with_a_hole(),   test::l_shaped_light(),        test::tilted_light(),
          test::window_in_a_sheet(),   test::stacked_boxes()};
}

TEST(EdgeSwaths, JoinEveryCornerOfTheLightWithTheEdge) {
  for (const SoundScene& scene : scenes()) {
    const LitScene lit(scene);
    const EmitterScene& emitter_scene = lit.emitter_scene;
    for (int e = 0; e < count(emitter_scene.edges); ++e) {
      const SilhouetteEdge& edge = emitter_scene.edges[static_cast<std::size_t>(e)];
      std::size_t from_corners = 0;
      for (const Swath& swath : of_edge(emitter_scene, e)) {
        EXPECT_TRUE(swath.is_planar);
        EXPECT_EQ(swath.source.kind, CurveKind::ev);
        EXPECT_EQ(swath.silhouettes[0], e);
        EXPECT_TRUE(std::is_sorted(swath.group.begin(), swath.group.end()));
        EXPECT_TRUE(
            std::binary_search(swath.group.begin(), swath.group.end(), EdgeId::edge(edge.id)));
        EXPECT_LT(distance_to_segment(swath.base.from, edge.front), 1e-9);
        EXPECT_LT(distance_to_segment(swath.base.to, edge.front), 1e-9);
        if (!swath.ends_on_outline) {
          const SilhouetteVertex& vertex =
              emitter_scene.vertices.at(static_cast<std::size_t>(swath.corner));
          EXPECT_EQ(swath.apex, vertex.position);
          continue;
        }
        ++from_corners;
        EXPECT_TRUE(std::any_of(
            emitter_scene.corners.begin(), emitter_scene.corners.end(), [&](const auto& c) {
              return c.position == swath.apex && c.feature == swath.source.features[0];
            }));
      }
      const Vec3 along = edge.whole.direction().normalized();
      const auto off_its_line =
          std::count_if(emitter_scene.corners.begin(), emitter_scene.corners.end(),
                        [&](const OutlinePoint& corner) {
                          return along.cross(corner.position - edge.whole.from).norm() > 1e-9;
                        });
      EXPECT_EQ(from_corners, static_cast<std::size_t>(off_its_line));
    }
  }
}

TEST(EdgeSwaths, HoldEveryLineFromTheLightThroughAVertexAndTheEdge) {
  Random random(1);
  int lines = 0, none = 0;
  for (const SoundScene& scene : scenes()) {
    const LitScene lit(scene);
    const EmitterScene& emitter_scene = lit.emitter_scene;
    for (int e = 0; e < count(emitter_scene.edges); ++e) {
      const SilhouetteEdge& edge = emitter_scene.edges[static_cast<std::size_t>(e)];
      const std::vector<Swath> swaths = of_edge(emitter_scene, e);
      for (const SilhouetteVertex& vertex : emitter_scene.vertices) {
        if (distance_to_segment(vertex.position, edge.whole) < 1e-6) continue;
        bool is_lit = false;
        for (int k = 0; k < 10; ++k) {
          const Vec3 p = edge.front.at(random(0, 1));
          const double height = emitter_scene.frame.height(p);
          if (std::abs(height - vertex.height) < 1e-3) continue;
          const bool is_nearer = height < vertex.height;
          if (!emitter_scene.contains(is_nearer ? onto_light(emitter_scene, p, vertex.position)
                                                : onto_light(emitter_scene, vertex.position, p)))
            continue;
          is_lit = true;
          ++lines;
          EXPECT_TRUE(std::any_of(swaths.begin(), swaths.end(), [&](const Swath& swath) {
            return swath.apex == vertex.position && distance_to_segment(p, swath.base) < 1e-9;
          }));
        }
        none += !is_lit && std::none_of(swaths.begin(), swaths.end(), [&](const Swath& swath) {
          return swath.apex == vertex.position;
        });
      }
    }
  }
  EXPECT_GT(lines, 500);
  EXPECT_GT(none, 500) << "most pairs cannot line up";
}

TEST(VertexSwaths, JoinTheVertexWithEveryPieceOfTheOutline) {
  for (const SoundScene& scene : scenes()) {
    const LitScene lit(scene);
    const EmitterScene& emitter_scene = lit.emitter_scene;
    for (std::size_t v = 0; v < emitter_scene.vertices.size(); ++v) {
      const std::vector<Swath> swaths = of_vertex(emitter_scene, static_cast<int>(v));
      ASSERT_EQ(swaths.size(), emitter_scene.outline.size());
      for (std::size_t k = 0; k < swaths.size(); ++k) {
        EXPECT_EQ(swaths[k].apex, emitter_scene.vertices[v].position);
        EXPECT_EQ(swaths[k].base.from, emitter_scene.outline[k].span.from);
        EXPECT_TRUE(swaths[k].ends_on_outline);
        EXPECT_EQ(swaths[k].corner, static_cast<int>(v));
        EXPECT_TRUE(std::binary_search(swaths[k].group.begin(), swaths[k].group.end(),
                                       emitter_scene.outline[k].id));
      }
    }
  }
}

TEST(EventSwaths, AreOfFirstOrderIfEdgesOfTheGroupLieInTheirPlane) {
  // All edges of light and occluder are parallel in pairs; a turned occluder has none that is.
  const LitScene parallel(test::s1());
  int first = 0;
  for (int e = 0; e < count(parallel.emitter_scene.edges); ++e) {
    if (parallel.emitter_scene.edges[static_cast<std::size_t>(e)].whole.from.z() < 0.5) continue;
    for (const Swath& swath : of_edge(parallel.emitter_scene, e))
      first += swath.ends_on_outline && swath.may_be_first_order;
  }
  EXPECT_EQ(first, 4 * 4) << "each edge with each corner, which has a side along the edge";
  const LitScene turned(SceneMaker().square_light().floor().polygon(
      {{0.3, 0.1, 1}, {-0.1, 0.4, 1.1}, {-0.2, -0.3, 0.9}}));
  int of_occluder = 0;
  for (int e = 0; e < count(turned.emitter_scene.edges); ++e) {
    if (turned.emitter_scene.edges[static_cast<std::size_t>(e)].whole.from.z() < 0.5) continue;
    ++of_occluder;
    for (const Swath& swath : of_edge(turned.emitter_scene, e))
      EXPECT_FALSE(swath.ends_on_outline && swath.may_be_first_order);
  }
  EXPECT_EQ(of_occluder, 3);
}

TEST(FaceSwaths, LieInThePlaneOfAFaceThatCutsTheLight) {
  const LitScene lit(test::face_plane());  // of the box's planes only y = .05 and x = .9 do
  int cutting = 0;
  for (int r = 0; r < static_cast<int>(lit.scene.surfaces.size()); ++r) {
    const PlaneFrame& plane = lit.scene.surfaces[static_cast<std::size_t>(r)].frame;
    const std::vector<Swath> swaths = of_face(lit, r);
    const bool cuts =
        (std::abs(plane.normal.y()) > 0.9 && std::abs(plane.origin.y() - 0.05) < 1e-9) ||
        (std::abs(plane.normal.x()) > 0.9 && std::abs(plane.origin.x() - 0.9) < 1e-9);
    EXPECT_EQ(!swaths.empty(), cuts) << r;
    cutting += cuts;
    for (const Swath& swath : swaths) {
      EXPECT_EQ(swath.source.kind, CurveKind::face);
      EXPECT_EQ(swath.source.features[0], (Feature{Feature::Kind::face, r}));
      EXPECT_TRUE(swath.may_be_first_order);
      for (const Vec3& p : {swath.apex, swath.base.from, swath.base.to})
        EXPECT_NEAR(plane.height(p), 0, 1e-9);
    }
  }
  EXPECT_EQ(cutting, 2);
}

TEST(MayLineUp, IsTrueForSpansThatALineFromTheLightMeets) {
  Random random(2);
  const LitScene lit(test::l_shaped_light());
  const EmitterScene& emitter_scene = lit.emitter_scene;
  const auto anywhere = [&] { return random.in_box({-1.5, -1.5, 0.05}, {1.5, 1.5, 1.95}); };
  int met = 0, ruled_out = 0;
  for (int round = 0; round < 2000; ++round) {
    const Vec3 from = anywhere(), other = anywhere();
    const Span3 a = {from, from + 0.4 * random.direction().cwiseProduct(Vec3(1, 1, 0.1))};
    const Span3 b = {other, other + 0.4 * random.direction().cwiseProduct(Vec3(1, 1, 0.1))};
    bool is_met = false;
    for (int k = 0; k < 100 && !is_met; ++k) {
      const Vec3 p = a.at(random(0, 1)), q = b.at(random(0, 1));
      if (std::abs(p.z() - q.z()) < 1e-3 || std::max(p.z(), q.z()) > 1.99) continue;
      is_met = emitter_scene.contains(p.z() > q.z() ? onto_light(emitter_scene, p, q)
                                                    : onto_light(emitter_scene, q, p));
    }
    const bool may = may_line_up(emitter_scene, a, b);
    EXPECT_TRUE(may || !is_met) << round;
    EXPECT_EQ(may_line_up(emitter_scene, b, a), may);
    met += is_met;
    ruled_out += !may;
  }
  EXPECT_GT(met, 100);
  EXPECT_GT(ruled_out, 1000);
}

TEST(LaterPartners, AreInOrderAndLaterAndMayLineUp) {
  for (const SoundScene& scene : scenes()) {
    const LitScene lit(scene);
    const EmitterScene& emitter_scene = lit.emitter_scene;
    for (int a = 0; a < count(emitter_scene.edges); ++a) {
      const std::vector<int> partners = later_partners(emitter_scene, a);
      EXPECT_TRUE(std::is_sorted(partners.begin(), partners.end()));
      for (int b = 0; b < count(emitter_scene.edges); ++b) {
        const bool expected =
            b > a &&
            may_line_up(emitter_scene, emitter_scene.edges[static_cast<std::size_t>(a)].front,
                        emitter_scene.edges[static_cast<std::size_t>(b)].front);
        EXPECT_EQ(std::binary_search(partners.begin(), partners.end(), b), expected);
      }
    }
  }
}

/// The silhouette edge between two points.
int edge_between(const EmitterScene& emitter_scene, const Vec3& a, const Vec3& b) {
  for (int e = 0; e < count(emitter_scene.edges); ++e) {
    const Span3& span = emitter_scene.edges[static_cast<std::size_t>(e)].whole;
    if (((span.from - a).norm() < 1e-9 && (span.to - b).norm() < 1e-9) ||
        ((span.from - b).norm() < 1e-9 && (span.to - a).norm() < 1e-9))
      return e;
  }
  ADD_FAILURE() << "no edge from " << a.transpose() << " to " << b.transpose();
  return 0;
}

TEST(TripleSwath, OfSkewEdgesRunsThroughAllThree) {
  const LitScene lit(test::three_skew_slats());
  const EmitterScene& emitter_scene = lit.emitter_scene;
  const int a = edge_between(emitter_scene, {-1, -0.9, 0.5}, {1.1, 0.8, 0.55});
  const int b = edge_between(emitter_scene, {-1, 0.7, 0.9}, {1.1, -0.9, 0.95});
  const int c = edge_between(emitter_scene, {-0.1, -1, 1.3}, {0.15, 1.1, 1.35});
  const std::vector<Swath> swaths = of_triple(emitter_scene, a, b, c);
  ASSERT_EQ(swaths.size(), 1u);
  EXPECT_FALSE(swaths[0].is_planar);
  EXPECT_EQ(swaths[0].group.size(), 3u);
  EXPECT_EQ(swaths[0].silhouettes, (std::array{a, b, c}));
  EXPECT_EQ(swaths[0].source.kind, CurveKind::eee);
  int met = 0;
  for (int k = 1; k < 100; ++k)
    if (const auto line = line_at(swaths[0], emitter_scene.frame, 0.01 * k)) {
      for (const int e : {a, b, c}) {
        const Span3& span = emitter_scene.edges[static_cast<std::size_t>(e)].whole;
        EXPECT_NEAR(
            line->direction.cross(span.direction()).normalized().dot(span.from - line->start), 0,
            1e-9);
      }
      ++met;
    }
  EXPECT_GT(met, 10);
}

TEST(TripleSwath, OfTwoEdgesInAPlaneRunsThroughWhereTheThirdCrossesIt) {
  // The first two lie in x = 0, the third crosses it in (0, .1, 1.2).
  const LitScene lit(SceneMaker()
                         .square_light()
                         .polygon({{0, -0.4, 0.5}, {0, 0.4, 0.6}, {0.6, 0, 0.55}})
                         .polygon({{0, -0.3, 1.6}, {0, 0.4, 1.7}, {-0.6, 0, 1.65}})
                         .polygon({{-0.2, 0, 1.2}, {0.2, 0.2, 1.2}, {0.3, -0.4, 1.1}}));
  const EmitterScene& emitter_scene = lit.emitter_scene;
  const int a = edge_between(emitter_scene, {0, -0.4, 0.5}, {0, 0.4, 0.6});
  const int b = edge_between(emitter_scene, {0, -0.3, 1.6}, {0, 0.4, 1.7});
  const int c = edge_between(emitter_scene, {-0.2, 0, 1.2}, {0.2, 0.2, 1.2});
  const std::vector<Swath> swaths = of_triple(emitter_scene, a, b, c);
  ASSERT_EQ(swaths.size(), 1u);
  EXPECT_TRUE(swaths[0].is_planar);
  EXPECT_TRUE(swaths[0].may_be_first_order);
  EXPECT_NEAR((swaths[0].apex - Vec3(0, 0.1, 1.2)).norm(), 0, 1e-12);
  EXPECT_NEAR(std::abs(swaths[0].base.from.x()) + std::abs(swaths[0].base.to.x()), 0, 1e-12);
}

TEST(TripleSwath, OfEdgesThatShareAVertexIsNone) {
  const LitScene lit(SceneMaker()
                         .square_light()
                         .polygon({{0, -0.4, 0.5}, {0, 0.4, 0.6}, {0.6, 0, 0.55}})
                         .polygon({{-0.2, 0, 1.2}, {0.2, 0.2, 1.3}, {0.3, -0.4, 1.4}}));
  const EmitterScene& emitter_scene = lit.emitter_scene;
  const int a = edge_between(emitter_scene, {0, -0.4, 0.5}, {0, 0.4, 0.6});
  const int b = edge_between(emitter_scene, {0, 0.4, 0.6}, {0.6, 0, 0.55});
  const int c = edge_between(emitter_scene, {-0.2, 0, 1.2}, {0.2, 0.2, 1.3});
  EXPECT_TRUE(of_triple(emitter_scene, a, b, c).empty()) << "the third does not reach their plane";
}

TEST(PairSwaths, JoinTwoEdgesWithEveryPieceOfTheOutline) {
  const LitScene lit(test::three_skew_slats());
  const EmitterScene& emitter_scene = lit.emitter_scene;
  const int a = edge_between(emitter_scene, {-1, -0.9, 0.5}, {1.1, 0.8, 0.55});
  const int b = edge_between(emitter_scene, {-1, 0.7, 0.9}, {1.1, -0.9, 0.95});
  const std::vector<Swath> swaths =
      collect([&](const SwathSink& sink) { pair_swaths(emitter_scene, a, b, sink); });
  ASSERT_EQ(swaths.size(), 4u);
  std::set<EdgeId> pieces;
  for (const Swath& swath : swaths) {
    EXPECT_FALSE(swath.is_planar);
    EXPECT_TRUE(swath.ends_on_outline);
    ASSERT_EQ(swath.group.size(), 3u);
    pieces.insert(swath.group[0]);
    EXPECT_EQ(swath.group[1], EdgeId::edge(emitter_scene.edges[at(std::min(a, b))].id));
  }
  EXPECT_EQ(pieces, (std::set{EdgeId::emitter_edge(0), EdgeId::emitter_edge(1),
                              EdgeId::emitter_edge(2), EdgeId::emitter_edge(3)}));
}

}  // namespace
}  // namespace halfshade
